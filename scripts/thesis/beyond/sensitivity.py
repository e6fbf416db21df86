"""What verdicts on the thesis's claims make of numbers that it does not state."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial

import numpy as np

from scanplan.lab.evaluation.length_metrics import safe_share
from scanplan.lab.evaluation.wall_findings import Findings
from scanplan.selection import area_greedy, hulls
from scanplan.types import Columns, FloatArray, IntArray, Settings
from thesis.beyond.measurements import Measurement
from thesis.beyond.wall_search import WallSearch, measure_walls
from thesis.claim_measures import FOUND
from thesis.comparison.survey_findings import SurveyTruth, match_walls
from thesis.stated_claims import Judged
from thesis.survey_files import OpenedSurvey

LITTLE_LOSS = "a tenth of the scans loses little"
POOREST = "the recorded order is the poorest"
"""Two claims of the thesis (5.2, 5.4) that hang on every stage; values are margins, in shares."""


def measure_sensitivity(
    survey: OpenedSurvey, search: WallSearch, sampling: Settings, factors: Sequence[float]
) -> Iterator[list[Measurement]]:
    """Judge two claims with each unstated number multiplied by factors, one at a time.

    Parameters
    ----------
    survey : survey_files.OpenedSurvey
        With the cell of its bitmaps.
    search : wall_search.WallSearch
        Inlier band and bandwidth of the mean shift among its settings.
    sampling : dict
        Keywords of `hulls.make_cluster_hulls`, with the size of the sample.

    Yields
    ------
    list of Measurement
        Of one value of one number; `level` is the factor.
    """
    cell_m = survey.bitmap_cell_m
    usual = survey.match_walls()
    order = _order_by_hulls(survey, sampling)

    def change_walls(name: str, factor: float) -> tuple[Findings, IntArray]:
        value = factor * getattr(search.settings, name)
        walls = search.change(**{name: value}).find_all(survey.truth, survey.store.scans())
        return match_walls(survey.truth, walls, cell_m), order

    def change_sample(factor: float) -> tuple[Findings, IntArray]:
        size = max(1, round(factor * sampling["sample_size"]))
        return usual, _order_by_hulls(survey, {**sampling, "sample_size": size})

    def change_cell(factor: float) -> tuple[Findings, IntArray]:
        return match_walls(survey.truth, survey.walls, factor * cell_m), order

    changes: dict[str, Callable[[float], tuple[Findings, IntArray]]] = {
        "inlier band of RANSAC": partial(change_walls, "inlier_m"),
        "bandwidth of the mean shift": partial(change_walls, "bandwidth_m"),
        "sample of KMeans": change_sample,
        "cell of the bitmaps": change_cell,
    }
    for name, change in changes.items():
        for factor in factors:
            findings, chosen = (usual, order) if factor == 1 else change(factor)
            margins = judge_claims_of(survey.truth, findings, chosen, sampling["seed"])
            yield [Measurement(name, factor, 0, claim, value) for claim, value in margins.items()]


def judge_claims_of(
    survey: SurveyTruth, findings: Findings, order: IntArray, seed: int
) -> dict[str, float]:
    """Return the margins by which the two claims hold, above 0 where they do.

    Parameters
    ----------
    order : (n,) int
        Rows of all scans by cluster hulls.
    seed : int
        Of the random order.
    """
    n_scans = len(order)
    tenth = max(1, n_scans // 10)
    drawn = np.random.default_rng(seed).permutation(n_scans)
    subsets = (np.arange(n_scans), order[:tenth], np.arange(tenth), drawn[:tenth])
    every, first, recorded, random = (measure_walls(survey, findings, rows) for rows in subsets)
    others = min(first["correct_match"], random["correct_match"])
    return {
        LITTLE_LOSS: safe_share(first[FOUND], every[FOUND]) - Judged.ALMOST,
        POOREST: float(others - recorded["correct_match"]),
    }


def _order_by_hulls(survey: OpenedSurvey, sampling: Settings) -> IntArray:
    _, polygons = hulls.scan_polygons(hull_scans(survey.store.scans(), sampling))
    return area_greedy.order_by_area(polygons).order


def hull_scans(scans: Iterable[tuple[int, FloatArray]], sampling: Settings) -> Columns:
    """Return the table of hulls of scans, given with their ids and points (n, 3)."""
    return hulls.concatenate_hulls(
        [hulls.make_cluster_hulls(scan_id, xyz_m, **sampling) for scan_id, xyz_m in scans]
    )
