"""Windows of a toy room.

What becomes of the rays to a part of its south wall is known on paper.
"""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from helpers import house_making
from helpers.facade_making import (
    BEFORE,
    BEYOND,
    ENDS_M,
    LIMITS,
    LOST,
    NICHE,
    ROOM,
    SENSORS,
    SETTINGS,
    look,
    seen,
    wall,
)
from helpers.wall_making import walls
from scanplan.plan import planning, windows
from scanplan.plan.faces import intervals
from scanplan.plan.openings import GAP, OPEN, Opening
from scanplan.plan.plan_wall import PlanWall


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
    """Windows found in the south wall, places along it counted from the origin."""
    looked = look(*part, **more)
    return find_along(looked, seen(looked))


def find_along(looked, line):
    side = intervals.FaceInterval(line, *ENDS_M)
    (found,) = windows.add_windows(
        [PlanWall(line.line, *ENDS_M, np.nan, [side], [])], looked, **LIMITS
    )
    return found.openings


@pytest.mark.parametrize("ends", [LOST, BEYOND])
def test_rays_that_go_through_above_a_wall_show_a_window(ends):
    (window,) = find((1.0, 2.2), (0.85, 2.4), ends=ends)
    assert (window.low_m, window.high_m) == (
        pytest.approx(1.0, abs=0.03),
        pytest.approx(2.2, abs=0.03),
    )
    assert window.sill_m == pytest.approx(0.85, abs=0.04)
    assert (window.state, window.kind) == (OPEN, GAP)


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


@pytest.mark.parametrize(
    ("places_m", "count"), [([1.6], 1), ([1.4, 1.8], 1), ([1.6] * 2, 1), ([1.6] * 3, 2)]
)
def test_stray_points_part_no_window_and_a_mullion_does(places_m, count):
    looked = look((1.0, 2.2), (0.85, 2.4))
    line = with_points(seen(looked), np.array(places_m))
    assert len(find_along(looked, line)) == count


def test_a_side_that_is_hidden_at_eye_height_is_seen_above_the_sill():
    looked = look((1.0, 2.2), (0.85, 2.4))
    line = seen(looked)
    is_hidden = (line.occupied_m > 2.1) & (line.occupied_m < 2.6) & (line.occupied_z_m > 1.25)
    columns = ("occupied_m", "occupied_z_m", "occupied_off_m", "occupied_scan")
    shown = replace(line, **{c: getattr(line, c)[~is_hidden] for c in columns})
    (window,) = find_along(looked, shown)
    assert (window.low_m, window.high_m) == pytest.approx((1.0, 2.2), abs=0.05)


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
