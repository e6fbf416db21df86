"""Our measurement of the thesis's claims about extraction, registration and run time, from the tables of a drive."""

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
    SUBSET,
    THINNED,
    ClaimMeasure,
    if_known,
    is_about,
    is_similar,
    measure_at,
)
from scanplan.lab.thesis.stated_claims import GROWS, SEVERAL, STEADY, stated_number

_THESIS_SCANS = 90
_NAMES = {OURS: "cluster RANSAC", ITERATIVE: "iterative RANSAC"}
_PLAIN_NAMES = {PLAIN_CLUSTERS: _NAMES[OURS], PLAIN: _NAMES[ITERATIVE]}


def several_per_wall(tables):
    """Count segments per true wall and scan, over every scan of the drive."""
    column, walls = "walls_per_true_wall_of_a_scan", tables["drive_walls"]
    single = {
        extractor: measure_at(walls, "sequential", extractor, np.inf, column)
        for extractor in (ITERATIVE, OURS)
    }
    values = {_NAMES[extractor]: (count, NUMBER) for extractor, count in single.items()}
    return ClaimMeasure(values, if_known(single[ITERATIVE], single[ITERATIVE] >= SEVERAL))


def fewer_walls(tables):
    """Count the walls that the thesis's extractors find in the timed scans, and the segments of ours in all scans."""
    times, walls = tables["drive_times"], tables["drive_walls"]
    count = {e: times["found"][times["task"] == e].mean() for e in _PLAIN_NAMES}
    values = {f"walls a scan, {said}": (count[e], NUMBER) for e, said in _PLAIN_NAMES.items()}
    for extractor, said in _NAMES.items():
        segments = measure_at(walls, "sequential", extractor, np.inf, "n_walls") / walls["k"].max()
        values[f"segments a scan, {said} of ours"] = segments, NUMBER
    return ClaimMeasure(values, count[PLAIN_CLUSTERS] < count[PLAIN])


def steadier_times(tables):
    """Compare how the extractors' times vary from scan to scan."""
    values, spread = {}, {}
    for extractor, said in _PLAIN_NAMES.items():
        seconds, _, _ = _of_task(tables["drive_times"], extractor)
        spread[extractor] = seconds.std() / seconds.mean()
        values[f"a scan, {said}"] = 1e3 * seconds.mean(), MILLISECONDS
        values[f"deviation per mean, {said}"] = spread[extractor], SHARE
    return ClaimMeasure(values, spread[PLAIN_CLUSTERS] < spread[PLAIN])


def time_by_size(tables):
    """Compare how the extractors' times grow with the number of points of the same scans."""
    grows = {e: _exponent(*_of_task(tables["drive_times"], THINNED + e)) for e in _PLAIN_NAMES}
    values = {f"exponent, {_PLAIN_NAMES[e]}": (of_it, NUMBER) for e, of_it in grows.items()}
    holds = grows[PLAIN] >= GROWS and abs(grows[PLAIN_CLUSTERS]) <= STEADY
    return ClaimMeasure(values, if_known(list(grows.values()), holds))


def fifteen_like_all(tables):
    """Compare cluster RANSAC on the thesis's subset with iterative RANSAC on all scans."""
    walls, values, pair = tables["drive_walls"], {}, {}
    for extractor, k, scans in ((OURS, SUBSET, "15 scans"), (ITERATIVE, np.inf, "all scans")):
        pair[k] = [
            measure_at(walls, "cluster_hull", extractor, k, column) for column in (FOUND, CORRECT)
        ]
        values[f"walls found, {_NAMES[extractor]}, {scans}"] = pair[k][0], SHARE
        values[f"length that is wall, {_NAMES[extractor]}, {scans}"] = pair[k][1], SHARE
    return ClaimMeasure(values, is_similar(pair[SUBSET], pair[np.inf]))


def two_percent_survive(tables):
    """Count what registration with the thesis's limits retains."""
    recorded, retained = tables["limits_steps"]["n_scans"][:2]
    values = {"share retained": (retained / recorded, SHARE), "scans retained": (retained, COUNT)}
    return ClaimMeasure(
        values,
        is_about(retained / recorded, stated_number("two_percent_survive", "share retained")),
    )


def survey_drive(tables):
    """Tell how long the drive is."""
    steps = tables["drive_steps"]
    return ClaimMeasure(
        {"scans": (steps["n_scans"][0], COUNT), "minutes": (steps["seconds"][0] / 60, NUMBER)}
    )


def selection_time(tables):
    """Tell how long it takes to choose the thesis's subset of as many scans as the thesis's, and how that grows.

    Of a survey of fewer scans there is no such time.
    """
    values, times = {}, tables["drive_times"]
    for task, what in (
        (CHOOSING, f"to choose {SUBSET} of {_THESIS_SCANS} scans"),
        (ORDERING, f"to order all {_THESIS_SCANS}"),
    ):
        seconds, size, _ = _of_task(times, task)
        values[what] = (
            seconds[size == _THESIS_SCANS].sum() if _THESIS_SCANS in size else np.nan,
            SECONDS,
        )
    exponent = _exponent(*_of_task(times, CHOOSING))
    return ClaimMeasure(values | {"exponent of the growth of choosing": (exponent, NUMBER)})


def localiser(tables):
    """Tell how good the localiser's poses are, and the registered ones."""
    errors = tables["drive_poses"]
    names = {"prior": "localiser", "refined": "registered"}
    rms_m = {said: np.sqrt(np.mean(errors[f"{name}_error_m"] ** 2)) for name, said in names.items()}
    return ClaimMeasure(
        {f"error of the position, {said}, rms": (value, METRES) for said, value in rms_m.items()}
    )


def own_limits(tables):
    """Count what registration with our limits retains."""
    return ClaimMeasure({"scans": (tables["drive_steps"]["n_scans"][1], COUNT)})


def _exponent(seconds, size, item):
    """Return the b of seconds = a size^b with an own a for every item, by least squares; NaN where no size varies."""
    if not len(size) or (seconds <= 0).any():
        return np.nan
    log_size, log_s = (_centred(np.log(values), item) for values in (size, seconds))
    return float(log_size @ log_s / (log_size @ log_size)) if np.ptp(log_size) > 0 else np.nan


def _centred(values, item):
    """Return values (n,) less the mean of their item's."""
    _, row = np.unique(item, return_inverse=True)
    return values - (np.bincount(row, values) / np.bincount(row))[row]


def _of_task(times, task):
    of_it = times["task"] == task
    return times["seconds"][of_it], times["size"][of_it], times["item"][of_it]
