"""Reading what a survey ought to find: true wall faces (GeoJSON) and true sensor poses (TUM)."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.lab.evaluation import visible_faces
from scanplan.store import tum

_REMEDY = "simulate the survey again, or mend it"
_MAX_GAP_S = 1.0
_SHORTEST_M = 1e-6


@dataclass(frozen=True)
class TrueFaces:
    """The straight stretches of wall surface of a floor, at the height of the sensor.

    Attributes
    ----------
    inner_m : (n, 2, 2) float64
        Start and end of the faces that can matter: those to be found.
    outer_m : (m, 2, 2) float64
        What hides walls and is none to be found: faces that can only be seen from outside the building, and screens
        (closed doors, tall furniture).
    """

    inner_m: np.ndarray
    outer_m: np.ndarray


@dataclass(frozen=True)
class TruePoses:
    """Where the sensor truly was.

    Attributes
    ----------
    t_ns : (n,) int64, strictly increasing
    xyz_m : (n, 3) float64
    quat_xyzw : (n, 4) float64
    """

    t_ns: np.ndarray
    xyz_m: np.ndarray
    quat_xyzw: np.ndarray


def read_true_faces(path):
    """Read the features of kind `face` and `screen` of a truth.geojson; a face without `side` is an inner one.

    Raises
    ------
    StageError
        If it is no GeoJSON, a face is no line of finite coordinates, or there is no inner face.
    """
    lines = {"inside": [], "outside": []}
    for number, feature in enumerate(parse_features(path)):
        properties = feature_member(feature, "properties")
        if properties.get("kind") not in ("face", "screen"):
            continue
        side = "outside" if properties["kind"] == "screen" else properties.get("side", "inside")
        if side not in lines:
            raise StageError(
                f"{path}: feature {number} has side {side!r}, inside or outside needed; {_REMEDY}"
            )
        lines[side].append(_runs(path, number, feature_member(feature, "geometry")))
    inner, outer = (
        np.concatenate([np.empty((0, 2, 2)), *lines[side]]) for side in ("inside", "outside")
    )
    if len(inner) == 0:
        raise StageError(f"{path}: holds 0 inner faces (kind: face), at least 1 needed; {_REMEDY}")
    return TrueFaces(inner, outer)


def read_sensor_view(path, *, max_range_m):
    """Return how far and how far around a scan of a survey can see: visible_faces.SensorView.

    Parameters
    ----------
    path : path-like
        truth.geojson; its member `sensor` may tell `max_range_m` and `field_deg`, as a simulated survey's does.
    max_range_m : float
        Points farther away are not used, however far the sensor sees.

    Raises
    ------
    StageError
        If it is no GeoJSON, or tells no positive numbers.
    """
    told = feature_member(_content(path), "sensor")
    numbers = [told.get("max_range_m", max_range_m), told.get("field_deg", 360.0)]
    if not all(isinstance(n, int | float) and n > 0 for n in numbers):
        raise StageError(
            f"{path}: its sensor has max_range_m, field_deg {numbers}, positive needed; {_REMEDY}"
        )
    return visible_faces.SensorView(
        min(numbers[0], max_range_m), np.radians(min(numbers[1], 360.0))
    )


def read_true_poses(path):
    """Read true poses from a file of TUM's form.

    Raises
    ------
    StageError
        If there is no pose, a number is not finite, a quaternion is zero, or the stamps do not increase.
    """
    try:
        t_ns, rows = tum.read_tum(path)
    except OSError as error:
        raise StageError(f"{path}: cannot be read ({error.strerror}); {_REMEDY}") from None
    if len(t_ns) == 0:
        raise StageError(f"{path}: holds 0 poses, at least 1 needed; {_REMEDY}")
    wrong = ~np.isfinite(rows).all(axis=1) | (np.abs(rows[:, 3:]).max(axis=1) < 1e-6)
    if wrong.any():
        raise StageError(
            f"{path}: {wrong.sum()} poses are not finite or have no direction, 0 allowed; {_REMEDY}"
        )
    if (np.diff(t_ns) <= 0).any():
        raise StageError(
            f"{path}: stamps do not increase after pose {np.argmax(np.diff(t_ns) <= 0)}; sort the lines"
        )
    return TruePoses(t_ns, rows[:, :3], rows[:, 3:])


def true_pose_matrices(poses):
    """Return TruePoses as world_from_sensor (n, 4, 4)."""
    return se3.pose_matrix(poses.xyz_m, poses.quat_xyzw)


def interpolate_true_poses(poses, t_ns, path):
    """Return world_from_sensor (n, 4, 4) at the stamps of scans; between two true poses by interpolation.

    Parameters
    ----------
    poses : TruePoses
    t_ns : (n,) int64
    path : path-like
        What an error names as the origin of the poses.

    Raises
    ------
    StageError
        If a stamp lies outside the true poses or in a gap of more than a second: the files are of different surveys.
    """
    xyz_m, quat, _, covered = se3.interpolate_poses(
        poses.t_ns, poses.xyz_m, poses.quat_xyzw, t_ns, max_gap_s=_MAX_GAP_S
    )
    if not covered.all():
        raise StageError(
            f"{path}: no true pose for {np.count_nonzero(~covered)} of {len(covered)} scans, the first at"
            f" {np.asarray(t_ns)[~covered][0]} ns; give the truth of this very recording"
        )
    return se3.pose_matrix(xyz_m, quat)


def parse_features(path):
    """Return the features of a truth.geojson, a list of anything; StageError if it is no FeatureCollection."""
    return _content(path)["features"]


def _content(path):
    try:
        content = json.loads(Path(path).read_bytes())
    except OSError as error:
        raise StageError(f"{path}: cannot be read ({error.strerror}); {_REMEDY}") from None
    except (ValueError, RecursionError) as error:
        raise StageError(f"{path}: is no JSON ({error}); {_REMEDY}") from None
    if not isinstance(content, dict) or not isinstance(content.get("features"), list):
        raise StageError(f"{path}: is no GeoJSON FeatureCollection; {_REMEDY}")
    return content


def feature_member(feature, name):
    """Return the member `name` of a feature, empty where there is no such object."""
    found = feature.get(name) if isinstance(feature, dict) else None
    return found if isinstance(found, dict) else {}


def _runs(path, number, geometry):
    """Return the straight runs (n, 2, 2) of a LineString, without those of no length."""
    try:
        xy_m = np.array([point[:2] for point in geometry["coordinates"]], float).reshape(-1, 2)
    except (KeyError, TypeError, ValueError):
        xy_m = np.empty((0, 2))
    if geometry.get("type") != "LineString" or len(xy_m) < 2 or not np.isfinite(xy_m).all():
        raise StageError(
            f"{path}: feature {number} is a face, but no LineString of finite coordinates; {_REMEDY}"
        )
    runs = np.stack([xy_m[:-1], xy_m[1:]], axis=1)
    return runs[np.hypot(*(runs[:, 1] - runs[:, 0]).T) > _SHORTEST_M]
