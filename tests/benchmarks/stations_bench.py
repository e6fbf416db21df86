"""What stations of a terrestrial scanner take and give: read one by one, planned, and merged.

An E57 file of many stations of some millions of points is read by processes of their own, which
say what they took of the processor and of memory. Fewer points of an office, as stations and as a
merged cloud, are planned and scored by what is true of it.
"""

import json
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from pipeline_bench import read_stages

from helpers import e57_making, las_making
from scanplan.geometry import se3
from scanplan.lab.buildings import truth
from scanplan.lab.buildings.building import Building
from scanplan.lab.evaluation import truth_file
from scanplan.lab.evaluation.scores import scene_file, score_files, sight
from scanplan.lab.evaluation.visible_faces import SensorView
from scanplan.lab.simulation import raycast, survey_setup, survey_truth
from scanplan.lab.simulation.rover import planar_poses
from scanplan.store.tum import format_tum
from scanplan.types import FloatArray, Settings

_ELEVATION_DEG = (-60.0, 90.0)  # the tripod hides what is below
_HEIGHT_M = 1.6  # of the scanner
_NOISE_M = 0.002  # of a range, as data sheets state it
_COLUMNS_AT_ONCE = 100
_VIEW = SensorView(100.0)
_SEED = 1
_MEASURES = (
    *("wall_completeness_010", "wall_correctness_010", "thickness_error_m"),
    *("doors_driven_true", "doors_driven_found", "doors_seen_true", "doors_seen_found"),
    *("doors_drawn", "door_precision"),
    *("windows_true", "windows_found", "windows_drawn", "window_precision"),
    *("rooms_true", "rooms_above_08", "rooms_drawn"),
)
# getrusage's peak of memory is that of the process that began this one, where that had more
_READ = """
import resource, sys
from pathlib import Path
from scanplan.recordings.survey import Reading, open_survey
with open_survey([sys.argv[1]], Reading()) as survey:
    n_points = sum(len(scan.xyz_m) for scan in survey.scans(range(int(sys.argv[2]))))
took = resource.getrusage(resource.RUSAGE_SELF)
peak_kb = Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0]
print(n_points, took.ru_utime + took.ru_stime, int(peak_kb) / 1024)
"""


def bench(project: Path, settings: Settings, folder: Path, counts: Sequence[int]) -> None:
    """Print tables of reading, and of plans of an office.

    Parameters
    ----------
    project : pathlib.Path
    settings : dict
        The whole configuration.
    folder : pathlib.Path
        For the files, kept, 2.5 GB, and the results, made anew.
    counts : sequence of int
        Numbers of stations to read of the large file, which has the most of them.
    """
    folder.mkdir(parents=True, exist_ok=True)
    ring = _load_building(project, settings, "ring_office")
    large = folder / f"ring_{max(counts)}.e57"
    if not large.exists():
        poses = _place_stations(ring, max(counts))
        e57_making.write_e57(large, poses, _scan(ring, poses, step_deg=360 / 3528))
    _print_reading(large, counts)
    office = _load_building(project, settings, "demo_office")
    poses = _place_stations(office, 14)
    _write_office(folder, office, poses)
    for name in ("office_stations.e57", "office_merged.laz"):
        _plan(project, folder, folder / name)
        _print_plan(folder, folder / "results" / Path(name).stem)


def _load_building(project: Path, settings: Settings, name: str) -> Building:
    source = project / f"config/buildings/{name}.geojson"
    simulate = settings["simulate"]
    scene = {
        "mount": {**simulate["mount"], "height_m": _HEIGHT_M},
        "site": {**simulate["site"], "route": "rooms", "start_m": "random"},
    }
    return survey_setup.prepare_site(source.read_bytes(), source, scene, seed=_SEED)


def _place_stations(site: Building, n: int) -> FloatArray:
    """Return poses (n, 4, 4) evenly along the way through all rooms, turned at random."""
    way_m = np.asarray(site.waypoints_m)
    along_m = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(way_m, axis=0), axis=1))])
    at_m = (np.arange(n) + 0.5) * along_m[-1] / n
    xy_m = np.column_stack([np.interp(at_m, along_m, axis) for axis in way_m.T])
    yaw_rad = np.random.default_rng(_SEED).uniform(0, 2 * np.pi, n)
    return planar_poses(xy_m, yaw_rad, _HEIGHT_M)


def _scan(site: Building, poses: FloatArray, *, step_deg: float) -> Iterator[FloatArray]:
    """Yield what each station sees (n, 3) in its own frame; NaN where nothing came back."""
    scene = raycast.RayScene(site.mesh)
    azimuth = np.radians(np.arange(0, 360, step_deg))
    elevation = np.radians(np.arange(*_ELEVATION_DEG, step_deg))
    for number, pose in enumerate(poses):
        rng = np.random.default_rng([_SEED, number])
        parts = []
        for begin in range(0, len(azimuth), _COLUMNS_AT_ONCE):
            around, up = np.meshgrid(
                azimuth[begin : begin + _COLUMNS_AT_ONCE], elevation, indexing="ij"
            )
            level = np.cos(up)
            beams = np.stack([level * np.cos(around), level * np.sin(around), np.sin(up)], axis=-1)
            origin_m = np.broadcast_to(pose[:3, 3], (len(beams), 3))
            turned = (beams @ pose[:3, :3].T).astype(np.float32)
            range_m = scene.opaque_hits(origin_m, turned).range_m.astype(float)
            range_m = np.where(range_m < _VIEW.max_range_m, range_m, np.nan)
            range_m += rng.normal(0, _NOISE_M, len(range_m))
            parts.append(beams.reshape(-1, 3) * range_m[:, None])
        yield np.concatenate(parts)


def _write_office(folder: Path, office: Building, poses: FloatArray) -> None:
    """Write the office as stations, as a cloud, and what is true of it, each but once."""
    features = survey_truth.mark_visible(office.truth, poses, _VIEW)
    sensor = {"max_range_m": _VIEW.max_range_m, "field_deg": 360.0}
    (folder / "truth.geojson").write_text(truth.format_features(features, sensor=sensor))
    stamps = (np.arange(len(poses)) + 1) * 10**9
    (folder / "truth_poses.tum").write_text(format_tum(stamps, poses))
    if (folder / "office_stations.e57").exists():
        return
    seen = list(_scan(office, poses, step_deg=360 / 1932))
    e57_making.write_e57(folder / "office_stations.e57", poses, seen)
    xyz_m = np.concatenate(
        [se3.transform_points(pose, own) for pose, own in zip(poses, seen, strict=True)]
    )
    xyz_m = xyz_m[np.isfinite(xyz_m).all(axis=1)]
    las_making.write_las(folder / "office_merged.laz", xyz_m, np.zeros(len(xyz_m)))


def _print_reading(path: Path, counts: Sequence[int]) -> None:
    print("| stations read | points kept | processor s | peak MB |\n|---|---|---|---|")
    for n in (0, *counts):
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
        said = subprocess.run(
            [sys.executable, "-c", _READ, str(path), str(n)],
            env=environment,
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        n_points, processor_s, peak_mb = map(float, said.split()[-3:])
        print(f"| {n} | {n_points:,.0f} | {processor_s:.1f} | {peak_mb:.0f} |", flush=True)


def _plan(project: Path, folder: Path, path: Path) -> None:
    command = [sys.executable, "-m", "snakemake", "-s", str(project / "Snakefile"), "--cores", "2"]
    command += ["--forceall", "--config", f"dataset={json.dumps([str(path)])}"]
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    subprocess.run(command, cwd=folder, env=environment, check=True)


def _print_plan(folder: Path, results: Path) -> None:
    """Print what a plan scores; nothing moves it, as its map is that of the truth."""
    track = truth_file.read_true_poses(folder / "truth_poses.tum")
    scene = scene_file.read_scene(folder / "truth.geojson", track.xyz_m[:, :2])
    seen = sight.observe_scene(scene, truth_file.true_pose_matrices(track), _VIEW, None)
    score = score_files.score_results(score_files.Placed(results, scene, seen, np.eye(4)))
    found = [f"{name} {score.measures[name]:.3g}" for name in _MEASURES]
    print(f"{results.name}: {', '.join(found)}")
    for stage in read_stages(folder / "benchmarks" / results.name):
        print(f"  {stage.name}: {stage.processor_s:.1f} s, {stage.peak_mb:.0f} MB")
