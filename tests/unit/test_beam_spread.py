"""Where planar scans look, how densely and how far, by returns at azimuths given one by one."""

import numpy as np
import pytest

from scanplan.rays.beam_spread import observe_beams


def beams(*azimuth_degs, range_m=3.0, further_deg=()):
    """Return what scans show of their sensor's beams, of returns at these azimuths.

    They look at further ones, too.
    """
    scans = []
    for azimuth_deg in azimuth_degs:
        azimuth_rad = np.radians(np.sort((np.asarray(azimuth_deg, float) + 180) % 360 - 180))
        way = np.column_stack([np.cos(azimuth_rad), np.sin(azimuth_rad), 0 * azimuth_rad])
        scans.append((azimuth_rad, range_m * way, np.radians(further_deg)))
    return observe_beams(scans)


HALF_TURN = np.arange(-90.0, 91.0)


class TestPlanarBeams:
    def test_a_scan_looks_from_its_first_beam_to_its_last(self):
        found = beams(HALF_TURN, HALF_TURN + 180)
        np.testing.assert_allclose(found.begin_rad, [-np.pi / 2, np.pi / 2])
        np.testing.assert_allclose(found.wide_rad, np.pi)
        np.testing.assert_allclose(found.per_deg, 1.0)

    def test_beams_that_never_came_back_are_no_edge_of_it(self):
        found = beams(HALF_TURN[np.abs(HALF_TURN) > 20])
        np.testing.assert_allclose(found.begin_rad, -np.pi / 2)
        np.testing.assert_allclose(found.wide_rad, np.pi)

    def test_where_returns_were_left_out_is_no_end_of_it(self):
        """Of a field of 270 degrees those of 100 are not given: more than it does not look at."""
        field = np.arange(-135.0, 136.0)
        given = field[np.abs(field) > 50]
        assert np.degrees(beams(given).wide_rad) == pytest.approx(360 - 102)
        found = beams(given, further_deg=np.arange(-50.0, 51.0, 5.0))
        assert np.degrees(found.wide_rad) == pytest.approx(270)
        assert np.degrees(found.begin_rad) == pytest.approx(-135)
        assert found.per_deg == pytest.approx(1)

    def test_of_a_sensor_that_looks_all_around_no_gap_is_the_end(self):
        around = np.arange(-180.0, 180.0)
        found = beams(around, around[np.abs(around) > 20])
        np.testing.assert_allclose(found.wide_rad, 2 * np.pi)

    def test_echoes_of_one_beam_are_one_beam_though_they_are_rounded(self):
        rng = np.random.default_rng(1)
        echoes = np.repeat(HALF_TURN, 3) + rng.uniform(-1e-5, 1e-5, 3 * len(HALF_TURN))
        assert beams(echoes).per_deg == pytest.approx(1.0, rel=1e-3)

    def test_it_reaches_as_far_as_some_returns_came_from(self):
        azimuth_rad = np.radians(HALF_TURN)
        range_m = np.full(len(HALF_TURN), 4.0)
        range_m[[5, 50]], range_m[[20, 70, 90]] = 100.0, 6.0
        ways_m = range_m[:, None] * np.column_stack(
            [np.cos(azimuth_rad), np.sin(azimuth_rad), 0 * azimuth_rad]
        )
        # two may be stray
        assert observe_beams([(azimuth_rad, ways_m, np.empty(0))]).reach_m == pytest.approx(6.0)

    def test_of_no_scans_and_of_one_beam_none_is_known(self):
        assert beams().per_deg.shape == (0,) and beams().reach_m == 0
        for few in ((), (0.0,), (0.0, 0.0, 0.0)):
            found = beams(few)
            assert (found.wide_rad, found.per_deg) == (0, 0)
