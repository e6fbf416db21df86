"""Sectors of five degrees, and the spans of rows that a bound on ranges leaves of them.

That leaving out sectors changes no ray that reaches a line is tested in `test_face_rays`.
"""

import numpy as np
import pytest

from helpers.ray_making import rays
from scanplan.rays import azimuth_sectors

DEGREES = np.arange(-177.5, 180, 5.0)


def ring(range_m):
    """Return a scan of one ray in the middle of each sector, ending so far away."""
    angle_rad = np.radians(DEGREES)
    points = [range_m * np.cos(angle_rad), range_m * np.sin(angle_rad), 0 * angle_rad]
    return (0, 0, 0), np.column_stack(points)


def test_each_sector_reaches_as_far_as_its_longest_ray():
    found = rays(ring(np.where(np.abs(DEGREES) < 30, 5.0, 1.0)), planar=True).sectors
    assert found.first.tolist() == [list(range(73))]
    assert found.reach_m[0] == pytest.approx(np.where(np.abs(DEGREES) < 30, 5.0, 1.0))


def test_a_sector_without_a_ray_reaches_nowhere():
    found = rays(((0, 0, 0), [(1, 0.01, 0)]), ((0, 0, 0), [])).sectors
    assert found.first.shape == (2, 73)
    assert np.flatnonzero(found.reach_m[0]).tolist() == [36]
    assert not found.reach_m[1].any()


def cut(range_m, side_m, at_m=0.1):
    """Return the rows that are left of a ring's whole turn, before the line x = side_m."""
    looked = rays(ring(range_m), planar=True)
    low, high, row = azimuth_sectors.cull_spans(
        looked.sectors,
        np.array([[0], [0]]),
        np.array([[72], [0]]),
        np.array([0]),
        np.array([side_m]),
        np.array([-1.0, 0.0]),
        at_m,
    )
    assert (row == 0).all()
    return [int(i) for a, b in zip(low[0], high[0], strict=True) for i in range(a, b)]


def test_only_sectors_that_may_come_near_the_line_are_left():
    # 2 m long, 1 m off: of those that turn by at most 60 degrees a part comes nearer than 0 m
    left = DEGREES[cut(np.full(72, 2.0), 1.0, at_m=0.0)]
    assert left.tolist() == np.arange(-62.5, 63, 5.0).tolist()
    # 0.5 m before it everything ends
    assert cut(np.full(72, 0.5), 1.0) == []
    assert len(cut(np.full(72, 0.5), 1.0, at_m=0.5)) > 0


def test_one_long_ray_is_enough_for_its_sector():
    far = np.where(DEGREES == 42.5, 9.0, 0.2)
    assert DEGREES[cut(far, 1.0)].tolist() == [42.5]
