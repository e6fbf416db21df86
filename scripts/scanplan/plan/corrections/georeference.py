"""Where on Earth a plan lies, by points of which both places are known."""

import json
from collections.abc import Sequence

import numpy as np

from scanplan.plan.floorplan import GeoReference
from scanplan.project.corrections_file import Correction


def fit_reference(points: Sequence[Correction]) -> GeoReference | None:
    """Return the rigid motion that lays the map frame onto reference points; None without any.

    Rotation and shift by least squares, no scale: a LiDAR's metres are held to be metres.

    Parameters
    ----------
    points : sequence of corrections_file.Correction
        None, or at least two.
    """
    if not points:
        return None
    map_m = np.array([point.at_m for point in points])
    world_m = np.array([point.world_m for point in points])
    around_m = (map_m - map_m.mean(axis=0)) @ np.array([1, 1j])
    world_around_m = (world_m - world_m.mean(axis=0)) @ np.array([1, 1j])
    rotation_rad = float(np.angle(np.sum(np.conj(around_m) * world_around_m)))
    cos, sin = np.cos(rotation_rad), np.sin(rotation_rad)
    turn = np.array([[cos, -sin], [sin, cos]])
    origin_m = world_m.mean(axis=0) - turn @ map_m.mean(axis=0)
    off_m = world_m - (map_m @ turn.T + origin_m)
    residual_m = float(np.sqrt(np.mean(np.sum(off_m**2, axis=1))))
    east_m, north_m = origin_m.tolist()
    return GeoReference(points[0].crs, east_m, north_m, rotation_rad, residual_m)


def format_reference(reference: GeoReference) -> str:
    """Return a reference as the note of `schemas.FREE` that `floorplan_files` reads."""
    return json.dumps(vars(reference))
