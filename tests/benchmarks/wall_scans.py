"""Scans of 28,000 points with exact poses, and how well walls of them show the truth."""

import copy
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from scanplan.geometry.lines import line_lengths_m
from scanplan.lab.buildings import building as buildings
from scanplan.lab.evaluation import (
    face_cells,
    length_metrics,
    truth_file,
    visible_faces,
    wall_findings,
)
from scanplan.lab.simulation import raycast, survey_setup, sweeps
from scanplan.types import BoolArray, FilePath, FloatArray, IntArray, Settings

N_AZIMUTH = 1800  # of a real VLP-16
_LONG_M = 0.5  # shorter faces are reveals and pillars
_APART = 100_000  # more than there are faces: scan and face as one number
_DISTANCES_M = (0.05, 0.10)  # those of the evaluation


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

    scans: list[tuple[int, FloatArray]]
    sensors: dict[int, FloatArray]
    truth: wall_findings.VisibleTruth


def prepare_standing(
    building: FilePath,
    settings: Settings,
    *,
    seed: int = 1,
    step_m: float = 0.4,
    every: int = 1,
    **site: Any,
) -> Survey:
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
        Only each n-th scan is taken; what can be seen is worked out from all of them.
    **site
        Instead of settings of `simulate.site`.
    """
    drive = {"speed_m_s": step_m, "turn_rate_deg_s": 360.0}
    found, survey = prepare_unswept(building, settings, seed=seed, rate_hz=1.0, drive=drive, **site)
    poses = survey_setup.true_poses(survey)[1]
    scene = raycast.RayScene(survey.mesh)
    ids = range(0, len(poses), every)
    scans = [(i, scan_points(survey, scene, i, poses[i])) for i in ids]
    faces = truth_file.TrueFaces(*(_face_lines(found.truth, s) for s in ("inside", "outside")))
    view = visible_faces.SensorView(settings["sensor"]["max_range_m"])
    truth = wall_findings.observe_truth(faces, poses[list(ids)], poses, sight=view)
    return Survey(scans, {i: poses[i, :3, 3] for i in ids}, truth)


def prepare_unswept(
    building: FilePath,
    settings: Settings,
    *,
    seed: int,
    rate_hz: float,
    drive: Settings,
    **site: Any,
) -> tuple[buildings.Building, sweeps.SimulatedSurvey]:
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
    """
    chosen = copy.deepcopy(dict(settings))
    chosen["sensor"] |= {"n_azimuth": N_AZIMUTH, "sweep": False, "rate_hz": rate_hz}
    chosen["drive"] |= drive
    chosen["site"] |= site
    path = Path(building)
    found = survey_setup.prepare_site(path.read_bytes(), path, chosen, seed=seed)
    return found, survey_setup.prepare_survey(found, chosen, seed=seed)


def measure_quality(
    lines_m: FloatArray, scan: IntArray, truth: wall_findings.VisibleTruth
) -> dict[str, float]:
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
        Correctness (share of the length near a true face) and completeness (share of the visible
        faces longer than 0.5 m near a wall) at 0.05 and 0.10 m, and walls per true wall and scan.
    """
    cells = truth.cells
    long_faces = line_lengths_m(cells.faces_m) > _LONG_M
    asked = truth.visible & long_faces[cells.face]
    row = {}
    for distance_m in _DISTANCES_M:
        near = length_metrics.find_near_intervals(lines_m, cells.faces_m, distance_m)
        near_m = length_metrics.union_length_m(near, len(lines_m)).sum()
        all_m = line_lengths_m(lines_m).sum()
        found = _found_cells(lines_m, truth, distance_m)
        found_m = cells.length_m[asked & found].sum()
        row[f"correct {distance_m:.2f}"] = length_metrics.safe_share(near_m, all_m)
        row[f"complete {distance_m:.2f}"] = found_m / cells.length_m[asked].sum()
    near = length_metrics.find_near_intervals(lines_m, cells.faces_m, _DISTANCES_M[-1])
    return row | {"walls per wall": _walls_per_wall(near, scan, len(lines_m))}


def _walls_per_wall(near: length_metrics.NearIntervals, scan: IntArray, n_lines: int) -> float:
    """Return how many lines of a scan lie along a true face on average."""
    face = np.full(n_lines, -1)
    order = np.argsort(near.high_m - near.low_m, kind="stable")
    face[near.line[order]] = near.other[order]
    on_face = face >= 0
    pairs = np.unique(scan[on_face] * _APART + face[on_face])
    return on_face.sum() / max(len(pairs), 1)


def _found_cells(
    lines_m: FloatArray, truth: wall_findings.VisibleTruth, distance_m: float
) -> BoolArray:
    near = length_metrics.find_near_intervals(truth.cells.faces_m, lines_m, distance_m)
    begin, end = face_cells.cells_in_intervals(truth.cells, near.line, near.low_m, near.high_m)
    change = np.zeros(len(truth.cells.face) + 1, int)
    np.add.at(change, begin, 1)
    np.add.at(change, end, -1)
    return np.cumsum(change)[:-1] > 0


def _face_lines(features: Iterable[Any], side: str) -> FloatArray:
    chosen = [g for g, p in features if p["kind"] == "face" and p["side"] == side]
    return np.array([np.array(line.coords) for line in chosen], float).reshape(-1, 2, 2)


def scan_points(
    survey: sweeps.SimulatedSurvey,
    scene: raycast.RayScene,
    scan_id: int,
    world_from_sensor: FloatArray,
) -> FloatArray:
    """Return the points (m, 3) float32, in the map, of a simulated scan at its true pose."""
    range_m = sweeps.take_scan(survey, scene, scan_id).range_m
    hit = np.isfinite(range_m)
    direction = np.broadcast_to(survey.sensor.direction, (*range_m.shape, 3))[hit]
    around_m = direction * range_m[hit][:, None]
    xyz_m = around_m @ world_from_sensor[:3, :3].T + world_from_sensor[:3, 3]
    return xyz_m.astype(np.float32)
