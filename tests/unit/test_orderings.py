import numpy as np
import pytest
import shapely
from shapely import box

from helpers.refusals import assert_told
from scanplan.errors import StageError
from scanplan.selection import methods, orderings
from scanplan.store import schemas

# scan 3 covers two far boxes (its one hull is 12), scan 8 one box, scan 20 that box and a strip,
# scan 21 nothing
SCANS = {
    3: [box(0, 0, 1, 1), box(11, 0, 12, 1)],
    8: [box(0, 5, 4, 6)],
    20: [box(0, 5, 4, 6), box(4, 5, 5, 6)],
    21: [shapely.LineString([(0, 0), (1, 0)])],
}


def columns(scans=SCANS):
    rows = [(i, c, 4, g.area, g.wkb) for i, shapes in scans.items() for c, g in enumerate(shapes)]
    names = list(schemas.HULLS.columns)
    return {
        n: np.array([r[j] for r in rows], object if n == "geometry" else None)
        for j, n in enumerate(names)
    }


def others(scan_ids):
    """Free space of 1, 2, 3, ... m2.

    Scan i shows cells i and i + 1, the later the longer; ever longer steps.
    """
    n = len(scan_ids)
    free = shapely.box(np.arange(n) * 10, 0, np.arange(n) * 10 + np.arange(1, n + 1), 1)
    cells = np.arange(n)[:, None] + [0, 1]
    return {
        "visibility": {"scan_id": np.array(scan_ids), "geometry": shapely.to_wkb(free)},
        "observations": {
            "scan_id": np.repeat(scan_ids, 2),
            "facing": np.zeros(2 * n, np.int32),
            "along": cells.ravel(),
            "across": np.zeros(2 * n, np.int32),
            "length_m": np.repeat(np.arange(1.0, n + 1), 2),
        },
        "registration": {
            "scan_id": np.array(scan_ids),
            "t_ns": np.arange(n),
            "kept": np.ones(n, bool),
            "x_m": np.arange(n) ** 2.0,
            **dict.fromkeys(("y_m", "z_m", "qx", "qy", "qz", *schemas.COVARIANCE), np.zeros(n)),
            "qw": np.ones(n),
        },
    }


def order(method, columns, *, seed=0, **options):
    known = others(np.unique(columns["scan_id"]).tolist())
    return orderings.order_scans(
        method,
        columns,
        seed=seed,
        others={t: known[t] for t in methods.METHODS[method].tables},
        **options,
    )


@pytest.mark.parametrize(
    ("method", "scan_ids", "covered_m2"),
    [
        ("visibility", [21, 20, 8, 3], [0, 5, 5, 7]),
        ("wall_length", [21, 8, 3, 20], [0, 4, 6, 7]),
        ("every_nth", [3, 20, 8, 21], [2, 7, 7, 7]),
        ("distance", [3, 21, 20, 8], [2, 2, 7, 7]),
        ("cluster_hull", [20, 3, 8, 21], [5, 7, 7, 7]),
        ("hull", [3, 20, 8, 21], [12, 17, 17, 17]),
        ("streaming", [20, 3, 8, 21], [5, 7, 7, 7]),
        ("sequential", [3, 8, 20, 21], [2, 6, 7, 7]),
    ],
)
def test_orders_on_paper(method, scan_ids, covered_m2):
    found = order(method, columns())
    assert list(found) == list(schemas.SELECTION.columns)
    assert found["rank"].tolist() == [1, 2, 3, 4]
    assert found["scan_id"].tolist() == scan_ids
    assert found["covered_m2"].tolist() == pytest.approx(covered_m2)
    assert found["gain_m2"].tolist() == pytest.approx(np.diff([0, *covered_m2]))


def test_random_is_a_permutation_drawn_with_the_seed():
    scans = {i: [box(i, 0, i + 1.5, 1)] for i in range(30)}
    drawn = [
        orderings.order_scans("random", columns(scans), seed=s)["scan_id"].tolist()
        for s in (1, 1, 2)
    ]
    assert drawn[0] == drawn[1] != drawn[2]
    assert sorted(drawn[2]) == list(range(30))
    assert drawn[0] != sorted(drawn[0])


@pytest.mark.parametrize("method", orderings.METHODS)
def test_bound_is_above_every_order_of_the_same_polygons(method):
    found = order(method, columns())
    assert (found["bound"] >= found["covered"]).all()
    assert (found["bound_m2"] >= found["covered_m2"]).all()
    if method != "hull":
        assert found["bound_m2"].tolist() == pytest.approx([5, 7, 7, 7], abs=1e-5)


@pytest.mark.parametrize("method", orderings.METHODS)
def test_one_scan_and_no_area(method):
    one = order(method, columns({5: SCANS[8]}))
    own = {"wall_length": [2.0], "visibility": [1.0]}.get(method, [4.0])
    assert [one[n].tolist() for n in one] == [[1], [5], [4], [4.0], [4.0], [4.0], own, own, own]
    nothing = order(method, columns({2: SCANS[21]}))
    assert nothing["covered_m2"].tolist() == nothing["bound_m2"].tolist() == [0.0]
    assert_told(orderings.summarise_order(method, nothing), value=(100, "1 could"))


def test_summary():
    found = orderings.order_scans("sequential", columns(), seed=0)
    told = orderings.summarise_order("sequential", found)
    assert_told(told, value=("sequential", "4 scans", "7.0 m2", "99% at 3 scans", "100 %"))
    assert orderings.summarise_order("wall_length", order("wall_length", columns())).startswith(
        "wall_length, 4 scans, 14.0 m;"
    )


def test_own_units_are_those_of_the_objective():
    # cells of scans 3, 8, 20, 21: 1 1; 2 2; 3 3; 4 4, each scan's second is the next one's first
    walls = order("wall_length", columns())
    assert walls["gain"].tolist() == [8, 4, 1, 1] and walls["covered"].tolist() == [8, 12, 13, 14]
    free = order("visibility", columns())
    assert free["gain"].tolist() == [*free["bound"][:1].tolist(), 3, 2, 1] == [4, 3, 2, 1]
    for method in ("cluster_hull", "hull", "random", "sequential", "every_nth", "distance"):
        found = order(method, columns())
        for name in ("gain", "covered", "bound"):
            np.testing.assert_array_equal(found[name], found[f"{name}_m2"])


@pytest.mark.parametrize("method", ["wall_length", "visibility", "cluster_hull", "hull"])
def test_an_overlap_changes_the_order_and_no_bound(method):
    scans = {i: [box(3 * i, 0, 3 * i + 4 + i, 1)] for i in range(6)}
    free, bound_to = order(method, columns(scans)), order(method, columns(scans), min_overlap=0.2)
    assert sorted(bound_to["scan_id"]) == sorted(free["scan_id"])
    np.testing.assert_array_equal(bound_to["bound"] >= free["covered"], True)
    if method != "visibility":  # whose parts share nothing
        assert bound_to["scan_id"].tolist() != free["scan_id"].tolist()


@pytest.mark.parametrize("method", ["wall_length", "visibility", "distance"])
def test_tables_of_other_scans_are_refused(method):
    with pytest.raises(StageError, match=r"hulls.*; delete"):
        orderings.order_scans(method, columns(), seed=0, others=others([3, 8, 20, 22]))


def test_scans_that_show_no_wall_come_last_by_id():
    seen = others([3, 8, 20, 21])["observations"]
    shown = {"observations": {name: values[2:4] for name, values in seen.items()}}
    assert orderings.order_scans("wall_length", columns(), seed=0, others=shown)[
        "scan_id"
    ].tolist() == [8, 3, 20, 21]
    none = {"observations": {name: values[:0] for name, values in seen.items()}}
    found = orderings.order_scans("wall_length", columns(), seed=0, others=none)
    assert found["scan_id"].tolist() == [3, 8, 20, 21] and found["covered"].tolist() == [0, 0, 0, 0]


def test_streaming_chooses_for_its_slots_and_then_goes_on_as_recorded():
    scans = {i: [box(3 * i, 0, 3 * i + 1 + i % 3, 1)] for i in range(9)}
    found = order("streaming", columns(scans), streaming_settings={"k": 3, "epsilon": 0.1})
    assert found["scan_id"].tolist() == [2, 5, 8, 0, 1, 3, 4, 6, 7]
    assert found["covered_m2"][2] == found["bound_m2"][2] == 9


@pytest.mark.parametrize(
    ("method", "scan_ids"),
    [
        ("wall_length", [21, 8, 3, 20]),
        ("visibility", [21, 8, 20, 3]),
        ("cluster_hull", [8, 3, 20, 21]),
        ("hull", [3, 8, 20, 21]),
    ],
)
def test_a_budget_puts_scans_that_fit_it_first(method, scan_ids):
    table = columns()
    # 8, 4, 100 and 5 points: scan 20 alone is too much
    table["n_points"] = np.array([4, 4, 4, 50, 50, 5])
    found = order(method, table, budget=14)
    assert found["scan_id"].tolist() == scan_ids
    assert found["n_points"].tolist() == [{3: 8, 8: 4, 20: 100, 21: 5}[i] for i in scan_ids]
    assert (found["bound"] >= found["covered"]).all()


@pytest.mark.parametrize("method", ["wall_length", "visibility", "cluster_hull", "hull"])
def test_a_budget_for_all_scans_changes_no_order(method):
    assert (
        order(method, columns(), budget=10**9)["scan_id"].tolist()
        == order(method, columns())["scan_id"].tolist()
    )


@pytest.mark.parametrize("method", ["sequential", "streaming"])
def test_a_budget_changes_no_order_without_an_objective(method):
    assert (
        order(method, columns(), budget=5)["scan_id"].tolist()
        == order(method, columns())["scan_id"].tolist()
    )


def varied(method, name):
    """Orders of 30 overlapping scans by two values of one of the workflow's settings."""
    scans = {
        i: [box(i % 7, i // 7, i % 7 + 1 + (i % 5) / 2, i // 7 + 1 + (i % 3) / 2)]
        for i in range(30)
    }
    values = {"seed": (1, 2), "min_overlap": (0.0, 0.9), "budget": (12, 40)}
    values["streaming"] = [{"k": k, "epsilon": 0.1} for k in (3, 20)]
    keyword = "streaming_settings" if name == "streaming" else name
    hulls = columns(scans)
    # a budget matters only where scans cost different numbers of points
    hulls["n_points"] = 1 + np.arange(len(hulls["scan_id"])) * 7 % 10
    return [order(method, hulls, **{keyword: value})["scan_id"].tolist() for value in values[name]]


@pytest.mark.parametrize("name", ["seed", "min_overlap", "budget", "streaming"])
def test_an_order_depends_on_the_settings_that_the_workflow_gives_it_and_on_no_other(name):
    depends = {
        method for method in methods.METHODS if len({tuple(o) for o in varied(method, name)}) > 1
    }
    named = {method for method in methods.METHODS if name in methods.METHODS[method].settings}
    assert depends <= named and depends


def test_refuses_a_random_order_without_a_seed():
    with pytest.raises(ValueError, match="seed"):
        order("random", columns(), seed=None)


def test_refuses_an_unknown_method():
    with pytest.raises(
        ValueError,
        match="only wall_length, visibility, cluster_hull, hull, streaming, every_nth, distance",
    ):
        orderings.order_scans("best", columns(), seed=0)
