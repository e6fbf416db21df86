"""The elements of a sheet: what is drawn, where, and what is known of it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from scanplan.geometry.arcs import NO_CIRCLES, SAGITTA_M, bend_path
from scanplan.geometry.lines import left_normals
from scanplan.types import FloatArray

Facts = Mapping[str, str | int | float | bool]
"""What is known of an element beside its shape, by the names of its table's columns."""


@dataclass(frozen=True)
class Mark:
    """Lines, or an area with its outline.

    Attributes
    ----------
    kind : str
        Of `styles.STYLES`.
    paths : list of (n, 3) float arrays
        Corners x, y and the bulge of the stretch that follows: the tangent of a quarter of the
        angle that its arc turns by, 0 of straight ones. Metres in the map frame, or millimetres
        on paper from the lower left.
    closed : bool
        Whether the paths are outlines; one inside another is a hole.
    element : str
        Its name, such as `wall-3`.
    title : str
        What it is, in words.
    facts : dict
    verify : bool
    circles_m : (k, 3) float
        Those that its paths may follow in short chords: x and y of centre, radius.
    """

    kind: str
    paths: list[FloatArray] = field(repr=False)
    closed: bool = False
    element: str = ""
    title: str = ""
    facts: Facts = field(default_factory=dict, repr=False)
    verify: bool = False
    circles_m: FloatArray = field(default_factory=lambda: NO_CIRCLES, repr=False)

    @property
    def bent_paths(self) -> list[FloatArray]:
        """Its paths, with arcs in place of short chords of circles."""
        if not len(self.circles_m):
            return self.paths
        return [bend_path(path[:, :2], self.circles_m, SAGITTA_M) for path in self.paths]


@dataclass(frozen=True)
class Word:
    """A line of text.

    Attributes
    ----------
    kind : str
        Of `styles.STYLES`.
    text : str
    place : (2,) float
        Its anchor: metres in the map frame, or millimetres on paper.
    size_mm : float
        Height of capitals on paper, one of `styles.LETTERS_MM`.
    turn_deg : float
        Counterclockwise, in the frame of `place`.
    align : float
        Which part of its length lies before the anchor: 0, 0.5 or 1. In height the anchor is in
        the middle of capitals.
    element : str
        What it belongs to.
    leader : (2, 2) float or None
        A line from the words to what they are about.
    """

    kind: str
    text: str
    place: FloatArray
    size_mm: float
    turn_deg: float = 0.0
    align: float = 0.5
    element: str = ""
    leader: FloatArray | None = None


@dataclass(frozen=True)
class Symbol:
    """A door, window or passage.

    Attributes
    ----------
    kind : str
    ends_m : (2, 2) float
        Along the middle of its wall, map frame; of a leaf that swings along the side that it is
        hinged in, which it opens to on the left.
    thickness_m : float
        Of its wall, as drawn.
    element, title : str
    facts : dict
    verify : bool
    is_marked : bool
        Whether lines around it show that it is doubtful, or was corrected.
    block : str
        Of `symbols.BLOCKS`, what it is drawn with; empty for that of its kind.
    """

    kind: str
    ends_m: FloatArray = field(repr=False)
    thickness_m: float
    element: str
    title: str
    facts: Facts = field(default_factory=dict, repr=False)
    verify: bool = False
    is_marked: bool = True
    block: str = ""

    @property
    def width_m(self) -> float:
        """Its clear width."""
        return float(np.hypot(*(self.ends_m[1] - self.ends_m[0])))

    @property
    def is_hinged(self) -> bool:
        """Whether a leaf of it swings."""
        return self.kind == "swing" and self.block != "SLIDING"

    @property
    def axis_m(self) -> FloatArray:
        """Its line (2, 2) in the middle of its wall."""
        if not self.is_hinged:
            return self.ends_m
        return self.ends_m - self.thickness_m / 2 * left_normals(self.ends_m[None])

    @property
    def surrounded_by(self) -> list[str]:
        """The kinds of lines around it: of what is to be verified, or was corrected by hand."""
        stated = {"verify": self.verify, "corrected": "corrected" in self.facts}
        return [kind for kind, holds in stated.items() if holds and self.is_marked]


@dataclass(frozen=True)
class Dimension:
    """A dimension: its line, and its text (ISO 129-1).

    Attributes
    ----------
    ends_m : (2, 2) float
        What is measured, map frame.
    line_m : (2, 2) float
        The dimension line, as long and parallel.
    word : Word
    """

    ends_m: FloatArray = field(repr=False)
    line_m: FloatArray = field(repr=False)
    word: Word


@dataclass(frozen=True)
class Stamp:
    """A room's stamp.

    Attributes
    ----------
    words : list of Word
        Its lines, from the top.
    facts : dict of str to str
        `NUMBER`, `NAME`, `AREA`, `PERIMETER`, `HEIGHT`, `CLOSED`, `CORRECTED`, `USE`, as text.
    verify : bool
    marks : str
        Behind its name, of what was corrected or is doubtful.
    room : int
        Its number in the plan's table, which `NUMBER` is where nobody gave it another.
    """

    words: list[Word]
    facts: dict[str, str]
    verify: bool = False
    marks: str = ""
    room: int = -1


def straight(points: FloatArray) -> FloatArray:
    """Return corners (n, 2) as a path (n, 3) without arcs."""
    points = np.asarray(points, float)
    return np.column_stack([points, np.zeros(len(points))])


def flatten(path: FloatArray, per_rad: float = 10.0) -> FloatArray:
    """Return the corners (m, 2) of a path (n, 3), its arcs cut into so many short lines a radian.

    Ten are off by a hundredth of a millimetre at a door's size.
    """
    parts = [path[:1, :2]]
    for (x0, y0, bulge), (x1, y1, _) in pairwise(path):
        start, end = np.array([x0, y0]), np.array([x1, y1])
        if bulge == 0:
            parts.append(end[None])
            continue
        turn = 4 * np.arctan(bulge)
        chord = end - start
        # the centre lies left of the chord's middle where the arc turns left by less than half
        away = np.array([-chord[1], chord[0]]) / (2 * np.tan(turn / 2))
        centre = (start + end) / 2 + away
        angles = np.linspace(0, turn, int(np.ceil(per_rad * abs(turn))) + 1)[1:]
        x, y = start - centre
        turned = [x * np.cos(angles) - y * np.sin(angles), x * np.sin(angles) + y * np.cos(angles)]
        parts.append(centre + np.column_stack(turned))
    return np.concatenate(parts)
