"""What orders maximise, as a stand-in for the walls found: how submodular, and how well it ranks.

See `premises` for the submodularity ratio. By theory it is 1 or more of every covered area and of
the covered length of wall; what matters is that it is so of the walls found, for which they stand.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from scanplan.lab.evaluation.wall_findings import Findings, VisibleTruth
from scanplan.selection import objectives
from scanplan.selection.objectives import Objective
from scanplan.selection.survey_scans import SurveyScans
from scanplan.types import IntArray
from thesis import premises

SurrogateRow = dict[str, Any]
"""A row of `thesis_schemas.SURROGATES`."""
SURROGATES = {
    "length of wall shown": objectives.cover_wall_length,
    "free space": objectives.cover_free_space,
    "area of cluster hulls": objectives.cover_cluster_hulls,
    "area of one hull each": objectives.cover_full_hulls,
}


def measure_draws(
    scans: SurveyScans,
    truth: VisibleTruth,
    findings: Findings,
    *,
    n_added: int,
    seed: int,
) -> Iterator[list[SurrogateRow]]:
    """Measure every surrogate on random scans that are added to as many random others.

    Parameters
    ----------
    scans : survey_scans.SurveyScans
        With the tables `observations`, `visibility` and `hulls`.
    findings : wall_findings.Findings
        Of one extractor.
    n_added, seed : int
        See `premises.draw_additions`.

    Yields
    ------
    list of SurrogateRow
        Of one draw, a row for every surrogate.
    """
    covers = {name: make(scans) for name, make in SURROGATES.items()}
    draws = premises.draw_additions(len(scans), n_added=n_added, seed=seed)
    for draw, (before, added) in enumerate(draws):
        found = premises.measure_utilities(truth, findings, before)[0]
        rows: list[SurrogateRow] = []
        for name, cover in covers.items():
            value, ratio = _measure_draw(cover, before, added)
            rows.append(
                {"surrogate": name, "draw": draw, "value": value, "ratio": ratio, "found": found}
            )
        yield rows


def _measure_draw(cover: Objective, before: IntArray, added: IntArray) -> tuple[float, float]:
    """Return what some scans cover, and the ratio of what others add singly and together."""
    gains = cover.gains(np.concatenate([before, added]))
    together = gains[len(before) :].sum()
    singly = sum(cover.gains(np.append(before, scan))[-1] for scan in added)
    value = float(gains[: len(before)].sum())
    return value, float(singly / together) if together > 0 else np.nan
