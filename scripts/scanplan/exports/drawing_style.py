"""Lines, letters and fills of a drawing to scale, after the ISO standards of technical drawings.

As in ISO 128-2 narrow lines are half as wide as wide ones, or less. Letters are stated in points of
the font, whose capitals are 0.26 mm a point high: 7 points make 1.8 mm, the least of ISO 3098.
"""

from typing import Any

MM_PER_INCH = 25.4
POINTS_PER_MM = 72 / MM_PER_INCH

INK = "black"
FAINT = "0.35"  # grey of dimensions and of what is inferred: steps back behind the walls
CUT_FILL = "0.55"  # grey of a cut wall (ISO 128-3 fills cut areas); letters on it can be read
INFERRED_FILL = "0.92"  # as good as paper

CUT_MM = 0.35  # outlines of cut walls: wide
FACE_MM = 0.4  # a surface alone: wider than an outline, as its wall has no second one
OPENING_MM = 0.13  # openings lie below the cut or in it: narrow
DIMENSION_MM = 0.15  # dimension and extension lines: narrow (ISO 129-1)
TICK_MM = 0.3  # oblique strokes at the ends of dimension lines (ISO 129-1), wider than these
PANE_MM = 0.8  # thickness of a window in a wall of unknown thickness: its three lines stay apart

DASHED = (0, (4, 2))  # in line widths: ISO 128's dashed line, for what is not seen
DOOR_DASHED = (0, (3, 2))  # shorter: an opening is short
DOTTED = (0, (1, 2))  # ISO 128's dotted line, for a boundary without a thing

TITLE_POINTS = 12
LABEL_POINTS = 8  # capitals 2.1 mm
NOTE_POINTS = 7  # capitals 1.8 mm
SMALL_POINTS = 5.5  # below ISO 3098, but fits into a wall at 1:100
LEAST_ROOM_POINTS = 3.0  # smaller cannot be read on paper, but is when the drawing is enlarged

Style = dict[str, Any]
"""Keywords of a matplotlib patch."""
WALL_STYLES: dict[str, Style] = {
    "observed": {"ec": INK, "fc": CUT_FILL, "joinstyle": "miter"},
    "inferred": {"ec": FAINT, "fc": INFERRED_FILL, "ls": DASHED, "joinstyle": "miter"},
}
"""By state, see `floorplan.STATES`."""
OPENING_STYLES: dict[str, Style] = {
    "door": {"ec": INK, "ls": DOOR_DASHED},
    "window": {"ec": INK},
    "passage": {"ec": FAINT, "ls": DOTTED},
}
"""By type, see `floorplan.OPENINGS`."""
