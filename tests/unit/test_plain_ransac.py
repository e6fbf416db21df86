"""The thesis's extractors on a corner of two walls and a floor."""

from dataclasses import fields

import numpy as np
import pytest

from helpers.default_settings import SETTINGS
from scanplan.extraction import cluster_ransac, segments
from scanplan.lab.thesis import plain_ransac
from scanplan.project.stage_settings import select_extractor


@pytest.fixture
def settings():
    given = select_extractor(SETTINGS, "iterative_ransac")
    return plain_ransac.PlainRansacSettings(**given | {"trials": 300})


def wall(rng, n, *, x=None, y=None, z=None, pause=False):
    """Points of a plane of 4 m x 2 m; `pause` leaves its middle out."""
    along = rng.uniform(0, 4, n)
    along = (
        np.where(np.abs(along - 2) < 1, along + 4 * np.sign(along - 2), along) if pause else along
    )
    first = np.full(n, x) if x is not None else along
    second = np.full(n, y) if y is not None else (along if x is not None else rng.uniform(0, 4, n))
    return np.column_stack(
        [first, second, np.full(n, z) if z is not None else rng.uniform(0, 2, n)]
    )


def test_every_upright_plane_is_one_wall_and_the_floor_none(settings):
    rng = np.random.default_rng(1)
    points = np.concatenate([wall(rng, 500, x=0.0), wall(rng, 400, y=-1.0), wall(rng, 600, z=-0.5)])
    found = plain_ransac.extract_plain(
        3, points, settings=settings, planar=False, sensor_xyz_m=np.zeros(3)
    )
    assert len(found) == 2
    np.testing.assert_allclose(np.abs(found), [(1, 0), (0, 1)], atol=0.03)


def test_a_wall_that_pauses_is_one(settings):
    points = wall(np.random.default_rng(1), 500, x=0.0, pause=True)
    assert len(plain_ransac.extract_plain(3, points, settings=settings)) == 1


def test_too_few_points_are_no_wall(settings):
    points = wall(np.random.default_rng(1), settings.min_points - 1, x=0.0)
    assert plain_ransac.extract_plain(3, points, settings=settings) == []
    assert plain_ransac.extract_plain(3, points[:0], settings=settings) == []


def test_clusters_are_one_wall_each_however_they_pause():
    given = select_extractor(SETTINGS, "cluster_ransac")
    points = wall(np.random.default_rng(1), 4000, x=2.0, pause=True)
    count = {}
    for name, over in (("ours", {}), ("lifted", plain_ransac.LIFTED)):
        settings = cluster_ransac.ClusterRansacSettings(**given | over)
        sensor_m = np.array([0.0, 2.0, 1.0])
        count[name] = len(
            cluster_ransac.extract_by_clusters(
                3, points, sensor_xyz_m=sensor_m, planar=False, settings=settings
            )
        )
    assert count["lifted"] == 1 and count["ours"] != 1


def test_every_limit_of_ours_is_lifted():
    kept = {"inlier_m", "min_points", "min_points_planar", "seed"}
    assert (
        set(plain_ransac.LIFTED) == {field.name for field in fields(segments.SegmentLimits)} - kept
    )
