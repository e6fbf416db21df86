"""Walls of a survey in cells along their lines, as another survey is asked about them."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from scanplan.changes import ray_cells
from scanplan.changes.ray_cells import CELL_M
from scanplan.changes.surveys import Survey
from scanplan.geometry.lines import Line
from scanplan.plan.floorplan import FloorPlan, centrelines_m
from scanplan.types import FloatArray

_MEETS_M = 0.3  # of a wall's end and another: as far as a plan draws them apart
_THROUGH_M = 0.5  # of a wall's end beyond another that holds it: it is drawn, or built, through
_BOW_M = 0.05  # of a piece of a curved wall: half of what rays are off by at a wall


@dataclass(frozen=True, eq=False)
class Wall:
    """A wall in the common frame, or a piece of a curved one, in cells along its line.

    Attributes
    ----------
    number : int
    line : Line
        Its middle, or its one face, from its first end on.
    half_m : float
        Half of its thickness; 0 where that is not known.
    n_cells : int
    p_true : float
        How likely it is a wall.
    p_met : (float, float)
        How likely what meets its two ends are walls; 0 where no two others do.
    """

    number: int
    line: Line
    half_m: float
    n_cells: int
    p_true: float
    p_met: tuple[float, float]

    @property
    def is_built_in(self) -> bool:
        """Whether two others meet its ends, as of no cupboard."""
        return min(self.p_met) > 0

    def rate_built_in(self, share: float) -> float:
        """Return how likely it has changed from wall to wall, if a share of its cells has."""
        return math.prod(self.p_met) * share

    def draw(self, cells: slice) -> shapely.LineString:
        """Return a stretch of it as a line."""
        return shapely.LineString(self.line.at(np.array([cells.start, cells.stop]) * CELL_M))

    @property
    def span_m(self) -> tuple[float, float]:
        """From where to where along its line."""
        return 0.0, self.n_cells * CELL_M

    @property
    def middle_m(self) -> FloatArray:
        """The middles of its cells along its line, (c,) float64."""
        return (np.arange(self.n_cells) + 0.5) * CELL_M


def list_walls(survey: Survey) -> Iterator[Wall]:
    """Yield the walls of a survey in the common frame, curved ones in pieces that hardly bow."""
    plan = survey.plan
    left_m, right_m = plan.sides_m
    rated = np.nan_to_num(np.asarray(plan.walls["p_true"], float), nan=1.0)
    for row, number in enumerate(plan.walls["wall"].tolist()):
        is_thick = bool(plan.thick[row])
        # of one seen from one side the line is that of its face
        half_m = float(left_m[row] + right_m[row]) / 2 if is_thick else 0.0
        p_met = _rate_met(plan, row, rated)
        for ends_m in survey.motion.move(_cut_lines(plan, row)):
            line, length_m = ray_cells.line_between(ends_m)
            n_cells = ray_cells.count_cells((0.0, length_m))
            yield Wall(number, line, half_m, n_cells, float(rated[row]), p_met)


def _cut_lines(plan: FloorPlan, row: int) -> FloatArray:
    """Return the line (1, 2, 2) of a wall; of a curved one pieces (k, 2, 2) that hardly bow."""
    shapes = plan.wall_shapes
    if not shapes.is_bent[row]:
        return shapes.lines_m[row][None]
    longest_m = math.sqrt(8 * _BOW_M * float(plan.walls["arc_radius_m"][row]))
    n_pieces = math.ceil(float(plan.lengths_m[row]) / longest_m)
    corners_m, _ = shapes.place_along(row, np.linspace(0, 1, n_pieces + 1))
    return np.stack([corners_m[:-1], corners_m[1:]], axis=1)


def hold_walls(walls: Sequence[Wall], plan: FloorPlan, changed: Mapping[int, float]) -> list[Wall]:
    """Return walls as those hold them that stand in both surveys: a cupboard's sides come as one.

    Parameters
    ----------
    changed : dict of int to float
        How likely each wall has changed, by its number.
    """
    rated = np.nan_to_num(np.asarray(plan.walls["p_true"], float), nan=1.0)
    numbers = plan.walls["wall"].tolist()
    stands = rated * [1 - changed.get(number, 0.0) for number in numbers]
    held = {number: _rate_met(plan, row, stands) for row, number in enumerate(numbers)}
    return [replace(wall, p_met=held[wall.number]) for wall in walls]


def _rate_met(plan: FloorPlan, row: int, rated: FloatArray) -> tuple[float, float]:
    """Return how likely what meets the ends of a wall is a wall, 0 where nothing does.

    Of two others: by one alone a short piece has both ends.
    """
    others = np.delete(np.arange(len(rated)), row)
    ends_m = centrelines_m(plan.walls)[row]
    inner_m = min(_THROUGH_M / max(float(plan.lengths_m[row]), _THROUGH_M), 1 / 3)
    way_m = inner_m * (ends_m[::-1] - ends_m)
    met = [
        others[shapely.dwithin(end, plan.bodies[others], _MEETS_M)]
        for end in map(shapely.LineString, np.stack([ends_m, ends_m + way_m], axis=1))
    ]
    both = [(float(rated[i]), float(rated[j])) for i in met[0] for j in met[1] if i != j]
    return max(both, key=math.prod, default=(0.0, 0.0))
