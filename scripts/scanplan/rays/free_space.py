"""Free floor: of each scan, and of all scans together."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import shapely
from shapely.geometry import MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.rays import ray_set
from scanplan.rays.beam_spread import column_spacing_rad
from scanplan.rays.ray_set import RaySet
from scanplan.types import Array, FloatArray

_SECTOR_RAD = np.radians(0.5)
_SPARE = 1.1  # a sector is so much wider than what has to be in it, however rays fall
_SIMPLIFY_M = 0.02  # what an outline may err by: spikes of twice that on either side are no floor
GRID_M = (
    SHORTEST_M  # corners of grounds lie on this: GEOS needs one, and nothing is surveyed as well
)


def free_polygons(rays: RaySet) -> list[MultiPolygon]:
    """Return the free floor of each scan as polygons.

    In every half degree (more where a sensor's rays are further apart) a ray of the longest tenth
    shows how far one can see; a planar scan has one ray a direction, and its outline runs from one
    to the next, where no ray counts for farther than both beside it. Where no ray came back from in
    two sectors on end nothing is known. Outlines err by 2 cm, and beside an edge by half of what is
    between two rays; spikes thinner than 8 cm are taken off.

    Returns
    -------
    list of shapely geometry
        A polygon, polygons, or an empty one, per scan.
    """
    find_outline = _outline_of_beams if rays.planar else _outline_of_sectors
    outlines_m = (
        sensor_m[:2] + find_outline(*polar)
        for sensor_m, polar in zip(rays.sensors_m, rays.headings(), strict=True)
    )
    return [_make_star(outline_m) for outline_m in outlines_m]


def find_seen_floor(
    scans: Iterable[tuple[int, FloatArray]], sensors_m: Mapping[int, FloatArray]
) -> MultiPolygon:
    """Return the floor that planar scans saw together.

    Parameters
    ----------
    scans : iterable of (int, (n, 3) float64)
        Scan ids and points, map frame.
    sensors_m : dict of int to (3,) float64
        Where the sensor was, by scan id, map frame.
    """
    rays = ray_set.gather_rays(scans, sensors_m, planar=True)
    return union_on_grid(free_polygons(rays))


def _make_star(outline_m: FloatArray) -> MultiPolygon:
    if len(outline_m) < 3:
        return MultiPolygon()
    star = overlays.simplify_shapes(overlays.repair_areas(Polygon(outline_m)), _SIMPLIFY_M)
    return union_on_grid(open_polygons(star, 2 * _SIMPLIFY_M))


def _outline_of_beams(azimuth_rad: FloatArray, way_m: FloatArray) -> FloatArray:
    """Return the outline (n, 2) that a planar scan's rays end at, from its sensor."""
    if not len(azimuth_rad):
        return np.empty((0, 2))
    # of two returns in one direction the nearer ends it
    first = np.flatnonzero(np.diff(azimuth_rad, prepend=-np.inf) > 0)
    range_m = np.minimum.reduceat(np.hypot(way_m[:, 0], way_m[:, 1]), first)
    width_rad = _sector_rad(azimuth_rad, way_m)
    azimuth_rad = azimuth_rad[first]
    is_gap = np.diff(azimuth_rad, append=azimuth_rad[0] + 2 * np.pi) > 2 * width_rad
    # one stray point would open a way through a wall
    after_m = np.where(is_gap, 0.0, np.roll(range_m, -1))
    before_m = np.where(np.roll(is_gap, 1), 0.0, np.roll(range_m, 1))
    reach_m = np.minimum(range_m, np.maximum(after_m, before_m))
    ends_m = np.column_stack([np.cos(azimuth_rad), np.sin(azimuth_rad)]) * reach_m[:, None]
    # between two rays with a gap between them nothing is known but the sensor's place
    return np.insert(ends_m, np.flatnonzero(is_gap) + 1, 0.0, axis=0)


def _sector_rad(azimuth_rad: FloatArray, way_m: FloatArray) -> float:
    """Return how wide a sector of a scan is that has a ray in it, unless nothing came back."""
    steps_rad = np.diff(azimuth_rad)
    steps_rad = steps_rad[steps_rad > 0]
    two_rays_rad = 2 * float(np.median(steps_rad)) if len(steps_rad) else 0.0
    return max(_SECTOR_RAD, _SPARE * max(two_rays_rad, column_spacing_rad(azimuth_rad, way_m)))


def _outline_of_sectors(azimuth_rad: FloatArray, way_m: FloatArray) -> FloatArray:
    """Return the outline (n, 2) that a scan's rays reach in each sector, from its sensor."""
    range_m = np.hypot(way_m[:, 0], way_m[:, 1])
    width_rad = _sector_rad(azimuth_rad, way_m)
    count = max(int(2 * np.pi / width_rad), 3)
    width_rad = 2 * np.pi / count
    sector = np.minimum(((azimuth_rad + np.pi) / width_rad).astype(np.int64), count - 1)
    reach_m = np.zeros(count)
    first = np.searchsorted(sector, np.arange(count + 1))
    number = np.diff(first)
    # a sector a row: much faster to sort than all rays at once
    by_sector = np.full((count, number.max(initial=0)), np.inf)
    by_sector[sector, np.arange(len(sector)) - first[sector]] = range_m
    by_sector.sort(axis=1)
    # not the longest of all: one stray point would open a way through a wall
    filled = np.flatnonzero(number)
    reach_m[filled] = by_sector[filled, (0.9 * (number[filled] - 1)).astype(np.int64)]
    edge = -np.pi + width_rad * np.arange(count + 1)
    begin, end = (
        np.column_stack([np.cos(e), np.sin(e)]) * reach_m[:, None] for e in (edge[:-1], edge[1:])
    )
    return np.stack([begin, end], axis=1).reshape(-1, 2)


def driven_ground(track_m: FloatArray, *, width_m: float, max_step_m: float) -> Array:
    """Return the polygons (k,) that were driven over between places, one after the other.

    Nothing stood there, whatever shadows of chairs and of people leave of it unseen.

    Parameters
    ----------
    track_m : (n, 2) float64
        Where sensors were, in order.
    width_m : float
        Of what carried them, at least.
    max_step_m : float
        Between places farther apart the way is not known.
    """
    is_known = np.hypot(*np.diff(track_m, axis=0).T) <= max_step_m
    steps_m = np.stack([track_m[:-1], track_m[1:]], axis=1)[is_known]
    return overlays.buffer_shapes(shapely.linestrings(steps_m), width_m / 2)


def union_on_grid(polygons: Sequence[BaseGeometry]) -> MultiPolygon:
    """Return the union of polygons, polygons whose corners are on a grid of a millimetre."""
    return (
        polygon_parts(overlays.unite_areas(polygons, grid=GRID_M))
        if len(polygons)
        else MultiPolygon()
    )


def difference_on_grid(ground: BaseGeometry, taken: BaseGeometry) -> MultiPolygon:
    """Return what of ground is not taken, polygons whose corners are on a grid of a millimetre.

    Without a grid GEOS 3.14 may return nothing where the ground just fills a hole of what is taken.
    """
    return polygon_parts(overlays.subtract_areas(polygon_parts(ground), taken, grid=GRID_M))


def open_polygons(ground: BaseGeometry, half_m: float) -> list[Polygon]:
    """Return ground without what is narrower than twice a width, its corners sharp.

    Each is grown by itself and within the ground: at a blunt, narrow end the mitre reaches on,
    maybe through a wall or into what a neck leads to.

    Returns
    -------
    list of shapely.Polygon
    """
    ground = polygon_parts(ground)
    opened = []
    for core in polygon_parts(overlays.buffer_shapes(ground, -half_m, join_style="mitre")).geoms:
        grown = overlays.buffer_shapes(core, half_m, join_style="mitre")
        # GEOS 3.14 makes nested shells of some mitres, which no overlay takes
        # or shells that touch along a line, which stays when they are repaired
        grown = grown if grown.is_valid else polygon_parts(overlays.repair_areas(grown))
        grown = overlays.intersect_areas(grown, ground, grid=GRID_M)
        opened += [part for part in polygon_parts(grown).geoms if part.intersects(core)]
    return opened


def close_shadows(ground: BaseGeometry, half_m: float) -> BaseGeometry:
    """Return ground with what is narrower than twice a width between parts of it."""
    grown = overlays.buffer_shapes(ground, half_m, join_style="mitre")
    return overlays.unite_each(overlays.buffer_shapes(grown, -half_m, join_style="mitre"), ground)


def polygon_parts(geometry: BaseGeometry) -> MultiPolygon:
    """Return what of a geometry has an area."""
    parts = [p for p in shapely.get_parts(geometry) if p.geom_type == "Polygon" and p.area > 0]
    parts += [
        q
        for p in shapely.get_parts(geometry)
        if p.geom_type == "MultiPolygon"
        for q in p.geoms
        if q.area > 0
    ]
    return MultiPolygon(parts)
