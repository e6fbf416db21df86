import numpy as np
import pytest
import shapely

from scanplan.geometry.lines import line_lengths_m
from scanplan.lab.evaluation import face_cells, visible_faces

NO_FACES = np.empty((0, 2, 2))
# a room of 4 m x 4 m whose east wall, 0.2 m thick, has a door of 1 m, and a larger room behind it
ROOM = np.array(
    [
        (0, 0, 4, 0),
        (4, 4, 0, 4),
        (0, 4, 0, 0),
        (4, 0, 4, 1.5),
        (4, 2.5, 4, 4),
        (4, 1.5, 4.2, 1.5),
        (4, 2.5, 4.2, 2.5),
        (4.2, 0, 4.2, 1.5),
        (4.2, 2.5, 4.2, 4),
        (8, -4, 8, 8),
    ],
    float,
).reshape(-1, 2, 2)


def seen_m(faces, position, max_range_m=100.0, outer=NO_FACES):
    cells = face_cells.cut_faces(faces)
    seen = visible_faces.visible_cells(
        cells, outer, np.array(position, float), max_range_m=max_range_m
    )
    return np.bincount(cells.face, cells.length_m * seen, minlength=len(faces))


class TestSeen:
    def test_a_room_and_what_its_door_shows(self):
        # from 2 m before the door, the jambs edge-on through 1 m at 2.2 m: 6 / 2.2 m on the far
        # wall at 6 m
        found = seen_m(ROOM, (2, 2))
        np.testing.assert_allclose(found[:5], [4, 4, 4, 1.5, 1.5], atol=0.021)
        np.testing.assert_allclose(found[5:9], [0.2, 0.2, 0, 0], atol=1e-9)
        assert found[9] == pytest.approx(6 / 2.2, abs=0.021)

    def test_a_jamb_seen_from_its_back_side_hides_itself(self):
        found = seen_m(ROOM, (2, 0.2))
        assert found[5] == 0 and found[6] == pytest.approx(0.2)

    def test_beyond_range_nothing_is_seen(self):
        # a circle of 2.5 m around (2, 2) cuts 2 * 1.5 m off a wall at 2 m
        assert seen_m(ROOM, (2, 2), 2.5)[0] == pytest.approx(3, abs=0.021)
        assert seen_m(ROOM, (2, 2), 2.5)[9] == 0

    def test_outer_faces_hide(self):
        found = seen_m(ROOM, (2, 2), outer=np.array([[(5.0, 0), (5.0, 4)]]))
        assert found[9] == 0

    def test_on_a_face_or_in_line_with_one_it_is_finite(self):
        assert seen_m(ROOM, (4.1, 1.5)).sum() >= 0
        assert np.isfinite(seen_m(ROOM, (4.0, 2.0))).all()

    def test_agrees_with_rays_among_many_walls(self):
        rng = np.random.default_rng(3)
        start = rng.uniform(-5, 5, (30, 2))
        faces = np.stack([start, start + rng.normal(0, 0.5, (30, 2))], axis=1)
        lines = shapely.linestrings(faces)
        crossing = shapely.STRtree(lines).query(lines, predicate="intersects")
        faces = np.delete(faces, np.unique(crossing[0][crossing[0] != crossing[1]]), axis=0)
        assert len(faces) > 15
        cells = face_cells.cut_faces(faces)
        rays = shapely.linestrings(
            np.stack([np.zeros_like(cells.middle_m), cells.middle_m * (1 - 1e-6)], axis=1)
        )
        free = ~np.array(
            [shapely.intersects(ray, shapely.linestrings(faces)).any() for ray in rays]
        )
        found = visible_faces.visible_cells(cells, NO_FACES, np.zeros(2), max_range_m=100.0)
        assert 0.1 < free.mean() < 0.9
        np.testing.assert_array_equal(found, free)

    def test_of_several_places_each_has_a_row(self):
        cells = face_cells.cut_faces(ROOM)
        poses = np.tile(np.eye(4), (2, 1, 1))
        poses[:, :2, 3] = [(2.0, 2.0), (6.0, 2.0)]
        both = visible_faces.cells_seen_by_each(
            cells, NO_FACES, poses, visible_faces.SensorView(100.0)
        )
        np.testing.assert_array_equal(
            both[0],
            visible_faces.visible_cells(cells, NO_FACES, np.array([2.0, 2]), max_range_m=100.0),
        )
        assert (both[0] != both[1]).any()

    def test_what_is_asked_for_is_seen_as_if_all_were(self):
        rng = np.random.default_rng(8)
        cells = face_cells.cut_faces(ROOM)
        for place_m in rng.uniform(0.1, 3.9, (20, 2)):
            everything = visible_faces.visible_cells(cells, NO_FACES, place_m, max_range_m=5.0)
            # cells of all faces, of a few faces, and none
            for asked in (rng.random(len(cells.face)) < 0.3, cells.face % 3 == 1, cells.face < 0):
                found = visible_faces.visible_cells(
                    cells, NO_FACES, place_m, max_range_m=5.0, asked=asked
                )
                np.testing.assert_array_equal(found, everything & asked)

    def test_a_survey_sees_what_any_of_its_poses_sees(self):
        rng = np.random.default_rng(5)
        cells = face_cells.cut_faces(ROOM)
        turned_rad = rng.uniform(0, 2 * np.pi, 40)
        poses = np.tile(np.eye(4), (40, 1, 1))
        poses[:, 0, 0] = poses[:, 1, 1] = np.cos(turned_rad)
        poses[:, 1, 0] = np.sin(turned_rad)
        poses[:, 0, 1] = -poses[:, 1, 0]
        poses[:, :2, 3] = rng.uniform(0.1, 3.9, (40, 2))
        view = visible_faces.SensorView(5.0, field_rad=1.0)
        each = visible_faces.cells_seen_by_each(cells, NO_FACES, poses, view)
        any_of_them = visible_faces.cells_seen_by_any(cells, NO_FACES, poses, view)
        assert each[0].sum() < any_of_them.sum() < len(any_of_them)
        np.testing.assert_array_equal(any_of_them, each.any(axis=0))


class TestCells:
    CELLS = face_cells.cut_faces(np.array([[(0, 0), (0.05, 0)], [(1, 1), (1, 1.04)]], float))

    def test_faces_are_cut_evenly(self):
        np.testing.assert_array_equal(self.CELLS.face, [0, 0, 0, 1, 1])
        np.testing.assert_allclose(self.CELLS.length_m, [0.05 / 3] * 3 + [0.02] * 2)
        np.testing.assert_allclose(self.CELLS.middle_m[3:], [(1, 1.01), (1, 1.03)])
        assert self.CELLS.length_m.sum() == pytest.approx(0.09)

    def test_a_stretch_has_the_cells_whose_middles_it_holds(self):
        begin, end = face_cells.cells_in_intervals(
            self.CELLS, np.array([0, 1, 1, 0]), [0.0, 0.015, 0.04, 0.0], [0.03, 1, 1, 0.001]
        )
        np.testing.assert_array_equal(begin, [0, 4, 5, 0])
        np.testing.assert_array_equal(end, [2, 5, 5, 0])

    def test_neighbouring_cells_of_a_face_are_joined(self):
        joined = face_cells.join_cells(self.CELLS, np.array([0, 1, 1, 1, 0], bool))
        np.testing.assert_allclose(joined[0], [(0.05 / 3, 0), (0.05, 0)])
        np.testing.assert_allclose(joined[1], [(1, 1), (1, 1.02)])
        assert len(face_cells.join_cells(self.CELLS, np.zeros(5, bool))) == 0

    def test_joining_all_gives_the_faces(self):
        everything = face_cells.join_cells(self.CELLS, np.ones(5, bool))
        np.testing.assert_allclose(line_lengths_m(everything), [0.05, 0.04])


def test_a_field_lies_to_either_side_of_forward():
    cells = face_cells.cut_faces(np.array([[(-1, 1), (1, 1)], [(-1, -1), (1, -1)]], float))
    forward_is_y = np.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 5], [0, 0, 0, 1]], float)
    right, whole = (
        visible_faces.is_in_field(cells.middle_m, forward_is_y, np.pi / 2),
        visible_faces.is_in_field(cells.middle_m, forward_is_y, np.pi),
    )
    assert right[:100].all() and whole[:100].all() and not right[100:].any()
    assert not visible_faces.is_in_field(cells.middle_m, forward_is_y, np.pi / 4)[[0, 99]].any()


def test_a_way_is_thinned_by_distance():
    way = np.column_stack([[0, 0.1, 0.2, 0.3, 0.3, 1.0], np.zeros(6)])
    np.testing.assert_array_equal(visible_faces.thin_positions(way, 0.25), [0, 3, 5])


def test_the_view_is_the_room_and_what_the_door_shows():
    outline = shapely.Polygon(
        visible_faces.visible_polygon(ROOM, np.array([2.0, 2.0]), open_m=100.0)
    )
    # the room, all of the door, and a fan whose edges pass its outer corners, 0.5 m off the middle
    # at 2.2 m
    fan = (0.5 + 6 * 0.5 / 2.2) * 3.8
    assert outline.area == pytest.approx(16 + 0.2 + fan)


def test_the_view_into_the_open_goes_as_far_as_told():
    wall = np.array([[(1, -1), (1, 1)]], float)
    corners = visible_faces.visible_polygon(wall, np.array([0.0, 0.0]), open_m=5.0)
    assert np.hypot(*corners.T).max() == pytest.approx(5)
    assert np.isclose(corners[:, 0], 1).sum() == 2
