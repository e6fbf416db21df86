import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from scanplan.selection import area_greedy
from scanplan.selection.polygon_area import PolygonArea

BOXES = st.lists(
    st.tuples(*[st.integers(0, 6)] * 2, *[st.integers(0, 4)] * 2).map(
        lambda b: box(b[0], b[1], b[0] + b[2], b[1] + b[3])
    ),
    min_size=1,
    max_size=7,
)


def plainly(polygons, min_overlap):
    """Look at every polygon in every step."""
    order, union = [], shapely.Polygon()
    while len(order) < len(polygons):
        gains = {
            i: polygons[i].difference(union).area for i in range(len(polygons)) if i not in order
        }
        shared = {
            i: g
            for i, g in gains.items()
            if g > area_greedy.TIE_M2 and 1 - g / polygons[i].area >= min_overlap - 1e-9
        }
        gains = shared if order and shared else gains
        order.append(
            min(i for i, g in gains.items() if g >= max(gains.values()) - area_greedy.TIE_M2)
        )
        union = union | polygons[order[-1]]
    return order, union.area


@settings(max_examples=100, deadline=None)
@given(BOXES, st.sampled_from([0.0, 0.3, 0.8]))
def test_order_is_that_of_looking_at_every_polygon(polygons, min_overlap):
    found = PolygonArea(polygons).greedy(min_overlap)
    order, area_m2 = plainly(polygons, min_overlap)
    assert found.order.tolist() == order
    assert found.covered_m2[-1] == pytest.approx(area_m2)
    assert PolygonArea(polygons).gains(found.order) == pytest.approx(found.gain_m2)


def test_an_overlap_keeps_the_choice_beside_what_is_chosen():
    row = [box(0, 0, 4, 1), box(3, 0, 6, 1), box(5, 0, 7, 1), box(20, 0, 23, 1)]
    assert PolygonArea(row).greedy().order.tolist() == [0, 3, 1, 2]
    assert PolygonArea(row).greedy(0.3).order.tolist() == [0, 1, 2, 3]


def test_invalid_polygons_are_repaired():
    bow = shapely.Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])
    assert PolygonArea([bow, box(0, 0, 2, 2)]).greedy(0.1).covered_m2.tolist() == pytest.approx(
        [4, 4]
    )
