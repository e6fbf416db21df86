"""What of an evaluation the thesis's claims are judged by; the claims' measures build on it."""

from dataclasses import dataclass

import numpy as np

from scanplan.selection import stopping
from scanplan.thesis.thesisclaims import ABOUT

FOUR = ("cluster_hull", "hull", "random", "sequential")
"""The orders that the thesis compares."""
OURS, ITERATIVE = "cluster_ransac", "iterative_ransac"
FOUND = "visible_completeness_010m"
SUBSET, MANY = 15, 60
"""Sizes of the subsets that the thesis shows walls of."""
_MOST = 80


@dataclass(frozen=True)
class Measured:
    """What was measured, by quantity, and whether the claim holds by it; None for a mere number."""

    values: dict
    holds: bool | None = None


def of_method(walls, method, extractor):
    """Return the rows of an evaluation of one method and extractor, by number of scans."""
    of_it = (walls["method"] == method) & (walls["extractor"] == extractor)
    return {name: values[of_it] for name, values in walls.items()}


def value_at(walls, method, extractor, k, column):
    """Return a column of the evaluation for the first k scans, or all if there are fewer."""
    rows = of_method(walls, method, extractor)
    return float(rows[column][rows["k"] <= k][-1])


def mean_over_first(walls, method, column):
    """Return the mean of a column over the first 1, 2, ... 80 scans by cluster RANSAC, linear between those evaluated.

    The numbers of scans evaluated lie denser the smaller they are: their own mean would be one of the first few scans.
    """
    rows = of_method(walls, method, OURS)
    every = np.arange(1, min(_MOST, rows["k"].max()) + 1)
    return float(np.interp(every, rows["k"], rows[column]).mean())


def scans_for_99(selection):
    """Return how many scans of an order cover 99 % of what all cover."""
    return stopping.n_scans(selection, area_share=0.99)[0]


def is_about(ours, stated):
    """Tell whether a number is the one that the thesis states as "about"."""
    return bool(abs(ours - stated) <= ABOUT * stated)
