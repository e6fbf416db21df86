"""What of an evaluation the thesis's claims are judged by; the claims' measures build on it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from scanplan.selection import stopping
from thesis.stated_claims import Judged, Sizes

Tables = Mapping[str, pd.DataFrame]
"""The tables of one survey by the names that `judging.judge_claims` knows them by."""
Quantities = dict[str, tuple[float, str]]
"""Value and unit by quantity."""

FOUR = ("cluster_hull", "hull", "random", "sequential")
"""The orders that the thesis compares."""
OURS, ITERATIVE = "cluster_ransac", "iterative_ransac"
PLAIN, PLAIN_CLUSTERS = "plain_ransac", "plain_clusters"
"""Iterative and cluster RANSAC as the thesis describes them, see `extraction.thesis_ransac`."""
FOUND, CORRECT = "visible_completeness_010m", "visible_correctness_010m"
ENTERED = "entered_completeness_010m"
CHOOSING, ORDERING, LITERAL = "choose_scans", "order_scans", "order_scans_literally"
MERGING = "merge_segments"
BUILDING, SAMPLED, UNSAMPLED = "build_hulls", "build_sampled_hulls", "build_unsampled_hulls"
"""Tasks that are timed, beside the extractors."""
THINNED = "thinned_"
"""Comes before the name of an extractor where the scans were thinned."""
SHARE, COUNT, NUMBER = "%", "count", "number"
METRES, AREA, SECONDS, MILLISECONDS = "m", "m²", "s", "ms"
"""Units of what is measured: of a share its value is from 0 to 1."""
MARGIN = "margin of the criterion"
"""The quantity that a verdict goes by: above 0 the criterion holds, and by so much."""


@dataclass(frozen=True)
class ClaimMeasure:
    """What was measured, by quantity, and by how much the claim's criterion holds.

    `margin` is above 0 where it holds, NaN where that could not be measured, and None of a mere
    number.
    """

    values: Quantities
    margin: float | None = None
    unit: str = NUMBER


def curve_of(walls: pd.DataFrame, method: str, extractor: str, column: str) -> pd.Series:
    """Return a column of an evaluation for one method and extractor, by number of scans."""
    rows = walls[(walls["method"] == method) & (walls["extractor"] == extractor)]
    return rows.set_index("k")[column]


def measure_at(walls: pd.DataFrame, method: str, extractor: str, k: float, column: str) -> float:
    """Return a column of the evaluation for the first k scans, infinity for all.

    It is NaN where so many were not evaluated: a survey of fewer scans has no first k.
    """
    curve = curve_of(walls, method, extractor, column)
    return float(curve.get(curve.index.max() if np.isinf(k) else k, np.nan))


def measure_tenth(
    walls: pd.DataFrame, columns: Sequence[str]
) -> tuple[int, list[float], list[float]]:
    """Measure the first tenth of the scans, and all of them, by cluster hulls.

    Returns
    -------
    tenth : int
        How many scans it is.
    some, every : list of float
        The columns of the evaluation for these, and for all.
    """
    tenth = max(1, walls["k"].max() // 10)
    some, every = (
        [measure_at(walls, "cluster_hull", OURS, k, column) for column in columns]
        for k in (tenth, np.inf)
    )
    return tenth, some, every


def count_scans_to(walls: pd.DataFrame, method: str, share: float) -> float:
    """Return the least evaluated number of scans that find a share of what all of them find."""
    found = curve_of(walls, method, OURS, FOUND)
    enough = found.index[found >= share * found.iloc[-1]]
    return float(enough.min())


def mean_over_first(walls: pd.DataFrame, column: str) -> pd.Series:
    """Return the means of a column over the first 1, 2, ... 60 scans by cluster RANSAC, by method.

    They are linear between the numbers of scans evaluated: these lie denser the smaller they are,
    and their own mean would be one of the first few scans.
    """
    of_extractor = walls[walls["extractor"] == OURS]
    curves = of_extractor.pivot(index="k", columns="method", values=column)
    every = np.arange(1, min(Sizes.MANY, curves.index.max()) + 1)
    return curves.reindex(curves.index.union(every)).interpolate("index").loc[every].mean()


def scans_for_99(selection: pd.DataFrame) -> int:
    """Return how many scans of an order cover 99 % of what all cover."""
    columns = {name: selection[name].to_numpy() for name in selection}
    return stopping.choose_n_scans(columns, area_share=0.99)[0]


def least_kept(some: Sequence[float], every: Sequence[float]) -> float:
    """Return by how much more than 90 % a part keeps of the measure that it keeps least of.

    NaN where one is not known or all have nothing.

    Parameters
    ----------
    some, every : (n,) sequence of float
        Measures of a part and of the whole, in the same order: the more, the better.
    """
    whole = np.array(every)
    if not (whole > 0).all():
        return np.nan
    return float((np.array(some) / whole).min() - Judged.ALMOST)


def of_unit(values: Mapping[str, float], unit: str) -> Quantities:
    """Return values by quantity with the unit of all of them."""
    return {quantity: (value, unit) for quantity, value in values.items()}


def count_clusters(number: int) -> str:
    """Return a number of clusters in words."""
    return f"{number} cluster{'s' if number > 1 else ''}"


def growth_exponent(times: pd.DataFrame, task: str, of: str = "seconds") -> float:
    """Return the b of seconds = a size^b of a task, with an own a for every item.

    By least squares; NaN where no size varies.

    Parameters
    ----------
    times : pandas.DataFrame
        `thesis_schemas.TIMES`.
    of : str
        The column that grows.
    """
    rows = times[times["task"] == task]
    if not len(rows) or (rows[of] <= 0).any():
        return np.nan
    logs = np.log(rows[["size", of]]).groupby(rows["item"])
    centred = np.log(rows[["size", of]]) - logs.transform("mean")
    squares = (centred["size"] ** 2).sum()
    if not (logs["size"].nunique() > 1).any():
        return np.nan
    return float((centred["size"] * centred[of]).sum() / squares)
