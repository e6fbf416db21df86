"""Our measurement of the thesis's claims about extraction, registration and run time, from a drive.

Every public function measures the claim that it is called like, from the tables of one seed.
"""

import numpy as np
import pandas as pd

from thesis.claim_measures import (
    BUILDING,
    CHOOSING,
    CORRECT,
    COUNT,
    ENTERED,
    FOUND,
    ITERATIVE,
    LITERAL,
    MERGING,
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
    growth_exponent,
    least_kept,
    measure_at,
    measure_tenth,
    of_unit,
)
from thesis.shown_figures import THESIS_SCANS
from thesis.stated_claims import Judged, Sizes

_NAMES = {OURS: "cluster RANSAC", ITERATIVE: "iterative RANSAC"}
_PLAIN_NAMES = {PLAIN_CLUSTERS: _NAMES[OURS], PLAIN: _NAMES[ITERATIVE]}


def several_per_wall(tables: Tables) -> ClaimMeasure:
    """Count the candidates of RANSAC per true wall and scan, and our segments."""
    found = tables["drive_candidates"]
    totals = found.groupby(["model", "inlier_m"])[["near_walls", "walls"]].sum()
    counts = totals["near_walls"] / totals["walls"].where(totals["walls"] > 0)
    values = {f"{model}s, {1e3 * band_m:.0f} mm": n for (model, band_m), n in counts.items()}
    claimed = values[f"lines, {1e3 * found['inlier_m'].max():.0f} mm"]
    column = "walls_per_true_wall_of_a_scan"
    for extractor in (ITERATIVE, OURS):
        count = measure_at(tables["drive_walls"], "sequential", extractor, np.inf, column)
        values[f"{_NAMES[extractor]} of ours"] = count
    return ClaimMeasure(of_unit(values, NUMBER), claimed - Judged.SEVERAL)


def fewer_walls(tables: Tables) -> ClaimMeasure:
    """Count the walls that the thesis's extractors find in timed scans, and our segments in all."""
    walls = tables["drive_walls"]
    counts = tables["drive_times"].groupby("task")["found"].mean()
    values = {f"walls a scan, {name}": counts[task] for task, name in _PLAIN_NAMES.items()}
    n_scans = walls["k"].max()
    for extractor, name in _NAMES.items():
        n_segments = measure_at(walls, "sequential", extractor, np.inf, "n_walls")
        values[f"segments a scan, {name} of ours"] = n_segments / n_scans
    fewer = 1 - counts[PLAIN_CLUSTERS] / counts[PLAIN]
    return ClaimMeasure(of_unit(values, NUMBER), fewer, SHARE)


def fewer_walls_merge_faster(tables: Tables) -> ClaimMeasure:
    """Measure how the time to merge segments grows with their number."""
    times = tables["drive_times"]
    seconds = times[times["task"] == MERGING].set_index("size")["seconds"].sort_index()
    exponent = growth_exponent(times, MERGING)
    values: Quantities = {"exponent of the time to merge": (exponent, NUMBER)}
    if len(seconds) <= 1:
        return ClaimMeasure(values, np.nan)
    for row, name in ((0, "the fewest"), (-1, "the most")):
        values[f"segments, {name}"] = seconds.index[row], COUNT
        values[f"time to merge {name}"] = seconds.iloc[row], SECONDS
    return ClaimMeasure(values, seconds.iloc[-1] / seconds.iloc[0] - 1 - Judged.LOADED, SHARE)


def steadier_times(tables: Tables) -> ClaimMeasure:
    """Compare how the extractors' times vary from scan to scan."""
    seconds = tables["drive_times"].groupby("task")["seconds"]
    mean_s = seconds.mean()
    spread = seconds.std(ddof=0) / mean_s
    values: Quantities = {}
    for task, name in _PLAIN_NAMES.items():
        values[f"a scan, {name}"] = 1e3 * mean_s[task], MILLISECONDS
        values[f"deviation per mean, {name}"] = spread[task], SHARE
    steadier = 1 - spread[PLAIN_CLUSTERS] / spread[PLAIN]
    return ClaimMeasure(values, steadier - Judged.LOADED, SHARE)


def time_by_size(tables: Tables) -> ClaimMeasure:
    """Compare how the extractors' times grow with the number of points of the same scans."""
    times = tables["drive_times"]
    values, exponents = {}, {}
    for task, name in _PLAIN_NAMES.items():
        exponents[task] = growth_exponent(times, THINNED + task)
        values[f"exponent of time, {name}"] = exponents[task]
        # each wall is one run of RANSAC: what the thesis's sentence gives as the reason
        values[f"exponent of walls, {name}"] = growth_exponent(times, THINNED + task, of="found")
    margin = np.minimum(
        exponents[PLAIN] - Judged.GROWS, Judged.GROWS - abs(exponents[PLAIN_CLUSTERS])
    )
    return ClaimMeasure(of_unit(values, NUMBER), float(margin))


def fifteen_like_all(tables: Tables) -> ClaimMeasure:
    """Compare cluster RANSAC on the thesis's subset with iterative RANSAC on all scans."""
    walls = tables["drive_walls"]
    values, measures = {}, {}
    for extractor, k, scans in ((OURS, Sizes.SUBSET, "15 scans"), (ITERATIVE, np.inf, "all scans")):
        entered, correct, found = (
            measure_at(walls, "cluster_hull", extractor, k, column)
            for column in (ENTERED, CORRECT, FOUND)
        )
        name = f"{_NAMES[extractor]}, {scans}"
        values[f"walls of the hallways found, {name}"] = entered
        values[f"length that is wall, {name}"] = correct
        values[f"with the rooms behind open doors, {name}"] = found
        measures[extractor] = entered, correct
    at_random = measure_at(walls, "random", OURS, Sizes.SUBSET, ENTERED)
    values["walls of the hallways found, 15 scans at random"] = at_random
    margin = least_kept(measures[OURS], measures[ITERATIVE])
    return ClaimMeasure(of_unit(values, SHARE), margin, SHARE)


def tenth_of_drive(tables: Tables) -> ClaimMeasure:
    """Compare what a tenth of the scans finds of the hallways' walls with what all find."""
    walls = tables["drive_walls"]
    tenth, some, every = measure_tenth(walls, (ENTERED, CORRECT))
    values = {
        "walls of the hallways found, a tenth": some[0],
        "walls of the hallways found, all": every[0],
        "length that is wall, a tenth": some[1],
        "length that is wall, all": every[1],
    }
    return ClaimMeasure(
        {"scans": (tenth, COUNT)} | of_unit(values, SHARE), least_kept(some, every), SHARE
    )


def subset_scales(tables: Tables) -> ClaimMeasure:
    """Compare the time for hulls of all scans and walls of a tenth with that for all walls."""
    times = tables["drive_times"]
    building = times[times["task"] == BUILDING]
    hull_s = (building["seconds"] / building["found"]).max()
    values: Quantities = {"a scan, hulls and order": (1e3 * hull_s, MILLISECONDS)}
    saved = {}
    for task, name in _PLAIN_NAMES.items():
        extraction_s = times.loc[times["task"] == task, "seconds"].mean()
        saved[task] = 1 - (hull_s + extraction_s / 10) / extraction_s
        values[f"a scan, {name}"] = 1e3 * extraction_s, MILLISECONDS
        values[f"time saved, {name}"] = saved[task], SHARE
    return ClaimMeasure(values, min(saved.values()) - Judged.LOADED, SHARE)


def selection_polynomial(tables: Tables) -> ClaimMeasure:
    """Measure how the times of algorithm 1 itself and of ours grow with the number of scans."""
    times = tables["drive_times"]
    exponents = {
        "exponent, algorithm 1": growth_exponent(times, LITERAL),
        "exponent, ours, all in order": growth_exponent(times, ORDERING),
        f"exponent, ours, the first {Sizes.SUBSET}": growth_exponent(times, CHOOSING),
    }
    seconds = times.pivot_table(index="size", columns="task", values="seconds")
    both = seconds.reindex(columns=[LITERAL, ORDERING]).dropna()
    values = of_unit(exponents, NUMBER)
    for n_scans, (literal_s, ours_s) in both.tail(1).iterrows():
        values[f"{n_scans} scans, algorithm 1"] = literal_s, SECONDS
        values[f"{n_scans} scans, ours"] = ours_s, SECONDS
    return ClaimMeasure(values, exponents["exponent, algorithm 1"] - 1 - Judged.LOADED)


def two_percent_survive(tables: Tables) -> ClaimMeasure:
    """Count what registration with the thesis's limits retains, on the drive that it is made of."""
    if "limits_steps" not in tables:
        return ClaimMeasure({})
    recorded, _, retained = tables["limits_steps"]["n_scans"].iloc[:3]
    values: Quantities = {
        "share retained": (retained / recorded, SHARE),
        "scans retained": (retained, COUNT),
    }
    return ClaimMeasure(values)


def survey_drive(tables: Tables) -> ClaimMeasure:
    """Measure how long the drive is, and how much it records."""
    recorded = tables["drive_steps"].iloc[0]
    minutes = recorded["seconds"] / 60
    return ClaimMeasure({
        "scans": (recorded["n_scans"], COUNT),
        "minutes": (minutes, NUMBER),
        "gigabytes a minute": (recorded["n_bytes"] / 1e9 / minutes, NUMBER),
    })  # fmt: skip


def selection_time(tables: Tables) -> ClaimMeasure:
    """Measure the time of choosing the thesis's subset of its number of scans.

    Of a survey of fewer scans there is no such time.
    """
    times = tables["drive_times"]
    return ClaimMeasure({
        f"to choose {Sizes.SUBSET} of {THESIS_SCANS} scans": (
            _seconds_at(times, CHOOSING),
            SECONDS,
        ),
        f"to order all {THESIS_SCANS}": (_seconds_at(times, ORDERING), SECONDS),
        f"to order all {THESIS_SCANS} by algorithm 1": (_seconds_at(times, LITERAL), SECONDS),
    })  # fmt: skip


def localiser(tables: Tables) -> ClaimMeasure:
    """Measure how good the localiser's poses are, and the registered ones."""
    errors = tables["drive_poses"]
    values = {
        f"error of the position, {name}, rms": np.sqrt((errors[f"{stage}_error_m"] ** 2).mean())
        for stage, name in (("prior", "localiser"), ("refined", "registered"))
    }
    return ClaimMeasure(of_unit(values, METRES))


def own_limits(tables: Tables) -> ClaimMeasure:
    """Count what registration with our limits retains."""
    return ClaimMeasure({"scans": (tables["drive_steps"]["n_scans"].iloc[2], COUNT)})


def _seconds_at(times: pd.DataFrame, task: str) -> float:
    """Return the time of a task for the thesis's number of scans; NaN where it was not timed."""
    at = times[(times["task"] == task) & (times["size"] == THESIS_SCANS)]
    return at["seconds"].sum() if len(at) else np.nan
