"""What all scans show of one wall of a toy room."""

from dataclasses import replace

import numpy as np
import pytest

from helpers import house_making
from helpers.observation_making import observation
from scanplan.geometry.lines import Line
from scanplan.rays import ray_set
from scanplan.rays.face_observation import filled_share, observe_face

SENSORS = [(1, 2, 0.9), (2, 3, 0.9), (3, 2, 0.9), (2.5, 3.4, 0.9)]
SOUTH = Line(np.array([0.0, 0.0]), np.array([0.0, 1.0]))
ROOM = [(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0)]


def look(lost, sensors=SENSORS):
    """Rays of scans that lose nineteen of twenty of the points (n, 3) that `lost` chooses."""
    generator = np.random.default_rng(1)
    scans = [
        (i, xyz[~lost(xyz) | (generator.random(len(xyz)) < 0.05)]) for i, xyz in _scans(sensors)
    ]
    found = ray_set.gather_rays(scans, dict(enumerate(np.array(sensors, float))), planar=False)
    # of the floor only the corners are seen
    return replace(found, floor_z_m=0.0)


def _scans(sensors):
    return house_making.scans(ROOM, sensors, columns=1800)


def through(low_z, high_z):
    return lambda xyz: (
        (np.abs(xyz[:, 1]) < 0.1)
        & (xyz[:, 0] > 1)
        & (xyz[:, 0] < 3)
        & (xyz[:, 2] > low_z)
        & (xyz[:, 2] < high_z)
    )


def lost_m(looked, line=SOUTH, low_m=0, high_m=4):
    return observe_face(looked, line, low_m, high_m, band_m=0.06).lost_m


def test_a_pane_down_to_the_floor_is_found():
    np.testing.assert_allclose(lost_m(look(through(0.1, 2.4))), [(1, 3)], atol=0.16)


@pytest.mark.parametrize("heights", [(1.3, 2.4), (0.1, 1.1), (9, 9)])
def test_a_wall_below_a_window_or_above_an_oven_is_wall(heights):
    assert len(lost_m(look(through(*heights)))) == 0


def test_two_scans_are_not_enough():
    assert len(lost_m(look(through(0.1, 2.4), SENSORS[:2]))) == 0


def test_from_behind_nothing_is_told():
    behind = Line(SOUTH.centre, -SOUTH.normal)
    assert len(lost_m(look(through(0.1, 2.4)), behind, -4, 0)) == 0


def test_a_pane_has_a_frame():
    sill = [(x_m, 0.1) for x_m in np.arange(1.0, 2.0, 0.02)]
    seen = observation(SOUTH, low=sill, lost=[(1.0, 2.0), (2.0, 3.5)])
    np.testing.assert_allclose(seen.framed_m, [(1.0, 2.0)])


def test_a_pane_in_the_plane_sends_a_ray_back_now_and_then():
    """One return every 0.4 m on the left; on the right one in 2 m, as of somebody in a way out."""
    returns = [(x_m, 0.0) for x_m in (1.1, 1.5, 1.9, 2.3, 2.7, 4.0)]
    seen = observation(SOUTH, returns, lost=[(1.0, 3.0), (3.5, 5.5)], planar=True)
    np.testing.assert_allclose(seen.framed_m, [(1.0, 3.0)])


@pytest.mark.parametrize(
    ("places_m", "width_m"),
    [([0.3], 0.6), ([0.45], 0.9), ([0.05, 0.85], 0.9), ([0.04, 1.17], 1.2), ([0.5, 0.6], 1.2)],
    ids=["one", "one_in_a_door", "jambs", "jambs_of_a_wide_door", "legs"],
)
def test_returns_of_jambs_or_of_somebody_in_a_way_make_no_pane_in_the_plane(places_m, width_m):
    returns = [(x_m, 0.0) for x_m in places_m]
    assert len(observation(SOUTH, returns, lost=[(0, width_m)], planar=True).framed_m) == 0


def test_returns_at_a_wall_and_rays_through_its_door():
    """The wall between the rooms of the house from the left; its door is at y = 1.5 to 2.4."""
    wall = Line(np.array([4.0, 0.0]), np.array([-1.0, 0.0]))
    seen = observe_face(house_making.looked(), wall, 0.2, 3.8, band_m=0.06)
    assert (np.diff(seen.occupied_m) >= 0).all() and (np.diff(seen.free_m) >= 0).all()
    # of points at the wall none is in the doorway but what the reveals show, 6 cm of them
    in_door = (seen.occupied_m > 1.56) & (seen.occupied_m < 2.34)
    assert not in_door.any() and set(seen.occupied_scan) == {0, 1}
    assert seen.free_m.min() > 1.4 and seen.free_m.max() < 2.5
    # from both sides
    assert set(seen.free_scan) == {0, 1, 2, 3}
    assert np.abs(seen.occupied_off_m).max() <= 0.06
    assert seen.occupied_z_m.min() > 0.2 >= seen.low_z_m.max()
    columns = seen.raster.between(1.6, 2.3)
    assert seen.raster.is_opened(1.8)[columns].all()
    assert seen.raster.is_solid(1.8)[seen.raster.between(0.3, 1.4)].all()


def test_slices_between_two_places_hold_both():
    seen = observation(SOUTH, [(1, 1), (2, 1), (3, 1)], [(1, 1), (4, 1)], [(2, 0), (2.5, 0)])
    assert seen.occupied_between(2, 3) == slice(1, 3)
    assert seen.free_between(1, 3) == slice(0, 1)
    assert seen.low_between(2.1, 2.4) == slice(1, 1)


def test_a_share_of_columns_is_filled():
    places_m = np.array([0.01, 0.02, 0.07, 0.97])
    assert filled_share(places_m, 0.0, 1.0) == pytest.approx(3 / 20)
    assert filled_share(np.empty(0), 0.0, 1.0) == filled_share(places_m, 0.5, 0.5) == 0
