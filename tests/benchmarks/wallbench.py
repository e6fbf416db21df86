"""Walls: cluster RANSAC against iterative RANSAC, the literal method, and a line detector on a raster of all points."""

import importlib.util
import time

import numpy as np
import wallscans

from reference import cluster_ransac as literal_clusters
from scanplan.extraction import normals
from scanplan.extraction.extractors import EXTRACTORS
from scanplan.project.stage_settings import select_extractors
from scanplan.rays import sensor_frame

METHODS = EXTRACTORS
_ROUTES = {"demo_office": ("given", 0.4), "ring_office": ("rooms", 1.2)}
_LITERAL_EVERY = 4  # points: the literal method's time grows with their square
_LITERAL_KEYS = ("reach_deg", "max_tilt_deg", "bandwidth_m", "inlier_m", "min_points")
_CELL_M = 0.02
_SLICE_M = (0.9, 2.1)


def speed(root, settings, n_scans=20):
    """Time both extractors on the same scans of two buildings, turn by turn, each on one core."""
    for building, (route, step_m) in _ROUTES.items():
        path = root / f"config/buildings/{building}.geojson"
        survey = wallscans.standing(path, settings["simulate"], route=route, step_m=step_m, every=8)
        scans = survey.scans[:n_scans]
        walls = select_extractors(settings, METHODS)
        took_ms = _best_of_turns(survey, scans, walls)
        _tell_speed(building, survey, scans, took_ms, walls)
        if building == "demo_office":
            _tell_literal(survey, scans[0], took_ms["cluster_ransac"][0], walls["cluster_ransac"])


def _best_of_turns(survey, scans, settings, turns=3):
    """Return each scan's least time by method: what the scan costs, without what else the machine did meanwhile."""
    _extract(survey, scans[:2], settings)  # imports and caches
    times = [_extract(survey, scans, settings) for _ in range(turns)]
    return {name: np.min([took_ms[name] for took_ms in times], axis=0) for name in METHODS}


def _tell_speed(building, survey, scans, took_ms, settings):
    points = np.mean([len(xyz_m) for _, xyz_m in scans])
    for name, times in took_ms.items():
        print(f"walls, {building}, {name}: {len(scans)} scans of {points:,.0f} points,", end=" ")
        print(f"{np.mean(times):.1f} ms each of one core, coefficient of variation", end=" ")
        print(
            f"{np.std(times) / np.mean(times):.2f} (standard deviation {np.std(times):.1f} ms)",
            flush=True,
        )
    reach_deg = settings["cluster_ransac"]["reach_deg"]
    normals_ms = []
    for i, xyz_m in scans:
        around_m = sensor_frame.centre_on_sensor(xyz_m, survey.sensors[i])
        normals_ms.append(
            _milliseconds(lambda p=around_m: normals.cut_surface_cells(p, reach_deg=reach_deg))
        )
    ours_ms, theirs_ms = (np.mean(took_ms[name]) for name in ("cluster_ransac", "iterative_ransac"))
    print(
        f"walls, {building}, cluster against iterative RANSAC: {theirs_ms / ours_ms:.1f} times faster; normals are"
        f" {np.mean(normals_ms) / ours_ms:.0%} of it; {settings['cluster_ransac']['trials']} trials a cluster against"
        f" {settings['iterative_ransac']['trials']} a plane",
        flush=True,
    )


def _tell_literal(survey, scan, ours_ms, settings):
    few_m = sensor_frame.centre_on_sensor(scan[1], survey.sensors[scan[0]])[::_LITERAL_EVERY]
    limits = {key: settings[key] for key in _LITERAL_KEYS} | {"max_trials": settings["trials"]}
    literal_ms = _milliseconds(
        lambda: literal_clusters.lines(few_m, **limits, rng=np.random.default_rng(1))
    )
    print(
        f"walls, the literal method on every {_LITERAL_EVERY}th point of one scan: {literal_ms / 1e3:.1f} s,",
        end=" ",
    )
    print(f"{literal_ms / ours_ms:,.0f} times as long as ours on all of them", flush=True)


def quality(root, settings, every=3):
    """Compare the walls that both extractors and a line detector show with the truth."""
    walls = select_extractors(settings, METHODS)
    for building, (route, step_m) in _ROUTES.items():
        path = root / f"config/buildings/{building}.geojson"
        survey = wallscans.standing(
            path, settings["simulate"], route=route, step_m=step_m, every=every
        )
        found = {name: _lines(survey, name, walls) for name in METHODS}
        if importlib.util.find_spec("cv2"):
            found["raster and LSD"] = raster_lines(survey), np.zeros(0, int)
        else:
            print("walls, quality: no OpenCV (cv2) here, so without its line detector", flush=True)
        for name, (lines_m, scan) in found.items():
            scan = scan if len(scan) else np.zeros(len(lines_m), int)
            row = wallscans.quality(lines_m, scan, survey.truth)
            values = ", ".join(f"{key} {value:.3f}" for key, value in row.items())
            print(f"walls, {building}, {len(survey.scans)} scans, {name}: {values}", flush=True)


def raster_lines(survey):
    """Return the lines (n, 2, 2) that OpenCV's LSD finds on a raster of all points of a slice, 2 cm a pixel."""
    import cv2  # only where it is installed: no stage needs it

    points = np.concatenate([xyz for _, xyz in survey.scans]).astype(float)
    points = points[(points[:, 2] > _SLICE_M[0]) & (points[:, 2] < _SLICE_M[1]), :2]
    low_m = points.min(axis=0) - 1
    cell = np.floor((points - low_m) / _CELL_M).astype(int)
    image = np.zeros(cell.max(axis=0)[::-1] + 50, np.uint8)
    image[cell[:, 1], cell[:, 0]] = 255
    lines = cv2.createLineSegmentDetector().detect(image)[0]
    lines_m = lines.reshape(-1, 2, 2) * _CELL_M + low_m + _CELL_M / 2
    return lines_m[np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T) >= 0.4]


def _lines(survey, name, settings):
    method = METHODS[name]
    limits = method.settings(**settings[name])
    lines, scan = [np.empty((0, 2, 2))], [np.empty(0, int)]
    for i, xyz_m in survey.scans:
        found = method.extract(
            i, xyz_m, sensor_xyz_m=survey.sensors[i], planar=False, settings=limits
        )
        lines.append(np.stack([found.start_m, found.end_m], axis=1))
        scan.append(np.full(len(found), i))
    return np.concatenate(lines), np.concatenate(scan)


def _extract(survey, scans, settings):
    """Return each method's time (ms) of each scan."""
    took_ms = {name: [] for name in METHODS}
    for i, xyz_m in scans:
        for name, method in METHODS.items():
            keywords = {"sensor_xyz_m": survey.sensors[i], "planar": False}
            keywords["settings"] = method.settings(**settings[name])
            took_ms[name].append(
                _milliseconds(lambda m=method, s=i, p=xyz_m, k=keywords: m.extract(s, p, **k))
            )
    return took_ms


def _milliseconds(function):
    """Return the processor time of a call: both extractors run on one thread, whatever else the machine does."""
    started = time.process_time()
    function()
    return 1e3 * (time.process_time() - started)
