"""Which pieces of questions a sensor would see from places on the floor."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.tolerances import FACING
from scanplan.plan.floorplan import WAYS, FloorPlan, centrelines_m, line_shapes
from scanplan.types import BoolArray, FloatArray, IntArray
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
    plan : FloorPlan
    height_m : float
        Of the sensor above the floor: it looks over walls that end below. NaN: over none.
    """
    is_low = plan.low & (plan.heights_m < height_m)
    is_way = np.isin(plan.openings["type"].astype(str), WAYS)
    loose = plan.faces["wall"] < 0
    ways = overlays.unite_areas(plan.gaps[is_way])
    walls = overlays.unite_areas(plan.bodies[~is_low])
    surfaces = overlays.unite_lines(line_shapes(centrelines_m(plan.faces)[loose]))
    return overlays.unite_shapes(
        [overlays.subtract_areas(walls, ways), overlays.subtract_lines(surfaces, ways)]
    )


def find_seen(views: Views, pieces: Pieces, blocked: BaseGeometry, reach: SensorReach) -> BoolArray:
    """Return which pieces (p,) are seen by which views (n,): (n, p) bool.

    A piece is seen from in front of it, less than 60 degrees aside (but for what one stands at),
    within range and in the field, where nothing stands between.

    Parameters
    ----------
    views : Views
    pieces : Pieces
    blocked : shapely geometry
        See `block_sight`.
    reach : SensorReach
    """
    shapely.prepare(blocked)
    seen = np.zeros((len(views.place_m), len(pieces.share)), bool)
    places_m, place = np.unique(views.place_m, axis=0, return_inverse=True)
    place = place.reshape(-1)
    for number, place_m in enumerate(places_m):
        piece, way_m = _find_clear(place_m, pieces, blocked, reach.range_m)
        bearing_rad = np.arctan2(way_m[:, 1], way_m[:, 0])
        for view in np.flatnonzero(place == number):
            shown = piece
            if reach.field_rad < 2 * np.pi:
                off_rad = bearing_rad - views.heading_rad[view]
                off_rad = np.abs((off_rad + np.pi) % (2 * np.pi) - np.pi)
                shown = piece[off_rad <= reach.field_rad / 2]
            seen[view, shown] = True
    return seen


def _find_clear(
    place_m: FloatArray, pieces: Pieces, blocked: BaseGeometry, range_m: float
) -> tuple[IntArray, FloatArray]:
    """Return the pieces (c,) that one looks at freely from a place, and the ways (c, 2) to them.

    One that is seen from either side stands twice.
    """
    way_m = pieces.place_m - place_m
    is_stood_at = np.isfinite(pieces.reach_m)[:, None]
    apart_m = np.hypot(way_m[..., 0], way_m[..., 1])
    toward_m = -(way_m * pieces.normal).sum(axis=-1)
    is_near = apart_m <= np.minimum(pieces.reach_m, range_m)[:, None]
    piece, side = np.nonzero((is_stood_at | (toward_m >= FACING * apart_m)) & is_near)
    ends_m = pieces.place_m[piece, side]
    sights = shapely.linestrings(np.stack([np.broadcast_to(place_m, ends_m.shape), ends_m], 1))
    clear = np.flatnonzero(~shapely.intersects(blocked, sights))
    return piece[clear], way_m[piece[clear], side[clear]]
