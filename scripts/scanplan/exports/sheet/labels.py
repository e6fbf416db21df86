"""Places for words: each takes the best of its candidates that overlaps no other word.

A greedy solver: whatever comes first has the choice. It is meant for a few hundred words with a few
dozen candidates each (Christensen, Marks, Shieber: An empirical study of algorithms for
point-feature label placement, 1995).
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.sheet.lettering import CLEAR, word_box
from scanplan.exports.sheet.marks import Word
from scanplan.types import FloatArray

_STRUCK = 5.0  # words on lines that are added: more than any place beside a line costs


@dataclass(frozen=True)
class Candidate:
    """Where words could go.

    Attributes
    ----------
    words : list of Word
        On paper, millimetres.
    cost : float
        Less is better; every line that they lie on costs one more, one that is crossed two.
    lines : list of (n, 2) float arrays
        Drawn with them: no word may lie on these.
    """

    words: list[Word]
    cost: float = 0.0
    lines: tuple[FloatArray, ...] = ()


class LabelSpace:
    """A sheet of paper with what words should keep off.

    `OFF_WALL` is the highest cost of words that lie on no wall.

    Parameters
    ----------
    frame_mm : (4,) float
        Words lie within: least x and y, greatest x and y.
    walls : sequence of shapely geometries
        On paper; no word lies on these if it can lie anywhere else.
    lines : sequence of shapely geometries
        Neither words nor lines drawn with them should lie on these.
    pale : sequence of shapely geometries
        Words alone should not lie on these.
    """

    OFF_WALL = 9.0

    def __init__(
        self,
        frame_mm: tuple[float, float, float, float],
        walls: Iterable[BaseGeometry],
        lines: Iterable[BaseGeometry],
        pale: Iterable[BaseGeometry] = (),
    ) -> None:
        self._frame = shapely.box(*frame_mm)
        self._walls = shapely.STRtree([*walls])
        self._lines = shapely.STRtree([*lines])
        self._pale = shapely.STRtree([*pale])
        self._words = _Shapes()
        self._drawn = _Shapes()
        self._struck = _Shapes()

    def add_lines(self, lines: Iterable[FloatArray]) -> None:
        """Add lines (n, 2) that words lie on only if they can lie nowhere else."""
        self._struck.add([shapely.LineString(line) for line in lines])

    def place(self, candidates: Iterable[Candidate], most: float = np.inf) -> Candidate | None:
        """Take the cheapest candidate whose words overlap nothing; None if there is none.

        Candidates that cost more than `most` are not taken.
        """
        best, least = None, most
        for candidate in candidates:
            if candidate.cost >= least:
                continue
            boxes: list[BaseGeometry] = [word_box(word, CLEAR) for word in candidate.words]
            cost = candidate.cost + self._measure_cost(boxes, candidate.lines)
            if cost < least and self._is_free(boxes, candidate.lines):
                best, least = candidate, cost
        if best is not None:
            self._words.add([word_box(word, CLEAR) for word in best.words])
            self._drawn.add([shapely.LineString(line) for line in best.lines])
        return best

    def _measure_cost(self, boxes: list[BaseGeometry], lines: Iterable[FloatArray]) -> float:
        """Return what is lain on: more than `OFF_WALL` for a wall, one for a line.

        A line through another is worse than a word on it, which can be read all the same.
        """
        on_walls = len(self._walls.query(boxes, "intersects")[0])
        on_lines = len(self._lines.query(boxes, "intersects")[0])
        crossed = sum(
            len(self._lines.query(shapely.LineString(line), "intersects")) for line in lines
        )
        on_pale = len(self._pale.query(boxes, "intersects")[0])
        struck = _STRUCK * self._struck.meet(boxes)
        return (self.OFF_WALL + 1) * on_walls + on_lines + 2 * crossed + on_pale + struck

    def _is_free(self, boxes: list[BaseGeometry], lines: Iterable[FloatArray]) -> bool:
        """Return whether words lie apart from words and lines, and lines apart from words."""
        if not all(box.within(self._frame) for box in boxes):
            return False
        if self._words.meet(boxes) or self._drawn.meet(boxes):
            return False
        return not self._words.meet([shapely.LineString(line) for line in lines])


class _Shapes:
    """Shapes that are added one after the other."""

    def __init__(self) -> None:
        self._shapes: list[BaseGeometry] = []
        self._bounds = np.empty((0, 4))

    def add(self, shapes: list[BaseGeometry]) -> None:
        self._shapes += shapes
        self._bounds = np.concatenate([self._bounds, shapely.bounds(shapes).reshape(-1, 4)])

    def meet(self, shapes: list[BaseGeometry]) -> bool:
        """Return whether any of some shapes meets any of these."""
        for shape in shapes:
            x0, y0, x1, y1 = shape.bounds
            is_near = (self._bounds[:, 0] <= x1) & (self._bounds[:, 2] >= x0)
            is_near &= (self._bounds[:, 1] <= y1) & (self._bounds[:, 3] >= y0)
            if any(self._shapes[i].intersects(shape) for i in np.flatnonzero(is_near)):
                return True
        return False
