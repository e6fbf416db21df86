"""A design laid on a plan, as a prior of the plan that is made next."""

from collections.abc import Sequence

import numpy as np

from scanplan.changes.change_table import warn_of_others
from scanplan.design.as_built import tie_storey, warn_of_alike
from scanplan.design.drawn_storey import DrawnStorey
from scanplan.plan.floorplan import FloorPlan
from scanplan.plan.model.designed_walls import DesignedWalls
from scanplan.types import FloatArray


def lay_design(
    storeys: Sequence[DrawnStorey], source: str, plan: FloorPlan, chosen: str | int | None = None
) -> tuple[DesignedWalls, list[str]]:
    """Return the straight walls of the storey that a plan fits best, in the plan's frame.

    And in words which storey it is, and which others or other turns of it fit nearly as well.

    Parameters
    ----------
    storeys, source, chosen
        See `as_built.compare_design`.

    Raises
    ------
    StageError
        If the plan fits none of the storeys.
    """
    tied = tie_storey(storeys, source, plan, chosen)
    back = tied.tie.fit.motion.inverse()

    def place(lines_m: Sequence[FloatArray]) -> FloatArray:
        return back.move(np.array(lines_m, float).reshape(-1, 2, 2))

    # of curved walls no line is known that labels are found along
    straight = [row for row, wall in enumerate(tied.storey.walls) if wall.centre_m is None]
    rows = {wall: row for row, wall in enumerate(straight)}
    walls = [tied.storey.walls[row] for row in straight]
    openings = [opening for opening in tied.storey.openings if opening.wall in rows]
    laid = DesignedWalls(
        place([wall.line_m for wall in walls]),
        np.array([wall.thickness_m / 2 for wall in walls]),
        place([opening.line_m for opening in openings]),
        np.array([rows[opening.wall] for opening in openings], np.int64),
        np.array([opening.kind for opening in openings], object),
    )
    told = [f"the plan is likelier to be as {source}, {tied.storey.name}"]
    return laid, [*told, *filter(None, [warn_of_alike(tied), warn_of_others(tied.tie)])]
