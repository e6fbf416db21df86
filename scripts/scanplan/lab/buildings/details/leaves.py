"""Where the leaves and frames of doors stand."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely import LineString, MultiLineString, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.ops import substring

from scanplan.geometry import overlays
from scanplan.lab.buildings.details.things import DrawnLeaf, DrawnOpening
from scanplan.types import FloatArray


@dataclass(frozen=True)
class LeafBody:
    """One leaf as it stands.

    Attributes
    ----------
    middle_m : LineString
        Its middle line seen from above, the hinge first.
    footprint_m : Polygon
    low_m, high_m : float
        Lower and upper edge above the floor.
    drawn : DrawnLeaf
        What it is of.
    """

    middle_m: LineString
    footprint_m: Polygon
    low_m: float
    high_m: float
    drawn: DrawnLeaf


def stand_leaves(opening: DrawnOpening) -> list[LeafBody]:
    """Return the leaves of a door as they stand: none, one, or the two of a double door.

    A leaf turns about the edge of its outer side, so that at 180 degrees it lies on the wall's
    face.
    """
    leaf = opening.leaf
    if leaf is None:
        return []
    if leaf.type == "double":
        return [_hinged_leaf(opening, leaf, hinge, 2) for hinge in ("start", "end")]
    if leaf.type == "sliding":
        return [_sliding_leaf(opening, leaf)]
    return [_hinged_leaf(opening, leaf, leaf.hinge, 1)]


def frame_bands(opening: DrawnOpening) -> list[tuple[float, float, BaseGeometry]]:
    """Return the frame of an opening as slabs: lower edge, upper edge, section; none without."""
    if opening.frame_m == 0.0:
        return []
    half_m = opening.thickness_m / 2
    whole = overlays.buffer_shapes(opening.line_m, half_m, cap_style="flat")
    # what is clear, taken from the whole, would leave slivers along the edges that both share
    line_m, frame_m = opening.line_m, opening.frame_m
    spans_m = ((0.0, frame_m), (line_m.length - frame_m, line_m.length))
    ends_m = MultiLineString([substring(line_m, *span_m).coords for span_m in spans_m])
    jambs = overlays.buffer_shapes(ends_m, half_m, cap_style="flat")
    return [
        (opening.sill_m, opening.clear_lintel_m, jambs),
        (opening.clear_lintel_m, opening.lintel_m, whole),
    ]


def _hinged_leaf(opening: DrawnOpening, leaf: DrawnLeaf, hinge: str, leaves: int) -> LeafBody:
    """Return a leaf, one of one or two, that turns about the jamb of an end."""
    origin_m, axes = _axes_at(opening, leaf, hinge)
    width_m = opening.clear_line_m.length / leaves - 2 * leaf.play_m
    behind_m = 0.0 if leaf.recess_m is None else leaf.recess_m - leaf.thickness_m / 2
    pivot_m = np.array([leaf.play_m, opening.thickness_m / 2 - behind_m])
    turn_rad = np.radians(leaf.open_deg)
    turn = np.array([[np.cos(turn_rad), np.sin(turn_rad)], [-np.sin(turn_rad), np.cos(turn_rad)]])
    outline_m, middle_m = _rectangle(width_m, -leaf.thickness_m, 0.0)
    outline_m = origin_m + (pivot_m + outline_m @ turn) @ axes
    middle_m = origin_m + (pivot_m + middle_m @ turn) @ axes
    return _body(opening, leaf, outline_m, middle_m)


def _sliding_leaf(opening: DrawnOpening, leaf: DrawnLeaf) -> LeafBody:
    """Return a leaf that slides along the wall's face, or within the wall where it is recessed."""
    origin_m, axes = _axes_at(opening, leaf, leaf.hinge)
    width_m = opening.clear_line_m.length - 2 * leaf.play_m
    before_m = leaf.hang_m + leaf.thickness_m / 2
    across_m = opening.thickness_m / 2 + (before_m if leaf.recess_m is None else -leaf.recess_m)
    half_m = leaf.thickness_m / 2
    outline_m, middle_m = _rectangle(width_m, across_m - half_m, across_m + half_m)
    moved_m = np.array([leaf.play_m - leaf.open_share * width_m, 0.0])
    return _body(
        opening,
        leaf,
        origin_m + (moved_m + outline_m) @ axes,
        origin_m + (moved_m + middle_m) @ axes,
    )


def _axes_at(opening: DrawnOpening, leaf: DrawnLeaf, hinge: str) -> tuple[FloatArray, FloatArray]:
    """Return the clear end of an opening at the hinge, and axes (2, 2) there.

    The first row leads along the opening to its other end, the second to the leaf's side.
    """
    ends_m = shapely.get_coordinates(opening.clear_line_m)
    along = (ends_m[1] - ends_m[0]) / np.hypot(*(ends_m[1] - ends_m[0]))
    left = np.array([-along[1], along[0]])
    across = left if leaf.side == "left" else -left
    if hinge == "start":
        return ends_m[0], np.array([along, across])
    return ends_m[1], np.array([-along, across])


def _rectangle(width_m: float, low_m: float, high_m: float) -> tuple[FloatArray, FloatArray]:
    """Return the outline (4, 2) and the middle line (2, 2) of a leaf that begins at x = 0."""
    outline_m = [[0.0, low_m], [width_m, low_m], [width_m, high_m], [0.0, high_m]]
    middle_m = (low_m + high_m) / 2
    return np.array(outline_m), np.array([[0.0, middle_m], [width_m, middle_m]])


def _body(
    opening: DrawnOpening, leaf: DrawnLeaf, outline_m: FloatArray, middle_m: FloatArray
) -> LeafBody:
    return LeafBody(
        middle_m=LineString(middle_m),
        footprint_m=Polygon(outline_m),
        low_m=opening.sill_m + leaf.play_m,
        high_m=opening.clear_lintel_m - leaf.play_m,
        drawn=leaf,
    )
