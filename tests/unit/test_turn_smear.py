"""Surfaces in turns show whether scans without times of points are smeared there."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from scanplan.recordings import clouds
from scanplan.recordings.motion import pose_kind, trajectory, turn_smear
from scanplan.stage.witness_table import WITNESSES

MOST_MM = WITNESSES["smeared turns"].limit
T_NS, SWEEP_S, CALM_S, WHOLE_S = 1_700_000_000_000_000_000, 0.1, 12.0, 24.0
BEAM_RAD = np.arange(360) * np.radians(1)
BEAM_S = np.arange(360) / 360 * SWEEP_S
TURN_RAD_S = 1.2


def heading_rad(t_s):
    """It stands for half of the time, and turns steadily for the other half."""
    return TURN_RAD_S * np.maximum(t_s - CALM_S, 0)


def make_motion(calm_s=CALM_S):
    t_s = np.arange(-0.5, WHOLE_S + 0.5, 0.02)
    quat = Rotation.from_euler("z", heading_rad(t_s + CALM_S - calm_s)[:, None]).as_quat()
    t_ns = T_NS + np.round(t_s * 1e9).astype(np.int64)
    still = np.zeros((len(t_s), 3))
    return trajectory.SensorMotion(t_ns, still, quat, np.zeros(len(t_s), np.int32))


def make_survey(beam_s, kind=pose_kind.LOCALISER, sweep_times=None):
    """A sensor in the middle of a room of 6 m by 4 m that sees each beam so long after a stamp."""
    stamps_s = np.arange(0, WHOLE_S, SWEEP_S)

    def scan(scan_id):
        towards = BEAM_RAD + heading_rad(stamps_s[scan_id] + beam_s)
        with np.errstate(divide="ignore"):
            range_m = np.minimum(3 / np.abs(np.cos(towards)), 2 / np.abs(np.sin(towards)))
        range_m += np.random.default_rng(scan_id).normal(0, 0.005, len(range_m))
        way = np.column_stack([np.cos(BEAM_RAD), np.sin(BEAM_RAD), 0 * BEAM_RAD])
        t_ns = T_NS + round(stamps_s[scan_id] * 1e9)
        return clouds.Scan(scan_id, t_ns, (range_m[:, None] * way).astype(np.float32), None, 0)

    return SimpleNamespace(
        sweep_times=sweep_times,
        planar=True,
        pose_kind=kind,
        stamps=lambda: T_NS + np.round(stamps_s * 1e9).astype(np.int64),
        scans=lambda wanted: map(scan, sorted(wanted)),
    )


def test_what_turns_smear_is_thicker_there():
    # a sweep turns by 7 degrees: what is seen askew 3 m away moves by up to 0.3 m
    assert turn_smear.measure_smear_mm(make_survey(BEAM_S), make_motion()) > MOST_MM


def test_what_was_seen_at_once_is_as_thin_in_turns():
    smear_mm = turn_smear.measure_smear_mm(make_survey(0 * BEAM_S), make_motion())
    assert smear_mm == pytest.approx(0, abs=2)


@pytest.mark.parametrize(
    "known",
    [
        make_survey(BEAM_S, kind=pose_kind.ODOMETRY),
        make_survey(BEAM_S, kind=pose_kind.STATIONS),
        make_survey(BEAM_S, sweep_times="s since the stamp"),
    ],
)
def test_of_poses_that_drift_and_of_points_with_times_it_is_not_asked(known):
    assert np.isnan(turn_smear.measure_smear_mm(known, make_motion()))


def test_times_that_fit_no_sweep_are_none():
    survey = make_survey(BEAM_S, sweep_times="s since the stamp")
    as_recorded = replace(make_motion(), time_scale=0.0)
    assert turn_smear.measure_smear_mm(survey, as_recorded) > MOST_MM


def test_of_a_sensor_that_never_turns_nothing_is_known():
    still = make_motion(calm_s=2 * WHOLE_S)
    assert np.isnan(turn_smear.measure_smear_mm(make_survey(BEAM_S), still))
