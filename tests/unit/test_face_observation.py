"""What all scans show of one wall of a toy room."""

import numpy as np

from helpers import house_making
from helpers.observation_making import observation
from scanplan.geometry.lines import Line
from scanplan.rays.face_observation import observe_face


def test_returns_at_a_wall_and_rays_through_its_door():
    """The wall between the rooms of the house from the left; its door is at y = 1.5 to 2.4."""
    wall = Line(np.array([4.0, 0.0]), np.array([-1.0, 0.0]))
    seen = observe_face(house_making.looked(), wall, 0.2, 3.8, band_m=0.06)
    assert (np.diff(seen.occupied_m) >= 0).all() and (np.diff(seen.free_m) >= 0).all()
    # of points at the wall none is in the doorway but what the reveals show, 6 cm of them
    in_door = (seen.occupied_m > 1.56) & (seen.occupied_m < 2.34)
    assert not in_door.any() and set(seen.occupied_scan) == {0, 1}
    assert seen.free_m.min() > 1.4 and seen.free_m.max() < 2.5
    assert np.abs(seen.occupied_off_m).max() <= 0.06
    assert seen.occupied_z_m.min() > 0.2 >= seen.low_z_m.max()
    columns = seen.raster.between(1.6, 2.3)
    assert seen.raster.is_opened(1.8)[columns].all()
    assert seen.raster.is_solid(1.8)[seen.raster.between(0.3, 1.4)].all()


def test_slices_between_two_places_hold_both():
    line = Line(np.zeros(2), np.array([0.0, 1.0]))
    seen = observation(line, [(1, 1), (2, 1), (3, 1)], [(1, 1), (4, 1)], [(2, 0), (2.5, 0)])
    assert seen.occupied_between(2, 3) == slice(1, 3)
    assert seen.free_between(1, 3) == slice(0, 1)
    assert seen.low_between(2.1, 2.4) == slice(1, 1)
