"""From wall segments and the points of the chosen scans to a floor plan."""

import functools
import math
from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.extraction.furniture import FurnitureLimits
from scanplan.plan import (
    half_height,
    opening_kinds,
    plan_tables,
    room_bounds,
    uncertainty,
    wall_faces,
    wall_ground,
)
from scanplan.plan.faces.merging import MergeSettings, merge_segments
from scanplan.plan.faces.tracing import trace_faces
from scanplan.plan.furniture import fronts
from scanplan.plan.furniture.pieces import find_pieces
from scanplan.plan.openings import OpeningSettings
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.rooms import find_rooms, leave_out_unseen, rooms_beside
from scanplan.plan.uncertainty import ReviewCriteria
from scanplan.plan.wall_pairs import PairSettings
from scanplan.plan.walls import assemble_walls
from scanplan.rays import free_space, range_bias
from scanplan.rays.face_observation import RaySettings
from scanplan.rays.ray_set import RaySet
from scanplan.store import schemas
from scanplan.types import Array, Columns, FloatArray, IntArray, Settings

TABLES = {
    "faces": schemas.FACES,
    "walls": schemas.PLAN_WALLS,
    "openings": schemas.OPENINGS,
    "rooms": schemas.ROOMS,
    "evidence": schemas.EVIDENCE,
    "free": schemas.FREE,
    "furniture": schemas.FURNITURE,
}
"""The tables of a plan by the names of their files."""
_THICKNESS_M = 0.1  # of a partition, where no wall shows both sides


@dataclass(frozen=True)
class RoomSettings:
    """What a room is.

    Attributes
    ----------
    min_area_m2 : float, > 0
    min_walled : float, 0 to 1
        Least share of the outline of a room that no sensor was in, that runs along walls and
        openings.
    """

    min_area_m2: float
    min_walled: float


@dataclass(frozen=True)
class PlanSettings:
    """All that a plan is made with: each part as its own class says."""

    merge: MergeSettings
    reading: RaySettings
    ranges: range_bias.RangeBiasSettings
    furniture: FurnitureLimits
    pairs: PairSettings
    openings: OpeningSettings
    rooms: RoomSettings
    trust: ReviewCriteria


@dataclass(frozen=True, eq=False)
class Plan:
    """The tables of a plan, columns by name, and what was left out and set right on the way.

    Attributes
    ----------
    faces, walls, openings, rooms, evidence, free, furniture : dict of str to (n,) array
    n_lines, n_dropped : int
        Lines of faces, and those dropped.
    range_errors_m : (181,) float64
        What ranges were shortened by, see `range_bias.estimate_range_bias`.
    """

    faces: dict[str, Array]
    walls: dict[str, Array]
    openings: dict[str, Array]
    rooms: dict[str, Array]
    evidence: dict[str, Array]
    free: dict[str, Array]
    furniture: dict[str, Array]
    n_lines: int
    n_dropped: int
    range_errors_m: FloatArray


def make_plan_settings(
    *,
    merge: Settings,
    trace: Settings,
    ranges: Settings,
    furniture: Settings,
    pair: Settings,
    openings: Settings,
    rooms: Settings,
    trust: Settings,
) -> PlanSettings:
    """Return settings from keywords of each part.

    Raises
    ------
    ValueError
        If one is out of its range.
    """
    return PlanSettings(
        merge=MergeSettings(**merge),
        reading=RaySettings(**trace),
        ranges=range_bias.RangeBiasSettings(**ranges),
        furniture=FurnitureLimits(**furniture),
        pairs=PairSettings(**pair, max_gap_m=openings["max_opening_m"]),
        openings=OpeningSettings(**openings),
        rooms=RoomSettings(**rooms),
        trust=ReviewCriteria(**trust),
    )


def make_plan(
    segments: Columns,
    rays: RaySet,
    track_m: FloatArray,
    t_ns: IntArray,
    settings: PlanSettings,
    up: FloatArray | None = None,
    *,
    threads: int = 1,
) -> Plan:
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
        The axis that the beams of each chosen scan's sensor are inclined to, in the map frame;
        plumb by default.
    threads : int
        Cores to use; the plan does not depend on it.

    Returns
    -------
    Plan
        Without any row of faces or walls where nothing is supported enough.
    """
    up = np.tile((0.0, 0.0, 1.0), (len(rays.scan_ids), 1)) if up is None else up
    band_m = settings.reading.band_m
    errors_m = range_bias.estimate_range_bias(rays, segments, settings.ranges, band_m, up)
    rays = range_bias.remove_range_bias(rays, errors_m, up)
    candidates = merge_segments(segments, settings.merge)
    traced = trace_faces(
        *(candidates, rays, settings.merge, settings.reading, settings.furniture), threads=threads
    )
    views = free_space.free_polygons(rays, threads)
    floor = free_space.union_on_grid(views)
    assemble = functools.partial(
        assemble_walls,
        pairing=settings.pairs,
        opening=settings.openings,
        corner_m=settings.merge.corner_m,
        door_height_m=settings.reading.door_height_m,
    )
    walls, furnished = assemble(traced.faces), []
    if rays.planar:
        walls, furnished = fronts.drop_fronts(
            *(walls, floor, assemble, _usual_thickness_m),
            max_thickness_m=settings.pairs.max_thickness_m,
        )
    unpaired_m = _usual_thickness_m(walls)
    walls = opening_kinds.add_windows(
        walls, rays, min_width_m=settings.openings.min_opening_m, band_m=band_m
    )
    walls, tops_m = half_height.drop_low_surfaces(walls, settings.furniture.wall_height_m)
    glass_walls = room_bounds.find_glass_walls(
        walls,
        traced.panes,
        min_length_m=settings.openings.min_opening_m,
        unpaired_m=unpaired_m,
    )
    bounds = [*walls, *glass_walls]
    partings = room_bounds.find_partings(
        bounds,
        floor,
        track_m,
        max_width_m=settings.openings.max_door_m,
        min_area_m2=settings.rooms.min_area_m2,
        unpaired_m=unpaired_m,
        planar=rays.planar,
    )
    rooms = find_rooms(
        [*bounds, *partings],
        views,
        track_m,
        min_area_m2=settings.rooms.min_area_m2,
        min_walled=settings.rooms.min_walled,
        min_width_m=settings.pairs.max_thickness_m,
        unpaired_m=unpaired_m,
        floor=free_space.union_on_grid([floor, *furnished]),
        planar=rays.planar,
    )
    pieces = find_pieces(
        *(
            rays,
            wall_ground.wall_strips(bounds, unpaired_m),
            [room.polygon for room in rooms],
            views,
        ),
        max_height_m=settings.furniture.furniture_height_m,
        hidden=furnished,
    )
    if rays.planar:
        rooms = leave_out_unseen(
            *(rooms, free_space.union_on_grid([floor, *(piece.outline for piece in pieces)])),
            *(bounds, track_m),
            min_area_m2=settings.rooms.min_area_m2,
            unpaired_m=unpaired_m,
        )
        ground = shapely.union_all([room.polygon for room in rooms])
        pieces = [piece for piece in pieces if piece.outline.intersects(ground)]
    walls = opening_kinds.decide_kinds(
        *(walls, rays, track_m, functools.partial(rooms_beside, rooms)),
        min_width_m=settings.openings.min_opening_m,
        band_m=band_m,
    )
    bounds = [*walls, *glass_walls]
    areas = [room.polygon for room in rooms]
    bare = wall_ground.find_bare_spans(
        areas,
        [*bounds, *partings],
        floor,
        unpaired_m=unpaired_m,
        min_length_m=settings.openings.min_opening_m,
    )
    bare = opening_kinds.decide_bare_spans(bare, rays, track_m, areas, band_m=band_m)
    floor_z_m = 0.0 if math.isnan(rays.floor_z_m) else rays.floor_z_m
    cut_walls = wall_faces.cut_wall_faces(walls, max_beyond_m=settings.openings.max_closed_m)
    face_columns, main_rows = plan_tables.face_columns(cut_walls, floor_z_m)
    evidence = uncertainty.estimate_evidence(
        walls, tops_m, registration_sigma_m=settings.merge.registration_sigma_m
    )
    doubtful = [known.needs_a_visit(settings.trust) for known in evidence]
    return Plan(
        faces=face_columns,
        walls=plan_tables.wall_columns(walls, evidence, main_rows, doubtful, floor_z_m),
        openings=plan_tables.opening_columns(
            walls, rooms, settings.openings.max_door_m, glass_walls, partings, bare
        ),
        rooms=plan_tables.room_columns(rooms),
        evidence=plan_tables.evidence_columns(evidence, rays.scan_ids, t_ns),
        free=plan_tables.free_columns(_find_free_floor(bounds, floor, unpaired_m)),
        furniture=plan_tables.furniture_columns(pieces, floor_z_m),
        n_lines=traced.n_lines,
        n_dropped=traced.n_dropped,
        range_errors_m=errors_m,
    )


def _usual_thickness_m(walls: list[PlanWall]) -> float:
    known_m = [wall.thickness_m for wall in walls if not math.isnan(wall.thickness_m)]
    return float(np.median(known_m)) if known_m else _THICKNESS_M


def _find_free_floor(
    walls: list[PlanWall], floor: shapely.MultiPolygon, unpaired_m: float
) -> list[shapely.Polygon]:
    """Return the polygons of floor that rays went over, openings with it, walls without."""
    strips = wall_ground.wall_strips(walls, unpaired_m)
    ways = [
        wall_ground.opening_polygon(wall, opening, unpaired_m)
        for wall in walls
        for opening in wall.openings
        if opening.kind == "door"
    ]
    solid = free_space.difference_on_grid(
        free_space.union_on_grid(strips), free_space.union_on_grid(ways)
    )
    return list(free_space.difference_on_grid(floor, solid).geoms)
