"""Reading the openings of a drawing, their frames and leaves, and the walls that they are in."""

import math
from collections.abc import Sequence
from itertools import pairwise

from shapely import LineString, Point
from shapely.ops import substring

from scanplan.errors import StageError
from scanplan.lab.buildings.details.feature_reading import DrawnPart
from scanplan.lab.buildings.details.things import DrawnLeaf, DrawnOpening, DrawnWall
from scanplan.lab.buildings.tolerances import DRAWN_M

OPENING_TYPES = ("door", "window", "passage")
LEAF_TYPES = ("hinged", "double", "sliding")


def read_opening(part: DrawnPart, walls: Sequence[DrawnWall]) -> DrawnOpening:
    """Return an opening on the wall that it is drawn on.

    Raises
    ------
    StageError
        If it is on no wall, reaches beyond its wall's straight run, or a value is not what it may
        be.
    """
    kind = part.choice("type", OPENING_TYPES)
    glazed = part.switch("glazed")
    wall, line_m = _place_on_wall(part, walls)
    thickness_m, bow_m = _depth_there(wall, line_m)
    sill_m = part.number("sill_m", 0.0, wall.height_m, default=0.0)
    lintel_m = part.number("lintel_m", sill_m + 0.01, wall.height_m)
    widest_m = min(line_m.length / 2, lintel_m - sill_m) - 0.01
    return DrawnOpening(
        line_m=line_m,
        thickness_m=thickness_m,
        sill_m=sill_m,
        lintel_m=lintel_m,
        type=kind,
        glazed=glazed,
        frame_m=part.number("frame_m", 0.0, max(widest_m, 0.0), default=0.0),
        bow_m=bow_m,
        in_glass=wall.is_glass,
        leaf=_read_leaf(part, kind, thickness_m, glazed=glazed) if part.has("leaf") else None,
    )


def _read_leaf(part: DrawnPart, kind: str, depth_m: float, *, glazed: bool) -> DrawnLeaf:
    """Return what shuts a door in a wall as thick as `depth_m`."""
    leaf_type = part.choice("leaf", LEAF_TYPES)
    if kind != "door" or glazed:
        pane = " that is glazed" if glazed else ""
        raise StageError(
            f"{part.where}: has a leaf and is a {kind}{pane}; expected a door without a pane of"
            " its own (leaf_glass makes the leaf one)"
        )
    thickness_m = part.number("leaf_thickness_m", 0.005, 0.2, default=0.04)
    recess_m = part.number("recess_m", 0.0, depth_m) if part.has("recess_m") else None
    open_deg = part.number("open_deg", 0.0, 180.0, default=0.0)
    # behind the wall's face a leaf meets the jamb soon after a right angle: its play lets it by
    behind_m = 0.0 if recess_m is None else recess_m - thickness_m / 2
    if behind_m > DRAWN_M and open_deg > 95.0 and leaf_type != "sliding":
        raise StageError(
            f"{part.where}: open_deg is {open_deg:g} and its leaf hangs {behind_m:.3f} m behind the"
            " wall's face, where it meets the jamb; open it to 95 at most, or leave out recess_m"
        )
    return DrawnLeaf(
        type=leaf_type,
        open_deg=open_deg,
        open_share=part.number("open_share", 0.0, 1.0, default=0.0),
        hinge=part.choice("hinge", ("start", "end"), "start"),
        side=part.choice("side", ("left", "right"), "left"),
        thickness_m=thickness_m,
        is_glass=part.switch("leaf_glass"),
        recess_m=recess_m,
    )


def _place_on_wall(part: DrawnPart, walls: Sequence[DrawnWall]) -> tuple[DrawnWall, LineString]:
    """Return the wall that an opening is in, and its stretch of the wall's centreline."""
    geometry_m = part.geometry_m
    is_line = geometry_m.geom_type == "LineString"
    middle = geometry_m.interpolate(0.5, normalized=True) if is_line else geometry_m
    runs = [(wall, run) for wall in walls for run in _openable_runs(wall)]
    wall, run = min(runs, key=lambda pair: pair[1].distance(middle) - _half_m(pair[0]))
    width_m = geometry_m.length or part.number("width_m", 0.05, 50.0)
    along_m = run.project(middle)
    ends = [run.interpolate(max(along_m + side * width_m / 2, 0.0)) for side in (-1, 1)]
    off_m = max(Point(xy).distance(run) for xy in geometry_m.coords)
    at = f"at ({middle.x:g}, {middle.y:g})"
    if off_m > _half_m(wall) + DRAWN_M:
        raise StageError(
            f"{part.where}: {at}, {off_m:.3f} m off the nearest wall's centreline; draw it on a"
            " wall"
        )
    reached_m = run.project(ends[1]) - run.project(ends[0])
    reached_m = reached_m if wall.is_curved else ends[0].distance(ends[1])
    if not math.isclose(reached_m, width_m, abs_tol=DRAWN_M):
        raise StageError(
            f"{part.where}: {at}, {width_m:g} m wide, reaches beyond its wall's straight run;"
            " narrow or move it"
        )
    return wall, LineString(ends)


def _openable_runs(wall: DrawnWall) -> list[LineString]:
    """Return the stretches that an opening may lie on: of a curve all, else the straight ones."""
    if wall.is_curved:
        return [wall.line_m]
    return [LineString(pair) for pair in pairwise(wall.line_m.coords)]


def _half_m(wall: DrawnWall) -> float:
    return max(wall.thickness_m, wall.last_thickness_m) / 2


def _depth_there(wall: DrawnWall, line_m: LineString) -> tuple[float, float]:
    """Return the thickness of a wall at an opening, and by how much more it reaches from the line.

    The line is the chord of a curve's stretch.
    """
    if wall.is_curved:
        start_m, end_m = (wall.line_m.project(Point(xy)) for xy in line_m.coords)
        curve = substring(wall.line_m, start_m, end_m)
        bow_m = max(line_m.distance(Point(xy)) for xy in curve.coords)
        return wall.thickness_m, bow_m
    if wall.end_thickness_m is None:
        return wall.thickness_m, 0.0
    slope = (wall.end_thickness_m - wall.thickness_m) / wall.line_m.length
    middle_m = wall.line_m.project(line_m.interpolate(0.5, normalized=True))
    return wall.thickness_m + slope * middle_m, abs(slope) * line_m.length / 4
