"""What of an evaluation the thesis's claims are judged by; the claims' measures build on it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from scanplan.lab.thesis.stated_claims import ABOUT, ALMOST
from scanplan.selection import stopping
from scanplan.types import Columns

Tables = Mapping[str, Columns]
"""The tables of one survey by the names that `judging.judge_claims` knows them by."""
Quantities = dict[str, tuple[float, str]]
"""Value and unit by quantity."""

FOUR = ("cluster_hull", "hull", "random", "sequential")
"""The orders that the thesis compares."""
OURS, ITERATIVE = "cluster_ransac", "iterative_ransac"
PLAIN, PLAIN_CLUSTERS = "plain_ransac", "plain_clusters"
"""Iterative and cluster RANSAC as the thesis describes them, see `extraction.thesis_ransac`."""
FOUND, CORRECT = "visible_completeness_010m", "visible_correctness_010m"
CHOOSING, ORDERING, BUILDING = "choose_scans", "order_scans", "build_hulls"
"""Tasks that are timed, beside the extractors."""
THINNED = "thinned_"
"""Comes before the name of an extractor where the scans were thinned."""
SHARE, COUNT, NUMBER = "%", "count", "number"
METRES, AREA, SECONDS, MILLISECONDS = "m", "m²", "s", "ms"
"""Units of what is measured: of a share its value is from 0 to 1."""
_MOST = 80  # scans: the claims on whole orders are on the part in which they differ


@dataclass(frozen=True)
class ClaimMeasure:
    """What was measured, by quantity (value, unit), and whether the claim holds by it.

    `holds` is None for a mere number and for what could not be measured.
    """

    values: Quantities
    holds: bool | None = None


def rows_of_method(walls: Columns, method: str, extractor: str) -> Columns:
    """Return the rows of an evaluation of one method and extractor, by number of scans."""
    rows = (walls["method"] == method) & (walls["extractor"] == extractor)
    return {name: values[rows] for name, values in walls.items()}


def measure_at(walls: Columns, method: str, extractor: str, k: float, column: str) -> float:
    """Return a column of the evaluation for the first k scans, infinity for all.

    It is NaN where so many were not evaluated: a survey of fewer scans has no first k.
    """
    rows = rows_of_method(walls, method, extractor)
    wanted = rows["k"].max() if np.isinf(k) else k
    values = rows[column][rows["k"] == wanted]
    return float(values[0]) if len(values) else np.nan


def mean_over_first(walls: Columns, method: str, column: str) -> float:
    """Return the mean of a column over the first 1, 2, ... 80 scans by cluster RANSAC.

    It is linear between the numbers of scans evaluated: these lie denser the smaller they are, and
    their own mean would be one of the first few scans.
    """
    rows = rows_of_method(walls, method, OURS)
    every = np.arange(1, min(_MOST, rows["k"].max()) + 1)
    return float(np.interp(every, rows["k"], rows[column]).mean())


def scans_for_99(selection: Columns) -> int:
    """Return how many scans of an order cover 99 % of what all cover."""
    return stopping.choose_n_scans(selection, area_share=0.99)[0]


def is_about(ours: float, stated: float) -> bool:
    """Return whether a number is the one that the thesis states as "about"."""
    return bool(abs(ours - stated) <= ABOUT * stated)


def is_similar(some: Sequence[float], every: Sequence[float]) -> bool | None:
    """Return whether no more than a tenth is lost of any measure.

    None where one is not known or all have nothing.

    Parameters
    ----------
    some, every : (n,) sequence of float
        Measures of a part and of the whole, in the same order: the more, the better.
    """
    part, whole = np.array(some), np.array(every)
    if not (np.isfinite(part).all() and np.isfinite(whole).all() and (whole > 0).all()):
        return None
    return bool((part >= ALMOST * whole).all())


def of_unit(values: Mapping[str, float], unit: str) -> Quantities:
    """Return values by quantity with the unit of all of them."""
    return {quantity: (value, unit) for quantity, value in values.items()}


def count_clusters(number: int) -> str:
    """Return a number of clusters in words."""
    return f"{number} cluster{'s' if number > 1 else ''}"


def if_known(values: ArrayLike, holds: bool | np.bool_) -> bool | None:
    """Return a verdict, or none where a value that it goes by could not be measured."""
    return bool(holds) if np.isfinite(values).all() else None
