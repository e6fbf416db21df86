"""Where on Earth a plan lies, by points of which both places are known."""

import json
from collections.abc import Sequence

import numpy as np

from scanplan.plan.floorplan import GeoReference
from scanplan.project.corrections_file import Correction
from scanplan.types import FloatArray


def fit_reference(
    points: Sequence[Correction], checks: Sequence[Correction] = ()
) -> GeoReference | None:
    """Return the rigid motion that lays the map frame onto reference points; None without any.

    Rotation and shift by least squares, no scale: a LiDAR's metres are held to be metres.

    Parameters
    ----------
    points : sequence of corrections_file.Correction
        None, or at least two.
    checks : sequence of corrections_file.Correction
        Points that are not used for it, and only held against it.
    """
    if not points:
        return None
    map_m, world_m = _read_places(points)
    around_m = (map_m - map_m.mean(axis=0)) @ np.array([1, 1j])
    world_around_m = (world_m - world_m.mean(axis=0)) @ np.array([1, 1j])
    rotation_rad = float(np.angle(np.sum(np.conj(around_m) * world_around_m)))
    cos, sin = np.cos(rotation_rad), np.sin(rotation_rad)
    turn = np.array([[cos, -sin], [sin, cos]])
    origin_m = world_m.mean(axis=0) - turn @ map_m.mean(axis=0)
    control_off_m, check_off_m = (
        np.linalg.norm(outside_m - (inside_m @ turn.T + origin_m), axis=1)
        for inside_m, outside_m in ((map_m, world_m), _read_places(checks))
    )
    residual_m = float(np.sqrt(np.mean(control_off_m**2)))
    east_m, north_m = origin_m.tolist()
    return GeoReference(
        points[0].crs,
        east_m,
        north_m,
        rotation_rad,
        residual_m,
        control_off_m.tolist(),
        check_off_m.tolist(),
    )


def _read_places(points: Sequence[Correction]) -> tuple[FloatArray, FloatArray]:
    """Return where points lie in the map and outside, (n, 2) each."""
    inside_m = np.array([point.at_m for point in points], float).reshape(-1, 2)
    return inside_m, np.array([point.world_m for point in points], float).reshape(-1, 2)


def format_reference(reference: GeoReference) -> str:
    """Return a reference as the note of `schemas.FREE` that `floorplan_files` reads."""
    return json.dumps(vars(reference))
