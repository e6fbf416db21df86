"""Leaves hung at random in doors that a drawing or a building model shows as holes."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import ArrayLike
from shapely import LineString
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.lab.buildings import building, detailed_truth, extrusion, ground, truth
from scanplan.lab.buildings.building_route import ROVER_RADIUS_M
from scanplan.lab.buildings.details import solids
from scanplan.lab.buildings.details.leaves import LeafBody, stand_leaves
from scanplan.lab.buildings.details.things import DrawnLeaf, DrawnOpening
from scanplan.lab.random_streams import RandomStream, open_stream

# ASSUME how doors stand in a building that is in use: share of them, and between which angles
_STATES = (
    ("shut", 0.3, (0.0, 0.0)),
    ("ajar", 0.15, (5.0, 30.0)),
    ("open", 0.4, (70.0, 95.0)),
    ("on the wall", 0.15, (180.0, 180.0)),
)


def widen_track(waypoints_m: ArrayLike, reach_m: float = 0.0) -> BaseGeometry:
    """Return the ground that a rover's way (n, 2) needs, whose sensor reaches so far ahead."""
    clearance_m = max(ROVER_RADIUS_M, reach_m)
    return overlays.buffer_shapes(LineString(np.asarray(waypoints_m, float)), 1.2 * clearance_m)


def hang_leaves(
    site: building.Building,
    *,
    share: float,
    seed: int,
    slice_height_m: float,
    planar: bool = False,
    track: BaseGeometry | None = None,
) -> building.Building:
    """Return a building with leaves in some of its doors that have none.

    ASSUME 30 % of them are shut, 15 % ajar by 5 to 30 degrees, 40 % open by 70 to 95 and 15 % by
    180, that doors wider than 1.4 m are double, and that leaves are 4 cm thick. A leaf that would
    stand in a wall, in furniture, in another leaf or in the rover's way is drawn again.

    Parameters
    ----------
    share : float, 0 to 1
        Of its doorways that get a leaf.
    slice_height_m, planar
        See `building.load_building`.
    track : shapely geometry or None
        Ground of the rover's way where it is given, see `widen_track`; one that is yet to be
        planned goes around them.

    Returns
    -------
    building.Building
        The same object where no leaf is hung; with a note where there is no doorway.
    """
    if share > 0 and not site.doorways:
        note = "simulate.site.leaves: the building tells of no door without a leaf; none is hung"
        return replace(site, notes=(*site.notes, note))
    taken = site.obstacles_m
    if track is not None:
        taken = overlays.unite_each(taken, track)
    hung: list[tuple[int, list[LeafBody]]] = []
    for row, opening in site.doorways:
        generator = open_stream(seed, RandomStream.LEAVES, row)
        if generator.random() < share:
            stands = (b for b in _draw_leaves(opening, generator) if _is_free(b, taken))
            bodies = next(stands, [])
            taken = overlays.unite_areas([taken, *(body.footprint_m for body in bodies)])
            hung.append((row, bodies))
    bodies = [body for _, leaves in hung for body in leaves]
    if not bodies:
        return site
    lowest_m = ground.least_screen_m(slice_height_m, planar=planar)
    sides = [line for b in bodies if b.high_m >= lowest_m for line in _sides(b.footprint_m)]
    features = [truth.screen_feature(line) for line in sides]
    features += [f for row, leaves in hung for f in detailed_truth.leaf_features(row, leaves)]
    rows_hung = {row for row, leaves in hung if leaves}
    return replace(
        site,
        mesh=extrusion.extend_mesh(site.mesh, solids.leaf_soups(bodies)),
        truth=[*site.truth, *features],
        obstacles_m=overlays.unite_areas(
            [site.obstacles_m, *(body.footprint_m for body in bodies)]
        ),
        doorways=tuple(doorway for doorway in site.doorways if doorway[0] not in rows_hung),
    )


def _draw_leaves(opening: DrawnOpening, generator: np.random.Generator) -> Iterator[list[LeafBody]]:
    """Yield the leaves of a door in one state after another, drawn at random."""
    shares = np.array([share for _, share, _ in _STATES])
    # ASSUME the widest single leaf of a dwelling or office is 1.25 m (DIN 18101)
    is_double = opening.clear_line_m.length > 1.4
    # after so many that its surroundings do not let stand a door keeps none
    for _ in range(12):
        low_deg, high_deg = _STATES[generator.choice(len(_STATES), p=shares)][2]
        leaf = DrawnLeaf(
            type="double" if is_double else "hinged",
            open_deg=round(float(generator.uniform(low_deg, high_deg)), 1),
            hinge=("start", "end")[generator.integers(2)],
            side=("left", "right")[generator.integers(2)],
        )
        yield stand_leaves(replace(opening, leaf=leaf))


def _is_free(bodies: list[LeafBody], taken: BaseGeometry) -> bool:
    """Return whether leaves stand in nothing else; what they touch, such as a jamb, is let be."""
    cores = [overlays.buffer_shapes(body.footprint_m, -0.9 * body.drawn.play_m) for body in bodies]
    return not any(core.intersects(taken) for core in cores)


def _sides(footprint_m: shapely.Polygon) -> list[LineString]:
    """Return the edges of a leaf seen from above."""
    corners_m = shapely.get_coordinates(footprint_m)
    return [LineString(pair) for pair in pairwise(corners_m)]
