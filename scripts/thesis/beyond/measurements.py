"""What an experiment measures: one table for all, case by case."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import pandas as pd

from scanplan.store import tables
from scanplan.types import FilePath
from thesis import thesis_schemas


class Measurement(NamedTuple):
    """A row of `thesis_schemas.MEASUREMENTS`.

    Attributes
    ----------
    case : str
        What is compared, as figures call it.
    level : float
        How much of it: number of scans, share, factor.
    item : int
        Which one of several alike: draw, seed, scan.
    quantity : str
    value : float
    """

    case: str
    level: float
    item: int
    quantity: str
    value: float


def write_measurements(path: FilePath, rows: Iterable[Measurement]) -> None:
    """Write the table of an experiment."""
    columns = dict(zip(Measurement._fields, zip(*sorted(rows), strict=True), strict=True))
    tables.write_table(path, thesis_schemas.MEASUREMENTS, columns)


def read_measurements(paths: Sequence[FilePath]) -> pd.DataFrame:
    """Return what was measured on several surveys, rows of `Measurement`, and `survey` from 0."""
    parts = [pd.DataFrame(tables.read_table(path, thesis_schemas.MEASUREMENTS)) for path in paths]
    joined = pd.concat(parts, keys=range(len(parts)), names=["survey", None])
    return joined.reset_index("survey")


def select_quantity(measured: pd.DataFrame, quantity: str) -> pd.DataFrame:
    """Return a quantity by level and survey, the mean over items; cases by columns."""
    rows = measured[measured["quantity"] == quantity]
    means = rows.groupby(["level", "survey", "case"])["value"].mean()
    return means.unstack()[list(rows["case"].unique())]


def mean_by_level(measured: pd.DataFrame, quantity: str) -> pd.DataFrame:
    """Return the mean of a quantity over items and surveys: levels by rows, cases by columns."""
    return select_quantity(measured, quantity).groupby("level").mean()
