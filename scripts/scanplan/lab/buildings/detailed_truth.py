"""The truth of what a drawn floor has beside walls and holes."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import shapely
from shapely import LineString, Point
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.tolerances import SAME_M
from scanplan.lab.buildings import drawn_floor
from scanplan.lab.buildings.details import ceilings, leaves, solids
from scanplan.lab.buildings.tolerances import CRACK_M, DECIMALS, DRAWN_M

Feature = tuple[BaseGeometry, dict[str, Any]]
"""A geometry in the map frame, metres, and its properties."""


def leaf_features(row: int, bodies: Sequence[leaves.LeafBody]) -> list[Feature]:
    """Return the leaves of a door, the opening of number `row`: their middle lines, hinge first."""
    return [
        (
            body.middle_m,
            {
                "kind": "leaf",
                "type": body.drawn.type,
                "open_deg": body.drawn.open_deg,
                "open_share": body.drawn.open_share,
                "thickness_m": body.drawn.thickness_m,
                "height_m": round(body.high_m, DECIMALS),
                "width_m": round(body.middle_m.length, DECIMALS),
                "opening": row,
                "glass": body.drawn.is_glass,
            },
        )
        for body in bodies
    ]


def find_outlines(
    plan: drawn_floor.DrawnFloor, slice_height_m: float, lowest_m: float
) -> list[BaseGeometry]:
    """Return the outlines of all that occludes walls at the slice and is none.

    What stands there must reach to `lowest_m` at least.
    """
    boxes = [(f.footprint_m, f.base_m, f.height_m) for f in plan.furniture]
    boxes += [(c.footprint_m, 0.0, c.height_m) for c in plan.columns]
    boxes += [(p.footprint_m, 0.0, p.height_m) for p in plan.platforms]
    boxes += [
        (body.footprint_m, body.low_m, body.high_m)
        for opening in plan.openings
        for body in leaves.stand_leaves(opening)
        if not body.drawn.is_glass
    ]
    boxes += [(tread, 0.0, z_m) for s in plan.stairs for tread, z_m in solids.stair_treads(s)]
    grounds = [
        ground for ground, low_m, high_m in boxes if low_m < slice_height_m and high_m >= lowest_m
    ]
    grounds += [ceilings.low_ground(ceiling, slice_height_m) for ceiling in plan.ceilings]
    return [shapely.boundary(ground) for ground in grounds if not ground.is_empty]


def describe_faces(
    plan: drawn_floor.DrawnFloor, faces: Sequence[tuple[LineString, str]], slice_height_m: float
) -> list[tuple[LineString, str, dict[str, Any]]]:
    """Return straight wall surfaces, parted where panes begin, with what is said of their walls.

    `material` is glass of a pane, `curved` is true of a curved wall.
    """
    curves = overlays.buffer_shapes(drawn_floor.cut_curves(plan), 10 * SAME_M)
    panes = overlays.buffer_shapes(drawn_floor.cut_walls(plan, slice_height_m, glass=True), DRAWN_M)
    described = []
    for line, side in faces:
        for piece, is_pane in _part_line(line, panes):
            values: dict[str, Any] = {"material": "glass"} if is_pane else {}
            if curves.covers(piece):
                values["curved"] = True
            described.append((piece, side, values))
    return described


def detail_features(plan: drawn_floor.DrawnFloor) -> list[Feature]:
    """Return leaves, columns, mirrors, panes, furniture, voids, stairs and beams of a floor."""
    features = []
    for row, opening in enumerate(plan.openings):
        features += leaf_features(row, leaves.stand_leaves(opening))
    for column in plan.columns:
        values = {"kind": "column", "type": column.type, "height_m": column.height_m}
        features.append((column.footprint_m, values))
    for mirror in plan.mirrors:
        values = {"kind": "mirror", "sill_m": mirror.sill_m, "lintel_m": mirror.lintel_m}
        features.append((mirror.line_m, values))
    features += [
        (line, {"kind": "pane", "sill_m": low_m, "lintel_m": high_m})
        for line, low_m, high_m in _panes(plan)
    ]
    for box in plan.furniture:
        if box.type:
            heights = {"base_m": box.base_m, "height_m": box.height_m}
            features.append((box.footprint_m, {"kind": "furniture", "type": box.type, **heights}))
    for void in plan.voids:
        features.append((void.footprint_m, {"kind": "void", "depth_m": void.depth_m}))
    for stairs in plan.stairs:
        values = {"kind": "stairs", "rise_m": stairs.rise_m, "steps": stairs.steps}
        features.append((stairs.footprint_m, values))
    for beam in filter(lambda ceiling: ceiling.is_beam, plan.ceilings):
        values = {"kind": "beam", "underside_m": beam.underside.level_m}
        features.append((beam.footprint_m, values))
    return features


def ceiling_values(plan: drawn_floor.DrawnFloor, room: BaseGeometry) -> dict[str, float]:
    """Return how high the ceiling is over a room, nothing of a floor with the main one alone."""
    if not plan.ceilings:
        return {}
    low_m, high_m = ceilings.ceiling_range(room, plan.ceilings, plan.height_m)
    return {"ceiling_low_m": round(low_m, DECIMALS), "ceiling_high_m": round(high_m, DECIMALS)}


def _part_line(line_m: LineString, area: BaseGeometry) -> list[tuple[LineString, bool]]:
    """Return the pieces of a straight line, in its direction, and whether each is in an area."""
    pieces = [(part, True) for part in shapely.get_parts(overlays.intersect_lines(line_m, area))]
    pieces += [(part, False) for part in shapely.get_parts(overlays.subtract_lines(line_m, area))]
    parts = []
    for piece, is_inside in pieces:
        if piece.length > CRACK_M:
            along_m = sorted(line_m.project(Point(xy)) for xy in piece.coords)
            parts.append((along_m[0], along_m[-1], is_inside))
    if len(parts) < 2:
        return [(line_m, bool(parts) and parts[0][2])]
    return [
        (LineString([line_m.interpolate(a), line_m.interpolate(b)]), is_inside)
        for a, b, is_inside in sorted(parts)
    ]


def _panes(plan: drawn_floor.DrawnFloor) -> Iterator[tuple[BaseGeometry, float, float]]:
    """Yield the middle lines of panes with their lower and upper edges."""
    for opening in plan.openings:
        if opening.glazed:
            yield opening.clear_line_m, opening.sill_m, opening.clear_lintel_m
    for wall in plan.walls:
        runs = map(LineString, pairwise(wall.line_m.coords)) if wall.is_glass else ()
        for run in runs:
            # a pane's middle line is drawn up to that of the wall which it ends in
            solid = drawn_floor.cut_walls(plan, wall.height_m / 2, glass=False)
            for part in shapely.get_parts(overlays.subtract_lines(run, solid)):
                yield from _panes_of_run(plan, part, wall.height_m)


def _panes_of_run(
    plan: drawn_floor.DrawnFloor, run: BaseGeometry, height_m: float
) -> Iterator[tuple[BaseGeometry, float, float]]:
    """Yield what openings leave of a straight run of a pane: beside them, below and above."""
    rest = run
    for opening in plan.openings:
        hole = overlays.buffer_shapes(opening.line_m, DRAWN_M + opening.bow_m, cap_style="flat")
        over = overlays.intersect_lines(run, hole)
        if not opening.in_glass or over.length <= CRACK_M:
            continue
        rest = overlays.subtract_lines(rest, hole)
        if opening.sill_m > CRACK_M:
            yield over, 0.0, opening.sill_m
        if opening.lintel_m < height_m - CRACK_M:
            yield over, opening.lintel_m, height_m
    for part in shapely.get_parts(rest):
        if part.length > CRACK_M:
            yield part, 0.0, height_m
