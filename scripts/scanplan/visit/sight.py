"""Which pieces of questions a sensor would see from places on the floor."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry.tolerances import FACING
from scanplan.plan.floorplan import WAYS, FloorPlan, centrelines_m, line_shapes
from scanplan.types import BoolArray, FloatArray
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
    walls = shapely.union_all(plan.bodies[~is_low])
    surfaces = shapely.union_all(line_shapes(centrelines_m(plan.faces)[loose]))
    blocked = shapely.union(walls, surfaces)
    return shapely.difference(blocked, shapely.union_all(plan.gaps[is_way]))


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
    range_m = np.minimum(pieces.reach_m, reach.range_m)[:, None]
    is_stood_at = np.isfinite(pieces.reach_m)[:, None]
    seen = np.zeros((len(views.place_m), len(pieces.share)), bool)
    for view, (place_m, heading_rad) in enumerate(
        zip(views.place_m, views.heading_rad, strict=True)
    ):
        way_m = pieces.place_m - place_m
        apart_m = np.hypot(way_m[..., 0], way_m[..., 1])
        toward_m = -(way_m * pieces.normal).sum(axis=-1)
        may = (is_stood_at | (toward_m >= FACING * apart_m)) & (apart_m <= range_m)
        if reach.field_rad < 2 * np.pi:
            off_rad = np.arctan2(way_m[..., 1], way_m[..., 0]) - heading_rad
            may &= np.abs((off_rad + np.pi) % (2 * np.pi) - np.pi) <= reach.field_rad / 2
        piece, side = np.nonzero(may)
        ends_m = pieces.place_m[piece, side]
        sights = shapely.linestrings(np.stack([np.broadcast_to(place_m, ends_m.shape), ends_m], 1))
        seen[view, piece[~shapely.intersects(blocked, sights)]] = True
    return seen
