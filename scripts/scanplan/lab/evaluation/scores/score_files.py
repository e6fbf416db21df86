"""Scores of a dataset's results, of whatever commit made them: tables read without their versions.

What a plan of an older commit does not have is left out: confidence, questions, leaves.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.errors import StageError
from scanplan.lab.evaluation import pose_errors, truth_file
from scanplan.lab.evaluation.scores import (
    drawn_plan,
    hand_truth,
    plan_scores,
    raster_truth,
    room_scores,
    scene_file,
    sight,
    wall_scores,
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


@dataclass(frozen=True, eq=False)
class Placed:
    """A dataset's results beside their truth.

    Attributes
    ----------
    folder : Path
        results/<dataset>.
    scene : scene.Scene
    known_sight : sight.Sight
    motion : (4, 4) float64
        Level rigid motion from the map to the frame of the truth.
    """

    folder: Path
    scene: Scene
    known_sight: sight.Sight
    motion: FloatArray


def place_results(
    folder: FilePath,
    truth: FilePath | None = None,
    true_poses: FilePath | None = None,
    *,
    with_points: bool = False,
    max_range_m: float = _MAX_RANGE_M,
) -> Placed:
    """Place a simulated survey's results by the motion of its registered poses onto the true ones.

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
        If a truth cannot be read, or registration.parquet is missing.
    """
    home = Path(folder)
    truth = home / "survey/truth.geojson" if truth is None else truth
    true_poses = home / "survey/truth_poses.tum" if true_poses is None else true_poses
    track = truth_file.read_true_poses(true_poses)
    _, poses, t_ns = _read_kept(home)
    placed = truth_file.interpolate_true_poses(track, t_ns, true_poses)
    motion = pose_errors.fit_alignment(poses[:, :3, 3], placed[:, :3, 3])
    scene = scene_file.read_scene(truth, track.xyz_m[:, :2])
    view = truth_file.read_sensor_view(truth, max_range_m=max_range_m)
    points_m = transform_lines(_read_points(home), motion) if with_points else None
    survey = truth_file.true_pose_matrices(track)
    return Placed(home, scene, sight.observe_scene(scene, survey, view, points_m), motion)


def place_results_by_hand(folder: FilePath, truth: FilePath) -> Placed:
    """Place a recording's results on a truth drawn by hand, by the small motion that fits best.

    Raises
    ------
    StageError
        If the truth cannot be read, or a table of the plan is missing.
    """
    scene = hand_truth.read_hand_scene(truth)
    unmoved = drawn_plan.place_plan(read_plan(folder), np.eye(4))
    motion = hand_truth.fit_motion(unmoved.faces_m, scene)
    return Placed(Path(folder), scene, sight.see_all(scene), motion)


def place_results_by_raster(folder: FilePath, truth: FilePath) -> Placed:
    """Place a map's results by the motion of its registered scans onto where they were taken.

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
    motion = pose_errors.fit_alignment(poses[:, :3, 3], places_m)
    return Placed(Path(folder), scene, sight.see_all(scene), motion)


def score_results(placed: Placed) -> Score:
    """Score the plan of a dataset's results.

    Returns
    -------
    score.Score
        See `plan_scores.score_plan`; with `hand_doors_true` and `hand_doors_found` where the truth
        is a part of a floor, and always what the plan was moved by: `moved_x_m` and `moved_y_m` at
        the map's origin, `moved_deg`.

    Raises
    ------
    StageError
        If a table of the plan is missing.
    """
    drawn = read_plan(placed.folder)
    floor_z_m, ceiling_z_m = _read_levels(placed.folder)
    score = plan_scores.score_plan(
        drawn,
        placed.motion,
        placed.scene,
        placed.known_sight,
        confidence=read_columns(placed.folder / "plan/confidence.parquet"),
        height_m=ceiling_z_m - floor_z_m,
    )
    further = {
        "moved_x_m": float(placed.motion[0, 3]),
        "moved_y_m": float(placed.motion[1, 3]),
        "moved_deg": float(np.degrees(np.arctan2(placed.motion[1, 0], placed.motion[0, 0]))),
    }
    if not placed.scene.is_whole:
        plan = drawn_plan.place_plan(drawn, placed.motion)
        further |= hand_truth.measure_hand_doors(plan, placed.scene)
    return Score(score.measures | further, score.elements)


def score_peer_rooms(placed: Placed, rooms: Sequence[BaseGeometry]) -> Score:
    """Score rooms of another method, in the map of the results, as those of a plan."""
    wkb = np.array([*map(shapely.to_wkb, rooms)], object)
    moved = drawn_plan.move_shapes(wkb, placed.motion)
    return room_scores.score_rooms(moved, placed.scene)


def score_peer_lines(placed: Placed, lines_m: FloatArray) -> Score:
    """Score lines (n, 2, 2) of another method, in the map of the results, as faces of a plan."""
    moved_m = transform_lines(lines_m, placed.motion)
    return wall_scores.score_lines(moved_m, placed.scene, placed.known_sight)


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


def _read_points(home: Path) -> FloatArray:
    """Return where (k, 2) registered points lie in the map, those of floor and ceiling left out."""
    floor_z_m, _ = _read_levels(home)
    store = tables.ScanStore(home / "scans.parquet")
    parts = [np.empty((0, 2))]
    for _, xyz_m in store.scans():
        above_m = xyz_m[:, 2] - floor_z_m
        # without a floor all points count, as they do of planar scans
        in_band = ~((above_m < _BAND_M[0]) | (above_m > _BAND_M[1]))
        parts.append(xyz_m[in_band | store.planar, :2].astype(float))
    return np.concatenate(parts)
