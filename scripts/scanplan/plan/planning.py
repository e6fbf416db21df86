"""From wall segments and the points of the chosen scans to a floor plan."""

import functools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Self

import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.plan import plan_tables, uncertainty, wall_faces, wall_ground
from scanplan.plan.curves.curved_walls import bend_walls
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.faces.merging import MergeSettings, merge_segments
from scanplan.plan.faces.tracing import trace_faces
from scanplan.plan.furniture import fronts
from scanplan.plan.furniture.columns import find_column_faces, tell_columns
from scanplan.plan.furniture.leaves import Leaf
from scanplan.plan.furniture.pieces import Piece, find_pieces, pieces_in_rooms
from scanplan.plan.furniture.pillars import cut_off_pillars
from scanplan.plan.model.designed_walls import DesignedWalls
from scanplan.plan.model.fronts import DenseScans, find_fronts
from scanplan.plan.model.likely_openings import settle_openings
from scanplan.plan.model.roofs import Roof
from scanplan.plan.model.surfaces import label_surfaces
from scanplan.plan.model.wall_labels import LabelEvidence
from scanplan.plan.openings import OpeningSettings, classify_gap
from scanplan.plan.plan_wall import (
    Nearly,
    PlanWall,
    greatest_thickness_m,
    list_faces,
    usual_thickness_m,
)
from scanplan.plan.reveals import settle_reveals
from scanplan.plan.rooms import partings, room_bounds
from scanplan.plan.rooms.parting_lines import Floor
from scanplan.plan.rooms.room import Room, RoomSettings
from scanplan.plan.rooms.room_outlines import find_rooms
from scanplan.plan.uncertainty import ReviewCriteria
from scanplan.plan.wall_pairs import PairSettings
from scanplan.plan.walls import assemble_walls
from scanplan.rays import free_space, lintels, range_bias
from scanplan.rays.face_observation import RaySettings
from scanplan.rays.ray_set import RaySet
from scanplan.stage import workers
from scanplan.store import schemas
from scanplan.store.registered_scans import RegisteredScans
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
_Free = tuple[list[shapely.MultiPolygon], shapely.MultiPolygon]


@dataclass(frozen=True)
class FurnitureSettings:
    """How large furniture is.

    Attributes
    ----------
    furniture_height_m : float, > 0
        What is seen higher is none.
    furniture_depth_m : float, >= 0
        From its front to the wall behind.
    """

    furniture_height_m: float
    furniture_depth_m: float


@dataclass(frozen=True)
class PlanSettings:
    """All that a plan is made with: each part as its own class says."""

    merge: MergeSettings
    reading: RaySettings
    ranges: range_bias.RangeBiasSettings
    furniture: FurnitureSettings
    pairs: PairSettings
    openings: OpeningSettings
    rooms: RoomSettings
    trust: ReviewCriteria


@dataclass(frozen=True, eq=False)
class ChosenScans:
    """What the chosen scans show, and how they stand.

    Attributes
    ----------
    segments : dict of str to (n,) array
        The columns of `schemas.WALLS`.
    rays : ray_set.RaySet
    t_ns : (s,) int64
        When each was taken.
    up : (s, 3) float, optional
        The axis that the beams of each sensor are inclined to, in the map frame; plumb by default.
    covariance : (s, 3, 3) float64, optional
        Of the x, y and heading of each, metres and radians; NaN where it is not known, which it is
        nowhere by default.
    """

    segments: Columns
    rays: RaySet
    t_ns: IntArray
    up: FloatArray | None = None
    covariance: FloatArray | None = None

    @classmethod
    def of_registered(
        cls, segments: Columns, rays: RaySet, registered: RegisteredScans, rows: IntArray
    ) -> Self:
        """Return these of the registered scans at rows (s,), in the order of the rays' scans."""
        up = registered.map_from_sensor[rows, :3, 2]
        return cls(segments, rays, registered.t_ns[rows], up, registered.covariance[rows])


@dataclass(frozen=True)
class OtherScans:
    """What scans saw that were not chosen, too.

    Attributes
    ----------
    find_floor : callable, optional
        Returns the floor that all planar ones saw: rooms are made of it. By default it is what the
        chosen ones saw.
    dense : DenseScans, optional
        Panes are found by them: by default by the chosen ones.
    """

    find_floor: Callable[[], BaseGeometry] | None = None
    dense: DenseScans | None = None


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
    nearly : list of plan_wall.Nearly
        What was nearly drawn.
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
    nearly: list[Nearly]


def make_plan_settings(keywords: Settings) -> PlanSettings:
    """Return settings from the keywords of each part, by its name.

    Raises
    ------
    ValueError
        If one is out of its range.
    """
    return PlanSettings(
        merge=MergeSettings(**keywords["merge"]),
        reading=RaySettings(**keywords["trace"]),
        ranges=range_bias.RangeBiasSettings(**keywords["ranges"]),
        furniture=FurnitureSettings(**keywords["furniture"]),
        pairs=PairSettings(**keywords["pair"], max_gap_m=keywords["openings"]["max_opening_m"]),
        openings=OpeningSettings(
            **keywords["openings"], door_height_m=keywords["trace"]["door_height_m"]
        ),
        rooms=RoomSettings(**keywords["rooms"], min_width_m=keywords["pair"]["max_thickness_m"]),
        trust=ReviewCriteria(**keywords["trust"]),
    )


def make_plan(
    chosen: ChosenScans,
    track_m: FloatArray,
    settings: PlanSettings,
    *,
    others: OtherScans = OtherScans(),
    designed: DesignedWalls | None = None,
    threads: int = 1,
) -> Plan:
    """Make a plan.

    Parameters
    ----------
    track_m : (k, 2) float64
        Where the sensor was, of all registered scans.
    settings : PlanSettings
    others : OtherScans
        Of planar scans.
    designed : DesignedWalls, optional
        A design that walls are likelier to be as, in the map frame.
    threads : int
        Cores to use; the plan does not depend on it.

    Returns
    -------
    Plan
        Without any row of faces or walls where nothing is supported enough.
    """
    segments, rays = chosen.segments, chosen.rays
    up = rays.up if chosen.up is None else chosen.up
    rays = replace(rays, floor_z_m=lintels.settle_floor_z(rays, segments, track_m))
    errors_m = range_bias.estimate_range_bias(
        rays, segments, settings.ranges, settings.reading.band_m, up
    )
    rays = range_bias.remove_range_bias(rays, errors_m, up, threads)
    rays = rays.with_up(up)
    openings = settings.openings
    find_free = workers.begin_in_thread(
        _find_free,
        rays,
        track_m,
        openings.min_opening_m,
        openings.max_door_m,
        threads=threads,
    )

    def read_dense(most: int | None) -> Iterator[RaySet]:
        if others.dense is None:
            yield rays
            return
        for dense, up in others.dense.gather_rays(rays.floor_z_m, most):
            moved = range_bias.remove_range_bias(dense, errors_m, up, threads, in_place=True)
            yield moved.with_up(up)

    survey = _Survey(
        settings, rays, read_dense, track_m, find_free, others.find_floor, designed, threads
    )
    surfaces = survey.find_surfaces(segments)
    spaces = survey.find_spaces(surfaces)
    surfaces = _settle(surfaces, spaces, settings.openings.max_door_m)
    bare = survey.find_bare_spans(surfaces, spaces)
    walls, tops_m = settle_reveals(
        surfaces.walls,
        surfaces.tops_m,
        rays,
        max_thickness_m=settings.pairs.max_thickness_m,
    )
    floor_z_m = rays.ground_z_m
    cut_walls = wall_faces.cut_wall_faces(
        walls,
        max_beyond_m=settings.openings.max_closed_m,
        door_height_m=settings.reading.door_height_m,
    )
    face_columns, main_rows = plan_tables.face_columns(cut_walls, floor_z_m)
    scans = uncertainty.place_scans(
        rays.sensors_m[:, :2], chosen.covariance, settings.merge.registration_sigma_m
    )
    evidence = uncertainty.estimate_evidence(walls, tops_m, scans)
    doubtful = [known.needs_a_visit(settings.trust) for known in evidence]
    free_floor = _find_free_floor(surfaces.bounds, survey.floor)
    return Plan(
        faces=face_columns,
        walls=plan_tables.wall_columns(walls, evidence, main_rows, doubtful, floor_z_m),
        openings=plan_tables.opening_columns(
            walls,
            spaces.rooms,
            settings.openings.max_door_m,
            surfaces.glass_walls,
            spaces.partings,
            bare,
        ),
        rooms=plan_tables.room_columns(spaces.rooms),
        evidence=plan_tables.evidence_columns(evidence, rays.scan_ids, chosen.t_ns),
        free=plan_tables.free_columns(free_floor),
        furniture=plan_tables.furniture_columns(
            spaces.pieces, floor_z_m, leaves_m=surfaces.open_leaves_m
        ),
        n_lines=surfaces.n_lines,
        n_dropped=surfaces.n_dropped,
        range_errors_m=errors_m,
        nearly=surfaces.nearly,
    )


@dataclass(frozen=True, eq=False)
class _Surfaces:
    """What stands, before rooms are known.

    Attributes
    ----------
    walls, glass_walls : list of PlanWall
    tops_m : list of float
        How high each wall ends, see `model.surfaces.LabelledSurfaces`.
    unpaired_m : float
        How thick a wall is taken to be of which one side was seen.
    furnished : list of shapely geometry
        Ground behind fronts of furniture and under leaves of doors, of planar scans.
    ways_m : list of (2, 2) float64
        Doors, from jamb to jamb: in fronts of glass, and where leaves stand open in planar scans.
    open_leaves_m : list of (2, 2) float64
        The surfaces of open leaves that labels tell from walls, from end to end.
    roof : roofs.Roof
    nearly : list of Nearly
        What was nearly drawn.
    n_lines, n_dropped : int
        As in `Plan`.
    """

    walls: list[PlanWall]
    glass_walls: list[PlanWall]
    tops_m: list[float]
    unpaired_m: float
    furnished: list[BaseGeometry]
    ways_m: list[FloatArray]
    open_leaves_m: list[FloatArray]
    roof: Roof
    nearly: list[Nearly]
    n_lines: int
    n_dropped: int

    @functools.cached_property
    def bounds(self) -> wall_ground.Bounds:
        """What bounds rooms."""
        return wall_ground.Bounds([*self.walls, *self.glass_walls], self.unpaired_m)


@dataclass(frozen=True, eq=False)
class _Spaces:
    """Rooms, the passages that part them where no wall does, and the furniture in them."""

    rooms: list[Room]
    partings: list[PlanWall]
    pieces: list[Piece]


@dataclass(frozen=True, eq=False)
class _Survey:
    """What was seen, and the settings to read it by: finds what a plan shows, step by step.

    Attributes
    ----------
    settings : PlanSettings
    rays : ray_set.RaySet
        Of the chosen scans, their ranges set right.
    read_dense : callable
        Returns those that panes are found by, likewise, of so many scans at once, or of all.
    track_m : (k, 2) float64
    find_free : callable
        Returns `views` and `floor`, for which lines need not wait.
    find_seen : callable, optional
    designed : DesignedWalls, optional
        As in `make_plan`.
    threads : int
    """

    settings: PlanSettings
    rays: RaySet
    read_dense: Callable[[int | None], Iterator[RaySet]]
    track_m: FloatArray
    find_free: Callable[[], _Free]
    find_seen: Callable[[], BaseGeometry] | None
    designed: DesignedWalls | None
    threads: int

    @property
    def views(self) -> list[shapely.MultiPolygon]:
        """What each scan saw free."""
        return self.find_free()[0]

    @property
    def floor(self) -> shapely.MultiPolygon:
        """All that was seen free."""
        return self.find_free()[1]

    @functools.cached_property
    def seen_floor(self) -> BaseGeometry:
        """Likewise by any scan, chosen or not: what rooms are made of."""
        if self.find_seen is None:
            return self.floor
        return free_space.union_on_grid([self.floor, self.find_seen()])

    def find_surfaces(self, segments: Columns) -> _Surfaces:
        """Return walls with their openings."""
        candidates = merge_segments(segments, self.settings.merge)
        traced = trace_faces(
            candidates,
            self.rays,
            self.settings.merge,
            self.settings.reading,
            self.settings.pairs,
        )
        walls, furnished, leaves = self._make_walls(traced.faces)
        unpaired_m = usual_thickness_m(walls)
        min_width_m = self.settings.openings.min_opening_m
        evidence = LabelEvidence(
            self.rays,
            self.track_m,
            self.settings.openings.max_opening_m,
            self.designed,
            self.seen_floor,
        )
        labelled = label_surfaces(walls, evidence, max_door_m=self.settings.openings.max_door_m)
        glass = find_fronts(labelled.walls, self.read_dense, self.track_m)
        glass_walls = room_bounds.find_glass_walls(
            labelled.walls,
            glass.panes,
            min_length_m=min_width_m,
            unpaired_m=unpaired_m,
        )
        walls, tops_m = self._leave_out_columns(
            labelled.walls,
            labelled.tops_m,
            glass_walls,
            unpaired_m,
        )
        walls, tops_m = bend_walls(
            walls,
            tops_m,
            self.rays,
            pairing=self.settings.pairs,
            opening=self.settings.openings,
            reading=self.settings.reading,
        )
        return _Surfaces(
            walls=walls,
            glass_walls=glass_walls,
            tops_m=tops_m,
            unpaired_m=unpaired_m,
            furnished=furnished,
            ways_m=[*(leaf.way_m for leaf in leaves), *glass.ways_m],
            open_leaves_m=labelled.leaves_m,
            roof=labelled.roof,
            nearly=labelled.nearly,
            n_lines=traced.n_lines,
            n_dropped=traced.n_dropped,
        )

    def _make_walls(
        self, faces: Sequence[FaceInterval]
    ) -> tuple[list[PlanWall], list[BaseGeometry], list[Leaf]]:
        """Return walls of faces, and of planar scans the ground of furniture, and leaves of doors.

        Fronts of furniture and leaves are none of the walls.
        """
        assemble = functools.partial(
            assemble_walls,
            pairing=self.settings.pairs,
            opening=self.settings.openings,
            corner_m=self.settings.merge.corner_m,
        )
        walls = assemble(faces)
        if not self.rays.planar:
            return walls, [], []
        limits = fronts.FrontLimits(
            max_door_m=self.settings.openings.max_door_m,
            max_thickness_m=self.settings.pairs.max_thickness_m,
            max_depth_m=self.settings.furniture.furniture_depth_m,
            ghost_distance_m=self.settings.merge.ghost_distance_m,
        )
        walls, furnished, leaves = fronts.drop_fronts(
            walls, self.floor, self.seen_floor, assemble, limits
        )
        # a plane shows no more of what is between two faces than its ends
        most_m = greatest_thickness_m(walls)
        if any(wall.thickness_m > most_m for wall in walls):
            pairing = replace(self.settings.pairs, max_thickness_m=most_m)
            walls = assemble(list_faces(walls), pairing=pairing)
        return walls, furnished, leaves

    def _leave_out_columns(
        self,
        walls: list[PlanWall],
        tops_m: list[float],
        glass_walls: list[PlanWall],
        unpaired_m: float,
    ) -> tuple[list[PlanWall], list[float]]:
        """Return walls and their tops, without pillars at their ends, and sides of columns."""
        # in the plane a few beams say that a wall ends free, and nothing what is above it
        if self.rays.planar:
            return walls, tops_m
        max_width_m = self.settings.pairs.max_thickness_m
        classify = functools.partial(classify_gap, settings=self.settings.openings)
        cut = cut_off_pillars(
            walls,
            glass_walls,
            classify,
            min_width_m=self.settings.openings.min_opening_m,
            max_thickness_m=max_width_m,
        )
        parts = [
            (part, top_m) for of_wall, top_m in zip(cut, tops_m, strict=True) for part in of_wall
        ]
        are_columns = find_column_faces(
            *([part for part, _ in parts], glass_walls, self.rays),
            furniture_height_m=self.settings.furniture.furniture_height_m,
            max_width_m=max_width_m,
            unpaired_m=unpaired_m,
        )
        left = [of for of, is_column in zip(parts, are_columns, strict=True) if not is_column]
        return [wall for wall, _ in left], [top_m for _, top_m in left]

    def find_spaces(self, surfaces: _Surfaces) -> _Spaces:
        """Return rooms and what stands in them."""
        bounds, floor = surfaces.bounds, self._floor_with(surfaces.furnished)
        outside = surfaces.roof.find_outside(
            floor, self.track_m, min_area_m2=self.settings.rooms.min_area_m2
        )
        floor = free_space.difference_on_grid(floor, outside)
        hidden = free_space.difference_on_grid(floor, self.seen_floor)
        parted = partings.find_partings(
            bounds,
            Floor(floor, planar=self.rays.planar, hidden=hidden),
            self.track_m,
            2 * self.settings.openings.max_door_m,
            ways_m=surfaces.ways_m,
        )
        rooms = find_rooms(
            wall_ground.Bounds([*bounds.walls, *parted.walls], bounds.unpaired_m),
            self.views,
            self.track_m,
            self.settings.rooms,
            floor=floor,
            threads=self.threads,
        )
        # returns of leaves are explained, as those of walls are
        leaves = [plan_tables.draw_leaf(ends_m) for ends_m in surfaces.open_leaves_m]
        pieces = find_pieces(
            self.rays,
            [*bounds.strips, *leaves],
            *([room.polygon for room in rooms], self.views),
            max_height_m=self.settings.furniture.furniture_height_m,
            hidden=surfaces.furnished,
        )
        # nothing of the plan is known of what other scans alone saw
        rooms = parted.rate_rooms([room for room in rooms if room.n_scans])
        pieces = pieces_in_rooms(pieces, [room.polygon for room in rooms])
        pieces = tell_columns(
            pieces,
            self.rays,
            bounds.strips,
            furniture_height_m=self.settings.furniture.furniture_height_m,
            max_width_m=self.settings.pairs.max_thickness_m,
        )
        return _Spaces(rooms=rooms, partings=parted.walls, pieces=pieces)

    def find_bare_spans(self, surfaces: _Surfaces, spaces: _Spaces) -> list[wall_ground.BareSpan]:
        """Return the spans of rooms' outlines where nothing is drawn."""
        return wall_ground.find_bare_spans(
            [room.polygon for room in spaces.rooms],
            *([*surfaces.bounds.walls, *spaces.partings], self.floor),
            unpaired_m=surfaces.unpaired_m,
            min_length_m=self.settings.openings.min_opening_m,
        )

    def _floor_with(self, grounds: Sequence[BaseGeometry]) -> BaseGeometry:
        return free_space.union_on_grid([self.seen_floor, *grounds]) if grounds else self.seen_floor


def _settle(surfaces: _Surfaces, spaces: _Spaces, max_door_m: float) -> _Surfaces:
    """Return surfaces without openings that are unlikely where rooms lie as they do."""
    settled = [settle_openings(wall, spaces.rooms, max_door_m) for wall in surfaces.walls]
    tops_m = [
        top_m for (parts, _), top_m in zip(settled, surfaces.tops_m, strict=True) for _ in parts
    ]
    return replace(
        surfaces,
        walls=[part for parts, _ in settled for part in parts],
        tops_m=tops_m,
        nearly=[*surfaces.nearly, *(of for _, nearly in settled for of in nearly)],
    )


def _find_free(rays: RaySet, track_m: FloatArray, width_m: float, max_step_m: float) -> _Free:
    """Return what each scan saw free, and all that was."""
    views = free_space.free_polygons(rays)
    seen_floor = free_space.union_on_grid(views)
    driven = free_space.driven_ground(track_m, width_m=width_m, max_step_m=max_step_m)
    # nearly all of it was seen: only what was not is worth a union
    shapely.prepare(seen_floor)
    unseen = driven[~shapely.covers(seen_floor, driven)]
    return views, free_space.union_on_grid([seen_floor, *unseen]) if len(unseen) else seen_floor


def _find_free_floor(
    bounds: wall_ground.Bounds, floor: shapely.MultiPolygon
) -> list[shapely.Polygon]:
    """Return the polygons of floor that rays went over, openings with it, walls without."""
    doors = [
        wall_ground.opening_polygon(wall, opening, bounds.unpaired_m)
        for wall in bounds.walls
        for opening in wall.openings
        if opening.kind == "door"
    ]
    solid = free_space.difference_on_grid(bounds.solid, free_space.union_on_grid(doors))
    return list(free_space.difference_on_grid(floor, solid).geoms)
