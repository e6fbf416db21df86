"""From a drawn floor to the triangles that rays hit."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.lab.buildings import drawn_floor
from scanplan.lab.buildings.details import leaves, solids
from scanplan.lab.buildings.details.triangles import extrude_bands, triangulate
from scanplan.types import FloatArray, IntArray

SURFACES = (
    *("wall", "floor", "ceiling", "furniture", "glass", "door", "other"),
    *("mirror", "polished"),
)


@dataclass(frozen=True)
class Mesh:
    """Triangles in the map frame, their normals out of the matter by the right-hand rule.

    Attributes
    ----------
    vertices_m : (v, 3) float64
    triangles : (t, 3) int32
        Rows of `vertices_m`.
    surface : (t,) uint8
        Index in `SURFACES`.
    """

    vertices_m: FloatArray
    triangles: IntArray
    surface: IntArray


def make_building_mesh(plan: drawn_floor.DrawnFloor) -> Mesh:
    """Return the mesh of a floor: closed walls and furniture between floor and ceiling.

    Floor and ceiling run through under and above the walls, so that no gap opens where they meet.
    Windows and doors are empty space (thesis, section 4.1), but for those that are drawn glazed.

    Returns
    -------
    Mesh
    """
    footprint = drawn_floor.floor_footprint(plan)
    soups = [
        ("wall", extrude_bands(drawn_floor.cut_wall_bands(plan, glass=False))),
        *solids.floor_soups(footprint, plan.voids, plan.polished_m),
        ("ceiling", triangulate(footprint, plan.height_m, up=False)),
    ]
    for box in plan.furniture:
        soups.append(solids.box_soup("furniture", box.footprint_m, box.base_m, box.height_m))
    for opening in plan.openings:
        if opening.glazed:
            soups.append(solids.box_soup("glass", opening.pane_m, opening.sill_m, opening.lintel_m))
    if plan.is_detailed:
        soups += _detail_soups(plan)
        soups += [solids.ground_soup(ground, footprint) for ground in plan.grounds]
    return join_meshes(soups)


def _detail_soups(plan: drawn_floor.DrawnFloor) -> list[solids.Soup]:
    soups = []
    if any(wall.is_glass for wall in plan.walls):
        soups.append(("glass", extrude_bands(drawn_floor.cut_wall_bands(plan, glass=True))))
    soups += solids.glass_frame_soups(plan.openings)
    bodies = [body for opening in plan.openings for body in leaves.stand_leaves(opening)]
    soups += solids.leaf_soups(bodies)
    soups += [solids.box_soup("wall", c.footprint_m, 0.0, c.height_m) for c in plan.columns]
    soups += [solids.ceiling_soup(ceiling, plan.height_m) for ceiling in plan.ceilings]
    soups += [step for stairs in plan.stairs for step in solids.stair_soups(stairs)]
    soups += [solids.box_soup("floor", p.footprint_m, 0.0, p.height_m) for p in plan.platforms]
    soups += map(solids.mirror_soup, plan.mirrors)
    soups += map(solids.facade_soup, plan.facades)
    return soups


def join_meshes(soups: Sequence[tuple[str, FloatArray]]) -> Mesh:
    """Return one mesh of triangles given by the kind of their surface.

    Parameters
    ----------
    soups : sequence of (str, (t, 3, 3) float64)
        One of `SURFACES` and the corners of triangles.

    Returns
    -------
    Mesh
        The triangles in the order given, equal corners stored once.
    """
    corners = np.concatenate([np.empty((0, 3, 3)), *(soup for _, soup in soups)]).reshape(-1, 3)
    vertices, inverse = np.unique(corners, axis=0, return_inverse=True)
    kinds = [SURFACES.index(name) for name, _ in soups]
    surface = np.repeat(kinds, [len(soup) for _, soup in soups])
    return Mesh(vertices, inverse.reshape(-1, 3).astype(np.int32), surface.astype(np.uint8))


def extend_mesh(mesh: Mesh, soups: Sequence[tuple[str, FloatArray]]) -> Mesh:
    """Return a mesh with more triangles, given as `join_meshes` takes them, behind its own."""
    more = join_meshes(soups)
    return Mesh(
        np.concatenate([mesh.vertices_m, more.vertices_m]),
        np.concatenate([mesh.triangles, more.triangles + np.int32(len(mesh.vertices_m))]),
        np.concatenate([mesh.surface, more.surface]),
    )
