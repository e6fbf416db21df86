"""The surfaces of drawn things: pairs of a kind of surface and triangles, normals outwards."""

from collections.abc import Iterable

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.lab.buildings.details import leaves, triangles
from scanplan.lab.buildings.details.things import (
    DrawnCeiling,
    DrawnFacade,
    DrawnGround,
    DrawnMirror,
    DrawnOpening,
    DrawnStairs,
    DrawnVoid,
)
from scanplan.types import FloatArray

Soup = tuple[str, FloatArray]
"""Kind of surface and corners of its triangles (t, 3, 3)."""


def box_soup(kind: str, footprint_m: BaseGeometry, low_m: float, high_m: float) -> Soup:
    """Return an upright body of one kind of surface."""
    return kind, triangles.extrude_bands([(low_m, high_m, footprint_m)])


def leaf_soups(bodies: Iterable[leaves.LeafBody]) -> list[Soup]:
    """Return the leaves of doors as they stand."""
    return [
        box_soup("glass" if b.drawn.is_glass else "door", b.footprint_m, b.low_m, b.high_m)
        for b in bodies
    ]


def glass_frame_soups(openings: Iterable[DrawnOpening]) -> list[Soup]:
    """Return the frames of openings in panes; those in walls are of the wall's own surface."""
    framed = [o for o in openings if o.in_glass and o.frame_m > 0]
    return [("door", triangles.extrude_bands(leaves.frame_bands(o))) for o in framed]


def ceiling_soup(ceiling: DrawnCeiling, main_m: float) -> Soup:
    """Return a lowered or sloping ceiling or a beam, up to the main ceiling."""
    return "ceiling", triangles.extrude_under(ceiling.footprint_m, ceiling.underside, main_m)


def floor_soups(
    footprint_m: BaseGeometry, voids: Iterable[DrawnVoid], polished_m: Iterable[Polygon]
) -> list[Soup]:
    """Return the floor without its voids, their shafts and floors, and what is polished of it."""
    voids = list(voids)
    solid = footprint_m
    if voids:
        solid = overlays.subtract_areas(solid, overlays.unite_areas([v.footprint_m for v in voids]))
    polished = overlays.unite_areas(list(polished_m))
    soups = []
    if not polished.is_empty:
        shining = overlays.intersect_areas(solid, polished)
        solid = overlays.subtract_areas(solid, polished)
        soups.append(("polished", triangles.triangulate(shining, 0.0, up=True)))
    soups.insert(0, ("floor", triangles.triangulate(solid, 0.0, up=True)))
    for void in voids:
        soups.append(("wall", triangles.line_shaft(void.footprint_m, void.depth_m)))
        soups.append(("floor", triangles.triangulate(void.footprint_m, -void.depth_m, up=True)))
    return soups


def stair_treads(stairs: DrawnStairs) -> list[tuple[Polygon, float]]:
    """Return the ground of every step and its height, from the first edge on."""
    near_a, near_b, far_b, far_a = shapely.get_coordinates(stairs.footprint_m)[:4]
    shares = np.linspace(0.0, 1.0, stairs.steps + 1)[:, None]
    side_a = near_a + shares * (far_a - near_a)
    side_b = near_b + shares * (far_b - near_b)
    return [
        (
            Polygon([side_a[i], side_b[i], side_b[i + 1], side_a[i + 1]]),
            stairs.rise_m * (i + 1) / stairs.steps,
        )
        for i in range(stairs.steps)
    ]


def stair_soups(stairs: DrawnStairs) -> list[Soup]:
    """Return steps, solid down to the floor, or a step below the last that leads down."""
    base_m = min(0.0, stairs.rise_m * (1 + 1 / stairs.steps))
    return [box_soup("other", tread, base_m, height_m) for tread, height_m in stair_treads(stairs)]


def mirror_soup(mirror: DrawnMirror) -> Soup:
    """Return a mirror's slab."""
    return box_soup("mirror", mirror.slab_m, mirror.sill_m, mirror.lintel_m)


def ground_soup(ground: DrawnGround, footprint_m: BaseGeometry) -> Soup:
    """Return ground outside a building."""
    outside = overlays.subtract_areas(ground.footprint_m, footprint_m)
    return "other", triangles.triangulate(outside, ground.z_m, up=True)


def facade_soup(facade: DrawnFacade) -> Soup:
    """Return a front outside."""
    return box_soup("wall", facade.slab_m, facade.base_m, facade.height_m)
