"""Our measurement of the thesis's claims about orders and areas, from the tables of a survey of the rooms."""

import numpy as np

from scanplan.lab.thesis import unevenness
from scanplan.lab.thesis.claim_measures import (
    AREA,
    BUILDING,
    CORRECT,
    COUNT,
    FOUND,
    FOUR,
    MANY,
    METRES,
    NUMBER,
    OURS,
    SECONDS,
    SHARE,
    SUBSET,
    ClaimMeasure,
    if_known,
    is_about,
    is_similar,
    mean_over_first,
    measure_at,
    scans_for_99,
)
from scanplan.lab.thesis.stated_claims import COMPLETE, HARM, MUCH, stated_number

_LATER = 40
_NAMES = {
    "cluster_hull": "cluster hulls",
    "hull": "one hull",
    "random": "random",
    "sequential": "sequential",
}


def sequential_poorest(tables):
    """Compare the orders by what they miss."""
    mean = _mean_of_each(tables, "false_negative")
    return ClaimMeasure(
        _named(mean), all(mean["sequential"] > mean[method] for method in FOUR[:-1])
    )


def sequential_poorest_match(tables):
    """Compare the orders by the share of cells that agree."""
    mean = _mean_of_each(tables, "correct_match")
    return ClaimMeasure(
        _named(mean), all(mean["sequential"] < mean[method] for method in FOUR[:-1])
    )


def others_similar(tables):
    """Compare how far the other three orders lie apart with how far sequential lies behind."""
    mean = _mean_of_each(tables, "false_negative")
    others = [mean[method] for method in FOUR[:-1]]
    apart, behind = max(others) - min(others), mean["sequential"] - max(others)
    return ClaimMeasure(
        _shares({"range of the other three": apart, "sequential behind them": behind}),
        apart < behind,
    )


def full_hull_overestimates(tables):
    """Compare the areas of whole scans' hulls with what the scans truly see."""
    areas, some = _seeing(tables["rooms_areas"])
    ratio = areas["full_hull_m2"] / areas["seen_m2"] if some else np.array([np.nan])
    values = {
        "hull per seen area, median": (np.median(ratio), NUMBER),
        "share of scans over-estimated": (np.mean(ratio > 1) if some else np.nan, SHARE),
    }
    return ClaimMeasure(values, if_known(ratio, np.median(ratio) > 1))


def cluster_hull_closer(tables):
    """Compare how well the shape of either kind of hull agrees with what the scans truly see."""
    areas, some = _seeing(tables["rooms_areas"])
    clusters, full = (
        np.median(areas[f"{kind}_hull_iou"]) if some else np.nan for kind in ("cluster", "full")
    )
    values = {
        "shared, cluster hulls, median": (clusters, SHARE),
        "shared, one hull, median": (full, SHARE),
    }
    return ClaimMeasure(values, if_known([clusters, full], 1 - clusters <= MUCH * (1 - full)))


def full_hull_99(tables):
    """Count the scans for 99 % of the area by one hull per scan."""
    return _at_99(tables["rooms_hull"], "full_hull_99")


def cluster_hull_99(tables):
    """Count the scans for 99 % of the area by cluster hulls."""
    return _at_99(tables["rooms_cluster_hull"], "cluster_hull_99")


def full_hull_sooner(tables):
    """Compare those two numbers."""
    full, cluster = (scans_for_99(tables[f"rooms_{method}"]) for method in ("hull", "cluster_hull"))
    return ClaimMeasure(
        {"one hull": (full, COUNT), "cluster hulls": (cluster, COUNT)}, full < cluster
    )


def slower_is_better(tables):
    """Compare what later scans of both orders bring."""
    found = [
        measure_at(tables["rooms_walls"], method, OURS, _LATER, FOUND)
        for method in ("cluster_hull", "hull")
    ]
    names = (f"walls found by {_LATER}, cluster hulls", f"walls found by {_LATER}, one hull")
    return ClaimMeasure(
        _shares(dict(zip(names, found, strict=True))), if_known(found, found[0] > found[1])
    )


def more_clusters_less_area(tables):
    """Compare the areas by numbers of clusters, for every number of scans."""
    table = tables["rooms_clusters"]
    numbers = np.unique(table["n_clusters"])
    growth = np.array([table["covered_m2"][table["n_clusters"] == n] for n in numbers])
    less = (np.diff(growth, axis=0) < 0).all(axis=0)
    at = {str(SUBSET): SUBSET - 1, "all": -1} if growth.shape[1] > SUBSET else {"all": -1}
    values = {
        f"by {scans} scans, {n} cluster{'s' * bool(n > 1)}": (growth[row, rank], AREA)
        for scans, rank in at.items()
        for row, n in ((0, numbers[0]), (-1, numbers[-1]))
    }
    return ClaimMeasure(
        values | {"numbers of scans at which it holds": (less.mean(), SHARE)}, bool(less.all())
    )


def more_clusters_more_time(tables):
    """Compare run times by numbers of clusters."""
    times = tables["rooms_times"]
    of_it = times["task"] == BUILDING
    numbers, taken = times["size"][of_it], times["seconds"][of_it]
    taken, numbers = taken[np.argsort(numbers)], np.sort(numbers)
    values = {
        f"{n} cluster{'s' * bool(n > 1)}": (s, SECONDS) for n, s in zip(numbers, taken, strict=True)
    }
    return ClaimMeasure(values, bool((np.diff(taken) > 0).all()))


def fifteen_almost_complete(tables):
    """Compare what the thesis's subset finds with the truth, and with what other orders find."""
    walls = tables["rooms_walls"]
    found = measure_at(walls, "cluster_hull", OURS, SUBSET, FOUND)
    values = {
        "walls found": found,
        "length that is wall": measure_at(walls, "cluster_hull", OURS, SUBSET, CORRECT),
        "walls found by all scans": measure_at(walls, "cluster_hull", OURS, np.inf, FOUND),
        "walls found by the oracle's 15": measure_at(walls, "oracle", OURS, SUBSET, FOUND),
        "walls found by the first 15 recorded": measure_at(
            walls, "sequential", OURS, SUBSET, FOUND
        ),
    }
    scans = {"of how many scans": (walls["k"].max(), COUNT)}
    return ClaimMeasure(_shares(values) | scans, if_known(found, found >= COMPLETE))


def tenth_little_loss(tables):
    """Compare what a tenth of the scans finds with what all find."""
    tenth = max(1, tables["rooms_walls"]["k"].max() // 10)
    some, every = (
        [
            measure_at(tables["rooms_walls"], "cluster_hull", OURS, k, column)
            for column in (FOUND, CORRECT)
        ]
        for k in (tenth, np.inf)
    )
    values = {
        "walls found, a tenth": some[0],
        "walls found, all": every[0],
        "length that is wall, a tenth": some[1],
        "length that is wall, all": every[1],
    }
    return ClaimMeasure({"scans": (tenth, COUNT)} | _shares(values), is_similar(some, every))


def uneven_harms_random(tables):
    """Compare what both orders lose where the scans of a crowd were taken many times."""
    values, losses = {}, {}
    for order, said in ((unevenness.RANDOM, "random"), (unevenness.AREA, "cluster hulls")):
        even_m, losses[order] = unevenness.lost_shares(tables["rooms_unevenness"], order)
        values[f"seen, {said}, each scan once"] = even_m, METRES
        for times, lost in list(zip(unevenness.REPEATS, losses[order], strict=True))[1:]:
            values[f"lost, {said}, crowd {times} times"] = lost, SHARE
    random, area = losses[unevenness.RANDOM], losses[unevenness.AREA]
    suffers = (np.diff(random) > 0).all() and random[-1] > HARM
    return ClaimMeasure(values, if_known([*random, *area], suffers and (area <= HARM).all()))


def first_sixty(tables):
    """Tell how the walls of the first 60 scans agree with the truth."""
    columns = ("false_negative", "correct_match", "false_positive", FOUND, CORRECT)
    names = (
        "false negative",
        "correct match",
        "false positive",
        "walls found (0.10 m)",
        "length that is wall (0.10 m)",
    )
    value = {
        name: measure_at(tables["rooms_walls"], "cluster_hull", OURS, MANY, column)
        for name, column in zip(names, columns, strict=True)
    }
    segments = measure_at(tables["rooms_walls"], "cluster_hull", OURS, MANY, "n_walls")
    return ClaimMeasure(_shares(value) | {"segments": (segments, COUNT)})


def survey_of_rooms(tables):
    """Count the scans of the survey."""
    return ClaimMeasure({"scans": (tables["rooms_walls"]["k"].max(), COUNT)})


def _mean_of_each(tables, column):
    return {method: mean_over_first(tables["rooms_walls"], method, column) for method in FOUR}


def _named(mean):
    return {_NAMES[method]: (value, SHARE) for method, value in mean.items()}


def _shares(values):
    return {name: (value, SHARE) for name, value in values.items()}


def _seeing(areas):
    """Return the rows of the scans that see any area, and whether there are any."""
    some = areas["seen_m2"] > 0
    return {name: column[some] for name, column in areas.items()}, some.any()


def _at_99(selection, claim):
    ours, quantity = scans_for_99(selection), "scans for 99 %"
    return ClaimMeasure({quantity: (ours, COUNT)}, is_about(ours, stated_number(claim, quantity)))
