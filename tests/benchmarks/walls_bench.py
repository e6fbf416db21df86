"""Walls: cluster RANSAC, iterative RANSAC, the literal method, and a line detector on a raster."""

import importlib.util
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import wall_scans

from reference import cluster_ransac as literal_clusters
from scanplan.extraction import cluster_ransac, iterative_ransac, normals
from scanplan.extraction.extractors import (
    EXTRACTORS,
    find_wall_segments,
    make_wall_finder,
)
from scanplan.project.stage_settings import select_extractors
from scanplan.rays import sensor_frame
from scanplan.types import FloatArray, IntArray, Settings

Scans = list[tuple[int, FloatArray]]

_ROUTES = {"demo_office": ("given", 0.4), "ring_office": ("rooms", 1.2)}
"""Building to the way through it and the metres from scan to scan."""

_LITERAL_EVERY = 4  # points: the literal method's time grows with their square
_LITERAL_KEYS = ("reach_deg", "inlier_m")
_LITERAL_CONSTANTS = {
    "max_tilt_deg": cluster_ransac.ClusterRansacSettings.max_tilt_deg,
    "bandwidth_m": cluster_ransac.ClusterRansacSettings.bandwidth_m,
    "min_points": cluster_ransac.ClusterRansacSettings.min_points,
    "max_trials": cluster_ransac.ClusterRansacSettings.trials,
}
_CELL_M = 0.02  # finer than walls scatter
_SLICE_M = (0.9, 2.1)  # above furniture, below lintels
_MIN_LENGTH_M = 0.4  # that of our segments
_SPEED_SCANS = 20  # enough for a coefficient of variation
_TURNS = 3  # the quickest of these is what a scan costs
_WARM_UP = 2  # scans for imports and caches


def bench_speed(root: Path, settings: Settings) -> None:
    """Time both extractors on the same scans of two buildings, turn by turn, each on one core."""
    walls = select_extractors(settings, EXTRACTORS)
    for building, (route, step_m) in _ROUTES.items():
        survey = wall_scans.prepare_standing(
            root / f"config/buildings/{building}.geojson",
            settings["simulate"],
            route=route,
            step_m=step_m,
            every=8,
        )
        scans = survey.scans[:_SPEED_SCANS]
        took_ms = _best_of_turns(survey, scans, walls)
        _print_speed(building, survey, scans, took_ms, walls)
        if building == "demo_office":
            ours_ms = took_ms["cluster_ransac"][0]
            _print_literal(survey, scans[0], ours_ms, walls["cluster_ransac"])


def _best_of_turns(
    survey: wall_scans.Survey, scans: Scans, settings: Settings
) -> dict[str, FloatArray]:
    """Return each scan's least time by method, without what else the machine did meanwhile."""
    _extraction_times(survey, scans[:_WARM_UP], settings)
    times = [_extraction_times(survey, scans, settings) for _ in range(_TURNS)]
    return {name: np.min([took_ms[name] for took_ms in times], axis=0) for name in EXTRACTORS}


def _print_speed(
    building: str,
    survey: wall_scans.Survey,
    scans: Scans,
    took_ms: dict[str, FloatArray],
    settings: Settings,
) -> None:
    points = np.mean([len(xyz_m) for _, xyz_m in scans])
    for name, times in took_ms.items():
        print(
            f"walls, {building}, {name}: {len(scans)} scans of {points:,.0f} points,"
            f" {np.mean(times):.1f} ms each of one core, coefficient of variation"
            f" {np.std(times) / np.mean(times):.2f} (standard deviation {np.std(times):.1f} ms)",
            flush=True,
        )
    ours_ms = np.mean(took_ms["cluster_ransac"])
    theirs_ms = np.mean(took_ms["iterative_ransac"])
    normals_ms = np.mean(_normal_times(survey, scans, settings["cluster_ransac"]["reach_deg"]))
    print(
        f"walls, {building}, cluster against iterative RANSAC:"
        f" {theirs_ms / ours_ms:.1f} times faster; normals are {normals_ms / ours_ms:.0%} of it;"
        f" {cluster_ransac.ClusterRansacSettings.trials} trials a cluster against"
        f" {iterative_ransac.IterativeRansacSettings.trials} a plane",
        flush=True,
    )


def _normal_times(survey: wall_scans.Survey, scans: Scans, reach_deg: float) -> list[float]:
    times = []
    for i, xyz_m in scans:
        around_m = sensor_frame.centre_in_order(xyz_m, survey.sensors[i])
        times.append(
            _milliseconds(lambda p=around_m: normals.cut_surface_cells(p, reach_deg=reach_deg))
        )
    return times


def _print_literal(
    survey: wall_scans.Survey, scan: tuple[int, FloatArray], ours_ms: float, settings: Settings
) -> None:
    scan_id, xyz_m = scan
    few_m = sensor_frame.centre_in_order(xyz_m, survey.sensors[scan_id])[::_LITERAL_EVERY]
    limits = {key: settings[key] for key in _LITERAL_KEYS} | _LITERAL_CONSTANTS
    literal_ms = _milliseconds(
        lambda: literal_clusters.lines(few_m, **limits, rng=np.random.default_rng(1))
    )
    print(
        f"walls, the literal method on every {_LITERAL_EVERY}th point of one scan:"
        f" {literal_ms / 1e3:.1f} s, {literal_ms / ours_ms:,.0f} times as long as ours on all",
        flush=True,
    )


def bench_quality(root: Path, settings: Settings, every: int = 3) -> None:
    """Compare the walls that both extractors and a line detector show with the truth."""
    walls = select_extractors(settings, EXTRACTORS)
    for building, (route, step_m) in _ROUTES.items():
        survey = wall_scans.prepare_standing(
            root / f"config/buildings/{building}.geojson",
            settings["simulate"],
            route=route,
            step_m=step_m,
            every=every,
        )
        found = {name: _extract_lines(survey, name, walls) for name in EXTRACTORS}
        if importlib.util.find_spec("cv2"):
            lines_m = raster_lines(survey.scans)
            found["raster and LSD"] = lines_m, np.zeros(len(lines_m), int)
        else:
            print("walls, quality: no OpenCV (cv2) here, so without its line detector", flush=True)
        for name, (lines_m, scan) in found.items():
            row = wall_scans.measure_quality(lines_m, scan, survey.truth)
            values = ", ".join(f"{key} {value:.3f}" for key, value in row.items())
            print(f"walls, {building}, {len(survey.scans)} scans, {name}: {values}", flush=True)


def raster_lines(scans: Scans, *, planar: bool = False) -> FloatArray:
    """Return the lines (n, 2, 2) that OpenCV's LSD finds on a raster of all points of a slice.

    Of planar scans all points are in it.
    """
    import cv2  # pyright: ignore[reportMissingImports]  # where it is installed: no stage needs it

    points = np.concatenate([xyz for _, xyz in scans]).astype(float)
    in_slice = planar | ((points[:, 2] > _SLICE_M[0]) & (points[:, 2] < _SLICE_M[1]))
    places_m = points[in_slice, :2]
    low_m = places_m.min(axis=0) - 1
    cell = np.floor((places_m - low_m) / _CELL_M).astype(int)
    image = np.zeros(cell.max(axis=0)[::-1] + 50, np.uint8)
    image[cell[:, 1], cell[:, 0]] = 255
    lines = cv2.createLineSegmentDetector().detect(image)[0]
    lines_m = lines.reshape(-1, 2, 2) * _CELL_M + low_m + _CELL_M / 2
    length_m = np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T)
    return lines_m[length_m >= _MIN_LENGTH_M]


def _extract_lines(
    survey: wall_scans.Survey, name: str, settings: Settings
) -> tuple[FloatArray, IntArray]:
    finder = make_wall_finder(EXTRACTORS[name], settings[name], planar=False)
    lines: list[FloatArray] = [np.empty((0, 2, 2))]
    scan = [np.empty(0, int)]
    for i, xyz_m in survey.scans:
        walls = find_wall_segments(i, xyz_m, sensor_xyz_m=survey.sensors[i], finder=finder)
        lines.append(np.stack([walls.start_m, walls.end_m], axis=1))
        scan.append(np.full(len(walls), i))
    return np.concatenate(lines), np.concatenate(scan)


def _extraction_times(
    survey: wall_scans.Survey, scans: Scans, settings: Settings
) -> dict[str, list[float]]:
    """Return each method's time (ms) of each scan."""
    took_ms: dict[str, list[float]] = {name: [] for name in EXTRACTORS}
    for i, xyz_m in scans:
        for name in EXTRACTORS:
            call = partial(
                find_wall_segments,
                i,
                xyz_m,
                sensor_xyz_m=survey.sensors[i],
                finder=make_wall_finder(EXTRACTORS[name], settings[name], planar=False),
            )
            took_ms[name].append(_milliseconds(call))
    return took_ms


def _milliseconds(function: Callable[[], object]) -> float:
    """Return the processor time of a call: extractors run on one thread."""
    started = time.process_time()
    function()
    return 1e3 * (time.process_time() - started)
