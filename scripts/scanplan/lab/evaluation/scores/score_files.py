"""Scores of a dataset's results, of whatever commit made them: tables read without their versions.

What a plan of an older commit does not have is left out: confidence, questions, leaves.
"""

from pathlib import Path

import numpy as np
import pandas as pd

from scanplan.errors import StageError
from scanplan.lab.evaluation import pose_errors, truth_file
from scanplan.lab.evaluation.scores import (
    drawn_plan,
    hand_truth,
    plan_scores,
    raster_truth,
    scene_file,
    sight,
)
from scanplan.lab.evaluation.scores.scene import Scene
from scanplan.lab.evaluation.scores.score import Score, transform_lines
from scanplan.store import schemas, tables
from scanplan.store.pose_columns import pose_matrices
from scanplan.types import Array, FilePath, FloatArray, IntArray

_NEEDED = ("faces", "walls", "openings", "rooms", "furniture")
_WANTED = ("leaves", "questions")
_MAX_RANGE_M = 100.0  # input.max_range_m; a sensor of a simulated survey states its own
_BAND_M = (0.2, 2.0)  # above the floor and below any ceiling: what lies there is no floor


def score_results(
    folder: FilePath,
    truth: FilePath | None = None,
    true_poses: FilePath | None = None,
    *,
    with_points: bool = False,
    max_range_m: float = _MAX_RANGE_M,
) -> Score:
    """Score the plan of a simulated survey after one rigid motion onto its truth.

    Parameters
    ----------
    folder : path-like
        results/<dataset>, with plan/ and registration.parquet.
    truth, true_poses : path-like, optional
        By default survey/truth.geojson and survey/truth_poses.tum in it.
    with_points : bool
        Whether completeness, leaves and columns are judged of what points of registered scans lie
        on, too; it reads scans.parquet.
    max_range_m : float
        How far points are used.

    Raises
    ------
    StageError
        If a truth cannot be read, or a table of the plan is missing.
    """
    home = Path(folder)
    truth = home / "survey/truth.geojson" if truth is None else truth
    true_poses = home / "survey/truth_poses.tum" if true_poses is None else true_poses
    track = truth_file.read_true_poses(true_poses)
    motion = fit_results(home, track, true_poses)
    scene = scene_file.read_scene(truth, track.xyz_m[:, :2])
    view = truth_file.read_sensor_view(truth, max_range_m=max_range_m)
    floor_z_m, ceiling_z_m = _read_levels(home)
    points_m = None
    if with_points:
        points_m = transform_lines(_read_points(home, floor_z_m), motion)
    seen = sight.observe_scene(scene, truth_file.true_pose_matrices(track), view, points_m)
    return plan_scores.score_plan(
        read_plan(home),
        motion,
        scene,
        seen,
        confidence=read_columns(home / "plan/confidence.parquet"),
        height_m=ceiling_z_m - floor_z_m,
    )


def score_results_by_hand(folder: FilePath, truth: FilePath) -> Score:
    """Score the plan of a real recording by a truth.geojson drawn by hand (see `hand_truth`).

    It is moved by the small rigid motion that fits best.
    """
    scene = hand_truth.read_hand_scene(truth)
    unmoved = drawn_plan.place_plan(read_plan(folder), np.eye(4))
    return _score_part(Path(folder), scene, hand_truth.fit_motion(unmoved.faces_m, scene))


def score_results_by_raster(folder: FilePath, truth: FilePath) -> Score:
    """Score the rooms of a plan by a truth.npz of labels (see `raster_truth`).

    It is moved by the rigid motion of its registered scans onto where they were truly taken.

    Raises
    ------
    StageError
        If registration.parquet is missing, or names scans that the truth has not.
    """
    scene = raster_truth.read_raster_scene(truth)
    scan_ids, poses, _ = _read_kept(Path(folder))
    if scan_ids.max(initial=-1) >= len(scene.track_m):
        raise StageError(
            f"{truth}: has {len(scene.track_m)} places, scan {scan_ids.max()} of {folder} is"
            " another; give the truth of this very recording"
        )
    places_m = np.column_stack([scene.track_m[scan_ids], poses[:, 2, 3]])
    return _score_part(Path(folder), scene, pose_errors.fit_alignment(poses[:, :3, 3], places_m))


def _score_part(home: Path, scene: Scene, motion: FloatArray) -> Score:
    drawn = read_plan(home)
    confidence = read_columns(home / "plan/confidence.parquet")
    floor_z_m, ceiling_z_m = _read_levels(home)
    score = plan_scores.score_plan(
        drawn, motion, scene, confidence=confidence, height_m=ceiling_z_m - floor_z_m
    )
    plan = drawn_plan.place_plan(drawn, motion)
    moved = {
        "moved_x_m": float(motion[0, 3]),
        "moved_y_m": float(motion[1, 3]),
        "moved_deg": float(np.degrees(np.arctan2(motion[1, 0], motion[0, 0]))),
    }
    doors = hand_truth.measure_hand_doors(plan, scene)
    return Score(score.measures | doors | moved, score.elements)


def read_plan(folder: FilePath) -> dict[str, dict[str, Array]]:
    """Return the tables of a plan below a folder of results by name, those that are there.

    Raises
    ------
    StageError
        If faces, walls, openings, rooms or furniture is missing.
    """
    read = {}
    for name in (*_NEEDED, *_WANTED):
        columns = read_columns(Path(folder) / f"plan/{name}.parquet")
        if columns is None and name in _NEEDED:
            raise StageError(f"{folder}/plan/{name}.parquet: is missing; make the plan first")
        if columns is not None:
            read[name] = columns
    return read


def read_columns(path: FilePath) -> dict[str, Array] | None:
    """Return the columns of a Parquet file of whatever version, None where there is no file."""
    if not Path(path).exists():
        return None
    frame = pd.read_parquet(path)
    return {name: frame[name].to_numpy() for name in frame.columns}


def fit_results(folder: FilePath, track: truth_file.TruePoses, origin: FilePath) -> FloatArray:
    """Return the level rigid motion (4, 4) of a dataset's registered poses onto the true ones.

    Raises
    ------
    StageError
        If registration.parquet is missing, or the true poses are of another survey.
    """
    _, poses, t_ns = _read_kept(Path(folder))
    placed = truth_file.interpolate_true_poses(track, t_ns, origin)
    return pose_errors.fit_alignment(poses[:, :3, 3], placed[:, :3, 3])


def _read_kept(home: Path) -> tuple[IntArray, FloatArray, IntArray]:
    """Return ids (n,), map_from_sensor (n, 4, 4) and stamps (n,) of registered scans."""
    path = home / "registration.parquet"
    columns = read_columns(path)
    if columns is None:
        raise StageError(f"{path}: is missing; make the plan first")
    kept = np.asarray(columns["kept"], bool)
    rows = {name: np.asarray(values)[kept] for name, values in columns.items()}
    return rows["scan_id"], pose_matrices(rows), rows["t_ns"]


def _read_levels(home: Path) -> tuple[float, float]:
    """Return the heights of floor and ceiling in the map, NaN where not known or not readable."""
    try:
        notes = tables.read_notes(home / "plan/free.parquet", schemas.FREE)
    except StageError:
        return np.nan, np.nan
    floor_z_m, ceiling_z_m = (
        float(notes.get(name) or "nan") for name in ("floor_z_m", "ceiling_z_m")
    )
    return floor_z_m, ceiling_z_m


def _read_points(home: Path, floor_z_m: float) -> FloatArray:
    """Return where (k, 2) registered points lie in the map, those of floor and ceiling left out."""
    store = tables.ScanStore(home / "scans.parquet")
    parts = [np.empty((0, 2))]
    for _, xyz_m in store.scans():
        above_m = xyz_m[:, 2] - floor_z_m
        # without a floor all points count, as they do of planar scans
        in_band = ~((above_m < _BAND_M[0]) | (above_m > _BAND_M[1]))
        parts.append(xyz_m[in_band | store.planar, :2].astype(float))
    return np.concatenate(parts)
