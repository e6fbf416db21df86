"""What a drawing leaves out and a low scanner sees: chairs about the floor, doors left ajar."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import shapely
from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.lab.buildings import building, extrusion, truth
from scanplan.lab.buildings.building_route import ROVER_RADIUS_M
from scanplan.lab.random_streams import RandomStream, open_stream
from scanplan.types import FloatArray

# ASSUME a visitor's chair: a seat as high as wide, legs under its corners, as thick as a leaf
_CHAIR_M = (0.42, 0.03)


def add_clutter(
    site: building.Building, *, chairs: int, doors_ajar: float, seed: int
) -> building.Building:
    """Return a building with chairs on its floor and leaves in some of its doors.

    All keep clear of the rover's way. They occlude walls in the truth, and are none.

    Parameters
    ----------
    site : building.Building
        With a way.
    chairs : int, >= 0
        On the whole floor; fewer where no place is left for them.
    doors_ajar : float, 0 to 1
        Share of the doors without a leaf in which one stands open; the others have none.
    """
    generator = open_stream(seed, RandomStream.CLUTTER)
    track = overlays.buffer_shapes(LineString(site.waypoints_m), 1.2 * ROVER_RADIUS_M)
    taken = overlays.unite_areas([track, site.obstacles_m])
    shapely.prepare(taken)
    openings = [feature for feature in site.truth if feature[1]["kind"] == "opening"]
    hung = {values["opening"] for _, values in site.truth if values["kind"] == "leaf"}
    doors = [
        line
        for row, (line, values) in enumerate(openings)
        if values["type"] == "door" and row not in hung
    ]
    leaves = list(_draw_leaves(doors, doors_ajar, track, generator))
    legs = [
        leg
        for chair in _draw_chairs(site.floor_m, taken, leaves, chairs, generator)
        for leg in chair
    ]
    if not leaves and not legs:
        return site
    soups = [("door", extrusion.extrude_bands([(0.0, 2.0, leaf)])) for leaf in leaves]
    soups += [("furniture", extrusion.extrude_bands([(0.0, _CHAIR_M[0], leg)])) for leg in legs]
    outlines = [LineString(side) for leaf in leaves for side in _sides(leaf)]
    return replace(
        site,
        mesh=extrusion.extend_mesh(site.mesh, soups),
        truth=[*site.truth, *map(truth.screen_feature, outlines)],
        obstacles_m=overlays.unite_areas([site.obstacles_m, *leaves, *legs]),
    )


def _sides(polygon: Polygon) -> FloatArray:
    """Return the edges (n, 2, 2) of a polygon."""
    corners = shapely.get_coordinates(polygon.exterior)
    return np.stack([corners[:-1], corners[1:]], axis=1)


def _draw_leaves(
    doors: Sequence[BaseGeometry], share: float, track: BaseGeometry, generator: np.random.Generator
) -> Iterator[Polygon]:
    """Yield leaves that hang on either jamb and open to either side, where the way lets them."""
    for door in doors:
        is_ajar, hinge, side = generator.random(3) < (share, 0.5, 0.5)
        # ASSUME a leaf left standing is open by a quarter of a half turn at least
        turn_rad = np.radians(generator.uniform(45, 110))
        ends = shapely.get_coordinates(door)
        pivot, other = ends if hinge else ends[::-1]
        turn = turn_rad if side else -turn_rad
        rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        leaf = LineString([pivot, pivot + rotation @ (other - pivot)])
        body = overlays.buffer_shapes(leaf, _CHAIR_M[1] / 2, cap_style="flat")
        if is_ajar and not body.intersects(track):
            yield body


def _draw_chairs(
    floor: BaseGeometry,
    taken: BaseGeometry,
    leaves: Sequence[Polygon],
    count: int,
    generator: np.random.Generator,
) -> Iterator[list[Polygon]]:
    """Yield the legs of chairs that stand clear of all else, turned anyhow."""
    low_x, low_y, high_x, high_y = floor.bounds
    standing: list[BaseGeometry] = list(leaves)
    seat_m, leg_m = _CHAIR_M
    for _ in range(count):
        # so many places for one that is clear: where none is, the floor is full
        for place in generator.uniform((low_x, low_y), (high_x, high_y), (200, 2)):
            turn_deg = generator.uniform(0.0, 90.0)
            seat = _square(place, seat_m, turn_deg)
            is_clear = floor.contains(seat) and not taken.intersects(seat)
            if is_clear and not any(other.intersects(seat) for other in standing):
                standing.append(seat)
                corners = shapely.get_coordinates(_square(place, seat_m - leg_m, turn_deg))[:4]
                yield [_square(corner, leg_m, turn_deg) for corner in corners]
                break


def _square(centre: FloatArray, side_m: float, turn_deg: float) -> Polygon:
    x, y = centre
    half_m = side_m / 2
    square = shapely.box(x - half_m, y - half_m, x + half_m, y + half_m)
    return shapely.affinity.rotate(square, turn_deg)
