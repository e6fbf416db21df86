"""What rings of points show of the sensor that measured them."""

import numpy as np
import pytest

from scanplan.visit.sensor_reach import measure_reach

NORTH = np.array([[0.0, -1, 0, 5], [1, 0, 0, 7], [0, 0, 1, 1.4], [0, 0, 0, 1]])


def ring(range_m, from_deg, to_deg, step_deg=1.0):
    """Points around a sensor at (5, 7), 1.4 m up, that looks north."""
    turn = np.radians(np.arange(from_deg, to_deg, step_deg))
    own = np.column_stack([range_m * np.cos(turn), range_m * np.sin(turn), np.zeros(len(turn))])
    return own @ NORTH[:3, :3].T + NORTH[:3, 3]


def test_returns_all_around_make_a_full_field():
    reach = measure_reach([(ring(4.0, -180, 180), NORTH)], floor_z_m=1.0)
    assert reach.field_rad == pytest.approx(2 * np.pi)
    assert reach.range_m == pytest.approx(4.0)
    assert reach.height_m == pytest.approx(0.4)


def test_half_a_ring_is_half_a_field():
    reach = measure_reach([(ring(4.0, -90, 90), NORTH)], floor_z_m=np.nan)
    assert reach.field_rad == pytest.approx(np.pi)
    assert np.isnan(reach.height_m)


def test_what_one_scan_does_not_show_of_the_field_another_does():
    scans = [(ring(4.0, -180, 40), NORTH), (ring(3.0, 0, 180), NORTH)]
    assert measure_reach(scans, 1.0).field_rad == pytest.approx(2 * np.pi)


def test_columns_are_to_be_a_tenth_of_a_metre_apart_at_most():
    # a degree apart: 0.1 m at 5.73 m
    reach = measure_reach([(ring(40.0, -180, 180), NORTH)], floor_z_m=1.0)
    assert reach.range_m == pytest.approx(0.1 / np.radians(1.0), rel=1e-6)
