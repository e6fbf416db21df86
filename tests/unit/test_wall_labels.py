"""Parts of toy walls whose rays are known one by one, see `helpers.label_making`."""

import numpy as np
import pytest

from helpers.label_making import (
    CEILING_M,
    HALL_M,
    NORTH_M,
    SOUTH_M,
    paired,
    scans_at,
    solid,
    with_hole,
)
from scanplan.plan.model import things
from scanplan.plan.model.surface_counts import BEYOND, FACE, PASSED, SHALLOW, add_passages
from scanplan.plan.model.surfaces import label_surfaces
from scanplan.plan.model.wall_labels import LabelEvidence, count_wall, label_wall, part_wall

MAX_OPENING_M = 2.0
NO_WAY_M = np.empty((0, 2))
MAX_DOOR_M = 1.2


def evidence(looked):
    return LabelEvidence(looked, NO_WAY_M, MAX_OPENING_M)


def parts(wall, looked):
    return list(label_wall(wall, evidence(looked)))


def spans_x(spans):
    """Return from where to where along x (n, 2) what has ends lies."""
    return [np.sort(span.ends[:, 0]).tolist() for span in spans]


def openings_x(wall):
    ends = [wall.line.at(np.array([o.low_m, o.high_m]))[:, 0] for o in wall.openings]
    return [np.sort(one).tolist() for one in ends]


class TestParts:
    def test_a_wall_is_parted_with_its_faces_and_what_has_none_is_no_part(self):
        wall, _ = paired(scans_at(5, solid), [(0, 5)], length_m=5.0)
        found = list(part_wall(wall, np.array([3.0])))
        ends_m = np.sort([wall.line.along_m(of.ends) for of in found])
        np.testing.assert_allclose(ends_m, [(0, 3), (3, 5)], atol=1e-6)
        assert [[face.length_m for face in of.members] for of in found] == [[3], [2]]
        assert len(list(part_wall(wall, np.array([3.0, 3.0])))) == 2
        assert list(part_wall(wall, np.empty(0))) == [wall]

    def test_a_solid_wall_stays_as_it_is(self):
        wall, looked = paired(scans_at(5, solid), [(0, 5)], length_m=5.0)
        ((part, top_m),) = parts(wall, looked)
        assert (part.low_m, part.high_m) == (0, 5) and np.isnan(top_m)
        assert part.openings == [] and part.closed == []
        assert 0.9 < part.p_solid <= 1

    def test_a_door_cuts_the_faces_and_not_the_wall(self):
        wall, looked = paired(
            scans_at(5, with_hole((2, 2.9), (0, 2.1))), [(0, 2), (2.9, 5)], length_m=5.0
        )
        ((part, _),) = parts(wall, looked)
        (door,) = part.openings
        assert (door.kind, door.sill_m, door.below_wall) == ("door", 0, True)
        np.testing.assert_allclose(openings_x(part), [(2, 2.9)], atol=0.03)
        np.testing.assert_allclose(spans_x(part.left), [(0, 2), (2.9, 5)], atol=0.03)

    def test_a_window_leaves_the_faces_whole(self):
        wall, looked = paired(scans_at(5, with_hole((2, 3.2), (0.9, 2.1))), [(0, 5)], length_m=5.0)
        ((part, _),) = parts(wall, looked)
        (window,) = part.openings
        assert window.kind == "window" and window.sill_m == pytest.approx(0.9, abs=0.15)
        assert window.lintel_m == pytest.approx(2.1, abs=0.15)
        assert spans_x(part.left) == [[0, 5]]

    def test_what_is_open_from_one_wall_to_another_parts_it_too(self):
        scans = scans_at(5, with_hole((1.2, 2.6)), ceiling_m=HALL_M)
        wall, looked = paired(scans, [(0, 1.2), (2.6, 5)], length_m=5.0)
        crossed_m = np.array([(1.0, 1.4), (2.4, 2.8)])
        assert len(list(label_wall(wall, evidence(looked), crossed_m=crossed_m))) == 2

    @pytest.mark.parametrize(("wide_m", "n_parts"), [(1.4, 1), (2.6, 2)])
    def test_what_is_open_for_long_parts_a_wall_in_two(self, wide_m, n_parts):
        begin_m, end_m = 1.2, 1.2 + wide_m
        scans = scans_at(5, with_hole((begin_m, end_m)), ceiling_m=HALL_M)
        wall, looked = paired(scans, [(0, begin_m), (end_m, 5)], length_m=5.0)
        found = [part for part, _ in parts(wall, looked)]
        assert len(found) == n_parts
        if n_parts == 2:
            np.testing.assert_allclose(spans_x(found), [(0, begin_m), (end_m, 5)], atol=0.06)
            assert found[0].openings == found[1].openings == []

    def test_what_is_open_at_an_end_is_no_wall(self):
        scans = scans_at(5, with_hole((3.5, 5.1)), ceiling_m=HALL_M)
        wall, looked = paired(scans, [(0, 3.5)], length_m=5.0)
        ((part, _),) = parts(wall, looked)
        assert part.high_m == pytest.approx(3.5, abs=0.06) and part.openings == []

    def test_of_which_the_right_side_alone_is_left_is_turned(self):
        """From the north a wall was seen up to x = 1.2, from the south beyond a gap of 2.6 m."""
        north = scans_at(3.8, with_hole((1.2, 9.0)), ceiling_m=HALL_M)
        south = scans_at(5, with_hole((1.2, 3.8)), SOUTH_M, face_y_m=-0.2, ceiling_m=HALL_M)
        wall, looked = paired(north + south, [(0, 1.2)], [(0, 1.2), (3.8, 5)], length_m=5.0)
        (one, _), (other, _) = parts(wall, looked)
        assert one.left and one.right and one.thickness_m == pytest.approx(0.2)
        np.testing.assert_allclose(one.line.offset_m(wall.line.centre), 0, atol=1e-9)
        # it lies where its face does, and how thick it is was not seen
        assert other.left and not other.right and np.isnan(other.thickness_m)
        assert other.line.normal.tolist() == [0, -1]
        np.testing.assert_allclose(other.line.offset_m(np.array([4.0, -0.2])), 0, atol=1e-9)
        np.testing.assert_allclose(spans_x([other]), [(3.8, 5)], atol=0.06)
        np.testing.assert_allclose(spans_x(other.left), [(3.8, 5)], atol=0.06)

    def test_the_openings_of_what_is_turned_are_where_they_were(self):
        """As before, with a door from x = 5 to 5.9 beyond the gap."""
        north = scans_at(3.8, with_hole((1.2, 9.0)), ceiling_m=HALL_M)
        hole = with_hole((1.2, 3.8), around=with_hole((5, 5.9), (0, 2.1)))
        sensors_m = (*SOUTH_M, (5.0, -2.2, 1.2), (6.0, -2.7, 1.2))
        south = scans_at(7, hole, sensors_m, face_y_m=-0.2, ceiling_m=HALL_M)
        right = [(0, 1.2), (3.8, 5), (5.9, 7)]
        wall, looked = paired(north + south, [(0, 1.2)], right, length_m=7.0)
        _, (turned, _) = parts(wall, looked)
        assert turned.line.normal.tolist() == [0, -1]
        np.testing.assert_allclose(openings_x(turned), [(5, 5.9)], atol=0.03)
        np.testing.assert_allclose(sorted(spans_x(turned.left)), [(3.8, 5), (5.9, 7)], atol=0.06)

    def test_a_pause_of_the_faces_that_nobody_saw_is_closed(self):
        def hidden(x, _z):
            return -0.5 if 2 < x < 3 else 0.0

        wall, looked = paired(scans_at(5, hidden), [(0, 2), (3, 5)], length_m=5.0)
        ((part, _),) = parts(wall, looked)
        assert part.openings == []
        np.testing.assert_allclose([(g.low_m, g.high_m) for g in part.closed], [(2, 3)])


class TestWaysThrough:
    """Nobody can see whether there is a door from 1 to 2 m of a wall, but somebody went there."""

    @staticmethod
    def look(track_m):
        wall, looked = paired(scans_at(5, solid), [(0, 1), (2, 5)], length_m=5.0)
        counts = count_wall(wall, looked)
        found = add_passages(counts, wall.line, looked, np.array(track_m))
        return counts, (found.ends - counts.ends).sum(axis=(1, 2))

    def test_where_a_sensor_was_carried_through_it_is_free(self):
        counts, added = self.look([(1.5, 1.0), (1.5, 0.3), (1.5, -0.9), (3.0, -0.9)])
        is_way = np.abs(counts.middles_m - 1.5) < 0.2
        assert (added[is_way, PASSED] > 0).all() and (added[~is_way] == 0).all()

    @pytest.mark.parametrize(
        "track_m", [[(1.5, 3.0), (1.5, -3.0)], [(0.0, 0.1), (1.4, -0.1)], [(1.5, 2.0), (1.5, 1.0)]]
    )
    def test_a_long_step_a_way_along_it_and_one_that_stays_say_nothing(self, track_m):
        assert (self.look(track_m)[1] == 0).all()


class TestLowParts:
    """A wall of 5 m that is 1.1 m high from x = 3 on: there rays pass over it."""

    @staticmethod
    def look(sensors_m=NORTH_M, face_y_m=0.0):
        over = with_hole((3, 9), (1.1, 9))
        return scans_at(5, over, sensors_m, face_y_m=face_y_m, ceiling_m=HALL_M)

    def test_what_ends_low_is_a_part_of_its_own(self):
        wall, looked = paired(self.look(), [(0, 5)], length_m=5.0)
        (one, one_top_m), (two, two_top_m) = parts(wall, looked)
        np.testing.assert_allclose(spans_x([one, two]), [(0, 3), (3, 5)], atol=0.06)
        assert np.isnan(one_top_m) and two_top_m == pytest.approx(1.1)

    def test_where_one_side_alone_was_seen_it_is_asked_what_it_is(self, monkeypatch):
        """Of the part that rays pass over it is told; how high it is says nothing of a wall."""
        asked = []

        def keep(features, *_known):
            asked.extend(features)
            return np.eye(4)[[things.WALL] * len(features)]

        monkeypatch.setattr(things, "weigh_things", keep)
        wall, looked = paired(self.look(), [(0, 5)], length_m=5.0)
        found = label_surfaces([wall], evidence(looked), max_door_m=MAX_DOOR_M)
        np.testing.assert_allclose(spans_x(found.walls), [(0, 3), (3, 5)], atol=0.06)
        assert [features.overlooked for features in asked] == [0, pytest.approx(1, abs=0.05)]
        assert np.isnan(found.tops_m).all()

    @pytest.mark.parametrize(("p_wall", "n_nearly"), [(0.4, 1), (0.2, 0)])
    def test_what_is_hardly_likelier_something_else_is_nearly_a_wall(
        self, monkeypatch, p_wall, n_nearly
    ):
        p = np.array([[1.0, 0, 0, 0], [p_wall, 1 - p_wall, 0, 0]])
        monkeypatch.setattr(things, "weigh_things", lambda *_: p)
        wall, looked = paired(self.look(), [(0, 5)], length_m=5.0)
        found = label_surfaces([wall], evidence(looked), max_door_m=MAX_DOOR_M)
        assert [part.p_wall for part in found.walls] == [1.0]
        assert [(near.kind, near.p) for near in found.nearly] == [("wall", p_wall)] * n_nearly
        for near in found.nearly:
            np.testing.assert_allclose(np.sort(near.ends_m[:, 0]), (3, 5), atol=0.06)

    def test_it_stays_where_both_sides_were_seen(self):
        scans = self.look() + self.look(SOUTH_M, -0.2)
        wall, looked = paired(scans, [(0, 5)], [(0, 5)], length_m=5.0)
        found = label_surfaces([wall], evidence(looked), max_door_m=MAX_DOOR_M)
        assert [round(part.length_m, 1) for part in found.walls] == [3, 2]
        assert found.tops_m == pytest.approx([np.nan, 1.1], nan_ok=True)


class TestCounts:
    def test_rays_that_end_at_either_face_are_at_the_wall(self):
        north = scans_at(5, solid, NORTH_M[:1])
        south = scans_at(5, solid, SOUTH_M[1:], face_y_m=-0.2)
        wall, looked = paired(north + south, [(0, 5)], [(0, 5)], length_m=5.0)
        ends = count_wall(wall, looked).ends
        n_rows = round((CEILING_M - 0.1) / 0.2)
        # how many returns ought to be there is an estimate: some are taken for lost
        assert ends[1:-1, :n_rows, :, FACE].sum(axis=2).min() > 1
        assert ends[..., SHALLOW : BEYOND + 1].sum() == 0
