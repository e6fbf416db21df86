"""Windows of a toy room: what becomes of the rays to a part of its south wall is known on paper."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from helpers import house_making
from helpers.observation_making import observation
from helpers.wall_making import walls
from scanplan.geometry.lines import Line
from scanplan.plan import planning, windows
from scanplan.plan.faces import intervals
from scanplan.plan.openings import OPEN, Opening
from scanplan.plan.plan_wall import PlanWall
from scanplan.rays import ray_set

SENSORS = [(1, 2.5, 0.9), (2, 3, 0.9), (3, 2.5, 0.9), (2.5, 3.4, 0.9)]
SOUTH = Line(np.array([0.0, 0.0]), np.array([0.0, 1.0]))
ROOM = [(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0)]
SETTINGS = planning.make_plan_settings(**house_making.PLAN)
LIMITS = {
    "min_width_m": SETTINGS.openings.min_opening_m,
    "band_m": SETTINGS.reading.band_m,
}
ENDS_M = (0.0, 4.0)
LOST, NICHE, BEYOND, BEFORE = None, "niche", 1.5, 0.7


def look(x, z, ends=LOST, sensors=SENSORS):
    """Rays of scans; those to a part of the south wall are lost or end elsewhere."""
    scans = []
    for i, xyz_m in house_making.scans(ROOM, sensors, columns=1800):
        there = (np.abs(xyz_m[:, 1]) < 0.1) & (xyz_m[:, 0] > x[0]) & (xyz_m[:, 0] < x[1])
        there &= (xyz_m[:, 2] > z[0]) & (xyz_m[:, 2] < z[1])
        if ends is LOST:
            scans.append((i, xyz_m[~there]))
        else:
            moved = (
                xyz_m - (0, 0.3, 0)
                if ends is NICHE
                else np.array(sensors[i]) + ends * (xyz_m - sensors[i])
            )
            scans.append((i, np.where(there[:, None], moved, xyz_m)))
    # the lowest beam ends at a wall: no floor is seen
    return replace(
        ray_set.gather_rays(scans, dict(enumerate(np.array(sensors, float))), planar=False),
        floor_z_m=0.0,
    )


def seen(looked):
    """The line refitted, places along it counted from the origin again."""
    line = intervals.observe_along(
        *(looked, SOUTH, 0.0, 4.0), band_m=SETTINGS.reading.band_m, reach_m=SETTINGS.reading.reach_m
    )
    begin_m = float(line.line.along_m(np.zeros(2)))
    return replace(
        line,
        line=Line(line.line.at(begin_m), line.line.normal),
        occupied_m=line.occupied_m - begin_m,
    )


def with_points(line, places_m):
    """More points at the height of a chest."""
    line = replace(
        line,
        occupied_m=np.concatenate([line.occupied_m, places_m]),
        occupied_z_m=np.concatenate([line.occupied_z_m, 0 * places_m + 1.5]),
        occupied_off_m=np.concatenate([line.occupied_off_m, 0 * places_m]),
        occupied_scan=np.concatenate([line.occupied_scan, np.zeros(len(places_m), int)]),
    )
    order = np.argsort(line.occupied_m, kind="stable")
    return replace(
        line,
        **{
            c: getattr(line, c)[order]
            for c in ("occupied_m", "occupied_z_m", "occupied_off_m", "occupied_scan")
        },
    )


def find(*part, **more):
    looked = look(*part, **more)
    return windows.find_windows(looked, seen(looked), *ENDS_M, **LIMITS)


@pytest.mark.parametrize("ends", [LOST, BEYOND])
def test_rays_that_go_through_above_a_wall_show_a_window(ends):
    (window,) = find((1.0, 2.2), (0.85, 2.4), ends=ends)
    assert (window.low_m, window.high_m) == (
        pytest.approx(1.0, abs=0.03),
        pytest.approx(2.2, abs=0.03),
    )
    assert window.sill_m == pytest.approx(0.85, abs=0.04)
    assert (window.state, window.kind(SETTINGS.openings.max_door_m)) == (OPEN, "window")


def test_a_window_may_be_wider_than_a_door():
    (window,) = find((0.8, 3.2), (0.85, 2.4))
    assert window.width_m == pytest.approx(2.4, abs=0.05)


@pytest.mark.parametrize(
    ("x", "z", "ends"),
    [
        ((1.0, 2.2), (-1.0, 2.4), LOST),  # a door, or glass down to the floor: no sill
        ((1.0, 2.2), (0.85, 2.4), BEFORE),  # a cupboard before the wall
        ((1.0, 2.2), (-1.0, 2.4), BEFORE),
        ((1.0, 2.2), (0.85, 2.4), NICHE),  # 30 cm deep
        ((1.0, 1.4), (0.85, 2.4), LOST),  # a slit
        ((-1.0, 1.5), (0.85, 2.4), LOST),  # no wall on one side
        ((1.0, 2.2), (0.3, 0.8), LOST),  # something dark below
        ((1.0, 2.2), (0.2, 2.4), LOST),  # glass down to a plinth
    ],
)
def test_what_is_no_window(x, z, ends):
    assert find(x, z, ends=ends) == []


def test_one_scan_is_not_enough():
    assert find((1.0, 2.2), (0.85, 2.4), sensors=SENSORS[1:2]) == []


def test_where_no_ray_is_sent_nothing_is_known():
    """From 1 m away the highest beam meets the wall at 1.17 m.

    Of the wall beside more is seen from further off.
    """
    looked = look((1.0, 2.2), (0.85, 2.4), sensors=[(1.6, 1, 0.9), (1.4, 0.9, 0.9)])
    line = with_points(seen(looked), np.repeat([0.2, 0.5, 0.9, 2.3, 2.6, 3.0], 3))
    assert windows.find_windows(looked, line, *ENDS_M, **LIMITS) == []


@pytest.mark.parametrize(
    ("places_m", "count"), [([1.6], 1), ([1.4, 1.8], 1), ([1.6] * 2, 1), ([1.6] * 3, 2)]
)
def test_stray_points_part_no_window_and_a_mullion_does(places_m, count):
    looked = look((1.0, 2.2), (0.85, 2.4))
    line = with_points(seen(looked), np.array(places_m))
    assert len(windows.find_windows(looked, line, *ENDS_M, **LIMITS)) == count


def wall(looked, openings=()):
    side = intervals.FaceInterval(seen(looked), 0.0, 4.0)
    # the other way round than its face, and begun elsewhere
    line = Line(np.array([4.0, -0.1]), np.array([0.0, -1.0]))
    return PlanWall(line, 0.0, 4.0, 0.2, [], [side], list(openings), [])


def test_windows_lie_along_the_wall_and_the_wall_goes_on_below_them():
    looked = look((1.0, 2.2), (0.85, 2.4))
    (found,) = windows.add_windows([wall(looked)], looked, **LIMITS)
    (window,) = found.openings
    ends = found.line.at(np.array([window.low_m, window.high_m]))
    np.testing.assert_allclose(np.sort(ends[:, 0]), [1.0, 2.2], atol=0.03)
    assert window.is_above_wall


def test_an_opening_is_not_found_again():
    looked = look((1.0, 2.2), (0.85, 2.4))
    known = Opening(2.0, 2.9, OPEN, 99, 0.0, np.nan, False)
    (found,) = windows.add_windows([wall(looked, [known])], looked, **LIMITS)
    assert found.openings == [known]


@pytest.mark.parametrize(("to_m", "count"), [(2.1, 0), (1.4, 1)])
def test_where_the_other_side_is_whole_there_is_no_window(to_m, count):
    """A screen or a mirror; a frame seen from the other side is not enough."""
    looked = look((1.0, 2.2), (0.85, 2.4))
    back = Line(np.array([0.0, -0.2]), np.array([0.0, -1.0]))
    place_m = back.along_m(np.array([(x, -0.2) for x in np.arange(1.1, to_m, 0.04)]))
    other = observation(back, [(along_m, 1.5) for along_m in place_m])
    this = wall(looked)
    behind = intervals.FaceInterval(other, -4.0, 0.0)
    (found,) = windows.add_windows([replace(this, left=[behind])], looked, **LIMITS)
    assert len(found.openings) == count


@pytest.mark.parametrize("count", [1, 2])
def test_one_or_two_points_below_show_no_sill(count):
    looked = look((1.0, 1.5), (0.85, 2.4))
    line = seen(looked)
    below = (line.occupied_m > 1.1) & (line.occupied_m < 1.4)
    below[np.searchsorted(line.occupied_m, [1.12, 1.38][:count])] = False
    few = replace(
        line,
        **{
            c: getattr(line, c)[~below]
            for c in ("occupied_m", "occupied_z_m", "occupied_off_m", "occupied_scan")
        },
    )
    assert windows.find_windows(looked, few, *ENDS_M, **LIMITS) == []


def test_a_plane_has_no_windows():
    looked = look((1.0, 2.2), (0.85, 2.4))
    flat = [wall(looked)]
    assert windows.add_windows(flat, replace(looked, planar=True), **LIMITS) == flat


def plan(ends):
    table = walls([face for _ in SENSORS for face in ROOM], scan_id=np.repeat(np.arange(4), 4))
    looked = look((1.0, 2.2), (0.85, 2.4), ends=ends)
    return planning.make_plan(table, looked, np.array(SENSORS)[:, :2], house_making.T_NS, SETTINGS)


@pytest.mark.parametrize("ends", [LOST, BEYOND])
def test_no_free_floor_leads_through_the_windows_of_a_plan(ends):
    made = plan(ends)
    assert made.openings["type"].tolist() == ["window"]
    assert made.openings["width_m"][0] == pytest.approx(1.2, abs=0.05)
    floor = shapely.union_all(shapely.from_wkb(made.free["geometry"]))
    # the wall's ground, taken to be 0.1 m deep, is whole
    assert floor.intersection(shapely.box(0.1, -0.08, 3.9, -0.02)).area == pytest.approx(
        0, abs=1e-3
    )


def test_faces_of_a_plan_go_on_below_windows():
    faces = plan(LOST).faces
    south = np.maximum(np.abs(faces["y0_m"]), np.abs(faces["y1_m"])) < 0.1
    assert np.abs(faces["x1_m"] - faces["x0_m"])[south].sum() == pytest.approx(4, abs=0.1)
