"""From wall segments and the points of the chosen scans to a floor plan."""

import math
from dataclasses import dataclass

import numpy as np

from scanplan.plan import (
    faces,
    furniture_fronts,
    glass,
    half_height,
    plan_tables,
    range_bias,
    segment_merging,
    uncertainty,
    wall_faces,
    wall_pairs,
    windows,
)
from scanplan.plan.openings import OpeningSettings
from scanplan.plan.rooms import find_rooms
from scanplan.plan.walls import assemble_walls
from scanplan.rays import face_profile, free_space
from scanplan.store import schemas

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

    merge: segment_merging.MergeSettings
    reading: face_profile.RaySettings
    ranges: range_bias.RangeBiasSettings
    furniture: furniture_fronts.FrontLimits
    pairs: wall_pairs.PairSettings
    openings: OpeningSettings
    rooms: RoomSettings
    trust: uncertainty.ReviewCriteria


@dataclass(frozen=True, eq=False)
class Plan:
    """The tables of a plan, columns by name, and what was left out and set right on the way.

    Attributes
    ----------
    faces, walls, openings, rooms, evidence, free : dict of str to (n,) array
    n_lines, n_dropped : int
        Lines of faces, and those dropped.
    range_errors_m : (181,) float64
        What ranges were shortened by, see `range_bias.estimate_range_bias`.
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


def make_plan_settings(*, merge, trace, ranges, furniture, pair, openings, rooms, trust):
    """Return settings from keywords of each part.

    Raises
    ------
    ValueError
        If one is out of its range.
    """
    merging = segment_merging.MergeSettings(**merge)
    return PlanSettings(
        merge=merging,
        reading=face_profile.RaySettings(**trace),
        ranges=range_bias.RangeBiasSettings(**ranges),
        furniture=furniture_fronts.FrontLimits(**furniture),
        pairs=wall_pairs.PairSettings(**pair, max_gap_m=openings["max_opening_m"]),
        openings=OpeningSettings(**openings),
        rooms=RoomSettings(**rooms),
        trust=uncertainty.ReviewCriteria(
            registration_sigma_m=merging.registration_sigma_m, **trust
        ),
    )


def make_plan(segments, rays, track_m, t_ns, settings, up=None):
    """Make a plan.

    Parameters
    ----------
    segments : dict of str to (n,) array
        The columns of `schemas.WALLS`, of the chosen scans.
    rays : ray_set.RaySet
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
    errors_m = range_bias.estimate_range_bias(
        rays, segments, settings.ranges, settings.reading.band_m, up
    )
    rays = range_bias.remove_range_bias(rays, errors_m, up)
    pieces = segment_merging.merge_segments(segments, settings.merge)
    parts = settings.merge, settings.reading, settings.furniture
    traced = faces.trace_faces(pieces, rays, *parts)
    found = assemble_walls(
        *(traced.stretches, settings.reading, settings.pairs, settings.openings),
        planar=rays.planar,
        corner_m=settings.merge.corner_m,
    )
    found = windows.add_windows(found, rays, settings.openings)
    found, tops_m = _without_low(found, settings.furniture.wall_height_m, rays.planar)
    unpaired_m = _usual_thickness_m(found)
    stars = free_space.free_polygons(rays)
    floor = free_space.union_on_grid(stars)
    panes = glass.find_glass_walls(
        *(found, traced.panes), min_length_m=settings.openings.min_opening_m, unpaired_m=unpaired_m
    )
    enclosed = find_rooms(
        *([*found, *panes], stars, track_m),
        min_area_m2=settings.rooms.min_area_m2,
        min_walled=settings.rooms.min_walled,
        min_width_m=settings.pairs.max_thickness_m,
        unpaired_m=unpaired_m,
        floor=floor,
    )
    floor_z_m = 0.0 if math.isnan(rays.floor_z_m) else rays.floor_z_m
    drawn = wall_faces.cut_wall_faces(found, max_beyond_m=settings.openings.max_closed_m)
    face_columns, face_rows = plan_tables.face_columns(drawn, floor_z_m)
    known = uncertainty.estimate_evidence(found, settings.trust, tops_m)
    return Plan(
        faces=face_columns,
        walls=plan_tables.wall_columns(found, known, face_rows, drawn, floor_z_m, settings.trust),
        openings=plan_tables.opening_columns(found, enclosed, settings.openings),
        rooms=plan_tables.room_columns(enclosed),
        evidence=plan_tables.evidence_columns(known, rays.scan_ids, t_ns),
        free=plan_tables.free_columns(_free([*found, *panes], floor, unpaired_m)),
        n_lines=traced.n_lines,
        n_dropped=traced.n_dropped,
        range_errors_m=errors_m,
    )


def _without_low(walls, wall_height_m, planar):
    """Return walls, less surfaces that were seen to end lower than a wall does, and the heights of their tops."""
    tops_m = [math.nan if planar else half_height.estimate_wall_top_m(wall) for wall in walls]
    known = [(w, t) for w, t in zip(walls, tops_m, strict=True) if w.right or not t < wall_height_m]
    return [w for w, _ in known], [t for _, t in known]


def _usual_thickness_m(walls):
    known = [w.thickness_m for w in walls if not math.isnan(w.thickness_m)]
    return float(np.median(known)) if known else _THICKNESS_M


def _free(walls, floor, unpaired_m):
    """Return the polygons of floor that rays went over, openings with it, walls without."""
    strips = free_space.wall_strips(walls, unpaired_m)
    ways = [
        free_space.opening_polygon(w, g, unpaired_m)
        for w in walls
        for g in w.openings
        if not g.is_above_wall
    ]
    solid = free_space.difference_on_grid(*map(free_space.union_on_grid, (strips, ways)))
    return list(free_space.difference_on_grid(floor, solid).geoms)
