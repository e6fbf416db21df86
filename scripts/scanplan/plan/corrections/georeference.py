"""Where on Earth a plan lies, by points of which both places are known."""

import json
from collections.abc import Sequence

import numpy as np

from scanplan.plan.corrections import point_odds
from scanplan.plan.floorplan import GeoReference
from scanplan.plan.survey_scale import PlacedPoints
from scanplan.project import reference_points
from scanplan.project.corrections_file import Correction
from scanplan.types import FloatArray


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
    turn, origin_m = placed.fit_motion(scale)
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
        float(np.arctan2(turn[1, 0], turn[0, 0])),
        residual_m,
        _name_each(points, control_off_m),
        _name_each(checks, check_off_m),
        reference_points.fits_mirrored(
            [point.at_m for point in (*points, *checks)],
            [point.world_m or point.at_m for point in (*points, *checks)],
        ),
        _list_faults(points, checks, scale),
    )


def _list_faults(
    points: Sequence[Correction], checks: Sequence[Correction], scale: float
) -> list[str]:
    """Return a line on each point that is off by more than chance: distance, limit and remedy."""
    placed, held = read_points(points), read_points(checks)
    told = []
    for point in point_odds.find_outliers(placed, scale):
        remedy = "any of three may be the one that is off: add a fourth"
        if point.n_others > 2:
            remedy = "measure it again, leave it out, or state its `sigma_m`"
        told.append(f"{_name(points[point.row])}: {point.fault}; {remedy}")
    for point in point_odds.find_off_checks(placed, held, scale):
        remedy = "measure it and these again, or state its `sigma_m`"
        told.append(f"{_name(checks[point.row])}: {point.fault}; {remedy}")
    return told


def _name(point: Correction) -> str:
    """Return the entry of a point, and its name where it has one."""
    return f"{point.entry_name} ({point.name})" if point.name else point.entry_name


def _name_each(points: Sequence[Correction], off_m: FloatArray) -> list[tuple[str, float]]:
    names = [point.name or _name(point) for point in points]
    return list(zip(names, off_m.tolist(), strict=True))


def format_reference(reference: GeoReference) -> str:
    """Return a reference as the note of `schemas.FREE` that `floorplan_files` reads."""
    return json.dumps(vars(reference))
