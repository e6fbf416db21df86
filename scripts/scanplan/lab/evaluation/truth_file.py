"""Reading what a survey ought to find: true wall faces (GeoJSON) and true sensor poses (TUM)."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.geometry.lines import line_lengths_m
from scanplan.geometry.tolerances import ROUNDING
from scanplan.lab.evaluation.visible_faces import SensorView
from scanplan.store import tum
from scanplan.types import FilePath, FloatArray, IntArray

_REMEDY = "simulate the survey again, or mend it"
_MAX_GAP_S = 1.0  # true poses come tens a second: a longer gap means another survey


@dataclass(frozen=True)
class TrueFaces:
    """The straight stretches of wall surface of a floor, at the height of the sensor.

    Attributes
    ----------
    inner_m : (n, 2, 2) float64
        Start and end of the faces that can matter: those to be found.
    outer_m : (m, 2, 2) float64
        What occludes walls and is none to be found: faces that can only be seen from outside the
        building, and screens (closed doors, tall furniture).
    """

    inner_m: FloatArray
    outer_m: FloatArray


@dataclass(frozen=True)
class TruePoses:
    """Where the sensor truly was.

    Attributes
    ----------
    t_ns : (n,) int64, strictly increasing
    xyz_m : (n, 3) float64
    quat_xyzw : (n, 4) float64
    """

    t_ns: IntArray
    xyz_m: FloatArray
    quat_xyzw: FloatArray


def read_true_faces(path: FilePath) -> TrueFaces:
    """Read the features of kind `face` and `screen` of a truth.geojson.

    A face without `side` is an inner one.

    Raises
    ------
    StageError
        If it is no GeoJSON, a face is no line of finite coordinates, or there is no inner face.
    """
    none = np.empty((0, 2, 2))
    lines_m: dict[str, list[FloatArray]] = {"inside": [none], "outside": [none]}
    for number, feature in enumerate(parse_features(path)):
        properties = feature_member(feature, "properties")
        if properties.get("kind") not in ("face", "screen"):
            continue
        side = "outside" if properties["kind"] == "screen" else properties.get("side", "inside")
        if side not in lines_m:
            raise StageError(
                f"{path}: feature {number} has side {side!r}, inside or outside needed; {_REMEDY}"
            )
        lines_m[side].append(_runs(path, number, feature_member(feature, "geometry")))
    faces = TrueFaces(np.concatenate(lines_m["inside"]), np.concatenate(lines_m["outside"]))
    if len(faces.inner_m) == 0:
        raise StageError(f"{path}: holds 0 inner faces (kind: face), at least 1 needed; {_REMEDY}")
    return faces


def read_sensor_view(path: FilePath, *, max_range_m: float) -> SensorView:
    """Return how far and how far around a scan of a survey can see.

    Parameters
    ----------
    path : path-like
        truth.geojson; its member `sensor` may state `max_range_m` and `field_deg`, as a simulated
        survey's does.
    max_range_m : float
        Points farther away are not used, however far the sensor sees.

    Raises
    ------
    StageError
        If it is no GeoJSON, or states no positive numbers.
    """
    sensor = feature_member(_read_collection(path), "sensor")
    numbers = [sensor.get("max_range_m", max_range_m), sensor.get("field_deg", 360.0)]
    if not all(isinstance(n, int | float) and n > 0 for n in numbers):
        raise StageError(
            f"{path}: its sensor has max_range_m, field_deg {numbers}, positive needed; {_REMEDY}"
        )
    return SensorView(min(numbers[0], max_range_m), np.radians(min(numbers[1], 360.0)))


def read_true_poses(path: FilePath) -> TruePoses:
    """Read true poses from a file of TUM's form.

    Raises
    ------
    StageError
        If there is no pose, a number is not finite, a quaternion is zero, or the stamps do not
        increase.
    """
    try:
        t_ns, rows = tum.read_tum(path)
    except OSError as error:
        raise StageError(f"{path}: cannot be read ({error.strerror}); {_REMEDY}") from None
    if len(t_ns) == 0:
        raise StageError(f"{path}: holds 0 poses, at least 1 needed; {_REMEDY}")
    has_direction = rows[:, 3:].any(axis=1)
    n_wrong = np.count_nonzero(~(np.isfinite(rows).all(axis=1) & has_direction))
    if n_wrong:
        raise StageError(
            f"{path}: {n_wrong} poses are not finite or have no direction, 0 allowed; {_REMEDY}"
        )
    falls = np.diff(t_ns) <= 0
    if falls.any():
        raise StageError(
            f"{path}: stamps do not increase after pose {np.argmax(falls)}; sort the lines"
        )
    return TruePoses(t_ns, rows[:, :3], rows[:, 3:])


def true_pose_matrices(poses: TruePoses) -> FloatArray:
    """Return TruePoses as world_from_sensor (n, 4, 4)."""
    return se3.pose_matrix(poses.xyz_m, poses.quat_xyzw)


def interpolate_true_poses(poses: TruePoses, t_ns: IntArray, path: FilePath) -> FloatArray:
    """Return world_from_sensor (n, 4, 4) at the stamps of scans, interpolated between true poses.

    Parameters
    ----------
    t_ns : (n,) int64
    path : path-like
        What an error names as the origin of the poses.

    Raises
    ------
    StageError
        If a stamp lies outside the true poses or in a gap of more than a second: the files are of
        different surveys.
    """
    xyz_m, quat, _, covered = se3.interpolate_poses(
        poses.t_ns, poses.xyz_m, poses.quat_xyzw, t_ns, max_gap_s=_MAX_GAP_S
    )
    if not covered.all():
        raise StageError(
            f"{path}: no true pose for {np.count_nonzero(~covered)} of {len(covered)} scans, the"
            f" first at {np.asarray(t_ns)[~covered][0]} ns; give the truth of this very recording"
        )
    return se3.pose_matrix(xyz_m, quat)


def parse_features(path: FilePath) -> list[Any]:
    """Return the features of a truth.geojson, whatever they are.

    Raises
    ------
    StageError
        If it is no FeatureCollection.
    """
    return _read_collection(path)["features"]


def _read_collection(path: FilePath) -> dict[str, Any]:
    try:
        content = json.loads(Path(path).read_bytes())
    except OSError as error:
        raise StageError(f"{path}: cannot be read ({error.strerror}); {_REMEDY}") from None
    except (ValueError, RecursionError) as error:
        raise StageError(f"{path}: is no JSON ({error}); {_REMEDY}") from None
    if not isinstance(content, dict) or not isinstance(content.get("features"), list):
        raise StageError(f"{path}: is no GeoJSON FeatureCollection; {_REMEDY}")
    return content


def feature_member(feature: Any, name: str) -> dict[str, Any]:
    """Return the member `name` of a feature, empty where there is no such object."""
    member = feature.get(name) if isinstance(feature, dict) else None
    return member if isinstance(member, dict) else {}


def _runs(path: FilePath, number: int, geometry: dict[str, Any]) -> FloatArray:
    """Return the straight runs (n, 2, 2) of a LineString, without those of no length."""
    try:
        xy_m = np.array([point[:2] for point in geometry["coordinates"]], float).reshape(-1, 2)
    except (KeyError, TypeError, ValueError):
        xy_m = np.empty((0, 2))
    if geometry.get("type") != "LineString" or len(xy_m) < 2 or not np.isfinite(xy_m).all():
        raise StageError(
            f"{path}: feature {number} is a face, but no LineString of finite coordinates;"
            f" {_REMEDY}"
        )
    runs = np.stack([xy_m[:-1], xy_m[1:]], axis=1)
    return runs[line_lengths_m(runs) > ROUNDING]
