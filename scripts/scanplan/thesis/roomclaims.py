"""Our measurement of the thesis's claims about orders and areas, from the tables of a survey of the rooms."""

import numpy as np

from scanplan.thesis.claims import (
    FOUND,
    FOUR,
    MANY,
    OURS,
    SUBSET,
    Measured,
    is_about,
    mean_over_first,
    scans_for_99,
    value_at,
)
from scanplan.thesis.thesisclaims import ALMOST, stated

_LATER = 40


def sequential_poorest(tables):
    """Compare the orders by what they miss."""
    mean = _mean_of_each(tables, "false_negative")
    return Measured(mean, all(mean["sequential"] > mean[method] for method in FOUR[:-1]))


def sequential_poorest_match(tables):
    """Compare the orders by the share of cells that agree."""
    mean = _mean_of_each(tables, "correct_match")
    return Measured(mean, all(mean["sequential"] < mean[method] for method in FOUR[:-1]))


def others_similar(tables):
    """Compare how far the other three orders lie apart with how far sequential lies behind."""
    mean = _mean_of_each(tables, "false_negative")
    others = [mean[method] for method in FOUR[:-1]]
    apart, behind = max(others) - min(others), mean["sequential"] - max(others)
    return Measured({"range of the other three": apart, "sequential behind them": behind}, apart < behind)


def full_hull_overestimates(tables):
    """Compare the areas of whole scans' hulls with what the scans truly see."""
    ratio = _area_ratio(tables, "full_hull_m2")
    values = {
        "hull per seen area, median": np.median(ratio),
        "share of scans over-estimated": np.mean(np.where(np.isnan(ratio), np.nan, ratio > 1)),
    }
    return Measured(values, np.median(ratio) > 1 if np.isfinite(ratio).all() else None)


def cluster_hull_closer(tables):
    """Compare by how much either kind of hull errs from what the scans truly see."""
    clusters, full = (_area_ratio(tables, name) for name in ("cluster_hull_m2", "full_hull_m2"))
    error = [np.median(np.abs(ratio - 1)) for ratio in (clusters, full)]
    values = {
        "cluster hulls per seen area, median": np.median(clusters),
        "relative error, cluster hulls": error[0],
        "relative error, one hull": error[1],
    }
    return Measured(values, error[0] < error[1] if np.isfinite(error).all() else None)


def full_hull_99(tables):
    """Count the scans for 99 % of the area by one hull per scan."""
    return _at_99(tables["rooms_hull"], "full_hull_99")


def cluster_hull_99(tables):
    """Count the scans for 99 % of the area by cluster hulls."""
    return _at_99(tables["rooms_cluster_hull"], "cluster_hull_99")


def full_hull_sooner(tables):
    """Compare those two numbers."""
    full, cluster = (scans_for_99(tables[f"rooms_{method}"]) for method in ("hull", "cluster_hull"))
    return Measured({"one hull": full, "cluster hulls": cluster}, full < cluster)


def slower_is_better(tables):
    """Compare what later scans of both orders bring."""
    found = [value_at(tables["rooms_walls"], method, OURS, _LATER, FOUND) for method in ("cluster_hull", "hull")]
    values = {f"walls found by {_LATER}, cluster hulls": found[0], f"walls found by {_LATER}, one hull": found[1]}
    return Measured(values, found[0] > found[1])


def more_clusters_less_area(tables):
    """Compare the areas by numbers of clusters, at the thesis's subset and at all scans."""
    table = tables["rooms_clusters"]
    numbers = np.unique(table["n_clusters"])
    growth = [table["covered_m2"][table["n_clusters"] == n] for n in numbers]
    at = np.array([[covered[min(SUBSET, len(covered)) - 1], covered[-1]] for covered in growth])
    values = {
        f"m² by {which} scans, {n} clusters": area
        for n, row in zip(numbers, at, strict=True)
        for which, area in zip((str(SUBSET), "all"), row, strict=True)
    }
    return Measured(values, bool((np.diff(at, axis=0) < 0).all()))


def more_clusters_more_time(tables):
    """Compare run times by numbers of clusters."""
    times = tables["rooms_times"]
    of_it = times["task"] == "build_hulls"
    taken = times["seconds"][of_it][np.argsort(times["size"][of_it])]
    values = {f"s, {n} clusters": s for n, s in zip(np.sort(times["size"][of_it]), taken, strict=True)}
    return Measured(values, bool(taken[0] == taken.min() < taken.max() == taken[-1]))


def fifteen_almost_complete(tables):
    """Compare what the thesis's subset finds with what all scans find, and with other orders."""
    share, walls = _share_of_all(tables, SUBSET), tables["rooms_walls"]
    oracle, sequential = (value_at(walls, method, OURS, SUBSET, FOUND) for method in ("oracle", "sequential"))
    values = {
        "share of what all find": share,
        "walls found by the oracle's 15": oracle,
        "walls found by the first 15 recorded": sequential,
        "of how many scans": walls["k"].max(),
    }
    return Measured(values, _almost(share))


def tenth_little_loss(tables):
    """Compare what a tenth of the scans finds with what all find."""
    tenth = max(1, tables["rooms_walls"]["k"].max() // 10)
    share = _share_of_all(tables, tenth)
    return Measured({"scans": tenth, "share of what all find": share}, _almost(share))


def first_sixty(tables):
    """Tell how the walls of the first 60 scans agree with the truth."""
    columns = ("false_negative", "correct_match", "false_positive", "n_walls", FOUND)
    names = ("false negative", "correct match", "false positive", "walls", "walls found (0.10 m)")
    return Measured(
        {
            name: value_at(tables["rooms_walls"], "cluster_hull", OURS, MANY, column)
            for name, column in zip(names, columns, strict=True)
        }
    )


def survey_of_rooms(tables):
    """Count the scans of the survey."""
    return Measured({"scans": tables["rooms_walls"]["k"].max()})


def _mean_of_each(tables, column):
    return {method: mean_over_first(tables["rooms_walls"], method, column) for method in FOUR}


def _area_ratio(tables, name):
    """Return the ratio for each scan that sees any area; NaN alone where none does."""
    areas, some = tables["rooms_areas"], tables["rooms_areas"]["seen_m2"] > 0
    return areas[name][some] / areas["seen_m2"][some] if some.any() else np.array([np.nan])


def _at_99(selection, claim):
    ours, quantity = scans_for_99(selection), "scans for 99 %"
    return Measured({quantity: ours}, is_about(ours, stated(claim, quantity)))


def _share_of_all(tables, k):
    """Return what the first k scans find per what all find; NaN where those find nothing."""
    some, every = (value_at(tables["rooms_walls"], "cluster_hull", OURS, size, FOUND) for size in (k, np.inf))
    return some / every if every > 0 else np.nan


def _almost(share):
    return bool(share >= ALMOST) if np.isfinite(share) else None
