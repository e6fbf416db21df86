import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from reference import greedy_coverage as literal
from scanplan.errors import StageError
from scanplan.geometry.tolerances import ROUNDING, SMALLEST_M2
from scanplan.selection import bounds, objectives
from scanplan.selection.objectives import CellCoverage, PolygonArea
from scanplan.selection.survey_scans import SurveyScans

# weights of eighths add up without rounding: ties are ties
SCANS = st.lists(
    st.dictionaries(st.integers(0, 9), st.integers(0, 16).map(lambda w: w / 8), max_size=6),
    min_size=1,
    max_size=7,
)
OFTEN = settings(max_examples=150, deadline=None)


def coverage(scans):
    rows = [(i, c, w) for i, cells in enumerate(scans) for c, w in cells.items()]
    scan, cell, weight = np.array(rows).reshape(-1, 3).T
    return CellCoverage(scan.astype(int), cell.astype(int), weight, len(scans))


def test_on_paper():
    # 3 + 3, then 2 of the last scan's 5 (its 3 is shown already), then the half metre that cell 0
    # is seen better
    order = coverage([{0: 3.5}, {0: 3, 1: 3}, {1: 3, 2: 2}]).greedy()
    assert order.order.tolist() == [1, 2, 0]
    assert order.gain.tolist() == [6, 2, 0.5]
    assert order.covered.tolist() == [6, 8, 8.5]


@OFTEN
@given(SCANS, st.sampled_from([0.0, 0.25, 0.5, 1.0]))
def test_lazy_order_is_that_of_looking_at_every_scan(scans, min_overlap):
    order = coverage(scans).greedy(min_overlap)
    assert order.order.tolist() == literal.order(scans, ROUNDING, min_overlap)
    for k in range(1, len(scans) + 1):
        assert order.covered[k - 1] == pytest.approx(literal.value(scans, order.order[:k].tolist()))


@OFTEN
@given(SCANS, st.data())
def test_monotone_and_submodular(scans, data):
    shuffled = data.draw(st.permutations(range(len(scans))))
    small = data.draw(st.integers(0, len(shuffled) - 1))
    large = data.draw(st.integers(small, len(shuffled) - 1))
    last = shuffled[-1]
    after_few = coverage(scans).gains([*shuffled[:small], last])[-1]
    after_more = coverage(scans).gains([*shuffled[:large], last])[-1]
    assert after_few >= after_more - 1e-12 and after_more >= 0


@OFTEN
@given(SCANS)
def test_bound_is_never_below_the_best_subset(scans):
    order = coverage(scans).greedy()
    bound = bounds.bound_any_subset(order)
    assert (bound >= [literal.best(scans, k) - 1e-9 for k in range(1, len(scans) + 1)]).all()
    assert (bound >= order.covered).all()


@OFTEN
@given(SCANS, st.randoms(use_true_random=False))
def test_numbers_of_cells_do_not_matter(scans, rng):
    names = list(range(10))
    rng.shuffle(names)
    renamed = [{100 * names[c]: w for c, w in cells.items()} for cells in scans]
    assert coverage(renamed).greedy().order.tolist() == coverage(scans).greedy().order.tolist()


def test_overlap_keeps_the_order_connected_until_a_part_is_done():
    # a chain 0-1-2 of scans that share a metre, and a far one that alone adds most
    chain = [{0: 1, 1: 1}, {1: 1, 2: 1.5}, {2: 1.5, 3: 1}, {9: 5}]
    assert coverage(chain).greedy().order.tolist() == [3, 1, 0, 2]
    # with nothing that shares, the best of all; then what shares two fifths of its worth
    assert coverage(chain).greedy(min_overlap=0.4).order.tolist() == [3, 1, 0, 2]
    near = [*chain[:3], {0: 1, 9: 5}]
    assert coverage(near).greedy(min_overlap=0.4).order.tolist() == [3, 0, 1, 2]


def test_no_scan_one_scan_identical_scans_and_empty_ones():
    assert coverage([]).greedy().order.tolist() == []
    assert coverage([{}]).greedy().covered.tolist() == [0]
    assert coverage([{4: 2}] * 4).greedy().order.tolist() == [0, 1, 2, 3]
    mixed = coverage([{}, {4: 2}, {}, {4: 2}]).greedy(min_overlap=1.0)
    assert mixed.order.tolist() == [1, 0, 2, 3] and mixed.covered.tolist() == [2, 2, 2, 2]


@pytest.mark.parametrize(
    ("scan", "cell", "weight", "n"),
    [
        ([1, 0], [0, 0], [1, 1], 2),
        ([0, 2], [0, 0], [1, 1], 2),
        ([-1], [0], [1], 2),
        ([0], [0], [-1], 2),
        ([0], [0], [np.nan], 2),
        ([0], [0], [np.inf], 2),
        ([0], [0, 1], [1, 1], 2),
    ],
)
def test_wrong_calls_are_refused(scan, cell, weight, n):
    with pytest.raises(ValueError, match="must be"):
        CellCoverage(np.array(scan), np.array(cell), np.array(weight, float), n)


@pytest.mark.parametrize("order", [[0, 0], [2], [-1]])
def test_wrong_orders_are_refused(order):
    with pytest.raises(ValueError, match="distinct indices"):
        coverage([{0: 1}, {1: 1}]).gains(order)


@pytest.mark.parametrize("share", [-0.1, 1.1, np.nan])
def test_wrong_overlaps_are_refused(share):
    with pytest.raises(ValueError, match="min_overlap is"):
        coverage([{0: 1}]).greedy(share)


BOXES = st.lists(
    st.tuples(*[st.integers(0, 6)] * 2, *[st.integers(0, 4)] * 2).map(
        lambda b: box(b[0], b[1], b[0] + b[2], b[1] + b[3])
    ),
    min_size=1,
    max_size=7,
)


def look_at_all(polygons, min_overlap):
    """Look at every polygon in every step."""
    order, union = [], shapely.Polygon()
    while len(order) < len(polygons):
        gains = {
            i: polygons[i].difference(union).area for i in range(len(polygons)) if i not in order
        }
        shared = {
            i: g
            for i, g in gains.items()
            if g > SMALLEST_M2 and 1 - g / polygons[i].area >= min_overlap - 1e-9
        }
        gains = shared if order and shared else gains
        order.append(min(i for i, g in gains.items() if g >= max(gains.values()) - SMALLEST_M2))
        union = union | polygons[order[-1]]
    return order, union.area


@settings(max_examples=100, deadline=None)
@given(BOXES, st.sampled_from([0.0, 0.3, 0.8]))
def test_order_is_that_of_looking_at_every_polygon(polygons, min_overlap):
    found = PolygonArea(polygons).greedy(min_overlap)
    order, area_m2 = look_at_all(polygons, min_overlap)
    assert found.order.tolist() == order
    assert found.covered[-1] == pytest.approx(area_m2)
    assert PolygonArea(polygons).gains(found.order) == pytest.approx(found.gain)


def test_an_overlap_keeps_the_choice_beside_what_is_chosen():
    row = [box(0, 0, 4, 1), box(3, 0, 6, 1), box(5, 0, 7, 1), box(20, 0, 23, 1)]
    assert PolygonArea(row).greedy().order.tolist() == [0, 3, 1, 2]
    assert PolygonArea(row).greedy(0.3).order.tolist() == [0, 1, 2, 3]


def test_invalid_polygons_are_repaired():
    bow = shapely.Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])
    assert PolygonArea([bow, box(0, 0, 2, 2)]).greedy(0.1).covered.tolist() == pytest.approx([4, 4])


def test_wall_of_scans_that_are_not_there_is_refused():
    columns = {"scan_id": np.array([1, 7]), "length_m": np.ones(2)}
    scans = SurveyScans(np.array([1, 2]), {"observations": columns})
    with pytest.raises(StageError, match="run again"):
        objectives.cover_wall_length(scans)
