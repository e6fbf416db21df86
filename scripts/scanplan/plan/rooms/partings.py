"""Where free floor is parted into rooms though no wall was seen there."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from scipy import special
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import intersections, overlays
from scanplan.geometry.ground_cells import part_ground
from scanplan.geometry.lines import Line
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.plan import wall_ground
from scanplan.plan.model.parting_odds import HIDDEN_SHARE, LEAST_ODDS, weigh_lines
from scanplan.plan.model.room_partition import join_cells
from scanplan.plan.openings import GAP, OPEN, Opening
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.rooms import parting_lines
from scanplan.plan.rooms.parting_lines import Floor
from scanplan.plan.rooms.room import Room
from scanplan.plan.tolerances import CORNER_M, END_M, FURNITURE_M2
from scanplan.rays import free_space
from scanplan.rays.face_raster import CELL_M
from scanplan.types import FloatArray

_BEYOND_M = 1.2 * END_M  # lines end at outlines that err by less


@dataclass(frozen=True, eq=False)
class Partings:
    """Where free floor is parted into rooms though no wall was seen, and how likely rightly so.

    Attributes
    ----------
    walls : list of plan_wall.PlanWall
        Thin ones without faces, each all an opening.
    places_m : (c, 2) float64
        In cells of the floor.
    whole, apart : (c,) float64
        What `room_partition.JoinedCells` says of each cell's room.
    """

    walls: list[PlanWall]
    places_m: FloatArray
    whole: FloatArray
    apart: FloatArray

    def rate_rooms(self, rooms: Sequence[Room]) -> list[Room]:
        """Return rooms with the probabilities that each is whole, and parted from all others."""
        tree = shapely.STRtree([room.polygon for room in rooms])
        place, row = tree.query(shapely.points(self.places_m), predicate="within")
        whole, apart = (np.full(len(rooms), np.inf) for _ in range(2))
        np.minimum.at(whole, row, self.whole[place])
        np.minimum.at(apart, row, self.apart[place])
        return [
            replace(room, p_whole=of_whole, p_apart=of_apart)
            for room, of_whole, of_apart in zip(
                rooms, special.expit(whole).tolist(), special.expit(apart).tolist(), strict=True
            )
        ]


def find_partings(
    bounds: wall_ground.Bounds,
    floor: Floor,
    track_m: FloatArray,
    longest_leg_m: float,
    *,
    ways_m: Sequence[FloatArray] = (),
) -> Partings:
    """Find where free floor is parted into rooms.

    There a wall was not seen, or its door was not; on the line of a wall nearby it stands in that.
    Where furniture hides most of the floor nothing is known of what is between.

    Parameters
    ----------
    bounds : wall_ground.Bounds
        What parts the floor already.
    floor : Floor
    track_m : (n, 2) float64
        Where sensors were.
    longest_leg_m : float, > 0
        Of what stands in a room, in the plane: walls as short may be sides of it.
    ways_m : sequence of (2, 2) float64
        Doors, from jamb to jamb: those that stand in no wall part floor, too.
    """
    known = overlays.buffer_shapes(overlays.unite_areas(bounds.strips), END_M)
    doors = [_make_parting(way_m, "door") for way_m in _choose_ways(ways_m, known)]
    grounds = _list_grounds(bounds, doors, floor, longest_leg_m)
    lines = parting_lines.find_lines(grounds, bounds.walls, bounds.unpaired_m)
    on = parting_lines.WallLines.of_walls(bounds.walls, bounds.unpaired_m)
    partings, places = list(doors), shapely.points(track_m)
    rated: list[FloatArray] = [np.empty((0, 4))]
    for ground, lines_m in zip(grounds, lines, strict=True):
        measures = parting_lines.measure_lines(ground, lines_m, on, floor)
        odds = weigh_lines(measures)
        is_likely = odds > LEAST_ODDS
        lines_m, odds = lines_m[is_likely], odds[is_likely]
        cells = part_ground(ground, lines_m, _BEYOND_M)
        visited = shapely.STRtree(cells.cells).query(places, "intersects")[1]
        is_visited = np.isin(np.arange(len(cells.cells)), visited)
        joined = join_cells(cells, odds, is_visited)
        middles_m = shapely.get_coordinates(shapely.point_on_surface(cells.cells))
        rated.append(np.column_stack([middles_m, joined.whole, joined.apart]))
        for row, first, last in cells.find_spans(joined.room):
            ends_m = lines_m[row, 0] + np.outer([first, last], lines_m[row, 1] - lines_m[row, 0])
            is_hidden = floor.rate_hidden(ends_m[None]) > HIDDEN_SHARE
            kind = wall_ground.UNSEEN if is_hidden.all() else GAP
            partings.append(_make_parting(_snap(ends_m, bounds.walls), kind))
    found = np.concatenate(rated)
    return Partings(partings, found[:, :2], found[:, 2], found[:, 3])


def _list_grounds(
    bounds: wall_ground.Bounds, doors: Sequence[PlanWall], floor: Floor, longest_leg_m: float
) -> list[Polygon]:
    """Return pieces of floor that nothing known parts, and what stands in them with it."""
    # no narrower than outlines err
    of_doors = wall_ground.wall_strips(doors, bounds.unpaired_m)
    grown = [overlays.buffer_shapes(strip, CELL_M, join_style="mitre") for strip in of_doors]
    solid = free_space.union_on_grid([*bounds.strips, *grown])
    # what is as narrow as a chair's leg casts a shadow, which is no place to stop at
    whole = free_space.close_shadows(floor.ground, END_M) if floor.planar else floor.ground
    free = free_space.difference_on_grid(whole, solid)
    is_long = [floor.planar and wall.length_m > longest_leg_m for wall in bounds.walls]
    walls = overlays.unite_areas(list(itertools.compress(bounds.strips, is_long)))
    filled = [_fill_islands(part, walls) for part in free_space.open_polygons(free, END_M)]
    return [part for of in filled for part in shapely.get_parts(of) if part.area > 0]


def _fill_islands(part: Polygon, walls: BaseGeometry) -> BaseGeometry:
    """Return ground with what is as small as furniture, but where walls stand."""
    holes = [Polygon(ring) for ring in part.interiors]
    small = [hole for hole in holes if hole.area <= FURNITURE_M2]
    # a wall between two doors stands alone, too
    islands = [hole for hole in small if overlays.intersect_areas(hole, walls).area < hole.area / 2]
    return overlays.unite_areas([part, *islands], grid=SHORTEST_M)


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
