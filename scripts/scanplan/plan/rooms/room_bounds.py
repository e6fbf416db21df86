"""What bounds a room though hardly a ray ends there: glass, and where free floor is narrow."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry import LineString
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import intersections, narrow_places, overlays
from scanplan.geometry.lines import Line
from scanplan.plan import wall_ground
from scanplan.plan.openings import GAP, OPEN, Opening, OpeningSettings
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import CORNER_M, END_M
from scanplan.rays import free_space
from scanplan.rays.face_raster import CELL_M
from scanplan.types import FloatArray

_FRAME_M = 0.8  # frame, reveal and the part of a pane seen at grazing angles only


def find_glass_walls(
    walls: Sequence[PlanWall],
    spans: Sequence[tuple[Line, float, float]],
    *,
    min_length_m: float,
    unpaired_m: float,
) -> list[PlanWall]:
    """Return panes that are no openings of walls as walls without faces, up to the walls beside.

    Rays that graze a frame or a deep reveal, or that furniture stops, leave the ends of a pane
    unknown.

    Parameters
    ----------
    walls : list of plan_wall.PlanWall
    spans : list of (lines.Line, float, float)
        From where to where along a line there is glass.
    min_length_m : float
        Shorter panes bound nothing.
    unpaired_m : float
        How thick a wall is taken for of which one side is known.
    """
    grounds = [
        overlays.buffer_shapes(wall_ground.opening_polygon(wall, opening, unpaired_m), END_M)
        for wall in walls
        for opening in wall.openings
    ]
    open_m2 = overlays.unite_areas(grounds)
    shapely.prepare(open_m2)
    stacked = intersections.stack_spans(walls)
    extended = (_extend(*span, walls, stacked) for span in spans)
    panes = [PlanWall(*span, math.nan, [], []) for span in extended]
    found: dict[int, list[PlanWall]] = {}
    # several lines show one pane, or each another part of it; rounding does not choose among them
    for row in sorted(range(len(panes)), key=lambda row: (-round(panes[row].length_m, 3), row)):
        pane = panes[row]
        if not open_m2.covers(shapely.Point(pane.ends.mean(axis=0))):
            known = [other for parts in found.values() for other in parts]
            parts = _cut_known(pane, known, unpaired_m)
            found[row] = [part for part in parts if part.length_m >= min_length_m]
    return [part for row in sorted(found) for part in found[row]]


def _cut_known(pane: PlanWall, known: Sequence[PlanWall], unpaired_m: float) -> list[PlanWall]:
    """Return the parts of a pane that no known collinear pane covers."""
    along = [other for other in known if pane.goes_on_as(other)]
    if not along:
        return [pane]
    # wider by what lines err, and no longer: panes may meet at a mullion
    inner = [replace(p, low_m=p.low_m + END_M, high_m=p.high_m - END_M) for p in along]
    strips = wall_ground.wall_strips(inner, unpaired_m)
    ground = overlays.unite_areas(
        [overlays.buffer_shapes(strip, END_M, join_style="mitre") for strip in strips]
    )
    rest = overlays.subtract_lines(LineString(pane.ends), ground)
    if rest.length >= pane.length_m - free_space.GRID_M:
        return [pane]
    parts = shapely.get_parts(rest)
    spans_m = [np.sort(pane.line.along_m(shapely.get_coordinates(part))) for part in parts]
    return [replace(pane, low_m=float(m[0]), high_m=float(m[-1])) for m in spans_m if len(m)]


@dataclass(frozen=True, eq=False)
class Floor:
    """Floor that rooms may be parted of.

    Attributes
    ----------
    ground : shapely geometry
        That was seen free, and what furniture stands on.
    planar : bool
        Whether all scans lie in one plane.
    hidden : shapely geometry, optional
        What of it furniture stands on: it was not seen.
    """

    ground: BaseGeometry
    planar: bool = False
    hidden: BaseGeometry | None = None

    def measure_seen_m(self, line_m: FloatArray) -> float:
        """Return how much of a line (2, 2) over floor furniture does not hide."""
        across = LineString(line_m)
        if self.hidden is None:
            return across.length
        return overlays.subtract_lines(across, self.hidden).length


def find_partings(
    bounds: wall_ground.Bounds,
    floor: Floor,
    track_m: FloatArray,
    opening: OpeningSettings,
    *,
    min_area_m2: float,
    ways_m: Sequence[FloatArray] = (),
) -> list[PlanWall]:
    """Return where free floor is narrow between walls: thin walls without faces, all an opening.

    There a wall was not seen, or its door was not; on the line of a wall nearby it stands in that.
    Where furniture hides most of the floor nothing is known of what is between.
    Gaps in the line of a wall part floor too (`_find_line_gaps`).

    Parameters
    ----------
    bounds : wall_ground.Bounds
        What parts the floor already.
    floor : Floor
    track_m : (n, 2) float64
        Where sensors were.
    opening : OpeningSettings
        What is narrower than the floor on both sides, and no wider than an opening, parts it; gaps
        in the line of a wall are measured by doors.
    min_area_m2 : float
        Of a room; less is not parted off.
    ways_m : sequence of (2, 2) float64
        Doors, from jamb to jamb: those that stand in no wall part floor, too.
    """
    strips, max_door_m = bounds.strips, opening.max_door_m
    known = overlays.buffer_shapes(overlays.unite_areas(strips), END_M)
    doors = [_make_parting(way_m, "door") for way_m in _choose_ways(ways_m, known)]
    # no narrower than the cells that narrow places are looked for in
    of_doors = wall_ground.wall_strips(doors, bounds.unpaired_m)
    grown = [overlays.buffer_shapes(strip, CELL_M, join_style="mitre") for strip in of_doors]
    solid = free_space.union_on_grid([*strips, *grown])
    # what is as narrow as a chair's leg casts a shadow, which is no place to stop at
    ground = floor.ground
    whole = free_space.close_shadows(ground, END_M) if floor.planar else ground
    free = free_space.difference_on_grid(whole, solid)
    partings = list(doors)
    gaps_m = _find_line_gaps(bounds, floor, free, max_door_m)
    # shorter ones may be sides of what stands in a room
    is_long = [floor.planar and wall.length_m > 2 * max_door_m for wall in bounds.walls]
    walls = overlays.unite_areas(list(itertools.compress(strips, is_long)))
    limits = narrow_places.NarrowLimits(opening.max_opening_m, min_area_m2, CELL_M)
    for part in free_space.open_polygons(free, END_M):
        for ends_m in narrow_places.find_narrow_places(
            part, track_m, limits, gaps_m=gaps_m, walls=walls
        ):
            is_hidden = 2 * floor.measure_seen_m(ends_m) < math.hypot(*(ends_m[1] - ends_m[0]))
            kind = wall_ground.UNSEEN if is_hidden else GAP
            partings.append(_make_parting(_snap(ends_m, bounds.walls), kind))
    return partings


def _find_line_gaps(
    bounds: wall_ground.Bounds, floor: Floor, free: BaseGeometry, max_door_m: float
) -> list[FloatArray]:
    """Return lines (2, 2) over free floor, from where a wall ends to where one goes on in its line.

    They are no wider than the wall is long; or, between two walls seen from both sides, than two
    doors. Also to a wall across, where nothing meets the wall's end, the gap is no wider than two
    doors, and the wall as long from there to its next opening: beside a door furniture hides what
    goes on, so that no more than a door of it was seen free.
    What meets another wall at its end is a corner that stands into one room.
    """
    walls, tree = bounds.walls, shapely.STRtree(bounds.strips)
    gaps_m: list[FloatArray] = []
    for wall in [wall for wall in walls if wall.bend is None]:
        reach_m = max(wall.length_m, 2 * max_door_m) if wall.right else wall.length_m
        for end_m, way_m in ((wall.low_m, -reach_m), (wall.high_m, reach_m)):
            gap_m = _find_free_line(wall, end_m, way_m, free, bounds.unpaired_m)
            if gap_m is None:
                continue
            near = tree.query(shapely.Point(gap_m[1]), predicate="dwithin", distance=CORNER_M)
            beyond = [walls[i] for i in near if walls[i] is not wall]
            width_m = math.hypot(*(gap_m[1] - gap_m[0]))
            is_short = width_m <= wall.length_m + CORNER_M
            on_line = [other for other in beyond if wall.goes_on_as(other)]
            goes_on = any(is_short or other.right for other in on_line)
            end, around_m = shapely.Point(wall.line.at(end_m)), wall.half_m + END_M
            is_free = len(tree.query(end, predicate="dwithin", distance=around_m)) == 1
            most_m = min(2 * max_door_m, _solid_m(wall, end_m))
            is_crossed = any(intersections.run_across(wall.line, other.line) for other in beyond)
            seen_m = floor.measure_seen_m(gap_m)
            is_narrow = width_m <= most_m and seen_m <= max_door_m + CORNER_M
            ends_at_wall = is_free and is_crossed and is_narrow
            if goes_on or ends_at_wall:
                gaps_m.append(gap_m)
    return gaps_m


def _find_free_line(
    wall: PlanWall, end_m: float, way_m: float, free: BaseGeometry, unpaired_m: float
) -> FloatArray | None:
    """Return from where to where (2, 2) floor is free next to an end of a wall, on its middle line.

    None if that is nothing, or begins farther from the end than a corner.
    """
    behind_m = unpaired_m / 2 if math.isnan(wall.thickness_m) else 0.0
    ray_m = wall.line.at(end_m + np.array([0.0, way_m])) - behind_m * wall.line.normal
    start = shapely.Point(ray_m[0])
    over = overlays.intersect_lines(free, LineString(ray_m))
    pieces = [piece for piece in shapely.get_parts(over) if piece.geom_type == "LineString"]
    first = min(pieces, key=start.distance, default=None)
    if first is None or start.distance(first) > CORNER_M or first.length <= CORNER_M:
        return None
    ends_m = shapely.get_coordinates(first)[[0, -1]]
    off_m = np.hypot(*(ends_m - ray_m[0]).T)
    return ends_m[np.argsort(off_m, kind="stable")]


def _solid_m(wall: PlanWall, end_m: float) -> float:
    """Return how long a wall is from one of its ends to the opening next to it."""
    jambs_m = [m for gap in wall.openings for m in (gap.low_m, gap.high_m)]
    return min((abs(m - end_m) for m in jambs_m), default=wall.length_m)


def _snap(ends_m: FloatArray, walls: Sequence[PlanWall]) -> FloatArray:
    """Return a line's ends (2, 2) moved onto the line of the wall nearest to both, if one is."""
    span_m = ends_m[1] - ends_m[0]
    middle_m = ends_m.mean(axis=0)
    least = math.cos(intersections.LEAST_RAD) * math.hypot(*span_m)
    off_m, nearest_m = CORNER_M, ends_m
    for wall in walls:
        normal = wall.normal_at(middle_m)
        farthest_m = float(np.abs(wall.offset_m(ends_m)).max())
        if farthest_m < off_m and abs(normal[1] * span_m[0] - normal[0] * span_m[1]) >= least:
            off_m, nearest_m = farthest_m, wall.onto_line(ends_m)
    return nearest_m


def _choose_ways(ways_m: Sequence[FloatArray], solid: BaseGeometry) -> list[FloatArray]:
    """Return the ways (2, 2) that no wall has an opening at, each once: a leaf has two sides."""
    chosen: list[FloatArray] = []
    for way_m in ways_m:
        middle = shapely.Point(way_m.mean(axis=0))
        known = [solid, *(overlays.buffer_shapes(LineString(other), CORNER_M) for other in chosen)]
        if not any(shape.covers(middle) for shape in known):
            chosen.append(way_m)
    return chosen


def _make_parting(ends_m: FloatArray, kind: str = GAP) -> PlanWall:
    """Return a thin wall between two places, a little longer, that is open all along."""
    span_m = ends_m[1] - ends_m[0]
    half_m = math.hypot(*span_m) / 2
    normal = np.array([-span_m[1], span_m[0]]) / (2 * half_m)
    opening = Opening(-half_m, half_m, OPEN, 0, math.nan, math.nan, below_wall=False, kind=kind)
    line = Line(ends_m.mean(axis=0), normal)
    low_m, high_m = np.sort(line.along_m(ends_m))
    reach_m = (float(low_m) - 2 * END_M, float(high_m) + 2 * END_M)
    return PlanWall(line, *reach_m, 2 * free_space.GRID_M, [], [], [opening])


def _extend(
    line: Line,
    low_m: float,
    high_m: float,
    walls: Sequence[PlanWall],
    stacked: intersections.SpanArrays,
) -> tuple[Line, float, float]:
    """Return a span with its ends moved to the nearest walls on or across its line."""
    places_m = [intersections.find_crossings(line, stacked, reach_m=CORNER_M).place_m]
    for wall in walls:
        is_on = np.abs(line.offset_m(wall.ends)) <= wall.half_m + END_M
        places_m.append(line.along_m(wall.ends)[is_on])
    place_m = np.concatenate(places_m)
    before_m = place_m[(place_m <= low_m) & (place_m >= low_m - _FRAME_M)]
    after_m = place_m[(place_m >= high_m) & (place_m <= high_m + _FRAME_M)]
    first_m = float(before_m.max()) if len(before_m) else float(low_m)
    last_m = float(after_m.min()) if len(after_m) else float(high_m)
    return line, first_m, last_m
