import numpy as np
import pytest
import shapely
from shapely import box

from scanplan import orderings, tables

# scan 3 covers two far boxes (its one hull is 12), scan 8 one box, scan 20 that box and a strip, scan 21 nothing
SCANS = {
    3: [box(0, 0, 1, 1), box(11, 0, 12, 1)],
    8: [box(0, 5, 4, 6)],
    20: [box(0, 5, 4, 6), box(4, 5, 5, 6)],
    21: [shapely.LineString([(0, 0), (1, 0)])],
}


def columns(scans=SCANS):
    rows = [(i, c, 4, g.area, g.wkb) for i, shapes in scans.items() for c, g in enumerate(shapes)]
    names = list(tables.HULLS.columns)
    return {n: np.array([r[j] for r in rows], object if n == "geometry" else None) for j, n in enumerate(names)}


@pytest.mark.parametrize(
    ("method", "scan_ids", "covered_m2"),
    [
        ("cluster_hull", [20, 3, 8, 21], [5, 7, 7, 7]),
        ("hull", [3, 20, 8, 21], [12, 17, 17, 17]),
        ("sequential", [3, 8, 20, 21], [2, 6, 7, 7]),
    ],
)
def test_orders_on_paper(method, scan_ids, covered_m2):
    found = orderings.order(method, columns(), seed=0)
    assert list(found) == list(tables.SELECTION.columns)
    assert found["rank"].tolist() == [1, 2, 3, 4]
    assert found["scan_id"].tolist() == scan_ids
    assert found["covered_m2"].tolist() == pytest.approx(covered_m2)
    assert found["gain_m2"].tolist() == pytest.approx(np.diff([0, *covered_m2]))


def test_random_is_a_permutation_drawn_with_the_seed():
    scans = {i: [box(i, 0, i + 1.5, 1)] for i in range(30)}
    drawn = [orderings.order("random", columns(scans), seed=s)["scan_id"].tolist() for s in (1, 1, 2)]
    assert drawn[0] == drawn[1] != drawn[2]
    assert sorted(drawn[2]) == list(range(30))
    assert drawn[0] != sorted(drawn[0])


@pytest.mark.parametrize("method", orderings.METHODS)
def test_bound_is_above_every_order_of_the_same_polygons(method):
    found = orderings.order(method, columns(), seed=0)
    assert (found["bound_m2"] >= found["covered_m2"]).all()
    if method != "hull":
        assert found["bound_m2"].tolist() == pytest.approx([5, 7, 7, 7], abs=1e-5)


@pytest.mark.parametrize("method", orderings.METHODS)
def test_one_scan_and_no_area(method):
    one = orderings.order(method, columns({5: SCANS[8]}), seed=0)
    assert [one[n].tolist() for n in one] == [[1], [5], [4.0], [4.0], [4.0]]
    nothing = orderings.order(method, columns({2: SCANS[21]}), seed=0)
    assert nothing["covered_m2"].tolist() == nothing["bound_m2"].tolist() == [0.0]
    assert "first 1 cover at least 100 %" in orderings.summary(method, nothing)


def test_summary():
    found = orderings.order("sequential", columns(), seed=0)
    assert orderings.summary("sequential", found) == (
        "sequential, 4 scans, 7.0 m2; 99% at 3 scans; first 4 cover at least 100 % of what any 4 could"
    )


def test_refuses_an_unknown_method():
    with pytest.raises(ValueError, match="cluster_hull, hull, random, sequential"):
        orderings.order("best", columns(), seed=0)
