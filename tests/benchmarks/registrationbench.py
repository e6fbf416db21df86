"""Registration of a drive with a real sensor's rate and density, against algorithm 3 written literally."""

import os
import resource
import time
from pathlib import Path

import simulating

import interpolate_poses
import register_scans
import simulate_survey
from reference import registration as literal
from scanplan.lab.evaluation import pose_errors, truth_file
from scanplan.project import stage_settings
from scanplan.recordings.motion import trajectory
from scanplan.recordings.survey import open_survey
from scanplan.registration import results
from scanplan.store import schemas, tables

N_LITERAL = 40
_TABLES = ("scans", "registration", "edges")
_KIB = 1024
_THREADS = 2


def drive(root, settings):
    """Simulate, unless it is there, a 10 Hz VLP-16 drive of six minutes through ring_office; return its folder.

    Parameters
    ----------
    root : pathlib.Path
        The project.
    settings : dict
        The whole configuration.
    """
    folder = root / "results/bench/registration"
    if not (folder / "poses.parquet").exists():
        rig = simulating.hallways(
            settings, speed_m_s=0.3, noise_m=0.05, noise_deg=1.0, jumps_per_min=1.0
        )
        truths = (
            folder / name for name in ("truth.geojson", "truth_poses.tum", "truth_trajectory.tum")
        )
        building = root / "config/buildings/ring_office.geojson"
        simulate_survey.simulate_survey(
            building, folder / "survey.bag", *truths, **rig, threads=_THREADS
        )
        reading = stage_settings.select_topics(settings)
        outputs = {"output": folder / "poses.parquet", "moved": folder / "motion.parquet"}
        interpolate_poses.interpolate_poses(
            [str(folder / "survey.bag")], **outputs, **settings["poses"], **reading
        )
    return folder


def bench(root, settings):
    """Print seconds of the stage and of algorithm 3, of a plain read of the recording, peak memory and accuracy."""
    folder = drive(root, settings)
    bag = folder / "survey.bag"
    read_s = _timed(lambda: _read(bag))[0]
    stage_s, stage_cpu_s = _timed(lambda: _register(folder, bag, settings))
    peak_mb = _peak_mb()
    literal_s, literal_cpu_s = _timed(_literal(folder, bag, settings))
    n = len(tables.read_table(folder / "poses.parquet", schemas.POSES, ["scan_id"])["scan_id"])
    ours_ms, theirs_ms = 1e3 * stage_s / n, 1e3 * literal_s / N_LITERAL
    cpu_ms, literal_cpu_ms = 1e3 * stage_cpu_s / n, 1e3 * literal_cpu_s / N_LITERAL
    print(
        f"registration, from bag to registered scans: {n} candidates, {ours_ms:.1f} ms each against {theirs_ms:.1f} ms"
        f" (mean of {N_LITERAL} from the middle): {theirs_ms / ours_ms:.1f} times faster\n"
        f"  by the processors' clocks {cpu_ms:.1f} ms against {literal_cpu_ms:.1f} ms:"
        f" {literal_cpu_ms / cpu_ms:.1f} times\n"
        f"  {stage_s:.1f} s in all; a plain read of the {bag.stat().st_size / 1e9:.1f} GB takes {read_s:.1f} s;"
        f" peak memory {peak_mb:.0f} MB\n  {_accuracy(folder)}",
        flush=True,
    )


def _register(folder, bag, settings):
    outputs = (folder / f"{name}.parquet" for name in _TABLES)
    keywords = {
        "reading": settings["input"],
        "settings": stage_settings.select_section(settings, "registration"),
        "moved": folder / "motion.parquet",
    }
    register_scans.register_scans(
        [str(bag)], folder / "poses.parquet", *outputs, **keywords, threads=_THREADS
    )


def _literal(folder, bag, settings):
    """Algorithm 3 on some candidates from the middle, of which the points are read beforehand."""
    candidates = tables.read_table(folder / "poses.parquet", schemas.POSES)
    middle = len(candidates["scan_id"]) // 2
    some = slice(middle, middle + N_LITERAL)
    way = trajectory.motion_from_columns(
        tables.read_table(folder / "motion.parquet", schemas.MOTION)
    )
    with open_survey([str(bag)], **settings["input"], motion=way) as survey:
        scans = [scan.xyz_m for scan in survey.scans(candidates["scan_id"][some].tolist())]
    limits = {
        key: settings["registration"][key] for key in ("min_prior_fitness", "min_refined_fitness")
    }
    distance_m = settings["registration"]["fitness_distance_m"]
    poses = results.pose_matrices(candidates)[some]
    return lambda: literal.register(scans, poses, keep_every=1, distance_m=distance_m, **limits)


def _accuracy(folder):
    found = tables.read_table(folder / "registration.parquet", schemas.REGISTRATION)
    kept = found["kept"]
    truth = truth_file.interpolate_true_poses(
        truth_file.read_true_poses(folder / "truth_poses.tum"),
        found["t_ns"][kept],
        folder / "truth_poses.tum",
    )
    told = []
    for name, columns in (
        ("localiser", tables.read_table(folder / "poses.parquet", schemas.POSES)),
        ("registered", found),
    ):
        pose = results.pose_matrices(columns)[kept]
        pose = pose_errors.fit_alignment(pose[:, :3, 3], truth[:, :3, 3]) @ pose
        distance_m, angle_deg = (sorted(error) for error in pose_errors.pose_errors(pose, truth))
        middle, high = len(pose) // 2, int(0.95 * len(pose))
        told.append(
            f"{name} {1e3 * distance_m[middle]:.1f} mm and {angle_deg[middle]:.2f} deg in the median,"
            f" 95 % within {1e3 * distance_m[high]:.1f} mm"
        )
    return f"{kept.sum()} kept; off the truth: {'; '.join(told)}"


def _read(path):
    with Path(path).open("rb") as file:
        while file.read(1 << 24):
            pass


def _timed(function):
    """Seconds by the clock, and those of processors: of this process and its workers."""
    started, before = time.perf_counter(), os.times()
    function()
    after = os.times()
    return time.perf_counter() - started, sum(after[:4]) - sum(before[:4])


def _peak_mb():
    """The most that this process and its workers have held: an upper bound, as if all had held it at once."""
    own, worker = (
        resource.getrusage(who).ru_maxrss
        for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    )
    return (own + _THREADS * worker) / _KIB
