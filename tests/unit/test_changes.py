"""Two surveys of a floor: frames, walls, openings, rooms and furniture, in a floor on paper."""

import json
from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers import changing_floor
from helpers.changing_floor import DOOR, INNER, SENSORS, survey
from helpers.refusals import refused
from scanplan.changes import (
    change_table,
    comparison,
    face_shifts,
    frames,
    opening_changes,
    ray_cells,
    room_changes,
    scan_plane,
    verdicts,
    wall_cells,
    wall_changes,
    wall_rays,
)
from scanplan.changes.frame_fit import fit_frame
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.seen_floors import see_floor
from scanplan.changes.surveys import RaySight
from scanplan.changes.verdicts import GONE, MOVED, NEW, NOT_SEEN, OPENED, SAME, SHUT
from scanplan.project.dataset import pair_surveys
from scanplan.rays.ray_set import gather_rays
from scanplan.store import schemas, tables

LEAF = (5, 3.0, 5, 3.9)
Y_M = ("y0_m", "y1_m")
STILL = PlaneMotion()
MOVED_ROOM = PlaneMotion(np.radians(40), 3.0, 0.5)


def tie(a, b):
    return frames.tie_frames((see_floor(a.plan), see_floor(b.plan)), ("a", "b"))


def compare(a, b):
    """All changes between two surveys whose rays lie in one frame already."""
    fit = fit_frame(a.faces, b.faces, PlaneMotion())
    shifts = face_shifts.measure_shifts(a, b, fit)
    changes = wall_changes.compare_walls(a, b, shifts)
    changes += opening_changes.compare_openings(a, b, changes)
    changes += room_changes.compare_rooms(a, b, changes)
    return changes + room_changes.compare_pieces(a, b, schemas.PIECE)


class Stub:
    """What is the same all along every wall."""

    plane = None

    def __init__(self, seen, off_m=0.0):
        self.seen = seen
        self.off_m = off_m

    def look_at(self, line, span_m, half_m):
        n = ray_cells.count_cells(span_m)
        rows = [of[of[:, 0] < n] for of in (self.seen.passing, self.seen.ending)]
        return ray_cells.Looks(self.seen.hits[:n], self.seen.passes[:n], *rows)

    def place_returns(self, line, span_m, reach_m):
        return np.full((ray_cells.count_cells(span_m), self.seen.hits.shape[1]), self.off_m)


def told(changes, table, *wanted):
    return [c for c in changes if c.table == table and c.verdict in (wanted or verdicts.CHANGES)]


@settings(max_examples=15)
@given(st.floats(-np.pi, np.pi), st.floats(-30, 30), st.floats(-30, 30))
def test_a_motion_applied_to_a_plan_is_found_again(yaw_rad, x_m, y_m):
    motion = PlaneMotion(yaw_rad, x_m, y_m)
    found = tie(survey(), survey(motion=motion))
    corner_m = np.array([8.0, 5.0])
    there_m = found.fit.motion.move(motion.inverse().move(corner_m))
    assert np.abs(there_m - corner_m).max() < 1e-3
    assert found.share == pytest.approx(1.0, abs=0.02) and found.fit.residual_m < 1e-3
    assert found.others == []


def test_a_wall_that_moved_does_not_move_the_frame():
    found = tie(survey(), survey([(5.1, 0, 5.1, 5)], [], motion=MOVED_ROOM))
    off_m = found.fit.motion.move(MOVED_ROOM.inverse().move(np.array([8.0, 5.0]))) - [8.0, 5.0]
    assert np.abs(off_m).max() < 0.01
    sigma_m = np.sqrt(np.diag(found.fit.covariance)[:2])
    assert ((sigma_m > 1e-3) & (sigma_m < 0.02)).all()


@pytest.mark.parametrize(("p_true", "is_bent"), [(0.1, False), (0.99, True)])
def test_furniture_that_was_carried_says_nothing_of_how_bent_maps_are(p_true, is_bent):
    fronts = [(x_m, 1, x_m, 3.5) for x_m in (2.0, 6.5)]
    carried = [(x_m + 0.3, *rest, x_m + 0.3, y_m) for x_m, *rest, _, y_m in fronts]
    before, after = (survey([INNER, *of], []) for of in (fronts, carried))
    for of in (before, after):
        of.plan.walls["p_true"][5:] = p_true
    scatter_m = fit_frame(before.faces, after.faces, STILL).scatter_m
    assert scatter_m > 0.1 if is_bent else scatter_m < 0.01


def test_frames_that_are_one_are_said_to_be_without_a_minus():
    found = tie(survey(), survey())
    nearly = replace(found.fit, motion=PlaneMotion(-1e-9, -1e-9, -1e-9))
    said = change_table.summarise_tie(replace(found, fit=nearly))
    assert "+0.00 " in said and "-0.0" not in said


def test_a_symmetric_floor_is_told_and_frames_are_left_as_they_are():
    square = [(0, 0, 5, 0), (5, 0, 5, 5), (5, 5, 0, 5), (0, 5, 0, 0)]
    a = survey([], [], outer=square)
    found = tie(a, survey([], [], outer=square))
    assert found.fit.motion.yaw_rad == pytest.approx(0.0, abs=1e-6)
    turns = sorted(round(np.degrees(motion.yaw_rad)) % 360 for motion, _ in found.others)
    assert turns == [90, 180, 270]
    assert "3 other ways" in change_table.warn_of_others(found)


def test_floors_that_do_not_fit_are_refused_in_one_line():
    star = [(0, 0, 3, 1), (3, 1, 9, 0.2), (9, 0.2, 5, 7), (5, 7, 1.2, 4), (1.2, 4, 0, 0)]
    with refused(file=("a", "b"), remedy="two surveys") as fault:
        tie(survey(), survey([], [], outer=star))
    assert "\n" not in str(fault.value)


def test_parallel_walls_alone_do_not_tie_frames():
    corridor = [(0, 0, 20, 0), (20, 2, 0, 2)]
    with refused(value="one direction"):
        tie(survey([], [], outer=corridor), survey([], [], outer=corridor))


@settings(max_examples=10)
@given(st.lists(st.sampled_from(SENSORS), min_size=1, max_size=6, unique=True))
def test_what_has_not_changed_is_never_told_as_changed_whatever_was_seen(sensors):
    a, b = survey(), survey(sensors=sensors)
    assert [c for c in compare(a, b) if c.verdict in verdicts.CHANGES] == []
    assert [c for c in compare(b, a) if c.verdict in verdicts.CHANGES] == []


def test_a_survey_compared_with_itself_says_all_same():
    changes = compare(survey(), survey())
    assert {c.verdict for c in changes} == {SAME}
    assert {(c.table, c.number_a) for c in changes} == {
        *(("wall", number) for number in range(5)),
        ("opening", 0),
        ("room", 0),
        ("room", 1),
    }
    assert all(c.number_b == c.number_a for c in changes)


@pytest.mark.parametrize("by_m", [-0.3, -0.1, 0.05, 0.1, 0.3])
def test_a_wall_that_moved_is_told_by_how_much_and_where_to(by_m):
    a, b = survey(doors=[]), survey([(5 + by_m, 0, 5 + by_m, 5)], [])
    (wall,) = [c for c in told(compare(a, b), "wall") if c.shape.length > 1]
    assert (wall.verdict, wall.number_a, wall.number_b) == (MOVED, 4, 4) and wall.is_change
    assert wall.moved_m == pytest.approx((by_m, 0.0), abs=0.005)
    # to the left of a line that goes up
    assert wall.shift_m == pytest.approx(-by_m, abs=0.005)
    assert abs(wall.shift_m) > verdicts.SIGMAS * wall.sigma_m


@pytest.mark.parametrize(
    ("by_m", "p_true", "wanted"),
    [
        # what is behind is likelier that wall, or a cupboard where another stood
        (0.3, 0.95, [(MOVED, True)]),
        (0.3, 0.8, [(GONE, True), (NEW, True)]),
        (0.3, 0.4, [(GONE, True), (NEW, False)]),
        # what stands before a wall may be a cupboard
        (-0.3, 0.8, [(MOVED, False)]),
    ],
)
def test_a_wall_that_what_is_behind_shows_to_be_gone_is_so_whatever_that_is(by_m, p_true, wanted):
    in_left = [place for place in SENSORS if place[0] < 4.5]
    before = survey(doors=[])
    after = survey([(5 + by_m, 0, 5 + by_m, 4)], [], sensors=in_left)
    after.plan.walls["p_true"][4] = p_true
    found = [c for c in compare(before, after) if c.table == "wall" and c.verdict != NOT_SEEN]
    changed = [c for c in found if c.verdict in verdicts.CHANGES and c.shape.length > 1]
    assert [(c.verdict, c.is_change) for c in changed] == wanted
    if len(changed) > 1:
        gone, new = changed
        assert (gone.number_a, gone.number_b, new.number_a, new.number_b) == (4, -1, -1, 4)
        assert new.shape.centroid.x - gone.shape.centroid.x == pytest.approx(by_m, abs=0.01)
        assert new.p == pytest.approx(p_true, abs=0.01)


def test_a_wall_that_moved_though_both_plans_doubt_it_has_and_may_be_furniture():
    in_left = [place for place in SENSORS if place[0] < 4.5]
    before, after = survey(doors=[]), survey([(5.3, 0, 5.3, 5)], [], sensors=in_left)
    for of in (before, after):
        of.plan.walls["p_true"][4] = 0.8
    (wall,) = [c for c in told(compare(before, after), "wall") if c.shape.length > 1]
    assert (wall.verdict, wall.is_change) == (MOVED, True)
    assert wall.p == pytest.approx(0.8, abs=0.02) and wall.p + wall.p_furniture > 0.99


@pytest.mark.parametrize("is_earlier", [True, False])
def test_a_wall_whose_other_side_stands_has_not_moved_from_what_stood_before_it(is_earlier):
    # a cupboard as long as half of the wall hides that side of it
    with_cupboard = survey([INNER, (4.45, 0, 4.45, 2.5)], [])
    faces = with_cupboard.plan.faces
    hidden = np.isclose(faces["x0_m"], 4.9) & np.isclose(faces["x1_m"], 4.9)
    shown = {name: np.where(hidden & (faces[name] < 2.5), 2.5, faces[name]) for name in Y_M}
    plan = replace(with_cupboard.plan, faces={**faces, **shown})
    both = (replace(with_cupboard, plan=plan), survey(doors=[]))
    changes = compare(*(both if is_earlier else both[::-1]))
    (cupboard,) = told(changes, "wall")
    number = cupboard.number_a if is_earlier else cupboard.number_b
    assert cupboard.verdict == (GONE if is_earlier else verdicts.NEW) and number == 5
    assert {c.number_a for c in changes if c.table == "wall" and c.verdict == SAME} == set(range(5))


def seen_between(of, number, low_m, high_m):
    """A survey whose plan has seen the sides of a wall from one place up to another only."""
    faces = of.plan.faces
    is_its = (faces["wall"] == number) & ~np.isclose(faces["y0_m"], faces["y1_m"])
    cut = {name: np.where(is_its, faces[name].clip(low_m, high_m), faces[name]) for name in Y_M}
    return replace(of, plan=replace(of.plan, faces={**faces, **cut}))


def test_what_stands_behind_a_door_that_was_broken_through_is_not_its_wall():
    # a longer front than what was seen of the wall beside the door
    after = seen_between(survey([INNER, (5.4, 2.5, 5.4, 4.1)]), 4, 2.4, 3.0)
    after.plan.walls["p_true"][5] = 0.1
    changes = compare(survey(doors=[]), after)
    assert {c.number_b for c in changes if c.table == "wall" and c.number_a == 4} == {4, -1}
    (door,) = told(changes, "opening")
    assert (door.verdict, door.is_change) == (NEW, True)


@pytest.mark.parametrize("by_m", [-0.12, 0.12])
def test_the_rest_of_a_wall_that_moved_has_where_returns_lie_as_far_beside_it(by_m):
    before = survey(doors=[])
    after = seen_between(survey([(5 + by_m, 0, 5 + by_m, 5)], []), 4, 3.0, 5.0)
    changed = {
        c.verdict: c.shape.length for c in told(compare(before, after), "wall") if c.is_change
    }
    assert changed == pytest.approx({MOVED: 2.0, GONE: 3.0, NEW: 3.0}, abs=0.25)
    # of one that has moved in part the rest stands
    half = seen_between(survey([(5 + by_m, 2.9, 5 + by_m, 5), (5, 0, 5, 2.9)], []), 5, 0.0, 0.3)
    (stands,) = [c for c in compare(before, half) if (c.number_a, c.verdict) == (4, SAME)]
    assert stands.shape.length > 2


def test_a_shift_within_its_error_is_none():
    changes = compare(survey(doors=[]), survey([(5.01, 0, 5.01, 5)], []))
    assert told(changes, "wall") == []
    (wall,) = [c for c in changes if c.table == "wall" and c.number_a == 4]
    assert abs(wall.shift_m) == pytest.approx(0.01, abs=0.003)


def test_a_wall_that_rays_go_through_is_gone_and_the_other_way_round_new():
    a, b = survey(doors=[]), survey([], [])
    gone = told(compare(a, b), "wall")
    assert [(c.verdict, c.number_a, c.number_b) for c in gone] == [(GONE, 4, -1)]
    assert gone[0].is_change and gone[0].shape.length > 4.4
    new = told(compare(b, a), "wall")
    assert [(c.verdict, c.number_a, c.number_b) for c in new] == [(NEW, -1, 4)]


@pytest.mark.parametrize(
    ("top_m", "p_true", "p_wall"), [(5, 0.7, 0.7), (4, 0.7, 0.41), (4, 0.8, 0.55), (4, 0.99, 0.97)]
)
def test_what_is_drawn_as_a_wall_may_be_furniture_that_was_carried_unless_walls_hold_it(
    monkeypatch, top_m, p_true, p_wall
):
    monkeypatch.setattr(changing_floor, "THICK_M", np.nan)
    a, b = survey([], []), survey([(5, 0, 5, top_m)], [])
    # carried 3.3 times as often as walls are built, but for what goes from wall to wall
    b.plan.walls["p_true"][:] = 1.0
    b.plan.walls["p_true"][4] = p_true
    for first, second in ((a, b), (b, a)):
        (found,) = told(compare(first, second), "wall")
        assert found.p == pytest.approx(p_wall, abs=0.01)
        assert found.p + found.p_furniture > 0.999
        # told is what is twice as likely a wall
        assert found.is_change == found.is_told == (p_wall > 2 / 3)
        assert bool(found.doubt) == (p_wall < verdicts.LIKELY)


@pytest.mark.parametrize(("x_m", "verdict"), [(4.95, GONE), (5.05, SAME), (5.1, SAME)])
def test_what_stands_behind_the_face_of_a_wall_is_not_that_wall(x_m, verdict):
    # the wall's face is at 5.1 m: poses, ranges and maps err by 0.1 m
    in_right = [place for place in SENSORS if place[0] > 5.5]
    a = survey(doors=[], sensors=in_right)
    b = survey([], [], hidden=[(x_m, 0, x_m, 5)], sensors=in_right)
    (wall,) = [c for c in compare(a, b) if c.number_a == 4 and c.verdict != NOT_SEEN]
    assert (wall.verdict, wall.is_change) == (verdict, verdict == GONE)


def test_a_door_goes_and_comes_with_the_wall_around_it():
    a, b = survey(), survey([], [])
    for first, second, verdict in ((a, b, GONE), (b, a, NEW)):
        changes = compare(first, second)
        walls, (door,) = told(changes, "wall"), told(changes, "opening")
        assert {c.verdict for c in walls} == {verdict} == {door.verdict}
        assert door.is_change and door.p == pytest.approx(np.mean([c.p for c in walls]))
    # beside a part of the wall that still stands it is open, and no more is known
    part = survey([(5, 0, 5, 2.9)], [])
    (door,) = [c for c in compare(a, part) if c.table == "opening"]
    assert (door.verdict, door.number_b) == (SAME, -1)
    # a part that is farther away says nothing of it
    rest = survey([(5, 0, 5, 2.4)], [])
    (door,) = told(compare(a, rest), "opening")
    assert (door.verdict, door.number_b) == (GONE, -1)


def test_a_wall_that_nobody_looked_at_is_not_seen():
    a = survey(doors=[])
    # from one room, with its door walled up: of the far outer walls nothing is known
    b = survey(doors=[], sensors=[s for s in SENSORS if s[0] < 5])
    changes = compare(a, b)
    assert told(changes, "wall") == []
    far = [c for c in changes if c.table == "wall" and c.number_a == 1]
    # b draws it, though none of its rays came there
    assert far and {c.verdict for c in far} <= {SAME, NOT_SEEN}
    b.plan.faces["wall"][:] = -1
    assert not [c for c in compare(a, b) if c.verdict in (GONE, NEW)]


def test_rooms_beside_a_wall_that_went_have_changed_and_others_have_not():
    a, b = survey(doors=[]), survey([(5.3, 0, 5.3, 5)], [])
    areas = [shapely.box(0, 0, 5.2, 5), shapely.box(5.4, 0, 8, 5)]
    b.plan.rooms["geometry"][:] = [shapely.to_wkb(area) for area in areas]
    rooms = told(compare(a, b), "room")
    found = [(c.verdict, c.number_a, c.number_b) for c in rooms]
    assert found == [(verdicts.ALTERED, 0, 0), (verdicts.ALTERED, 1, 1)]
    # parted otherwise, while no wall has changed
    c = survey(doors=[])
    c.plan.rooms["geometry"][:] = [shapely.to_wkb(area) for area in areas]
    assert told(compare(a, c), "room") == []


def test_a_door_walled_up_behind_furniture_is_told_by_what_is_seen_beside_it():
    hiding = shapely.box(5.15, 2.2, 5.6, 3.68)
    (walled,) = told(compare(survey(), survey(doors=[], pieces=[hiding])), "opening")
    assert (walled.verdict, walled.is_change) == (GONE, True)
    all_of_it = shapely.box(5.15, 2.2, 5.6, 4.5)
    changes = compare(survey(), survey(doors=[], pieces=[all_of_it]))
    assert told(changes, "opening") == []
    (closed,) = [c for c in changes if c.table == "opening"]
    assert (closed.verdict, closed.is_told) == (
        SHUT,
        True,
    ) and "shut 0.75, walled up 0.25" in closed.doubt


def test_a_door_is_walled_up_if_flush_and_shut_if_set_back():
    a = survey()
    walled = told(compare(a, survey(doors=[])), "opening")
    assert [(c.verdict, c.kind_a, c.number_b) for c in walled] == [(GONE, "door", -1)]
    assert walled[0].is_change
    b = survey(doors=[DOOR], hidden=[LEAF])
    empty = {name: values[:0] for name, values in b.plan.openings.items()}
    object.__setattr__(b.plan, "openings", empty)
    (door,) = [c for c in compare(a, b) if c.table == "opening"]
    assert (door.verdict, door.number_b, door.doubt) == (SHUT, -1, "") and door.is_told
    (door,) = [c for c in compare(b, a) if c.table == "opening"]
    assert (door.verdict, door.number_a) == (OPENED, -1) and not door.is_change


def test_an_opening_that_its_plan_doubts_is_not_told_as_shut():
    a, b = survey(), survey(doors=[DOOR], hidden=[LEAF])
    empty = {name: values[:0] for name, values in b.plan.openings.items()}
    object.__setattr__(b.plan, "openings", empty)
    for p_true, is_told in ((0.6, True), (np.nan, True), (0.1, False)):
        a.plan.openings["p_true"] = np.array([p_true])
        (door,) = opening_changes.compare_openings(a, b)
        # of what is likely none it is likelier that nothing has changed
        assert (door.verdict, door.is_told) == (SHUT if is_told else SAME, is_told)


def test_a_door_that_both_have_is_told_shut_or_opened_and_its_wall_the_same():
    a, b = survey(), survey(hidden=[LEAF])
    for first, second, verdict in ((a, b, SHUT), (b, a, OPENED), (b, b, SAME)):
        changes = compare(first, second)
        (door,) = [c for c in changes if c.table == "opening"]
        assert (door.verdict, door.number_a, door.number_b) == (verdict, 0, 0)
        assert told(changes, "wall") == [] == told(changes, "room")
    (line,) = [of for of in change_table.summarise_changes(compare(a, b)) if "opening" in of]
    assert line == "opening: 1 shut"


def test_a_door_broken_through_is_new_and_takes_nothing_of_its_wall():
    changes = compare(survey(doors=[]), survey())
    (door,) = told(changes, "opening")
    assert (door.verdict, door.number_a, door.number_b, door.kind_b) == (NEW, -1, 0, "door")
    assert told(changes, "wall") == []


@pytest.mark.parametrize("p_true", [0.9, 0.3])
def test_a_way_that_parts_a_wall_is_new_where_that_was_one(p_true):
    parted = survey([(5, 0, 5, 3.0), (5, 3.9, 5, 5)], [])
    loose = survey()
    rated = {"wall": np.array([-1], np.int32), "p_true": np.array([p_true])}
    plan = replace(parted.plan, openings={**loose.plan.openings, **rated})
    later = replace(parted, plan=plan)
    for first, second, verdict in ((survey(doors=[]), later, verdicts.NEW), (later, later, None)):
        found = told(compare(first, second), "opening")
        assert [c.verdict for c in found] == ([verdict] if verdict and p_true > 0.5 else [])
        assert all(c.is_change for c in found)


def test_a_door_moved_along_its_wall_is_told_by_rays_at_its_edge():
    there = (5, 3.3, 5, 4.2)
    (door,) = told(compare(survey(), survey(doors=[there])), "opening")
    assert door.verdict == MOVED and door.moved_m == pytest.approx((0.0, 0.3), abs=0.02)
    # where one of the plans holds it for none, its edge is that of something else
    for p_true, verdict in ((0.6, MOVED), (0.2, SAME)):
        doubted = survey(doors=[there])
        doubted.plan.openings["p_true"] = np.array([p_true])
        (door,) = [c for c in compare(survey(), doubted) if c.table == "opening"]
        assert door.verdict == verdict


def test_edges_are_known_as_well_as_most_of_them_agree():
    doors = [(5, y, 5, y + 0.7) for y in (0.3, 1.5, 2.7, 3.9)]
    near = [(5, y + 0.01, 5, end + 0.01) for _, y, _, end in doors]
    wider = [near[0], (5, 1.5, 5, 2.36), *near[2:]]
    for later, shifts_m in ((near, [0.01] * 4), (wider, [0.01, 0.16, 0.01, 0.01])):
        found = opening_changes.compare_openings(survey(doors=doors), survey(doors=later))
        assert [abs(c.shift_m) for c in found] == pytest.approx(shifts_m, abs=1e-6)
        assert [c.sigma_m for c in found] == pytest.approx([1.4826 * 0.01] * 4)
        # what one shows that is far from where it was is no error of the others
        assert {c.verdict for c in found if abs(c.shift_m) < 0.1} == {SAME}
        assert all(c.p > 0.99 for c in found if abs(c.shift_m) < 0.1)
    # two edges say nothing of what edges differ by
    (door,) = opening_changes.compare_openings(survey(doors=doors[:1]), survey(doors=near[:1]))
    assert door.sigma_m > 0.05 and door.verdict == SAME


def test_furniture_that_was_carried_is_one_piece_and_no_wall():
    before, after = shapely.box(1.4, 3.9, 2.2, 4.4), shapely.box(2.6, 3.9, 3.4, 4.4)
    changes = compare(survey(pieces=[before]), survey(pieces=[after]))
    (piece,) = told(changes, "furniture")
    assert (piece.verdict, piece.number_a, piece.number_b) == (MOVED, 0, 0)
    assert piece.moved_m == pytest.approx((1.2, 0.0), abs=0.01)
    assert told(changes, "wall") == [] == told(changes, "opening")


def looks(hits, passes, places=5):
    """Looks of counts (c, r), each ray from one of some places in turn."""
    hits, passes = np.array(hits), np.array(passes)
    rows = []
    for counts in (passes, hits):
        cells, heights = np.nonzero(counts)
        times = counts[cells, heights]
        told_of = np.column_stack([np.repeat(cells, times), np.repeat(heights, times)])
        rows.append(np.column_stack([told_of, np.arange(len(told_of)) % places]))
    plane = scan_plane.ScanPlane(np.nan) if hits.shape[1] == 1 else None
    return ray_cells.Looks(hits, passes, *rows, plane)


def test_rays_above_what_was_solid_deny_nothing():
    half_height = looks([[5, 5, 0, 0]], [[0, 0, 9, 9]])
    over_it = looks([[0, 0, 0, 0]], [[0, 0, 9, 9]])
    through_it = looks([[0, 0, 0, 0]], [[9, 9, 9, 9]])
    assert not ray_cells.compare_looks(half_height, over_it).is_passed.any()
    assert ray_cells.compare_looks(half_height, through_it).is_passed.all()


def test_rays_that_go_over_what_stands_where_more_stood_show_it_to_be_lowered():
    wall = looks([[5, 5, 5, 5]], [[0, 0, 0, 0]])
    for hits, passes, is_lowered in (
        ([[9, 9, 0, 0]], [[0, 0, 5, 2]], True),
        # by a row alone, by too few rays, or by none
        ([[9, 9, 9, 0]], [[0, 0, 0, 9]], False),
        ([[9, 9, 0, 0]], [[0, 0, 1, 1]], False),
        ([[9, 9, 0, 0]], [[0, 0, 0, 0]], False),
        # what ends over it stands
        ([[9, 9, 0, 9]], [[0, 0, 9, 0]], False),
        ([[0, 0, 0, 0]], [[0, 0, 9, 9]], False),
    ):
        found = ray_cells.compare_looks(wall, looks(hits, passes))
        assert found.is_lowered.tolist() == [is_lowered]
        assert (len(found.over) > 0) == is_lowered
    # nor was it known how high what a planar scanner saw is
    of_a_plane = looks([[7]], [[0]])
    assert not ray_cells.compare_looks(of_a_plane, looks([[9, 9, 0, 0]], [[0, 0, 5, 5]])).is_lowered
    # no wall was as high before
    low = looks([[5, 5, 0, 0]], [[0, 0, 9, 9]])
    assert not ray_cells.compare_looks(low, looks([[9, 9, 0, 0]], [[0, 0, 9, 9]])).is_lowered.any()


@pytest.mark.parametrize(
    ("is_later_low", "off_m", "verdict", "is_told"),
    [
        # what is left of it stands on its faces: the wall does; a desk is likelier than that
        (True, 0.0, SAME, False),
        (True, 0.08, GONE, True),
        # what is lower now was rather built than left, but nobody knows
        (True, np.nan, GONE, False),
        (False, 0.0, SAME, False),
    ],
)
def test_a_wall_that_rays_go_over_now_is_gone_if_what_stands_there_is_off_its_faces(
    is_later_low, off_m, verdict, is_told
):
    wall = looks([[5, 5, 5, 5]] * 80, [[0] * 4] * 80)
    desk = looks([[9, 9, 0, 0]] * 80, [[0, 0, 5, 5]] * 80)
    before, after = survey(doors=[]), survey([], [])
    shifts = face_shifts.measure_shifts(before, after, fit_frame(before.faces, after.faces, STILL))
    # maps are as good as they are measured to be: a centimetre
    shifts = replace(shifts, sigma_m=np.full(len(shifts.sigma_m), 0.01))
    stubs = (Stub(wall), Stub(desk if is_later_low else wall, off_m))
    sights = [replace(of, sight=stub) for of, stub in zip((before, after), stubs, strict=True)]
    (inner,) = [c for c in wall_changes.compare_walls(*sights, shifts) if c.number_a == 4]
    assert (inner.verdict, inner.is_change) == (verdict, is_told)
    assert bool(inner.doubt) == (is_later_low and not is_told)
    if verdict == SAME:
        assert inner.p > 0.9


def test_what_was_seen_beside_a_wall_does_not_show_that_what_is_behind_it_now_is_another():
    (wall,) = [w for w in wall_cells.list_walls(survey(doors=[])) if w.number == 4]
    seen = looks([[5]] * wall.n_cells, [[0]] * wall.n_cells)
    later = ray_cells.compare_looks(seen, seen)
    stretch = wall_rays.Stretch(wall, slice(0, 20), wall_rays.UNKNOWN)
    for off_m, verdict in ((0.0, GONE), (0.15, NOT_SEEN)):
        sights = (Stub(seen, off_m), Stub(seen, off_m - 0.15))
        surveys = tuple(replace(survey(), sight=sight) for sight in sights)
        shown = wall_rays.weigh_rays(stretch, surveys, later, 0.01)
        assert wall_rays.tell_rays(shown, 0.95, 0.9).verdict == verdict
        assert shown.weight > 1000 if verdict == GONE else shown.weight == 1


@pytest.mark.parametrize(
    ("hidden_m", "p_wall"),
    # 3.3 times as likely furniture by the share that may have stood before
    [(0.0, 0.6), (1.1, 0.5), (3.0, 0.39)],
)
def test_a_wall_is_built_in_as_far_as_it_is_new_from_wall_to_wall(monkeypatch, hidden_m, p_wall):
    monkeypatch.setattr(changing_floor, "THICK_M", np.nan)
    hidden = [shapely.box(4.6, 5 - hidden_m, 5.4, 5.0)] * (hidden_m > 0)
    before, after = survey([], [], pieces=hidden), survey([INNER], [])
    after.plan.walls["p_true"][:] = 1.0
    after.plan.walls["p_true"][4] = 0.6
    (new,) = told(compare(before, after), "wall", NEW)
    assert new.shape.length == pytest.approx(5 - hidden_m, abs=0.3)
    assert new.p == pytest.approx(p_wall, abs=0.02)


@pytest.mark.parametrize(("thick_m", "p_wall"), [(np.nan, 0.73), (0.2, 0.9), (0.4, 0.14)])
def test_what_ends_free_and_is_as_deep_as_furniture_is_likelier_that(monkeypatch, thick_m, p_wall):
    monkeypatch.setattr(changing_floor, "THICK_M", thick_m)
    before, after = survey([], []), survey([(5, 0, 5, 4)], [])
    after.plan.walls["p_true"][4] = 0.9
    (new,) = told(compare(before, after), "wall", NEW)
    assert new.p == pytest.approx(p_wall, abs=0.01) and new.is_change == (p_wall > 0.5)


def test_sides_of_a_cupboard_that_come_together_do_not_hold_one_another(monkeypatch):
    monkeypatch.setattr(changing_floor, "THICK_M", np.nan)
    # a box before the upper wall: its front goes from side to side
    sides = [(4, 3.6, 4, 5), (6, 3.6, 6, 5), (4, 3.6, 6, 3.6)]
    before, after = survey([], []), survey(sides, [])
    after.plan.walls["p_true"][4:] = 0.6
    front = {c.number_b: c for c in told(compare(before, after), "wall", NEW)}[6]
    assert front.p == pytest.approx(verdicts.rate_wall(0.6, 0.0), abs=0.03)
    # that of one of which both sides stood before is held by them
    held = {c.number_b: c for c in told(compare(survey(sides[:2], []), after), "wall", NEW)}[6]
    assert held.p == pytest.approx(verdicts.rate_wall(0.6, 0.36), abs=0.03)


def test_a_wall_that_goes_through_those_beside_it_is_held_by_them(monkeypatch):
    monkeypatch.setattr(changing_floor, "THICK_M", np.nan)
    beside, across = [(3, 0, 3, 5), (6, 0, 6, 5)], (2.6, 2, 6.4, 2)
    before, after = survey(beside, []), survey([*beside, across], [])
    after.plan.walls["p_true"][:] = 0.99
    after.plan.walls["p_true"][6] = 0.3
    new = [c for c in told(compare(before, after), "wall", NEW) if c.number_b == 6]
    free = verdicts.rate_wall(0.3, 0.0)
    assert max(c.p for c in new) > free + 0.1


def test_a_cupboard_and_a_new_wall_beside_are_not_one_that_moved(monkeypatch):
    monkeypatch.setattr(changing_floor, "THICK_M", np.nan)
    for p_true, wanted in ((0.99, [MOVED]), (0.3, [GONE, NEW])):
        a, b = (survey([(x_m, 0, x_m, 4)], []) for x_m in (5.0, 5.3))
        a.plan.walls["p_true"][4] = p_true
        found = [c for c in told(compare(a, b), "wall") if 4 in (c.number_a, c.number_b)]
        assert [c.verdict for c in found] == wanted
    # the cupboard was likely carried, the wall was built
    assert [round(c.p) for c in found] == [0, 1] and found[0].p_furniture > 0.8


def test_a_part_of_a_wall_that_neither_survey_saw_is_told_once():
    # behind a cupboard, which leaves its ends to be seen
    hidden = [(4.6, 1.5, 4.6, 3.5), (4.6, 1.5, 4.9, 1.5), (4.6, 3.5, 4.9, 3.5)]
    in_left = [place for place in SENSORS if place[0] < 4.5]
    a, b = (survey(doors=[], hidden=hidden, sensors=in_left) for _ in range(2))
    for of in (a, b):
        faces = of.plan.faces
        cut = np.flatnonzero(faces["wall"] == 4)
        faces["state"][cut] = "inferred"
    unseen = [c for c in compare(a, b) if c.table == "wall" and c.verdict == NOT_SEEN]
    assert [(c.number_a, c.number_b) for c in unseen] == [(4, 4)]
    assert unseen[0].shape.length == pytest.approx(2.0, abs=0.3)


def test_what_looks_up_at_a_wall_shows_that_it_stands_on_the_floor():
    upper = looks([[0, 0, 0, 5, 5]], [[0, 0, 0, 0, 0]])
    assert upper.solid.tolist() == [[True] * 5]
    # below a lintel or a table top rays go through, and what is between was not seen
    over_a_gap = looks([[0, 0, 0, 5, 5]], [[0, 9, 0, 0, 0]])
    assert over_a_gap.solid.tolist() == [[False, False, False, True, True]]
    low = replace(looks([[0]], [[9]]), plane=scan_plane.ScanPlane(0.3))
    assert ray_cells.compare_looks(upper, low).is_passed.tolist() == [True]
    assert ray_cells.compare_looks(over_a_gap, low).is_passed.tolist() == [False]


@pytest.mark.parametrize(("behind_m", "is_passed"), [(0.05, False), (0.25, True)])
def test_rays_go_through_that_end_farther_behind_a_wall_than_maps_err_by(behind_m, is_passed):
    # its far side is at 5.1 m, and what ends 0.1 m behind that may be it
    in_left = [place for place in SENSORS if place[0] < 4.5]
    b = survey([], [], hidden=[(5.1 + behind_m, 0, 5.1 + behind_m, 5)], sensors=in_left)
    line, length_m = ray_cells.line_between(np.array(INNER, float).reshape(2, 2))
    seen = b.sight.look_at(line, (0.5, length_m - 0.5), 0.1)
    assert bool(seen.passes.sum() > seen.hits.sum()) == is_passed


def test_a_stretch_of_a_wall_is_what_those_beside_it_are_unless_much_denies_it():
    alone, beside = verdicts.rate_along([0.1]), verdicts.rate_along([1e4, 0.1, 1e4])
    assert alone[0] < 0.01 and beside[1] > 0.8
    assert verdicts.rate_along([1e4, 1e-6, 1e4])[1] < 0.02
    # what was not looked at says nothing, from either end
    for weights in ([1e4, 1, 1], [1, 1, 1e4][::-1]):
        rated = verdicts.rate_along(weights)
        assert rated[0] > rated[1] > rated[2] > verdicts.CHANGED
    assert len(verdicts.rate_along([])) == 0


def test_what_is_likely_furniture_is_counted_as_that_and_not_as_doubtful():
    shape = shapely.LineString([(0, 0), (1, 0)])
    drawn_as_wall = verdicts.Change("wall", -1, 1, NEW, 0.05, shape, p_furniture=0.95)
    elsewhere = shapely.LineString([(5, 5), (6, 5)])
    doubtful = replace(drawn_as_wall, number_b=2, shape=elsewhere, p=0.4, p_furniture=0.6)
    said = change_table.summarise_changes([drawn_as_wall, doubtful])
    assert said == ["wall: 1 maybe new, 1 new, likely furniture"]


def test_what_a_planar_scanner_saw_is_gone_if_free_at_all_heights():
    planar = looks([[7]], [[0]])
    above_a_bed = looks([[0, 6, 0, 0]], [[9, 0, 9, 9]])
    never_low = looks([[0, 0, 0, 0]], [[0, 9, 9, 9]])
    all_over = looks([[0, 0, 0, 0]], [[9, 9, 9, 9]])
    for seen, is_gone in ((above_a_bed, False), (never_low, False), (all_over, True)):
        assert ray_cells.compare_looks(planar, seen).is_passed.tolist() == [is_gone]


def test_what_a_planar_scanner_saw_is_gone_if_free_in_the_row_of_its_plane():
    planar = replace(looks([[7]], [[0]]), plane=scan_plane.ScanPlane(0.3))
    for hits, passes, is_gone in (
        ([[0, 0, 0, 0]], [[0, 9, 0, 0]], True),
        ([[0, 0, 0, 6]], [[0, 9, 9, 0]], True),
        # a plane that is tilted comes to the rows beside its own
        ([[6, 0, 0, 0]], [[0, 9, 9, 9]], False),
        ([[0, 0, 6, 0]], [[9, 9, 0, 9]], False),
        # over it alone
        ([[0, 0, 0, 0]], [[0, 0, 9, 9]], False),
    ):
        assert ray_cells.compare_looks(planar, looks(hits, passes)).is_passed.all() == is_gone


def test_what_has_heights_is_gone_if_planar_rays_go_through_what_was_solid_in_their_row():
    through = replace(looks([[0]], [[9]]), plane=scan_plane.ScanPlane(0.3))
    for hits, passes, is_gone in (
        ([[0, 5, 0, 0]], [[9, 0, 9, 9]], True),
        ([[5, 0, 5, 5]], [[0, 9, 0, 0]], False),
    ):
        found = ray_cells.compare_looks(looks(hits, passes), through)
        assert found.is_passed.tolist() == [is_gone]


def at_height(of, height_m):
    """The same survey, its plane so high above the floor."""
    rays = of.sight.rays
    up_m = np.array([0, 0, height_m])
    lifted = replace(rays, sensors_m=rays.sensors_m + up_m, xyz_m=rays.xyz_m + up_m)
    return replace(of, sight=RaySight(lifted))


@pytest.mark.parametrize(("height_m", "row"), [(0.3, 1), (1.1, 4), (0.0, -1), (5.0, -1)])
def test_a_planar_survey_is_in_the_row_of_its_map_if_a_scanner_may_be_mounted_there(height_m, row):
    line, length_m = ray_cells.line_between(np.array(INNER, float).reshape(2, 2))
    sight = at_height(survey(), height_m).sight
    assert sight.look_at(line, (0, length_m), 0.1).row == row
    assert np.degrees(sight.plane.beam_rad) == pytest.approx(0.5, rel=0.01)


@pytest.mark.parametrize(
    ("one", "other", "is_one"),
    [
        ((0.3, 0.5), (0.3, 0.25), True),
        # a plane that is tilted comes to the row beside
        ((0.45, 0.5), (0.55, 0.5), True),
        ((0.3, 0.5), (1.0, 0.5), False),
        # where a height is not known a scanner is taken to be where it was, if it is the same
        ((np.nan, 0.5), (np.nan, 0.51), True),
        ((np.nan, 0.5), (0.3, 0.5), True),
        ((np.nan, 0.5), (np.nan, 0.25), False),
        ((np.nan, 0.5), (0.3, 1.0), False),
    ],
)
def test_planes_are_one_by_their_heights_or_else_by_their_beams(one, other, is_one):
    planes = [scan_plane.ScanPlane(*of) for of in (one, other)]
    assert scan_plane.are_one_plane(*planes) == is_one == scan_plane.are_one_plane(*planes[::-1])
    assert scan_plane.are_one_plane(planes[0], None)


@pytest.mark.parametrize("change", ["wall", "door", "furniture"])
def test_what_one_plane_shows_and_another_cannot_see_is_not_seen(change):
    low, high = {
        "wall": (survey(), survey([INNER, (6.0, 1.0, 6.0, 3.0)])),
        "door": (survey(doors=[]), survey()),
        "furniture": (survey(), survey(pieces=[shapely.box(1.5, 1.5, 2.5, 2.2)])),
    }[change]
    told_at = {}
    for height_m in (0.3, 1.0):
        found = compare(at_height(low, 0.3), at_height(high, height_m))
        told_at[height_m] = {c.verdict for c in told(found, change.replace("door", "opening"))}
        if height_m == 1.0:
            assert any(c.verdict == NOT_SEEN and c.number_a < 0 for c in found)
            # what both show stands
            same = [c for c in found if c.table == "wall" and c.verdict == SAME]
            assert {c.number_a for c in same} == {0, 1, 2, 3, 4}
    assert told_at == {0.3: {verdicts.NEW}, 1.0: set()}


@pytest.mark.parametrize(
    ("height_m", "values"), [(0.3, ()), (1.0, ("0.30 m", "1.00 m")), (None, ("0.30 m", "unknown"))]
)
def test_planes_that_lie_apart_are_told_with_their_heights(height_m, values):
    a, b = (at_height(survey(), of) for of in (0.3, height_m or 0.0))
    if height_m is None:
        rays = b.sight.rays
        few = gather_rays(
            [(i, rays.xyz_m[rows][::2]) for i, rows in enumerate(rays.rows)],
            dict(enumerate(rays.sensors_m)),
            planar=True,
        )
        b = replace(b, sight=RaySight(few))
    compared = comparison.Comparison(a, b, tie(a, b), [])
    said = change_table.warn_of_planes(compared)
    assert bool(said) == bool(values) and all(value in said for value in values)


def test_a_front_before_a_wall_has_not_moved_in_another_plane():
    # a cupboard's front at 0.3 m hides the wall that is seen over it
    front = [(0, 0, 8, 0), (8, 0, 8, 5), (8, 4.6, 0, 4.6), (0, 5, 0, 0)]
    low, high = survey([], [], outer=front), survey([], [])
    moved = [c for c in compare(at_height(low, 0.3), at_height(high, 1.0)) if c.verdict == MOVED]
    assert not any(c.is_change for c in moved)
    in_one_plane = compare(at_height(low, 0.3), at_height(high, 0.3))
    assert any(c.is_change and c.table == "wall" for c in in_one_plane)


def test_rays_of_unknown_heights_deny_nothing_that_a_planar_scanner_saw():
    planar, all_over = looks([[7]], [[0]]), looks([[0]], [[30]])
    assert ray_cells.compare_looks(planar, all_over).is_passed.all()
    of_any_height = replace(all_over, plane=None)
    assert not ray_cells.compare_looks(planar, of_any_height).is_passed.any()
    # of what it saw itself it knows as little, and as much
    assert ray_cells.compare_looks(replace(planar, plane=None), of_any_height).is_passed.all()


@given(st.sampled_from(verdicts.VERDICTS), st.floats(0, 1), st.floats(0, 1))
def test_what_is_likelier_the_same_is_told_as_that_and_nothing_to_verify(verdict, p_any, p_wall):
    told_as = verdicts.Change(
        "wall", 1, -1, verdict, p_any * p_wall, shapely.Point(), p_furniture=p_any * (1 - p_wall)
    )
    found = told_as.settled()
    if verdict in (SAME, NOT_SEEN) or p_any > 0.51:
        assert found == told_as
    if verdict not in (SAME, NOT_SEEN) and p_any < 0.49:
        assert (found.verdict, found.p) == (SAME, pytest.approx(1 - p_any, abs=1e-9))
        assert not found.is_doubtful and not found.is_told
    # what is furniture nine times in ten is not asked about on site, either
    assert not (found.is_doubtful and found.p < 0.1)


@given(st.integers(0, 9), st.integers(0, 9))
def test_each_place_more_that_shows_a_change_makes_it_likelier(n_for, n_against):
    p = verdicts.rate_places(n_for, n_against)
    assert 0 < p < 1
    assert verdicts.rate_places(n_for + 1, n_against) >= p
    assert verdicts.rate_places(n_for, n_against + 1) <= p


def test_the_table_keeps_all_and_states_the_motion(tmp_path):
    a, b = survey(doors=[]), survey([(5.1, 0, 5.1, 5)], [], motion=MOVED_ROOM)
    found = comparison.Comparison(a, b, tie(a, b), compare(a, b))
    path = tmp_path / "changes.parquet"
    columns = change_table.tabulate_changes(found.changes)
    tables.write_table(path, schemas.CHANGES, columns, notes=change_table.state_tie(found))
    read = tables.read_table(path, schemas.CHANGES)
    assert read["verdict"].tolist() == [c.verdict for c in found.changes]
    assert set(read["verdict"]) <= set(verdicts.VERDICTS)
    yaw_rad, x_m, y_m = json.loads(tables.read_note(path, schemas.CHANGES, "motion"))
    assert (np.degrees(yaw_rad), x_m, y_m) == pytest.approx((40, 3.0, 0.5), abs=0.02)
    assert sum(read["likely"]) == sum(c.is_change for c in found.changes) > 0


def test_floors_without_walls_or_rays_have_a_table_without_rows(tmp_path):
    path = tmp_path / "changes.parquet"
    tables.write_table(path, schemas.CHANGES, change_table.tabulate_changes([]), allow_empty=True)
    assert len(tables.read_table(path, schemas.CHANGES, allow_empty=True)["p"]) == 0
    a, blind = survey(), survey()
    none = replace(blind.sight.rays, xyz_m=np.empty((0, 3)), azimuth_rad=np.empty(0))
    sight = RaySight(replace(none, first=np.zeros_like(none.first)))
    object.__setattr__(blind, "sight", sight)
    assert [c for c in compare(a, blind) if c.verdict in verdicts.CHANGES] == []


def test_what_is_compared_is_each_with_the_one_before():
    assert pair_surveys(["a", "b", "c"]) == [("a", "b"), ("b", "c")]
    with refused(remedy="earlier one"):
        pair_surveys(["a"])


def test_the_floor_of_the_tests_is_seen_as_it_is_drawn():
    points_m = np.concatenate(
        [
            xyz[:, :2]
            for _, xyz in changing_floor.cast(
                SENSORS,
                np.array(
                    [np.array(line, float).reshape(2, 2) for line in [*changing_floor.OUTER, INNER]]
                ),
            )
        ]
    )
    assert ((points_m >= -1e-9) & (points_m <= [8 + 1e-9, 5 + 1e-9])).all()
