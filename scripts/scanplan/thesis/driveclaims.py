"""Our measurement of the thesis's claims about extraction, registration and run time, from the tables of a drive."""

import numpy as np

from scanplan.thesis.claims import FOUND, ITERATIVE, OURS, SUBSET, Measured, is_about, value_at
from scanplan.thesis.thesisclaims import ALMOST, CLEAR, SEVERAL, SLIGHT, stated

_THESIS_SCANS = 90


def uneven_harms_random(tables):
    """Compare the lead of cluster hulls over a random order between drive and rooms.

    A proxy: no survey is there both evenly and unevenly sampled, and the two are of different places.
    """
    lead = [
        value_at(tables[f"{kind}_walls"], "cluster_hull", OURS, SUBSET, FOUND)
        - value_at(tables[f"{kind}_walls"], "random", OURS, SUBSET, FOUND)
        for kind in ("drive", "rooms")
    ]
    return Measured({"lead on the drive": lead[0], "lead in the rooms": lead[1]}, lead[0] > lead[1])


def several_per_wall(tables):
    """Count segments per true wall and scan, over every scan of the drive."""
    column, walls = "walls_per_true_wall_of_a_scan", tables["drive_walls"]
    single = {extractor: value_at(walls, "sequential", extractor, np.inf, column) for extractor in (ITERATIVE, OURS)}
    values = {f"segments per true wall, {extractor}": count for extractor, count in single.items()}
    return Measured(values, _if_known(single[ITERATIVE], single[ITERATIVE] >= SEVERAL))


def fewer_walls(tables):
    """Count the segments of all scans."""
    walls, n = tables["drive_walls"], tables["drive_walls"]["k"].max()
    count = {e: value_at(walls, "sequential", e, np.inf, "n_walls") / n for e in (OURS, ITERATIVE)}
    return Measured({f"walls a scan, {e}": c for e, c in count.items()}, count[OURS] < count[ITERATIVE])


def steadier_times(tables):
    """Compare how the extractors' times vary from scan to scan."""
    values, spread = {}, {}
    for extractor in (OURS, ITERATIVE):
        seconds, _ = _of_task(tables["drive_times"], extractor)
        spread[extractor] = seconds.std() / seconds.mean()
        values[f"ms a scan, {extractor}"] = 1e3 * seconds.mean()
        values[f"deviation per mean, {extractor}"] = spread[extractor]
    return Measured(values, spread[OURS] < spread[ITERATIVE])


def time_by_size(tables):
    """Correlate the extractors' times with the size of the cloud."""
    r = {e: _correlation(*_of_task(tables["drive_times"], e)) for e in (OURS, ITERATIVE)}
    values = {f"correlation, {e}": of_it for e, of_it in r.items()}
    return Measured(values, _if_known(sum(r.values()), r[ITERATIVE] >= CLEAR and abs(r[OURS]) <= SLIGHT))


def fifteen_like_all(tables):
    """Compare cluster RANSAC on the thesis's subset with iterative RANSAC on all scans."""
    walls = tables["drive_walls"]
    few = value_at(walls, "cluster_hull", OURS, SUBSET, FOUND)
    every = value_at(walls, "cluster_hull", ITERATIVE, np.inf, FOUND)
    values = {"walls found, cluster RANSAC, 15 scans": few, "walls found, iterative RANSAC, all scans": every}
    return Measured(values, few >= ALMOST * every if every > 0 else None)


def two_percent_survive(tables):
    """Count what registration with the thesis's limits retains."""
    recorded, retained = tables["limits_steps"]["n_scans"][:2]
    values = {"share retained": retained / recorded, "scans retained": retained}
    return Measured(values, is_about(retained / recorded, stated("two_percent_survive", "share retained")))


def survey_drive(tables):
    """Tell how long the drive is."""
    steps = tables["drive_steps"]
    return Measured({"scans": steps["n_scans"][0], "minutes": steps["seconds"][0] / 60})


def selection_time(tables):
    """Tell how long the greedy order takes for as many scans as the thesis's, and how that grows.

    Of a survey of fewer scans there is no such time.
    """
    seconds, size = _of_task(tables["drive_times"], "order_scans")
    of_thesis = seconds[size == _THESIS_SCANS].sum() if _THESIS_SCANS in size else np.nan
    growth = np.polyfit(np.log(size), np.log(seconds), 1)[0] if len(size) > 1 else np.nan
    return Measured({f"seconds for {_THESIS_SCANS} scans": of_thesis, "exponent of its growth": growth})


def localiser(tables):
    """Tell how good the localiser's poses are, and the registered ones."""
    errors = tables["drive_poses"]
    names = {"prior": "localiser", "refined": "registered"}
    rms_m = {said: np.sqrt(np.mean(errors[f"{name}_error_m"] ** 2)) for name, said in names.items()}
    return Measured({f"error of the position, {said}, rms (m)": value for said, value in rms_m.items()})


def own_limits(tables):
    """Count what registration with our limits retains."""
    return Measured({"scans": tables["drive_steps"]["n_scans"][1]})


def _correlation(seconds, size):
    """Return Pearson's r, NaN where one of the two does not vary."""
    if len(size) < 2 or np.ptp(size) == 0 or np.ptp(seconds) == 0:
        return np.nan
    return float(np.corrcoef(seconds, size)[0, 1])


def _if_known(value, holds):
    """Return a verdict, or none where the value that it goes by could not be measured."""
    return bool(holds) if np.isfinite(value) else None


def _of_task(times, task):
    of_it = times["task"] == task
    return times["seconds"][of_it], times["size"][of_it]
