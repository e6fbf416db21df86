"""Scans of 28,000 points with exact poses, for the benchmarks of walls, and how well walls show the truth."""

import copy
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from scanplan.lab.evaluation import length_metrics, truth_file, visible_faces, wall_findings
from scanplan.lab.simulation import raycast, survey_setup, sweeps

N_AZIMUTH = 1800  # of a real VLP-16
_LONG_M = 0.5
_APART = 100_000


@dataclass(frozen=True)
class Survey:
    """A simulated drive that stops for every scan.

    Attributes
    ----------
    scans : list of (int, (n, 3) float32)
        scan_id and points, in the map.
    sensors : dict of int to (3,) float64
    truth : wall_findings.VisibleTruth
    """

    scans: list
    sensors: dict
    truth: wall_findings.VisibleTruth


def standing(building, settings, *, seed=1, step_m=0.4, every=1, **site):
    """Simulate a drive through a building without sweep, with exact poses.

    Parameters
    ----------
    building : path-like
    settings : dict
        The section `simulate` of the configuration.
    seed : int
    step_m : float
        From scan to scan.
    every : int
        Only each n-th of these is taken; what can be seen is told from all of them.
    **site
        Instead of settings of `simulate.site`.
    """
    drive = {"speed_m_s": step_m, "turn_rate_deg_s": 360.0}
    found, survey = unswept(building, settings, seed=seed, rate_hz=1.0, drive=drive, **site)
    poses, scene = survey_setup.true_poses(survey)[1], raycast.RayScene(survey.mesh)
    scans = [(i, points(survey, scene, i, poses[i])) for i in range(0, len(poses), every)]
    faces = truth_file.TrueFaces(*(_lines(found.truth, side) for side in ("inside", "outside")))
    sight = visible_faces.SensorView(settings["sensor"]["max_range_m"])
    truth = wall_findings.observe_truth(faces, poses[[i for i, _ in scans]], poses, sight=sight)
    return Survey(scans, {i: poses[i, :3, 3] for i, _ in scans}, truth)


def unswept(building, settings, *, seed, rate_hz, drive, **site):
    """Prepare a survey without sweep by a VLP-16.

    Parameters
    ----------
    building : path-like
    settings : dict
        The section `simulate` of the configuration.
    seed : int
    rate_hz : float
        Scans a second.
    drive : dict
        Instead of settings of `simulate.drive`.
    **site
        Instead of settings of `simulate.site`.

    Returns
    -------
    site : building.Building
    survey : sweeps.SimulatedSurvey
    """
    chosen = copy.deepcopy(settings)
    chosen["sensor"] |= {"n_azimuth": N_AZIMUTH, "sweep": False, "rate_hz": rate_hz}
    chosen["drive"] |= drive
    rig = {key: chosen[key] for key in ("mount", "sensor", "errors", "drive", "people")}
    chosen["site"] |= site
    found = survey_setup.prepare_site(
        Path(building).read_bytes(), Path(building), chosen["mount"], seed=seed, **chosen["site"]
    )
    return found, survey_setup.prepare_survey(found, seed=seed, **rig)


def quality(lines_m, scan, truth):
    """Measure walls against the truth.

    Parameters
    ----------
    lines_m : (n, 2, 2) float
    scan : (n,) int
        The scan that shows each.
    truth : wall_findings.VisibleTruth

    Returns
    -------
    dict
        Correctness (share of the length near a true face) and completeness (share of the visible faces longer than
        0.5 m near a wall) at 0.05 and 0.10 m, and walls per true wall and scan.
    """
    faces_m, cells = truth.cells.faces_m, truth.cells
    asked = truth.visible & (length_metrics.line_lengths_m(faces_m) > _LONG_M)[cells.face]
    row = {}
    for distance_m in (0.05, 0.10):
        near = length_metrics.find_near_intervals(lines_m, faces_m, distance_m)
        all_m = length_metrics.line_lengths_m(lines_m).sum()
        row[f"correct {distance_m:.2f}"] = length_metrics.safe_share(
            length_metrics.union_length_m(near, len(lines_m)).sum(), all_m
        )
        found = _found(lines_m, truth, distance_m)
        row[f"complete {distance_m:.2f}"] = (
            cells.length_m[asked & found].sum() / cells.length_m[asked].sum()
        )
    face = np.full(len(lines_m), -1)
    order = np.argsort(near.high_m - near.low_m, kind="stable")
    face[near.line[order]] = near.other[order]
    pairs = np.unique(scan[face >= 0] * _APART + face[face >= 0])
    return row | {"walls per wall": (face >= 0).sum() / max(len(pairs), 1)}


def _found(lines_m, truth, distance_m):
    from scanplan.lab.evaluation import face_cells

    near = length_metrics.find_near_intervals(truth.cells.faces_m, lines_m, distance_m)
    begin, end = face_cells.cells_in_intervals(truth.cells, near.line, near.low_m, near.high_m)
    change = np.zeros(len(truth.cells.face) + 1, int)
    np.add.at(change, begin, 1)
    np.add.at(change, end, -1)
    return np.cumsum(change)[:-1] > 0


def _lines(features, side):
    lines = [np.array(g.coords) for g, p in features if p["kind"] == "face" and p["side"] == side]
    return np.array(lines, float).reshape(-1, 2, 2)


def points(survey, scene, scan_id, world_from_sensor):
    """Return the points (m, 3) float32, in the map, of one scan of a simulated survey at its true pose."""
    range_m = sweeps.take_scan(survey, scene, scan_id).range_m
    hit = np.isfinite(range_m)
    direction = np.broadcast_to(survey.sensor.direction, (*range_m.shape, 3))[hit]
    xyz_m = (direction * range_m[hit][:, None]) @ world_from_sensor[:3, :3].T + world_from_sensor[
        :3, 3
    ]
    return xyz_m.astype(np.float32)
