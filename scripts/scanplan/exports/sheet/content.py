"""What of a plan is drawn, on sheets and in the report: rooms and walls as marks, map frame."""

from collections.abc import Iterator

import numpy as np
import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.exports.sheet.lettering import clean_text
from scanplan.exports.sheet.marks import Facts, Mark, straight
from scanplan.geometry import overlays
from scanplan.geometry.arcs import NO_CIRCLES
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import BoolArray, Columns
from scanplan.validation import doubts

_FACTS = {
    "wall": (
        "thickness_m",
        "arc_radius_m",
        "sigma_radius_m",
        "sigma_offset_m",
        "sigma_end0_m",
        "sigma_end1_m",
        "n_points",
        "n_scans",
        "moved_m",
        "turned_deg",
        "thickness_changed_m",
        "thickness_from",
        "joined",
    ),
    "face": ("n_points", "n_scans", "rmse_m", "z_min_m", "z_max_m"),
    "opening": (
        "width_m",
        "thickness_m",
        "sill_m",
        "lintel_m",
        "n_rays",
        "p_kind",
        "room_a",
        "room_b",
        "width_changed_m",
    ),
    "room": ("area_m2", "perimeter_m", "closed", "n_scans"),
    "furniture": ("area_m2", "z_min_m", "z_max_m", "n_points", "n_scans"),
}
_END_M = 0.15  # around an end: it is seen beside a wall of usual thickness
_OF_ALL = ("p_true", "about", "doubt", "corrected")


def facts_of(table: str, columns: Columns, row: int) -> Facts:
    """Return what a table's row says of a wall, an opening or a room, NaN left out."""
    names = [name for name in (table, *_FACTS[table], *_OF_ALL) if name in columns]
    values = {name: _plain_value(columns[name][row]) for name in names}
    return {name: value for name, value in values.items() if value not in (None, "")}


def is_doubtful(columns: Columns) -> BoolArray:
    """Return which rows (n,) of a table are to be verified on site."""
    n_rows = len(next(iter(columns.values())))
    return np.asarray(columns.get("verify", np.zeros(n_rows)), bool)


def is_corrected(columns: Columns) -> BoolArray:
    """Return which rows (n,) of a table a person corrected."""
    n_rows = len(next(iter(columns.values())))
    return np.asarray(columns.get("corrected", np.full(n_rows, "")), str) != ""


def draw_rooms(plan: FloorPlan) -> Iterator[Mark]:
    """Yield the rooms, in the order of their table."""
    doubtful = doubts.find_doubtful_rooms(plan)
    for row, area in enumerate(plan.areas):
        room, name = plan.rooms["room"][row], clean_text(plan.room_labels[row])
        facts = {"name": name, **facts_of("room", plan.rooms, row)}
        is_doubted = bool(doubtful[row])
        yield draw_area("room", area, f"room-{room}", name, facts, verify=is_doubted, of=plan)


def draw_unseen(plan: FloorPlan) -> Iterator[Mark]:
    """Yield the spans of rooms' outlines of which nothing is known."""
    unseen_m = floorplan.centrelines_m(plan.unseen)
    for number, line_m in zip(plan.unseen["opening"], unseen_m, strict=True):
        path = [straight(line_m)]
        yield Mark("not-seen", path, element=f"not-seen-{number}", title="not seen")


def draw_walls(plan: FloorPlan) -> Iterator[Mark]:
    """Yield ground and outlines that were not seen, walls by what is known, and surfaces."""
    for number, part in enumerate([*plan.hidden_floor, *plan.enclosed_ground]):
        yield draw_area("hidden", part, f"hidden-{number}", f"not seen, {part.area:.1f} m²")
    yield from draw_unseen(plan)
    assumed = [*list_polygons(plan.assumed)]
    for number, part in enumerate(assumed):
        title = f"wall, assumed {plan.assumed_thickness_m:.2f} m thick"
        yield draw_area("assumed", part, f"assumed-{number}", title, of=plan)
    known = {"inferred": plan.walls["state"] == "inferred", "low": plan.low}
    known["inferred"] = known["inferred"] & ~plan.low
    known["wall"] = ~known["inferred"] & ~known["low"]
    above = shapely.Polygon()
    for kind in ("wall", "inferred", "low"):
        shape = overlays.subtract_areas(_footprint(plan, known[kind]), above)
        above = overlays.unite_each(above, shape)
        for number, part in enumerate(list_polygons(shape)):
            yield draw_area(kind, part, f"{kind}-{number}", kind, of=plan)
    yield from draw_surfaces(plan)


def draw_surfaces(plan: FloorPlan) -> Iterator[Mark]:
    """Yield surfaces with nothing known behind them."""
    for kind, state in (("surface", "observed"), ("surface-inferred", "inferred")):
        for number, line in enumerate(plan.single(state)):
            path = [straight(shapely.get_coordinates(line))]
            yield Mark(
                kind,
                path,
                element=f"{kind}-{number}",
                title=f"{state} surface",
                circles_m=plan.circles_m,
            )


def draw_axes(plan: FloorPlan) -> Iterator[Mark]:
    """Yield the middle of each wall as it is drawn, with what is known of it: for CAD alone.

    Of a curved wall that one side was seen of it is that side.
    """
    left_m, right_m = plan.sides_m
    aside_m = np.where(plan.wall_shapes.is_bent, 0.0, (left_m - right_m) / 2)
    for row, off_m in enumerate(aside_m.tolist()):
        number = plan.walls["wall"][row]
        facts = facts_of("wall", plan.walls, row)
        path = straight(plan.wall_shapes.trace(row, off_m))
        yield Mark("axis", [path], element=f"wall-{number}", facts=facts, circles_m=plan.circles_m)


def draw_doubts(plan: FloorPlan) -> Iterator[Mark]:
    """Yield what of the walls is to be verified, with what is known of it.

    Outlines of whole walls, circles around ends of those that are sure but for these, and lines of
    faces whose walls are not.
    """
    for row in np.flatnonzero(is_doubtful(plan.walls)).tolist():
        number = plan.walls["wall"][row]
        facts = facts_of("wall", plan.walls, row)
        title = " ".join(["verify wall", str(number), str(facts.get("doubt", ""))]).strip()
        element = f"verify-wall-{number}"
        yield draw_area("verify", plan.bodies[row], element, title, facts, verify=True, of=plan)
    for row, end_m in doubts.list_loose_ends(plan):
        number, facts = plan.walls["wall"][row], facts_of("wall", plan.walls, row)
        around = overlays.buffer_shapes(shapely.Point(end_m), _END_M)
        title = f"verify the end of wall {number} {facts['doubt']}"
        yield draw_area("verify", around, f"verify-end-{number}", title, facts, verify=True)
    for row in doubts.find_doubtful_faces(plan).tolist():
        number, facts = plan.faces["face"][row], facts_of("face", plan.faces, row)
        title = " ".join(["verify face", str(number), str(facts.get("doubt", ""))]).strip()
        line = straight(floorplan.centrelines_m(plan.faces)[row])
        yield Mark("verify", [line], False, f"verify-face-{number}", title, facts, True)


def draw_corrections(plan: FloorPlan, apart_m: float) -> Iterator[Mark]:
    """Yield lines around the walls that a person corrected, so far from them, likewise."""
    for row in np.flatnonzero(is_corrected(plan.walls)).tolist():
        number, said = plan.walls["wall"][row], plan.walls["corrected"][row]
        around = overlays.buffer_shapes(plan.bodies[row], apart_m, join_style="mitre")
        facts = facts_of("wall", plan.walls, row)
        yield draw_area(
            "corrected", around, f"corrected-wall-{number}", f"wall {number} {said}", facts
        )


def draw_furniture(plan: FloorPlan) -> Iterator[Mark]:
    """Yield the outlines of furniture and columns, with what is known of them."""
    outlines = shapely.from_wkb(np.asarray(plan.furniture["geometry"], object))
    for row, outline in enumerate(outlines):
        facts = facts_of("furniture", plan.furniture, row)
        kind = str(plan.furniture["kind"][row])
        yield draw_area(kind, outline, f"{kind}-{facts['furniture']}", kind, facts)


def _footprint(plan: FloorPlan, is_wanted: BoolArray) -> BaseGeometry:
    bodies = overlays.unite_areas(plan.known_bodies[is_wanted[plan.thick]])
    return overlays.subtract_areas(bodies, plan.all_gaps)


def draw_area(
    kind: str,
    shape: BaseGeometry,
    element: str,
    title: str,
    facts: Facts | None = None,
    *,
    verify: bool = False,
    of: FloorPlan | None = None,
) -> Mark:
    """Return an area with its outline, and holes."""
    rings = shapely.get_rings(shapely.get_parts(shape))
    paths = [straight(shapely.get_coordinates(ring)) for ring in rings]
    circles_m = NO_CIRCLES if of is None else of.circles_m
    return Mark(kind, paths, True, element, title, facts or {}, verify, circles_m)


def list_polygons(shape: BaseGeometry) -> Iterator[Polygon]:
    """Yield the polygons of a shape, none of what is empty."""
    for part in shapely.get_parts(shape):
        if isinstance(part, Polygon) and not part.is_empty:
            yield part


def _plain_value(value: object) -> str | int | float | bool | None:
    """Return a value of a table as Python's own; None of NaN."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if np.isfinite(value) else None
    return value if isinstance(value, str | int | bool) else None
