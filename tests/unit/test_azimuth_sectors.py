"""Leaving out directions in which no ray comes near a line must change nothing."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from scanplan.geometry.lines import Line
from scanplan.rays import ray_set

BAND_M = 0.06


def seen(seed, n_scans=4):
    """Random rays of some scans, and a last scan without any."""
    rng = np.random.default_rng(seed)
    sensors = {i: rng.uniform(-3, 3, 3) for i in range(n_scans + 1)}
    scans = [(i, sensors[i] + rng.normal(0, 3, (300, 3))) for i in range(n_scans)]
    return ray_set.gather_rays([*scans, (n_scans, np.empty((0, 3)))], sensors, planar=False)


@given(st.integers(0, 10_000), st.floats(-np.pi, np.pi), st.floats(-4, 4))
@settings(max_examples=60, deadline=None)
def test_a_line_is_seen_by_the_rays_that_reach_it_and_by_no_others(seed, angle_rad, away_m):
    found = seen(seed)
    normal = np.array([np.cos(angle_rad), np.sin(angle_rad)])
    line = Line(away_m * normal, normal)
    sight = ray_set.observe_line(found, line, -100.0, 100.0, band_m=BAND_M)
    xyz_m, scan = found.stacked.xyz_m, found.stacked.scan
    side_m, off_m = line.offset_m(found.sensors_m[scan, :2]), line.offset_m(xyz_m[:, :2])
    # a ray just outside the angle between the ends of a stretch of 200 m is no concern of this test
    inside = (np.abs(side_m) >= ray_set.LEAST_SIDE_M) & (np.abs(line.along_m(xyz_m[:, :2])) < 50)
    hit = inside & (np.abs(off_m) <= BAND_M) & (side_m > 0)
    assert sorted(sight.hit_xy_m.tolist()) == sorted(xyz_m[hit, :2].tolist())
    beyond = inside & (off_m * np.sign(side_m) <= -(BAND_M + 0.15))
    assert len(sight.pass_z_m) == beyond.sum()


def test_far_reaching_fans_alone_are_kept():
    sensor = {0: np.zeros(3)}
    angle_rad = np.radians(np.arange(-179, 180, 2.0))
    range_m = np.where(np.abs(angle_rad) < np.radians(30), 5.0, 1.0)
    points = np.column_stack(
        [range_m * np.cos(angle_rad), range_m * np.sin(angle_rad), 0 * angle_rad]
    )
    found = ray_set.gather_rays([(0, points)], sensor, planar=True)
    assert found.fans.reach_m.max(axis=1) == pytest.approx(5.0)
    assert (found.fans.reach_m > 2).sum() == 30
    assert found.fans.first[0, [0, -1]].tolist() == [0, 180]
