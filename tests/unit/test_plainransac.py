"""Iterative RANSAC with removal of inliers alone, on a corner of two walls and a floor."""

import numpy as np
import pytest

from scanplan.configuration import read_yaml
from scanplan.thesis import plainransac


@pytest.fixture
def settings(project_root):
    given = read_yaml(project_root / "config/config.yaml")["walls"]["iterative_ransac"]
    return plainransac.Settings(**given | {"trials": 300})


def wall(rng, n, *, x=None, y=None, z=None, pause=False):
    """Points of a plane of 4 m x 2 m; `pause` leaves its middle out."""
    along = rng.uniform(0, 4, n)
    along = np.where(np.abs(along - 2) < 1, along + 4 * np.sign(along - 2), along) if pause else along
    first = np.full(n, x) if x is not None else along
    second = np.full(n, y) if y is not None else (along if x is not None else rng.uniform(0, 4, n))
    return np.column_stack([first, second, np.full(n, z) if z is not None else rng.uniform(0, 2, n)])


def test_every_upright_plane_is_one_wall_and_the_floor_none(settings):
    rng = np.random.default_rng(1)
    points = np.concatenate([wall(rng, 500, x=0.0), wall(rng, 400, y=-1.0), wall(rng, 600, z=-0.5)])
    found = plainransac.extract(3, points, settings=settings, planar=False, sensor_xyz_m=np.zeros(3))
    assert len(found) == 2
    np.testing.assert_allclose(np.abs(found), [(1, 0), (0, 1)], atol=0.03)


def test_a_wall_that_pauses_is_one(settings):
    points = wall(np.random.default_rng(1), 500, x=0.0, pause=True)
    assert len(plainransac.extract(3, points, settings=settings)) == 1


def test_too_few_points_are_no_wall(settings):
    points = wall(np.random.default_rng(1), settings.min_points - 1, x=0.0)
    assert plainransac.extract(3, points, settings=settings) == []
    assert plainransac.extract(3, points[:0], settings=settings) == []
