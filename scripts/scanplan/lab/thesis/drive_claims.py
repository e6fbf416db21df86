"""Our measurement of the thesis's claims about extraction, registration and run time, from a drive.

Every public function measures the claim that it is called like, from the tables of one seed.
"""

import numpy as np

from scanplan.lab.thesis.claim_measures import (
    CHOOSING,
    CORRECT,
    COUNT,
    FOUND,
    ITERATIVE,
    METRES,
    MILLISECONDS,
    NUMBER,
    ORDERING,
    OURS,
    PLAIN,
    PLAIN_CLUSTERS,
    SECONDS,
    SHARE,
    THINNED,
    ClaimMeasure,
    Quantities,
    Tables,
    if_known,
    is_about,
    is_similar,
    measure_at,
    of_unit,
)
from scanplan.lab.thesis.stated_claims import GROWS, SEVERAL, STEADY, SUBSET, stated_number
from scanplan.types import Array, Columns, FloatArray, IntArray

_THESIS_SCANS = 90  # what the thesis chose its subset from (table 5.1)
_NAMES = {OURS: "cluster RANSAC", ITERATIVE: "iterative RANSAC"}
_PLAIN_NAMES = {PLAIN_CLUSTERS: _NAMES[OURS], PLAIN: _NAMES[ITERATIVE]}


def several_per_wall(tables: Tables) -> ClaimMeasure:
    """Count segments per true wall and scan, over every scan of the drive."""
    column = "walls_per_true_wall_of_a_scan"
    counts = {
        extractor: measure_at(tables["drive_walls"], "sequential", extractor, np.inf, column)
        for extractor in (ITERATIVE, OURS)
    }
    values = of_unit({_NAMES[extractor]: count for extractor, count in counts.items()}, NUMBER)
    return ClaimMeasure(values, if_known(counts[ITERATIVE], counts[ITERATIVE] >= SEVERAL))


def fewer_walls(tables: Tables) -> ClaimMeasure:
    """Count the walls that the thesis's extractors find in timed scans, and our segments in all."""
    times, walls = tables["drive_times"], tables["drive_walls"]
    counts = {e: times["found"][times["task"] == e].mean() for e in _PLAIN_NAMES}
    values = {f"walls a scan, {name}": counts[e] for e, name in _PLAIN_NAMES.items()}
    n_scans = walls["k"].max()
    for extractor, name in _NAMES.items():
        n_segments = measure_at(walls, "sequential", extractor, np.inf, "n_walls")
        values[f"segments a scan, {name} of ours"] = n_segments / n_scans
    return ClaimMeasure(of_unit(values, NUMBER), bool(counts[PLAIN_CLUSTERS] < counts[PLAIN]))


def steadier_times(tables: Tables) -> ClaimMeasure:
    """Compare how the extractors' times vary from scan to scan."""
    values: Quantities = {}
    spread = {}
    for extractor, name in _PLAIN_NAMES.items():
        seconds, _, _ = _of_task(tables["drive_times"], extractor)
        spread[extractor] = seconds.std() / seconds.mean()
        values[f"a scan, {name}"] = 1e3 * seconds.mean(), MILLISECONDS
        values[f"deviation per mean, {name}"] = spread[extractor], SHARE
    return ClaimMeasure(values, bool(spread[PLAIN_CLUSTERS] < spread[PLAIN]))


def time_by_size(tables: Tables) -> ClaimMeasure:
    """Compare how the extractors' times grow with the number of points of the same scans."""
    times = tables["drive_times"]
    exponents = {e: _exponent(*_of_task(times, THINNED + e)) for e in _PLAIN_NAMES}
    values = {f"exponent, {_PLAIN_NAMES[e]}": exponent for e, exponent in exponents.items()}
    holds = exponents[PLAIN] >= GROWS and abs(exponents[PLAIN_CLUSTERS]) <= STEADY
    return ClaimMeasure(of_unit(values, NUMBER), if_known(list(exponents.values()), holds))


def fifteen_like_all(tables: Tables) -> ClaimMeasure:
    """Compare cluster RANSAC on the thesis's subset with iterative RANSAC on all scans."""
    walls = tables["drive_walls"]
    values, measures = {}, {}
    for extractor, k, scans in ((OURS, SUBSET, "15 scans"), (ITERATIVE, np.inf, "all scans")):
        found = measure_at(walls, "cluster_hull", extractor, k, FOUND)
        correct = measure_at(walls, "cluster_hull", extractor, k, CORRECT)
        values[f"walls found, {_NAMES[extractor]}, {scans}"] = found
        values[f"length that is wall, {_NAMES[extractor]}, {scans}"] = correct
        measures[extractor] = found, correct
    holds = is_similar(measures[OURS], measures[ITERATIVE])
    return ClaimMeasure(of_unit(values, SHARE), holds)


def two_percent_survive(tables: Tables) -> ClaimMeasure:
    """Count what registration with the thesis's limits retains."""
    recorded, _, retained = tables["limits_steps"]["n_scans"][:3]
    share = retained / recorded
    values: Quantities = {"share retained": (share, SHARE), "scans retained": (retained, COUNT)}
    stated = stated_number("two_percent_survive", "share retained")
    return ClaimMeasure(values, is_about(share, stated))


def survey_drive(tables: Tables) -> ClaimMeasure:
    """Measure how long the drive is."""
    steps = tables["drive_steps"]
    minutes = steps["seconds"][0] / 60
    return ClaimMeasure({"scans": (steps["n_scans"][0], COUNT), "minutes": (minutes, NUMBER)})


def selection_time(tables: Tables) -> ClaimMeasure:
    """Measure the time of choosing the thesis's subset of its number of scans, and its growth.

    Of a survey of fewer scans there is no such time.
    """
    times = tables["drive_times"]
    exponent = _exponent(*_of_task(times, CHOOSING))
    return ClaimMeasure({
        f"to choose {SUBSET} of {_THESIS_SCANS} scans": (_seconds_at(times, CHOOSING), SECONDS),
        f"to order all {_THESIS_SCANS}": (_seconds_at(times, ORDERING), SECONDS),
        "exponent of the growth of choosing": (exponent, NUMBER),
    })  # fmt: skip


def localiser(tables: Tables) -> ClaimMeasure:
    """Measure how good the localiser's poses are, and the registered ones."""
    errors = tables["drive_poses"]
    values = {}
    for stage, name in (("prior", "localiser"), ("refined", "registered")):
        rms_m = np.sqrt(np.mean(errors[f"{stage}_error_m"] ** 2))
        values[f"error of the position, {name}, rms"] = rms_m
    return ClaimMeasure(of_unit(values, METRES))


def own_limits(tables: Tables) -> ClaimMeasure:
    """Count what registration with our limits retains."""
    return ClaimMeasure({"scans": (tables["drive_steps"]["n_scans"][2], COUNT)})


def _seconds_at(times: Columns, task: str) -> float:
    """Return the time of a task for the thesis's number of scans; NaN where it was not timed."""
    seconds, size, _ = _of_task(times, task)
    at = seconds[size == _THESIS_SCANS]
    return at.sum() if len(at) else np.nan


def _exponent(seconds: FloatArray, size: IntArray, item: IntArray) -> float:
    """Return the b of seconds = a size^b with an own a for every item, by least squares.

    It is NaN where no size varies.
    """
    if not len(size) or (seconds <= 0).any():
        return np.nan
    log_size = _centred(np.log(size), item)
    log_s = _centred(np.log(seconds), item)
    return float(log_size @ log_s / (log_size @ log_size)) if np.ptp(log_size) > 0 else np.nan


def _centred(values: FloatArray, item: IntArray) -> FloatArray:
    """Return values (n,) less the mean of their item's."""
    _, row = np.unique(item, return_inverse=True)
    return values - (np.bincount(row, values) / np.bincount(row))[row]


def _of_task(times: Columns, task: str) -> tuple[Array, Array, Array]:
    """Return the seconds, sizes and items of a task."""
    rows = times["task"] == task
    return times["seconds"][rows], times["size"][rows], times["item"][rows]
