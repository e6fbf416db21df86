"""The files of a survey that experiments are made on, opened."""

from collections.abc import Mapping
from dataclasses import dataclass

from scanplan.lab.evaluation.wall_findings import Findings
from scanplan.selection.methods import METHODS
from scanplan.store import registered_scans, tables
from scanplan.store.tables import ScanStore
from scanplan.types import Array, FilePath, IntArray
from thesis.comparison.survey_findings import SurveyTruth, match_walls, read_survey_truth


@dataclass(frozen=True)
class OpenedSurvey:
    """A survey with its truth, and the tables made of it.

    Attributes
    ----------
    truth : survey_findings.SurveyTruth
    store : tables.ScanStore
    walls : dict of str to (s,) array
        The columns of walls/cluster_ransac.parquet.
    orders : dict of str to (n,) int
        Rows of the scans by method, of the methods whose orders were given.
    bitmap_cell_m : float
        Edge of a bitmap's cell.
    """

    truth: SurveyTruth
    store: ScanStore
    walls: dict[str, Array]
    orders: dict[str, IntArray]
    bitmap_cell_m: float

    def match_walls(self) -> Findings:
        """Work out what the walls find, see `survey_findings.match_walls`."""
        return match_walls(self.truth, self.walls, self.bitmap_cell_m)


def open_survey_files(
    files: Mapping[str, FilePath], *, max_range_m: float, bitmap_cell_m: float
) -> OpenedSurvey:
    """Open a survey.

    Parameters
    ----------
    files : dict of str to path-like
        `scans`, `walls`, `registration`, `truth` and `true_poses`; selection/<method>.parquet as
        `order_<method>`; others are not looked at.
    max_range_m, bitmap_cell_m : float
        How far a scan can see; edge of a bitmap's cell.

    Raises
    ------
    StageError
        If a file cannot be used.
    """
    registration = files["registration"]
    truth = read_survey_truth(
        registration, files["truth"], files["true_poses"], max_range_m=max_range_m
    )
    known = truth.registered
    orders = {
        method: registered_scans.read_order_rows(files[f"order_{method}"], known, registration)
        for method in METHODS
        if f"order_{method}" in files
    }
    walls = registered_scans.read_wall_segments(files["walls"], known, registration)
    store = tables.ScanStore(files["scans"])
    return OpenedSurvey(truth, store, walls, orders, bitmap_cell_m)
