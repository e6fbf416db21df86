"""What the thesis takes for granted, measured: a submodular utility, and clusters of one wall each.

The submodularity ratio of a utility (Das and Kempe 2011, "Submodular meets spectral") is what some
scans add to others one by one, summed, per what they add together: at least 1 of a submodular one.
"""

from collections.abc import Iterable, Iterator

import numpy as np
import shapely

from scanplan.lab.evaluation import first_ranks
from scanplan.lab.evaluation.wall_findings import JUDGED, WITHIN_M, Findings, VisibleTruth
from scanplan.lab.evaluation.wall_metrics import measure_first_scans
from scanplan.types import FloatArray, IntArray
from thesis.steps_figure import WallSteps

UTILITIES = {
    "walls found": "visible_completeness_010m",
    "F1 of walls": "visible_f1_010m",
    "correct match": "correct_match",
}
"""Columns of the evaluation whose ratio is measured, by what they are called."""
ONE_WALL = "points of a cluster on its wall"


def submodularity_ratios(
    truth: VisibleTruth, findings: Findings, *, n_added: int, seed: int
) -> list[dict[str, float]]:
    """Return the ratios of the utilities for random scans that are added to random others.

    Parameters
    ----------
    findings : wall_findings.Findings
        Of one extractor.
    n_added, seed : int
        See `draw_additions`.

    Returns
    -------
    list of dict
        Draw by draw, ratio by the names of `UTILITIES`; NaN where nothing is added.
    """
    ratios = []
    for before, added in draw_additions(len(truth.seen), n_added=n_added, seed=seed):
        alone = measure_utilities(truth, findings, before)
        together = measure_utilities(truth, findings, [*before, *added]) - alone
        singly = [measure_utilities(truth, findings, [*before, scan]) - alone for scan in added]
        gain = np.sum(singly, axis=0)
        ratio = np.divide(gain, together, out=np.full(len(gain), np.nan), where=together > 0)
        ratios.append(dict(zip(UTILITIES, ratio.tolist(), strict=True)))
    return ratios


def draw_additions(n_scans: int, *, n_added: int, seed: int) -> Iterator[tuple[IntArray, IntArray]]:
    """Draw random scans, and others that are added to them.

    Parameters
    ----------
    n_added : int
        So many scans are added to as many others, and so often; fewer of a small survey.

    Yields
    ------
    before, added : (k,) int
        Rows of scans, none twice.
    """
    size = max(1, min(n_added, n_scans // 2))
    rng = np.random.default_rng(seed)
    for _ in range(n_added):
        drawn = rng.choice(n_scans, min(2 * size, n_scans), replace=False)
        yield drawn[:size], drawn[size:]


def measure_utilities(truth: VisibleTruth, findings: Findings, rows: Iterable[int]) -> FloatArray:
    """Return the utilities of a set of scans, as `UTILITIES` has them.

    Parameters
    ----------
    findings : wall_findings.Findings
        Of one extractor.
    rows : iterable of int
        The scans'.

    Returns
    -------
    (u,) float64
    """
    rank = np.full(len(truth.seen), first_ranks.NEVER)
    rank[list(rows)] = 1
    (measured,) = measure_first_scans(truth, findings, rank, [1])
    return np.array([measured[column] for column in UTILITIES.values()])


def number_lines(faces_m: FloatArray) -> IntArray:
    """Return the line (n,) that each face (n, 2, 2) lies on: a wall goes on behind its doors."""
    way_m = faces_m[:, 1] - faces_m[:, 0]
    across = np.column_stack([-way_m[:, 1], way_m[:, 0]]) / np.hypot(*way_m.T)[:, None]
    # from either end it is the same line
    turned = (across[:, 0] < -WITHIN_M[JUDGED]) | (
        (np.abs(across[:, 0]) <= WITHIN_M[JUDGED]) & (across[:, 1] < 0)
    )
    across = np.where(turned[:, None], -across, across)
    offset_m = (across * faces_m[:, 0]).sum(axis=1)
    # half of what a wall may be off by: the sides of the thinnest wall stay apart
    lines = np.column_stack([across, offset_m]) / WITHIN_M["005m"]
    return np.unique(lines.round().astype(int), axis=0, return_inverse=True)[1].reshape(-1)


def share_on_one_wall(
    steps: WallSteps, sensor_xy_m: FloatArray, faces_m: FloatArray, *, min_points: int
) -> float:
    """Return the share of clustered points that lie on their cluster's main true wall.

    Parameters
    ----------
    sensor_xy_m : (2,) float
        Where the sensor truly was.
    faces_m : (n, 2, 2) float
        The true faces.
    min_points : int
        Clusters of fewer points make no wall and do not count.

    Returns
    -------
    float
        Over the points of all clusters; NaN without any.
    """
    points = np.asarray(shapely.points(steps.xy_m + sensor_xy_m))
    tree = shapely.STRtree(np.asarray(shapely.linestrings(faces_m)))
    point, face = tree.query_nearest(points, max_distance=WITHIN_M[JUDGED], all_matches=False)
    line = np.full(len(points), -1)
    line[point] = number_lines(faces_m)[face]
    n_points, n_on_wall = 0, 0
    for cluster in range(steps.label.max(initial=-1) + 1):
        own = line[steps.label == cluster]
        if len(own) >= min_points:
            n_points += len(own)
            n_on_wall += np.bincount(own[own >= 0]).max(initial=0)
    return n_on_wall / n_points if n_points else np.nan
