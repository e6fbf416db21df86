"""From wall segments and the points of the chosen scans to a floor plan."""

import math
from dataclasses import dataclass

import numpy as np

from scanplan import schemas
from scanplan.plan import (
    faces,
    freespace,
    fronts,
    gaps,
    glazing,
    planfaces,
    plantables,
    planwalls,
    profiles,
    rangeerrors,
    rightangles,
    rooms,
    tops,
    wallevidence,
    wallfaces,
    wallpairs,
    windows,
)

TABLES = {
    "faces": schemas.FACES,
    "walls": schemas.PLAN_WALLS,
    "openings": schemas.OPENINGS,
    "rooms": schemas.ROOMS,
    "evidence": schemas.EVIDENCE,
    "free": schemas.FREE,
}
"""The tables of a plan by the names of their files."""
_THICKNESS_M = 0.1


@dataclass(frozen=True)
class RoomSettings:
    """What a room is.

    Attributes
    ----------
    min_area_m2 : float, > 0
    min_walled : float, 0 to 1
        Least share of the outline of a room that no sensor was in, that runs along walls and openings.
    """

    min_area_m2: float
    min_walled: float


@dataclass(frozen=True)
class PlanSettings:
    """All that a plan is made with: each part as its own class says."""

    merge: faces.MergeSettings
    reading: profiles.Reading
    ranges: rangeerrors.RangeSettings
    square: rightangles.Prior
    furniture: fronts.Limits
    pairs: wallpairs.PairSettings
    openings: gaps.GapSettings
    rooms: RoomSettings
    trust: wallevidence.Trust


@dataclass(frozen=True, eq=False)
class Plan:
    """The tables of a plan, columns by name, and what was left out and set right on the way.

    Attributes
    ----------
    faces, walls, openings, rooms, evidence, free : dict of str to (n,) array
    n_lines, n_dropped : int
        Lines of faces, and those dropped.
    range_errors_m : (181,) float64
        What ranges were shortened by, see `rangeerrors.estimate`.
    """

    faces: dict
    walls: dict
    openings: dict
    rooms: dict
    evidence: dict
    free: dict
    n_lines: int
    n_dropped: int
    range_errors_m: np.ndarray


def settings(*, merge, trace, ranges, right_angles, furniture, pair, openings, rooms, trust):
    """Return settings from keywords of each part.

    Raises
    ------
    ValueError
        If one is out of its range.
    """
    merging = faces.MergeSettings(**merge)
    return PlanSettings(
        merge=merging,
        reading=profiles.Reading(**trace),
        ranges=rangeerrors.RangeSettings(**ranges),
        square=rightangles.Prior(registration_sigma_m=merging.registration_sigma_m, **right_angles),
        furniture=fronts.Limits(**furniture),
        pairs=wallpairs.PairSettings(**pair, max_gap_m=openings["max_opening_m"]),
        openings=gaps.GapSettings(**openings),
        rooms=RoomSettings(**rooms),
        trust=wallevidence.Trust(registration_sigma_m=merging.registration_sigma_m, **trust),
    )


def make(segments, rays, track_m, t_ns, settings, up=None):
    """Make a plan.

    Parameters
    ----------
    segments : dict of str to (n,) array
        The columns of `schemas.WALLS`, of the chosen scans.
    rays : rays.Rays
        Of the chosen scans.
    track_m : (k, 2) float64
        Where the sensor was, of all registered scans.
    t_ns : (s,) int64
        When each of the chosen scans was taken.
    settings : PlanSettings
    up : (s, 3) float, optional
        The axis that the beams of each chosen scan's sensor are inclined to, in the map frame; plumb by default.

    Returns
    -------
    Plan
        Without any row of faces or walls where nothing is supported enough.
    """
    up = np.tile((0.0, 0.0, 1.0), (len(rays.scan_ids), 1)) if up is None else up
    errors_m = rangeerrors.estimate(rays, segments, settings.ranges, settings.reading.band_m, up)
    rays = rangeerrors.without(rays, errors_m, up)
    pieces = faces.pieces(segments, settings.merge)
    parts = settings.merge, settings.reading, settings.square, settings.furniture
    traced = planfaces.trace(pieces, rays, *parts)
    found = planwalls.assemble(
        *(traced.stretches, settings.reading, settings.pairs, settings.openings),
        planar=rays.planar,
        corner_m=settings.merge.corner_m,
    )
    found = windows.added(found, rays, settings.openings)
    found, tops_m = _without_low(found, settings.furniture.wall_height_m, rays.planar)
    unpaired_m = _usual_thickness_m(found)
    stars = freespace.visible(rays)
    floor = freespace.joined(stars)
    panes = glazing.between(*(found, traced.panes), min_length_m=settings.openings.min_opening_m, unpaired_m=unpaired_m)
    enclosed = rooms.find(
        *([*found, *panes], stars, track_m),
        min_area_m2=settings.rooms.min_area_m2,
        min_walled=settings.rooms.min_walled,
        min_width_m=settings.pairs.max_thickness_m,
        unpaired_m=unpaired_m,
        floor=floor,
    )
    floor_z_m = 0.0 if math.isnan(rays.floor_z_m) else rays.floor_z_m
    drawn = wallfaces.of_walls(found, max_beyond_m=settings.openings.max_closed_m)
    face_columns, face_rows = plantables.faces(drawn, floor_z_m)
    known = wallevidence.weigh(found, settings.trust, tops_m)
    return Plan(
        faces=face_columns,
        walls=plantables.walls(found, known, face_rows, drawn, floor_z_m, settings.trust),
        openings=plantables.openings(found, enclosed, settings.openings),
        rooms=plantables.rooms(enclosed),
        evidence=plantables.evidence(known, rays.scan_ids, t_ns),
        free=plantables.free(_free([*found, *panes], floor, unpaired_m)),
        n_lines=traced.n_lines,
        n_dropped=traced.n_dropped,
        range_errors_m=errors_m,
    )


def _without_low(walls, wall_height_m, planar):
    """Return walls, less surfaces that were seen to end lower than a wall does, and the heights of their tops."""
    tops_m = [math.nan if planar else tops.find(wall) for wall in walls]
    known = [(w, t) for w, t in zip(walls, tops_m, strict=True) if w.right or not t < wall_height_m]
    return [w for w, _ in known], [t for _, t in known]


def _usual_thickness_m(walls):
    known = [w.thickness_m for w in walls if not math.isnan(w.thickness_m)]
    return float(np.median(known)) if known else _THICKNESS_M


def _free(walls, floor, unpaired_m):
    """Return the polygons of floor that rays went over, openings with it, walls without."""
    strips = freespace.strips(walls, unpaired_m)
    ways = [freespace.opening_ground(w, g, unpaired_m) for w in walls for g in w.openings if not g.is_above_wall]
    solid = freespace.without(*map(freespace.joined, (strips, ways)))
    return list(freespace.without(floor, solid).geoms)
