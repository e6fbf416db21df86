"""What of an evaluation the thesis's claims are judged by; the claims' measures build on it."""

from dataclasses import dataclass

import numpy as np

from scanplan.lab.thesis.stated_claims import ABOUT, ALMOST
from scanplan.selection import stopping

FOUR = ("cluster_hull", "hull", "random", "sequential")
"""The orders that the thesis compares."""
OURS, ITERATIVE = "cluster_ransac", "iterative_ransac"
PLAIN, PLAIN_CLUSTERS = "plain_ransac", "plain_clusters"
"""Iterative and cluster RANSAC as the thesis describes them, see `plain_ransac`."""
FOUND, CORRECT = "visible_completeness_010m", "visible_correctness_010m"
SUBSET, MANY = 15, 60
"""Sizes of the subsets that the thesis shows walls of."""
CHOOSING, ORDERING, BUILDING, THINNED = "choose_scans", "order_scans", "build_hulls", "thinned_"
"""Tasks that are timed, beside the extractors; the last comes before one's name where the scans were thinned."""
SHARE, COUNT, NUMBER, METRES, AREA, SECONDS, MILLISECONDS = (
    "%",
    "count",
    "number",
    "m",
    "m²",
    "s",
    "ms",
)
"""Units of what is measured: of a share its value is from 0 to 1."""
_MOST = 80


@dataclass(frozen=True)
class ClaimMeasure:
    """What was measured, by quantity (value, unit), and whether the claim holds by it.

    `holds` is None for a mere number and for what could not be measured.
    """

    values: dict
    holds: bool | None = None


def rows_of_method(walls, method, extractor):
    """Return the rows of an evaluation of one method and extractor, by number of scans."""
    of_it = (walls["method"] == method) & (walls["extractor"] == extractor)
    return {name: values[of_it] for name, values in walls.items()}


def measure_at(walls, method, extractor, k, column):
    """Return a column of the evaluation for the first k scans, infinity for all; NaN where so many were not evaluated.

    A survey of fewer scans has no first k.
    """
    rows = rows_of_method(walls, method, extractor)
    at = np.flatnonzero(rows["k"] == (rows["k"].max() if np.isinf(k) else k))
    return float(rows[column][at[0]]) if len(at) else np.nan


def mean_over_first(walls, method, column):
    """Return the mean of a column over the first 1, 2, ... 80 scans by cluster RANSAC, linear between those evaluated.

    The numbers of scans evaluated lie denser the smaller they are: their own mean would be one of the first few scans.
    """
    rows = rows_of_method(walls, method, OURS)
    every = np.arange(1, min(_MOST, rows["k"].max()) + 1)
    return float(np.interp(every, rows["k"], rows[column]).mean())


def scans_for_99(selection):
    """Return how many scans of an order cover 99 % of what all cover."""
    return stopping.choose_n_scans(selection, area_share=0.99)[0]


def is_about(ours, stated):
    """Tell whether a number is the one that the thesis states as "about"."""
    return bool(abs(ours - stated) <= ABOUT * stated)


def is_similar(some, every):
    """Tell whether no more than a tenth is lost of any measure; None where one is not known or all have nothing.

    Parameters
    ----------
    some, every : (n,) sequence of float
        Measures of a part and of the whole, in the same order: the more, the better.
    """
    some, every = np.array(some), np.array(every)
    if not (np.isfinite(some).all() and np.isfinite(every).all() and (every > 0).all()):
        return None
    return bool((some >= ALMOST * every).all())


def if_known(values, holds):
    """Return a verdict, or none where a value that it goes by could not be measured."""
    return bool(holds) if np.isfinite(values).all() else None
