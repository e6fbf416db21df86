"""The floors of a campus over time: a row for each survey, with what changed since the last."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from scanplan.changes.verdicts import CHANGES, SAME, STATES
from scanplan.exports.sheet.facts import summarise_survey
from scanplan.plan.floorplan import FloorPlan
from scanplan.report.templates import render_template
from scanplan.types import BoolArray, Columns
from scanplan.validation.doubts import list_doubts

Row = dict[str, Any]
_COUNTED = {"walls": "wall", "openings": "opening", "furniture": "furniture"}


def describe_survey(
    of: Mapping[str, str], plan: FloorPlan, evidence: Columns, changes: Columns | None
) -> Row:
    """Return what a floor was like at a survey.

    Parameters
    ----------
    of : dict of str to str
        `floor`, `survey`, and `earlier`, the one before; empty of the first.
    evidence : dict of str to (n,) array
        The columns of `schemas.EVIDENCE`.
    changes : dict of str to (m,) array or None
        Those of `schemas.CHANGES` since the one before, where there is one.

    Returns
    -------
    dict of str to str, float or int
        Counts of changes are those that are likely; None of a floor's first survey.
    """
    kinds = plan.openings["type"]
    row: Row = {
        **of,
        "surveyed": summarise_survey(evidence).surveyed,
        "area_m2": round(float(plan.net_areas_m2.sum()), 2),
        "rooms": len(plan.rooms["room"]),
        "wall_m": round(float(plan.lengths_m.sum()), 2),
        "doors": int(np.isin(kinds, ("door", "passage")).sum()),
        "windows": int((kinds == "window").sum()),
        "to_verify": len(list_doubts(plan)),
    }
    return row | _count_changes(changes)


def _count_changes(changes: Columns | None) -> Row:
    names = [f"{noun}_changed" for noun in _COUNTED]
    if changes is None:
        return dict.fromkeys((*names, "doors_swung", "doubtful_changes", "unchanged_wall_m"))
    verdict, element = changes["verdict"], changes["element"]
    is_change = np.isin(verdict, CHANGES)
    is_same_wall = (verdict == SAME) & (element == "wall")
    return {
        **{
            name: _count_wholes(changes, changes["likely"] & (element == table))
            for name, table in zip(names, _COUNTED.values(), strict=True)
        },
        "doors_swung": int(np.isin(verdict, STATES).sum()),
        "doubtful_changes": _count_wholes(changes, is_change & ~changes["likely"]),
        "unchanged_wall_m": round(float(changes["length_m"][is_same_wall].sum()), 2),
    }


def _count_wholes(changes: Columns, rows: BoolArray) -> int:
    """Return of how many wholes some rows are: a wall may have several."""
    return len(np.unique(changes["whole"][rows]))


def format_page(rows: Sequence[Row], sources: Mapping[str, str]) -> str:
    """Return the rows as a page that opens offline, beside the folders of the surveys."""
    return render_template(sources, "floors.html.j2", rows=rows)
