"""Which pieces of questions a sensor would see from places on the floor."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.tolerances import FACING
from scanplan.plan.floorplan import WAYS, FloorPlan, centrelines_m, line_shapes
from scanplan.types import FloatArray, IntArray
from scanplan.visit.questions import Pieces
from scanplan.visit.sensor_reach import SensorReach


@dataclass(frozen=True, eq=False)
class Views:
    """Places with the directions that a sensor looks in there.

    Attributes
    ----------
    place_m : (n, 2) float64
    heading_rad : (n,) float64
        Of the middle of its field; NaN where it sees all around.
    """

    place_m: FloatArray
    heading_rad: FloatArray


def turn_views(place_m: FloatArray, reach: SensorReach) -> Views:
    """Return places (n, 2) with as many headings as it takes to see everything twice around."""
    if reach.field_rad >= 2 * np.pi:
        return Views(place_m, np.full(len(place_m), np.nan))
    n_headings = int(np.ceil(4 * np.pi / reach.field_rad))
    heading_rad = 2 * np.pi * np.arange(n_headings) / n_headings
    return Views(np.repeat(place_m, n_headings, axis=0), np.tile(heading_rad, len(place_m)))


def block_sight(plan: FloorPlan, height_m: float) -> BaseGeometry:
    """Return what a sensor cannot look through: walls and single surfaces, less doors and passages.

    Parameters
    ----------
    height_m : float
        Of the sensor above the floor: it looks over walls that end below. NaN: over none.
    """
    is_low = plan.low & (plan.heights_m < height_m)
    is_way = np.isin(plan.openings["type"].astype(str), WAYS)
    loose = plan.faces["wall"] < 0
    open_area = overlays.unite_areas(plan.gaps[is_way])
    walls = overlays.unite_areas(plan.bodies[~is_low])
    surfaces = overlays.unite_lines(line_shapes(centrelines_m(plan.faces)[loose]))
    return overlays.unite_shapes(
        [overlays.subtract_areas(walls, open_area), overlays.subtract_lines(surfaces, open_area)]
    )


def find_seen(
    views: Views, pieces: Pieces, blocked: BaseGeometry, reach: SensorReach
) -> list[IntArray]:
    """Return which pieces each of the views (n,) sees, increasing.

    A piece is seen from in front of it, less than 60 degrees aside (but for what one stands at),
    within range and in the field, where nothing stands between.

    Parameters
    ----------
    blocked : shapely geometry
        See `block_sight`.
    """
    shapely.prepare(blocked)
    pieces_of_view: list[IntArray] = [np.empty(0, np.int64)] * len(views.place_m)
    places_m, place, n_views = np.unique(
        views.place_m, axis=0, return_inverse=True, return_counts=True
    )
    views_at = np.split(np.argsort(place.reshape(-1), kind="stable"), np.cumsum(n_views)[:-1])
    tree = shapely.STRtree(np.asarray(shapely.points(pieces.place_m[:, 0])))
    # a piece that is seen from either side is found by the one
    apart_m = np.hypot(*(pieces.place_m[:, 1] - pieces.place_m[:, 0]).T)
    around_m = reach.range_m + np.nanmax(apart_m, initial=0.0)
    for place_m, views_here in zip(places_m, views_at, strict=True):
        near = np.sort(tree.query(shapely.Point(place_m), predicate="dwithin", distance=around_m))
        piece, way_m = _find_clear(place_m, pieces, near, blocked, reach.range_m)
        bearing_rad = np.arctan2(way_m[:, 1], way_m[:, 0])
        for view in views_here.tolist():
            shown = piece
            if reach.field_rad < 2 * np.pi:
                off_rad = bearing_rad - views.heading_rad[view]
                off_rad = np.abs((off_rad + np.pi) % (2 * np.pi) - np.pi)
                shown = piece[off_rad <= reach.field_rad / 2]
            pieces_of_view[view] = np.unique(shown)
    return pieces_of_view


def _find_clear(
    place_m: FloatArray, pieces: Pieces, near: IntArray, blocked: BaseGeometry, range_m: float
) -> tuple[IntArray, FloatArray]:
    """Return those of some pieces (c,) that one looks at freely from a place, and the ways (c, 2).

    One that is seen from either side stands twice.
    """
    way_m = pieces.place_m[near] - place_m
    reach_m = pieces.reach_m[near]
    is_stood_at = np.isfinite(reach_m)[:, None]
    apart_m = np.hypot(way_m[..., 0], way_m[..., 1])
    toward_m = -(way_m * pieces.normal[near]).sum(axis=-1)
    is_near = apart_m <= np.minimum(reach_m, range_m)[:, None]
    row, side = np.nonzero((is_stood_at | (toward_m >= FACING * apart_m)) & is_near)
    ends_m = pieces.place_m[near[row], side]
    sights = shapely.linestrings(np.stack([np.broadcast_to(place_m, ends_m.shape), ends_m], 1))
    clear = np.flatnonzero(~shapely.intersects(blocked, sights))
    return near[row[clear]], way_m[row[clear], side[clear]]
