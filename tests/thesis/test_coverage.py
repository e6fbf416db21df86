import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from scanplan.lab.evaluation import face_cells, visible_faces
from scanplan.lab.evaluation.truth_file import TrueFaces
from thesis import coverage

BOX = np.array([(0, 0, 6, 0), (6, 0, 6, 4), (6, 4, 0, 4), (0, 4, 0, 0)], float).reshape(-1, 2, 2)
# a pillar in the middle of the box
PILLAR = np.array(
    [(2.5, 1.5, 3.5, 1.5), (3.5, 1.5, 3.5, 2.5), (3.5, 2.5, 2.5, 2.5), (2.5, 2.5, 2.5, 1.5)], float
)
NOTHING = np.empty((0, 2, 2))


def seen(inner, place, max_range_m=100.0, outer=NOTHING):
    return coverage.seen_polygons(
        TrueFaces(inner, outer), np.array([place], float), max_range_m=max_range_m
    )[0]


def test_a_box_is_seen_whole():
    assert seen(BOX, (1, 1)).symmetric_difference(shapely.box(0, 0, 6, 4)).area < 1e-9


def test_outer_faces_hide_too():
    assert seen(BOX[:2], (1, 1), outer=BOX[2:]).area == pytest.approx(24)


def test_range_ends_the_view():
    assert seen(BOX, (3, 2), max_range_m=1.0).area == pytest.approx(np.pi, rel=1e-2)


def test_behind_a_pillar_nothing_is_seen():
    found = seen(np.concatenate([BOX, PILLAR.reshape(-1, 2, 2)]), (0.5, 2.0))
    # the pillar's near face, 1 m wide at 2 m, casts a shadow 0.5 + 3.5 * 0.25 wide at the far wall,
    # each side
    shadow = (1 + 2.75) / 2 * 3.5
    assert found.area == pytest.approx(24 - shadow)


@given(st.floats(0.1, 2.4), st.floats(0.1, 3.9))
def test_a_place_in_it_is_in_sight_of_its_middle(x, y):
    faces = np.concatenate([BOX, PILLAR.reshape(-1, 2, 2)])
    outline, cells = seen(faces, (x, y)), face_cells.cut_faces(faces)
    in_sight = visible_faces.visible_cells(cells, NOTHING, np.array([x, y]), max_range_m=100.0)
    reached = shapely.dwithin(outline.boundary, shapely.points(cells.middle_m), 1e-6)
    # a face seen edge-on is a matter of rounding, and one of the pillar is a 24th of all
    assert np.mean(reached == in_sight) > 0.95


def test_corners_that_coincide_leave_one_polygon():
    faces = np.concatenate([BOX, PILLAR.reshape(-1, 2, 2)])
    assert seen(faces, (0.5, 0.5625)).geom_type == "Polygon"
