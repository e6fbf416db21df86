"""Where on Earth a plan lies, by points of which both places are known."""

import json
from collections.abc import Sequence

import numpy as np

from scanplan.plan.floorplan import GeoReference
from scanplan.plan.survey_scale import PlacedPoints
from scanplan.project import reference_points
from scanplan.project.corrections_file import Correction


def read_points(points: Sequence[Correction]) -> PlacedPoints:
    """Return what corrections say of points whose places are known inside and outside."""
    return PlacedPoints.of(
        [point.at_m for point in points],
        [point.world_m or point.at_m for point in points],
        [point.sigma_m for point in points],
    )


def fit_reference(
    points: Sequence[Correction], checks: Sequence[Correction] = (), scale: float = 1.0
) -> GeoReference | None:
    """Return the rigid motion that lays the map frame onto reference points; None without any.

    Rotation and shift by least squares, each point by its weight.

    Parameters
    ----------
    points : sequence of corrections_file.Correction
        None, or at least two.
    checks : sequence of corrections_file.Correction
        Points that are not used for it, and only held against it.
    scale : float
        By which the map is multiplied before, see `survey_scale`.
    """
    if not points:
        return None
    placed = read_points(points)
    rotation_rad = float(np.angle(placed.fit_similarity()))
    cos, sin = np.cos(rotation_rad), np.sin(rotation_rad)
    turn = scale * np.array([[cos, -sin], [sin, cos]])
    weights = placed.sigma_m**-2
    inside_m, outside_m = (
        np.average(of_m, axis=0, weights=weights) for of_m in (placed.inside_m, placed.outside_m)
    )
    origin_m = outside_m - turn @ inside_m
    control_off_m, check_off_m = (
        np.linalg.norm(of.outside_m - (of.inside_m @ turn.T + origin_m), axis=1)
        for of in (placed, read_points(checks))
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
        reference_points.fits_mirrored(
            [point.at_m for point in (*points, *checks)],
            [point.world_m or point.at_m for point in (*points, *checks)],
        ),
    )


def format_reference(reference: GeoReference) -> str:
    """Return a reference as the note of `schemas.FREE` that `floorplan_files` reads."""
    return json.dumps(vars(reference))
