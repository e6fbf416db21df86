"""Whether what a plan doubts is wrong, and what it is sure of right.

Calibration: Guo, Pleiss, Sun and Weinberger 2017, "On calibration of modern neural networks": ten
bins of equal width; the expected calibration error is the mean difference of probability and share
that is right, weighed by the elements in a bin.
"""

import numpy as np

from scanplan.lab.evaluation.scores.score import (
    MISSED,
    RIGHT,
    UNCOUNTED,
    mean_or_nan,
    share_or_nan,
)
from scanplan.types import BoolArray, Columns, FloatArray

RATED = ("face", "wall", "opening", "room")
"""Tables whose elements a plan rates."""
BINS = 10
_SURE = 0.99  # of what a reader takes for certain


def score_flags(elements: Columns) -> dict[str, float]:
    """Measure flags and probabilities of elements, see `score.Score.elements`.

    Returns
    -------
    dict of str to float
        By table, and for `all`: `<table>_n_wrong`, `<table>_wrong_flagged`, `<table>_right_flagged`
        (shares of the wrong and of the right elements that are flagged), `<table>_wrong_and_sure`
        (number of the wrong that are not), `<table>_no_probability` (share),
        `<table>_calibration_error`, `<table>_sure_n` and `<table>_sure_right` (where p >= .99), and
        `<table>_bin_<i>_n`, `_p`, `_right`. `missed_<kind>` and `missed_<kind>_asked` of openings.
    """
    drawn = (elements["number"] >= 0) & ~np.isin(elements["verdict"], [MISSED, *UNCOUNTED])
    measures: dict[str, float] = {}
    for table in (*RATED, "all"):
        of_table = np.isin(elements["table"], RATED if table == "all" else [table])
        # a wall's faces are it once more
        chosen = drawn & of_table & ~((table == "all") & (elements["table"] == "wall"))
        measures |= measure_flags(
            table,
            elements["verdict"][chosen] == RIGHT,
            np.asarray(elements["flagged"][chosen], bool),
            np.asarray(elements["p_true"][chosen], float),
        )
    missed = (elements["verdict"] == MISSED) & (elements["table"] == "opening")
    is_window = elements["kind"] == "window"
    for name, chosen in (("windows", missed & is_window), ("doors", missed & ~is_window)):
        measures[f"missed_{name}"] = int(chosen.sum())
        measures[f"missed_{name}_asked"] = mean_or_nan(elements["flagged"][chosen])
    return measures


def measure_flags(
    table: str, right: BoolArray, flagged: BoolArray, p_true: FloatArray
) -> dict[str, float]:
    """Return what `score_flags` returns of one table, of elements (n,) that are right or not."""
    known = np.isfinite(p_true)
    sure = known & (p_true >= _SURE)
    return {
        f"{table}_n": len(right),
        f"{table}_n_wrong": int((~right).sum()),
        f"{table}_wrong_flagged": mean_or_nan(flagged[~right]),
        f"{table}_right_flagged": mean_or_nan(flagged[right]),
        f"{table}_wrong_and_sure": int((~right & ~flagged).sum()),
        f"{table}_no_probability": share_or_nan(int((~known).sum()), len(known)),
        f"{table}_sure_n": int(sure.sum()),
        f"{table}_sure_right": mean_or_nan(right[sure]),
        **_calibrate(table, right[known], p_true[known]),
    }


def _calibrate(table: str, right: BoolArray, p_true: FloatArray) -> dict[str, float]:
    bins = np.minimum((p_true * BINS).astype(int), BINS - 1)
    measures: dict[str, float] = {}
    error = 0.0
    for i in range(BINS):
        own = bins == i
        error += abs(p_true[own].sum() - right[own].sum())
        measures[f"{table}_bin_{i}_n"] = int(own.sum())
        measures[f"{table}_bin_{i}_p"] = mean_or_nan(p_true[own])
        measures[f"{table}_bin_{i}_right"] = mean_or_nan(right[own])
    return {f"{table}_calibration_error": share_or_nan(error, len(right)), **measures}
