"""Registration of a drive at a real sensor's rate and density, against algorithm 3 as written."""

import os
import resource
import time
from collections.abc import Callable
from pathlib import Path

import simulation_bench

import interpolate_poses
import register_scans
import simulate_survey
from reference import registration as literal
from scanplan.lab.evaluation import pose_errors, truth_file
from scanplan.project import stage_settings
from scanplan.recordings.motion import trajectory
from scanplan.recordings.survey import Reading, open_survey
from scanplan.store import pose_columns, schemas, tables
from scanplan.types import Columns, Settings

N_LITERAL = 40  # candidates: each takes the literal algorithm a second or two
_SPEED_M_S = 0.3  # six minutes for the hallways
_LOCALISER = {"noise_m": 0.05, "noise_deg": 1.0, "jumps_per_min": 1.0}
_TABLES = ("scans", "registration", "edges")
_KIB = 1024  # bytes, the unit of ru_maxrss
_THREADS = 2  # the cores that the measured figures are stated for
_READ_BYTES = 1 << 24  # large enough that reading costs no processor time
_HIGH_SHARE = 0.95  # of the poses are no worse


def simulate_drive(root: Path, settings: Settings) -> Path:
    """Simulate a 10 Hz drive of six minutes through ring_office, unless it is there.

    Parameters
    ----------
    root : pathlib.Path
        The project.
    settings : dict
        The whole configuration.

    Returns
    -------
    pathlib.Path
        Its folder.
    """
    folder = root / "results/bench/registration"
    if not (folder / "poses.parquet").exists():
        rig = simulation_bench.hallway_rig(settings, speed_m_s=_SPEED_M_S, **_LOCALISER)
        names = ("survey.bag", "truth.geojson", "truth_poses.tum", "truth_trajectory.tum")
        files = [folder / name for name in names]
        building = root / "config/buildings/ring_office.geojson"
        simulate_survey.simulate_survey(building, *files, **rig, threads=_THREADS)
        reading = stage_settings.select_topics(settings)
        outputs = {"output": folder / "poses.parquet", "moved": folder / "motion.parquet"}
        interpolate_poses.interpolate_poses(
            [str(folder / "survey.bag")], **outputs, **settings["poses"], **reading
        )
    return folder


def bench(root: Path, settings: Settings) -> None:
    """Print seconds of the stage, of algorithm 3 and of a plain read, peak memory and accuracy."""
    folder = simulate_drive(root, settings)
    bag = folder / "survey.bag"
    read_s, _ = _seconds(lambda: _read(bag))
    stage_s, stage_cpu_s = _seconds(lambda: _register(folder, bag, settings))
    peak_mb = _peak_mb()
    literal_s, literal_cpu_s = _seconds(_literal(folder, bag, settings))
    n = len(tables.read_table(folder / "poses.parquet", schemas.POSES, ["scan_id"])["scan_id"])
    ours_ms = 1e3 * stage_s / n
    theirs_ms = 1e3 * literal_s / N_LITERAL
    cpu_ms = 1e3 * stage_cpu_s / n
    literal_cpu_ms = 1e3 * literal_cpu_s / N_LITERAL
    print(
        f"registration, from bag to registered scans: {n} candidates, {ours_ms:.1f} ms each"
        f" against {theirs_ms:.1f} ms (mean of {N_LITERAL} from the middle):"
        f" {theirs_ms / ours_ms:.1f} times faster\n"
        f"  by the processors' clocks {cpu_ms:.1f} ms against {literal_cpu_ms:.1f} ms:"
        f" {literal_cpu_ms / cpu_ms:.1f} times\n"
        f"  {stage_s:.1f} s in all; a plain read of the {bag.stat().st_size / 1e9:.1f} GB takes"
        f" {read_s:.1f} s; peak memory {peak_mb:.0f} MB\n  {_accuracy(folder)}",
        flush=True,
    )


def _register(folder: Path, bag: Path, settings: Settings) -> None:
    outputs = (folder / f"{name}.parquet" for name in _TABLES)
    keywords = {
        "reading": settings["input"],
        "settings": stage_settings.select_section(settings, "registration"),
        "moved": folder / "motion.parquet",
    }
    register_scans.register_scans(
        [str(bag)], folder / "poses.parquet", *outputs, **keywords, threads=_THREADS
    )


def _literal(folder: Path, bag: Path, settings: Settings) -> Callable[[], object]:
    """Return algorithm 3 on candidates from the middle, whose points are read beforehand."""
    candidates = tables.read_table(folder / "poses.parquet", schemas.POSES)
    middle = len(candidates["scan_id"]) // 2
    some = slice(middle, middle + N_LITERAL)
    motion = trajectory.motion_from_columns(
        tables.read_table(folder / "motion.parquet", schemas.MOTION)
    )
    with open_survey([str(bag)], Reading(**settings["input"]), motion=motion) as survey:
        scans = [scan.xyz_m for scan in survey.scans(candidates["scan_id"][some].tolist())]
    names = ("min_prior_fitness", "min_refined_fitness")
    limits = {name: settings["registration"][name] for name in names}
    distance_m = settings["registration"]["fitness_distance_m"]
    poses = pose_columns.pose_matrices(candidates)[some]
    return lambda: literal.register(scans, poses, keep_every=1, distance_m=distance_m, **limits)


def _accuracy(folder: Path) -> str:
    registered = tables.read_table(folder / "registration.parquet", schemas.REGISTRATION)
    localiser = tables.read_table(folder / "poses.parquet", schemas.POSES)
    sentences = [
        _pose_accuracy("localiser", localiser, registered, folder),
        _pose_accuracy("registered", registered, registered, folder),
    ]
    return f"{registered['kept'].sum()} kept; off the truth: {'; '.join(sentences)}"


def _pose_accuracy(name: str, columns: Columns, registered: Columns, folder: Path) -> str:
    kept = registered["kept"]
    file = folder / "truth_poses.tum"
    true_poses = truth_file.read_true_poses(file)
    truth = truth_file.interpolate_true_poses(true_poses, registered["t_ns"][kept], file)
    poses = pose_columns.pose_matrices(columns)[kept]
    aligned = pose_errors.fit_alignment(poses[:, :3, 3], truth[:, :3, 3]) @ poses
    distance_m, angle_deg = (sorted(error) for error in pose_errors.pose_errors(aligned, truth))
    middle = len(poses) // 2
    high = int(_HIGH_SHARE * len(poses))
    return (
        f"{name} {1e3 * distance_m[middle]:.1f} mm and {angle_deg[middle]:.2f} deg in the median,"
        f" {_HIGH_SHARE:.0%} within {1e3 * distance_m[high]:.1f} mm"
    )


def _read(path: Path) -> None:
    with path.open("rb") as file:
        while file.read(_READ_BYTES):
            pass


def _seconds(function: Callable[[], object]) -> tuple[float, float]:
    """Return seconds by the clock, and those of processors, of this process and its workers."""
    started = time.perf_counter()
    before = os.times()
    function()
    after = os.times()
    return time.perf_counter() - started, sum(after[:4]) - sum(before[:4])


def _peak_mb() -> float:
    """Return an upper bound of what this process and its workers held at once."""
    own = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    worker = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    return (own + _THREADS * worker) / _KIB
