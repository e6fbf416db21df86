"""How high the ceiling is over a floor with lowered and sloping ceilings and beams."""

from collections.abc import Sequence

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.lab.buildings.details.things import DrawnCeiling, Plane


def part_below(area: BaseGeometry, plane: Plane, other: Plane) -> BaseGeometry:
    """Return the part of an area over which a plane lies lower than another."""
    slope = np.array([plane.rise_x - other.rise_x, plane.rise_y - other.rise_y])
    above_m = plane.level_m - other.level_m
    steepness = np.hypot(*slope)
    if steepness < 1e-9 or area.is_empty:
        return area if above_m < 0 and not area.is_empty else Polygon()
    # lower on the side of a line that its slope leads down to: a square as large as the area there
    down = -slope / steepness
    middle_m = np.array([area.centroid.x, area.centroid.y])
    x0, y0, x1, y1 = area.bounds
    size_m = 2 * float(np.hypot(x1 - x0, y1 - y0))
    above_middle_m = float(above_m + middle_m @ slope)
    on_line_m = middle_m + down * above_middle_m / steepness
    along = size_m * np.array([-down[1], down[0]])
    # the line may run far beside the area, which is then wholly on one side
    reach_m = size_m + abs(above_middle_m) / steepness
    corners_m = [on_line_m - along, on_line_m + along]
    corners_m += [on_line_m + along + down * reach_m, on_line_m - along + down * reach_m]
    return overlays.intersect_areas(area, Polygon(corners_m))


def low_ground(ceiling: DrawnCeiling, z_m: float) -> BaseGeometry:
    """Return the ground over which a ceiling's underside is lower than a height."""
    return part_below(ceiling.footprint_m, ceiling.underside, Plane(z_m))


def ceiling_range(
    room: BaseGeometry, ceilings: Sequence[DrawnCeiling], main_m: float
) -> tuple[float, float]:
    """Return the least and the greatest height of the ceiling over a room.

    Strips narrower than 2 cm, which a drawing leaves between a ceiling and the walls, do not count.
    """
    surfaces = [(room, Plane(main_m))]
    surfaces += [(overlays.intersect_areas(room, c.footprint_m), c.underside) for c in ceilings]
    heights_m = []
    for row, (area, plane) in enumerate(surfaces):
        lower = [
            part_below(other, other_plane, plane)
            for other_row, (other, other_plane) in enumerate(surfaces)
            if other_row != row
        ]
        open_area = overlays.subtract_areas(area, overlays.unite_areas(lower))
        wide = [
            p for p in shapely.get_parts(open_area) if not overlays.buffer_shapes(p, -0.01).is_empty
        ]
        heights_m += [plane.heights(shapely.get_coordinates(part)) for part in wide]
    if not heights_m:
        return main_m, main_m
    over_m = np.concatenate(heights_m)
    return float(over_m.min()), float(over_m.max())
