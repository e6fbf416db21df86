"""Drives with odometry alone: recorded, registered, and how far their scans are off the truth."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

import interpolate_poses
import register_scans
import simulate_survey
from helpers.default_settings import SETTINGS
from scanplan.geometry import se3
from scanplan.lab.evaluation import pose_errors, truth_file
from scanplan.lab.simulation import survey_bag
from scanplan.project import stage_settings
from scanplan.project.settings import merge_settings
from scanplan.store import doubts, pose_columns, schemas, tables
from scanplan.types import BoolArray, FloatArray, IntArray, Settings

ODOMETRY: Settings = {"scale_share": 0.01, "drift_deg_per_m": 0.05}
"""What wheels err by: 1 % of the way and of turns, drawn by the seed, and 5 degrees in 100 m."""
SENSORS: dict[str, Settings] = {
    "3d": {"model": "vlp16", "n_azimuth": 450, "rate_hz": 2.0, "sweep": False},
    "2d": {
        **{"model": "laser", "n_azimuth": 541, "field_deg": 270.0},
        **{"rate_hz": 4.0, "max_range_m": 20.0},
    },
}
"""Fewer beams and turns a second than real ones have: what drifts is between scans, not in one."""
SPEED_M_S = 1.0


class Placed(NamedTuple):
    """A drive as registration placed it: stamps, poses, which were kept, and what it doubts."""

    t_ns: IntArray
    world_from_sensor: FloatArray
    recorded: FloatArray
    kept: BoolArray
    told: Sequence[str]


def record_drives(
    building: Path,
    folder: Path,
    ways_m: Sequence[Sequence[Sequence[float]]],
    *,
    sensor: str,
    seed: int = 1,
    odometry: Settings = ODOMETRY,
) -> list[str]:
    """Record drives, each a second after the one before, whose odometry begins at zero again.

    Those that lie there already are kept.

    Returns
    -------
    list of str
        The recordings; the true poses of all lie beside them in `truth_poses.tum`.
    """
    folder.mkdir(parents=True, exist_ok=True)
    truth = folder / "truth_poses.tum"
    bags = [folder / f"{number}.bag" for number in range(len(ways_m))]
    recordings = [str(bag) for bag in bags]
    if truth.exists():
        return recordings
    poses = []
    start_ns = survey_bag.EPOCH_NS
    for bag, way_m in zip(bags, ways_m, strict=True):
        changes = {
            "seed": seed,
            "site": {"route": "given", "waypoints_m": np.round(way_m, 4).tolist()},
            "sensor": SENSORS[sensor],
            "drive": {"speed_m_s": SPEED_M_S},
            "odometry": odometry,
            "localiser": {"present": False},
        }
        settings = merge_settings(SETTINGS, {"simulate": changes})
        files = [folder / name for name in ("truth.geojson", "own_poses.tum", "own_way.tum")]
        given = stage_settings.select_simulation(settings)
        simulate_survey.simulate_survey(building, bag, *files, **given, start_ns=start_ns)
        rows = files[1].read_text().splitlines(keepends=True)
        poses += rows
        start_ns = round(float(rows[-1].split()[0])) * 10**9 + 10**9
    truth.write_text("".join(poses))
    return recordings


def register_drive(recordings: Sequence[str], folder: Path, **settings: Settings) -> Placed:
    """Register recordings with the default settings, but for some sections of them."""
    folder.mkdir(parents=True, exist_ok=True)
    known = merge_settings(SETTINGS, settings)
    reading = stage_settings.select_topics(known)
    file = {name: folder / f"{name}.parquet" for name in ("poses", "motion", "scans", "edges")}
    registered = folder / "registration.parquet"
    interpolate_poses.interpolate_poses(
        recordings,
        file["poses"],
        moved=file["motion"],
        **stage_settings.select_section(known, "poses"),
        **reading,
    )
    register_scans.register_scans(
        recordings,
        file["poses"],
        file["scans"],
        registered,
        file["edges"],
        reading=stage_settings.select_section(known, "input"),
        settings=stage_settings.select_section(known, "registration"),
        moved=file["motion"],
    )
    columns = tables.read_table(registered, schemas.REGISTRATION)
    return Placed(
        columns["t_ns"],
        pose_columns.pose_matrices(columns),
        pose_columns.pose_matrices(tables.read_table(file["poses"], schemas.POSES)),
        columns["kept"],
        doubts.read_doubts(registered, schemas.REGISTRATION).contradictions,
    )


def errors_m(
    t_ns: IntArray, world_from_sensor: FloatArray, truth: Path, *, max_gap_s: float = 0.0
) -> FloatArray:
    """Return how far poses are off the true ones, at whose stamps, after one rigid motion.

    Between two poses no farther apart in time than `max_gap_s` they are interpolated.
    """
    known = truth_file.read_true_poses(truth)
    parts = se3.split_pose(world_from_sensor)
    xyz_m, _, _, covered = se3.interpolate_poses(t_ns, *parts, known.t_ns, max_gap_s=max_gap_s)
    found_m, true_m = xyz_m[covered], known.xyz_m[covered]
    motion = pose_errors.fit_alignment(found_m, true_m)
    return np.linalg.norm(se3.transform_points(motion, found_m) - true_m, axis=1)
