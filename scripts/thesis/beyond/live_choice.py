"""Scans chosen while a recording plays, against orders of all scans at as many."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from scanplan.lab.evaluation.wall_findings import Findings
from scanplan.selection.playing import PlayingSelection
from scanplan.types import Columns, IntArray
from thesis.beyond.measurements import Measurement
from thesis.beyond.wall_search import measure_walls
from thesis.claim_measures import FOUND
from thesis.comparison.survey_findings import SurveyTruth

PLAYING = "while it plays"
FOUND_SHARE, TAKEN, HELD = "walls found", "scans taken", "cells kept at most"


def measure_live_choice(
    survey: SurveyTruth,
    findings: Findings,
    observed: Columns,
    orders: Mapping[str, IntArray],
    shares: Sequence[float],
) -> Iterator[Measurement]:
    """Measure what is taken in one pass, and what as many of the first scans of orders find.

    Parameters
    ----------
    observed : dict of str to (m,) array
        The columns of `schemas.OBSERVATIONS`.
    orders : dict of str to (n,) int
        Rows by method.

    Yields
    ------
    Measurement
        `level` is the least share of new wall.
    """
    ids = survey.registered.scan_ids
    begins = np.searchsorted(observed["scan_id"], ids)
    ends = np.searchsorted(observed["scan_id"], ids, side="right")
    for share in shares:
        playing = PlayingSelection(min_new_share=share)
        taken = [
            row
            for row, (begin, end) in enumerate(zip(begins, ends, strict=True))
            if playing.take({name: values[begin:end] for name, values in observed.items()})
        ]
        chosen = {PLAYING: np.array(taken, int)}
        chosen |= {method: order[: len(taken)] for method, order in orders.items()}
        for case, rows in chosen.items():
            found = measure_walls(survey, findings, rows)[FOUND]
            yield Measurement(case, share, 0, FOUND_SHARE, float(found))
        yield Measurement(PLAYING, share, 0, TAKEN, len(taken))
        yield Measurement(PLAYING, share, 0, HELD, playing.most_held)
