"""What joins the elements of a building model: walls that meet, and what bounds each room."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
from ifcopenshell import entity_instance
from shapely.geometry.base import BaseGeometry

from scanplan.exports.envelope import NEAR_M
from scanplan.exports.ifc_elements.openings import Opening
from scanplan.exports.ifc_elements.spaces import floor_parts
from scanplan.exports.ifc_elements.storey_plan import StoreyPlan
from scanplan.exports.ifc_model import Frame, IfcModel
from scanplan.exports.opening_extents import vertical_extent_m
from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import Array, FloatArray

_TURN_RAD = np.radians(20)  # of a boundary: outlines run within 30 degrees of an element's way


def connect_walls(model: IfcModel, storey: StoreyPlan, walls: Sequence[entity_instance]) -> None:
    """State which walls meet, and whether at the start, the end or along each."""
    plan = storey.plan
    bodies = overlays.buffer_shapes(plan.bodies, NEAR_M / 2, cap_style="flat", join_style="mitre")
    lines_m = floorplan.centrelines_m(plan.walls)
    widths_m = np.add(*plan.sides_m)
    for one, other in _touching(bodies):
        place_m = shapely.get_coordinates(
            overlays.intersect_shapes(bodies[one], bodies[other]).centroid
        )[0]
        model.new(
            "IfcRelConnectsPathElements",
            **model.rooted("IfcRelConnectsPathElements", walls[one], walls[other]),
            RelatingElement=walls[one],
            RelatedElement=walls[other],
            RelatingPriorities=[],
            RelatedPriorities=[],
            RelatingConnectionType=_part_at(lines_m[one], place_m, widths_m[other]),
            RelatedConnectionType=_part_at(lines_m[other], place_m, widths_m[one]),
        )


def bound_spaces(
    model: IfcModel,
    storey: StoreyPlan,
    spaces: Sequence[entity_instance],
    walls: Sequence[entity_instance],
    openings: Sequence[Opening],
) -> None:
    """State which walls, doors, windows and passages bound each room, and where (first level)."""
    sides = [*_wall_sides(storey, walls), *_opening_sides(storey, openings)]
    reaches = np.array([side.reach for side in sides], object)
    for space, area in zip(spaces, storey.plan.areas, strict=True):
        rings = shapely.get_rings(shapely.orient_polygons(shapely.get_parts(area)))
        for number in np.flatnonzero(shapely.intersects(reaches, area)):
            side = sides[number]
            for line_m in _straight_parts(overlays.intersect_lines(rings, side.reach), side.along):
                upright = model.upright(line_m, side.extent_m)
                _add_boundary(model, space, side.element, upright, is_external=side.is_external)


@dataclass(frozen=True)
class _Side:
    """What may bound rooms.

    Attributes
    ----------
    element : entity
    reach : Polygon
        Outlines of rooms within it lie along the element.
    along : (2,) float
        Its direction, of length 1.
    extent_m : (float, float)
        From where to where above the floor it reaches.
    is_external : bool
    """

    element: entity_instance
    reach: BaseGeometry
    along: FloatArray
    extent_m: tuple[float, float]
    is_external: bool


def _wall_sides(storey: StoreyPlan, walls: Sequence[entity_instance]) -> Iterator[_Side]:
    plan = storey.plan
    reaches = overlays.buffer_shapes(plan.bodies, NEAR_M, quad_segs=8)
    for row, line_m in enumerate(floorplan.centrelines_m(plan.walls)):
        extent_m = (0.0, float(plan.heights_m[row]))
        is_external = bool(storey.external[row])
        for along, reach in _straight_reaches(plan, row, line_m, reaches[row]):
            yield _Side(walls[row], reach, along, extent_m, is_external)


def _straight_reaches(
    plan: FloorPlan, row: int, line_m: FloatArray, reach: BaseGeometry
) -> Iterator[tuple[FloatArray, BaseGeometry]]:
    """Yield the directions of a wall, and where each is that of outlines within its reach."""
    if not plan.wall_shapes.is_bent[row]:
        yield Frame(line_m).along, reach
        return
    centre_m = plan.wall_shapes.centres_m[row]
    corners_m = plan.wall_shapes.trace(row)
    n_parts = int(np.ceil(plan.lengths_m[row] / plan.walls["arc_radius_m"][row] / _TURN_RAD))
    at = np.unique(np.linspace(0, len(corners_m) - 1, n_parts + 1).round().astype(int))
    for begin_m, end_m in pairwise(corners_m[at]):
        # as far outwards as walls are thick at most
        sector = shapely.Polygon(
            [centre_m, *(centre_m + 2 * (np.array([begin_m, end_m]) - centre_m))]
        )
        yield Frame(np.array([begin_m, end_m])).along, overlays.intersect_areas(reach, sector)


def _opening_sides(storey: StoreyPlan, openings: Sequence[Opening]) -> Iterator[_Side]:
    plan = storey.plan
    lines_m = floorplan.centrelines_m(plan.openings)
    half_m = shapely.area(plan.gaps) / plan.openings["width_m"] / 2
    reaches = floorplan.buffer_lines(lines_m, half_m + NEAR_M)
    for row, opening in enumerate(openings):
        if opening.element is not None:
            extent_m = vertical_extent_m(plan, row)
            is_external = storey.leads_outside(row)
            along = Frame(lines_m[row]).along
            yield _Side(opening.element, reaches[row], along, extent_m, is_external)


def bound_levels(
    model: IfcModel,
    storey: StoreyPlan,
    spaces: Sequence[entity_instance],
    floors: Sequence[entity_instance],
    ceilings: Sequence[entity_instance],
) -> None:
    """State which floor and which ceiling bound each room, where they were seen."""
    plan = storey.plan
    _, height_m = plan.storey_m
    parts = floor_parts(plan)
    for row, (space, area) in enumerate(zip(spaces, plan.areas, strict=True)):
        bounds = [(ceilings[row], height_m, True)] if ceilings else []
        if floors:
            below = int(np.argmax(shapely.area(overlays.intersect_areas(parts, area))))
            bounds.append((floors[below], 0.0, False))
        for element, level_m, is_up in bounds:
            for polygon in shapely.get_parts(area):
                level = model.level(polygon, level_m, up=is_up)
                _add_boundary(model, space, element, level, is_external=False)


def _add_boundary(
    model: IfcModel,
    space: entity_instance,
    element: entity_instance,
    connection: entity_instance,
    *,
    is_external: bool,
) -> None:
    is_virtual = any(map(element.is_a, ("IfcOpeningElement", "IfcVirtualElement")))
    model.new(
        "IfcRelSpaceBoundary",
        **model.rooted("IfcRelSpaceBoundary", space, element),
        RelatingSpace=space,
        RelatedBuildingElement=element,
        ConnectionGeometry=connection,
        PhysicalOrVirtualBoundary="VIRTUAL" if is_virtual else "PHYSICAL",
        InternalOrExternalBoundary="EXTERNAL" if is_external else "INTERNAL",
    )


def _touching(bodies: Array) -> Iterator[tuple[int, int]]:
    """Yield the pairs of bodies that intersect, each once, in order."""
    ones, others = shapely.STRtree(bodies).query(bodies, predicate="intersects").tolist()
    yield from sorted((one, other) for one, other in zip(ones, others, strict=True) if one < other)


def _part_at(line_m: FloatArray, place_m: FloatArray, width_m: float) -> str:
    """Return where along a wall another of a width meets it."""
    along = line_m[1] - line_m[0]
    length_m = float(np.linalg.norm(along))
    at_m = float((place_m - line_m[0]) @ along) / length_m
    near_m = min(width_m + NEAR_M, length_m / 2)
    if at_m <= near_m:
        return "ATSTART"
    return "ATEND" if at_m >= length_m - near_m else "ATPATH"


def _straight_parts(parts: Array, along: FloatArray) -> Iterator[FloatArray]:
    """Yield the straight stretches (2, 2) of lines that run in a direction, within 30 degrees.

    What is so short that it may be mere roughness is left out.
    """
    lines = shapely.get_parts(shapely.get_parts(parts))
    for line in overlays.simplify_shapes(overlays.merge_lines(lines), NEAR_M / 2):
        for start_m, end_m in pairwise(shapely.get_coordinates(line)):
            step_m = end_m - start_m
            length_m = float(np.linalg.norm(step_m))
            across_m = abs(step_m[0] * along[1] - step_m[1] * along[0])
            if length_m > NEAR_M and across_m < length_m / 2:
                yield np.array([start_m, end_m])
