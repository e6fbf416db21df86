"""How a plan is drawn, on paper and in CAD: layers, strokes and letters, by one table each.

Lines have the widths of ISO 128-2, letters are near the heights of ISO 3098. All else on paper is
spaced by the size of its letters.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import constants

from scanplan.types import FloatArray

POINTS_PER_MM = constants.milli / constants.point
LETTER_POINTS = 8  # size of letters: capitals 2.1 mm high, between the 1.8 and 2.5 of ISO 3098
_READ_ALONG = np.array([1.0, 0.1])  # an almost upright line is read from the right

INK = "black"
FAINT = "0.35"  # grey of what steps back behind the walls: dimensions, and what is inferred


@dataclass(frozen=True)
class Layer:
    """A layer of CAD programs: lines of one width, and a colour on the screen.

    Attributes
    ----------
    width_mm : float
        On paper.
    colour : int
        Of the AutoCAD colour index: 7 is black on paper and white on a black screen.
    """

    width_mm: float
    colour: int

    @property
    def width_points(self) -> float:
        """Width of lines in points."""
        return self.width_mm * POINTS_PER_MM


@dataclass(frozen=True)
class Stroke:
    """How an element of the plan is drawn.

    Attributes
    ----------
    layer : str
        Of `LAYERS`; the stroke is as wide as its lines.
    ink : str
        Colour on paper.
    fill : str
        Of what the stroke encloses: grey where a wall is cut (ISO 128-3), light enough for letters.
    dashes : tuple of float
        Dash and gap in widths of the line; none for a continuous line.
    """

    layer: str
    ink: str = INK
    fill: str = "none"
    dashes: tuple[float, ...] = ()

    @property
    def width_points(self) -> float:
        """Width of the line in points."""
        return LAYERS[self.layer].width_points

    @property
    def line(self) -> dict[str, Any]:
        """Keywords of matplotlib for a line."""
        dashes = (0, self.dashes) if self.dashes else "-"
        return {"color": self.ink, "lw": self.width_points, "ls": dashes}

    @property
    def patch(self) -> dict[str, Any]:
        """Keywords of matplotlib for an area and its outline."""
        return {
            "ec": self.ink,
            "fc": self.fill,
            "lw": self.width_points,
            "ls": self.line["ls"],
            "joinstyle": "miter",
        }


# by their names in CAD programs; beside them their likes in the AIA CAD layer guidelines
LAYERS = {
    "WALLS": Layer(width_mm=0.35, colour=7),  # A-WALL: what is cut has the widest lines
    "WALLS_INFERRED": Layer(width_mm=0.25, colour=8),  # A-WALL: apart, to be switched off
    "OPENINGS": Layer(width_mm=0.18, colour=5),  # A-DOOR and A-GLAZ: rays cannot always tell them
    "ROOMS": Layer(width_mm=0.13, colour=3),  # A-AREA
    "TEXT": Layer(width_mm=0.13, colour=7),  # A-ANNO-TEXT
}
STROKES = {
    "observed": Stroke("WALLS", fill="0.55"),
    "inferred": Stroke("WALLS_INFERRED", ink=FAINT, fill="0.92", dashes=(4, 2)),
    "door": Stroke("OPENINGS", dashes=(3, 2)),
    "window": Stroke("OPENINGS"),
    "passage": Stroke("OPENINGS", ink=FAINT, dashes=(1, 2)),  # a boundary without a thing
    "glass": Stroke("OPENINGS"),
    "gap": Stroke("OPENINGS", ink=FAINT, dashes=(1, 1)),
    "unseen": Stroke("ROOMS", ink=FAINT, dashes=(6, 3)),
    "dimension": Stroke("TEXT", ink=FAINT),
}
"""By the state of a wall (`floorplan.STATES`), the type of an opening (`floorplan.OPENINGS`), and
of what was not seen."""


def read_along(line: FloatArray) -> FloatArray:
    """Return the direction (2,) to write in along a line (2, 2).

    So that it is read from below or from the right (ISO 129-1).
    """
    way = (line[1] - line[0]) / np.hypot(*(line[1] - line[0]))
    return way if way @ _READ_ALONG > 0 else -way
