"""Our measurement of the thesis's claims about orders and areas, from a survey of the rooms.

Every public function measures the claim that it is called like, from the tables of one seed.
"""

import numpy as np

from scanplan.lab.thesis import unevenness
from scanplan.lab.thesis.claim_measures import (
    AREA,
    BUILDING,
    CORRECT,
    COUNT,
    FOUND,
    FOUR,
    METRES,
    NUMBER,
    OURS,
    SECONDS,
    SHARE,
    ClaimMeasure,
    Quantities,
    Tables,
    count_clusters,
    if_known,
    is_about,
    is_similar,
    mean_over_first,
    measure_at,
    of_unit,
    scans_for_99,
)
from scanplan.lab.thesis.stated_claims import (
    COMPLETE,
    HARM,
    MANY,
    MUCH,
    SUBSET,
    stated_number,
)
from scanplan.types import Columns

_LATER = 40  # scans: of the evaluated sizes the one at which both orders have long converged
_NAMES = {
    "cluster_hull": "cluster hulls",
    "hull": "one hull",
    "random": "random",
    "sequential": "sequential",
}


def sequential_poorest(tables: Tables) -> ClaimMeasure:
    """Compare the orders by what they miss."""
    missed = _mean_of_each(tables, "false_negative")
    most_of_others = max(missed[method] for method in FOUR[:-1])
    return ClaimMeasure(_by_order(missed), missed["sequential"] > most_of_others)


def sequential_poorest_match(tables: Tables) -> ClaimMeasure:
    """Compare the orders by the share of cells that agree."""
    matched = _mean_of_each(tables, "correct_match")
    least_of_others = min(matched[method] for method in FOUR[:-1])
    return ClaimMeasure(_by_order(matched), matched["sequential"] < least_of_others)


def others_similar(tables: Tables) -> ClaimMeasure:
    """Compare how far the other three orders lie apart with how far sequential lies behind."""
    missed = _mean_of_each(tables, "false_negative")
    others = [missed[method] for method in FOUR[:-1]]
    apart = max(others) - min(others)
    behind = missed["sequential"] - max(others)
    values = {"range of the other three": apart, "sequential behind them": behind}
    return ClaimMeasure(of_unit(values, SHARE), apart < behind)


def full_hull_overestimates(tables: Tables) -> ClaimMeasure:
    """Compare the areas of whole scans' hulls with what the scans truly see."""
    areas = _seeing_scans(tables["rooms_areas"])
    ratio = areas["full_hull_m2"] / areas["seen_m2"]
    median = float(np.median(ratio)) if len(ratio) else np.nan
    over_share = float(np.mean(ratio > 1)) if len(ratio) else np.nan
    values: Quantities = {
        "hull per seen area, median": (median, NUMBER),
        "share of scans over-estimated": (over_share, SHARE),
    }
    return ClaimMeasure(values, if_known(median, median > 1))


def cluster_hull_closer(tables: Tables) -> ClaimMeasure:
    """Compare how well the shape of either kind of hull agrees with what the scans truly see."""
    areas = _seeing_scans(tables["rooms_areas"])
    is_known = len(areas["seen_m2"]) > 0
    clusters = float(np.median(areas["cluster_hull_iou"])) if is_known else np.nan
    full = float(np.median(areas["full_hull_iou"])) if is_known else np.nan
    values = {"shared, cluster hulls, median": clusters, "shared, one hull, median": full}
    holds = 1 - clusters <= MUCH * (1 - full)
    return ClaimMeasure(of_unit(values, SHARE), if_known([clusters, full], holds))


def full_hull_99(tables: Tables) -> ClaimMeasure:
    """Count the scans for 99 % of the area by one hull per scan."""
    return _measure_99(tables["rooms_hull"], "full_hull_99")


def cluster_hull_99(tables: Tables) -> ClaimMeasure:
    """Count the scans for 99 % of the area by cluster hulls."""
    return _measure_99(tables["rooms_cluster_hull"], "cluster_hull_99")


def full_hull_sooner(tables: Tables) -> ClaimMeasure:
    """Compare those two numbers."""
    full = scans_for_99(tables["rooms_hull"])
    cluster = scans_for_99(tables["rooms_cluster_hull"])
    return ClaimMeasure(
        of_unit({"one hull": full, "cluster hulls": cluster}, COUNT), full < cluster
    )


def slower_is_better(tables: Tables) -> ClaimMeasure:
    """Compare what later scans of both orders bring."""
    walls = tables["rooms_walls"]
    cluster = measure_at(walls, "cluster_hull", OURS, _LATER, FOUND)
    full = measure_at(walls, "hull", OURS, _LATER, FOUND)
    values = {
        f"walls found by {_LATER}, cluster hulls": cluster,
        f"walls found by {_LATER}, one hull": full,
    }
    return ClaimMeasure(of_unit(values, SHARE), if_known([cluster, full], cluster > full))


def more_clusters_less_area(tables: Tables) -> ClaimMeasure:
    """Compare the areas by numbers of clusters, for every number of scans."""
    table = tables["rooms_clusters"]
    numbers = np.unique(table["n_clusters"])
    covered_m2 = np.array([table["covered_m2"][table["n_clusters"] == n] for n in numbers])
    is_less = (np.diff(covered_m2, axis=0) < 0).all(axis=0)
    ranks = {"all": -1}
    if covered_m2.shape[1] > SUBSET:
        ranks = {str(SUBSET): SUBSET - 1, **ranks}
    values: Quantities = {}
    for scans, rank in ranks.items():
        for row in (0, -1):
            quantity = f"by {scans} scans, {count_clusters(numbers[row])}"
            values[quantity] = covered_m2[row, rank], AREA
    values["numbers of scans at which it holds"] = is_less.mean(), SHARE
    return ClaimMeasure(values, bool(is_less.all()))


def more_clusters_more_time(tables: Tables) -> ClaimMeasure:
    """Compare run times by numbers of clusters."""
    times = tables["rooms_times"]
    rows = np.flatnonzero(times["task"] == BUILDING)
    rows = rows[np.argsort(times["size"][rows])]
    seconds = times["seconds"][rows]
    names = [count_clusters(number) for number in times["size"][rows]]
    values = of_unit(dict(zip(names, seconds, strict=True)), SECONDS)
    return ClaimMeasure(values, bool((np.diff(seconds) > 0).all()))


def fifteen_almost_complete(tables: Tables) -> ClaimMeasure:
    """Compare what the thesis's subset finds with the truth, and with what other orders find."""
    walls = tables["rooms_walls"]
    found = measure_at(walls, "cluster_hull", OURS, SUBSET, FOUND)
    by_recorded = measure_at(walls, "sequential", OURS, SUBSET, FOUND)
    values = {
        "walls found": found,
        "length that is wall": measure_at(walls, "cluster_hull", OURS, SUBSET, CORRECT),
        "walls found by all scans": measure_at(walls, "cluster_hull", OURS, np.inf, FOUND),
        "walls found by the oracle's 15": measure_at(walls, "oracle", OURS, SUBSET, FOUND),
        "walls found by the first 15 recorded": by_recorded,
    }
    scans = {"of how many scans": (walls["k"].max(), COUNT)}
    return ClaimMeasure(of_unit(values, SHARE) | scans, if_known(found, found >= COMPLETE))


def tenth_little_loss(tables: Tables) -> ClaimMeasure:
    """Compare what a tenth of the scans finds with what all find."""
    walls = tables["rooms_walls"]
    tenth = max(1, walls["k"].max() // 10)
    some, every = (
        [measure_at(walls, "cluster_hull", OURS, k, column) for column in (FOUND, CORRECT)]
        for k in (tenth, np.inf)
    )
    values = {
        "walls found, a tenth": some[0],
        "walls found, all": every[0],
        "length that is wall, a tenth": some[1],
        "length that is wall, all": every[1],
    }
    return ClaimMeasure({"scans": (tenth, COUNT)} | of_unit(values, SHARE), is_similar(some, every))


def uneven_harms_random(tables: Tables) -> ClaimMeasure:
    """Compare what both orders lose where the scans of a crowd were taken many times."""
    table = tables["rooms_unevenness"]
    values: Quantities = {}
    losses = {}
    for order, name in ((unevenness.RANDOM, "random"), (unevenness.AREA, "cluster hulls")):
        even_m, losses[order] = unevenness.lost_shares(table, order)
        values[f"seen, {name}, each scan once"] = even_m, METRES
        for repeats, lost in zip(unevenness.REPEATS[1:], losses[order][1:], strict=True):
            values[f"lost, {name}, crowd {repeats} times"] = lost, SHARE
    random, area = losses[unevenness.RANDOM], losses[unevenness.AREA]
    random_suffers = (np.diff(random) > 0).all() and random[-1] > HARM
    holds = random_suffers and (area <= HARM).all()
    return ClaimMeasure(values, if_known([*random, *area], holds))


def first_sixty(tables: Tables) -> ClaimMeasure:
    """Measure how the walls of the first 60 scans agree with the truth."""
    columns = {
        "false negative": "false_negative",
        "correct match": "correct_match",
        "false positive": "false_positive",
        "walls found (0.10 m)": FOUND,
        "length that is wall (0.10 m)": CORRECT,
    }
    walls = tables["rooms_walls"]
    values = {
        name: measure_at(walls, "cluster_hull", OURS, MANY, column)
        for name, column in columns.items()
    }
    n_segments = measure_at(walls, "cluster_hull", OURS, MANY, "n_walls")
    return ClaimMeasure(of_unit(values, SHARE) | {"segments": (n_segments, COUNT)})


def survey_of_rooms(tables: Tables) -> ClaimMeasure:
    """Count the scans of the survey."""
    return ClaimMeasure({"scans": (tables["rooms_walls"]["k"].max(), COUNT)})


def _mean_of_each(tables: Tables, column: str) -> dict[str, float]:
    return {method: mean_over_first(tables["rooms_walls"], method, column) for method in FOUR}


def _by_order(shares: dict[str, float]) -> Quantities:
    return of_unit({_NAMES[method]: share for method, share in shares.items()}, SHARE)


def _seeing_scans(areas: Columns) -> Columns:
    """Return the rows of the scans that see any area."""
    sees = areas["seen_m2"] > 0
    return {name: values[sees] for name, values in areas.items()}


def _measure_99(selection: Columns, claim: str) -> ClaimMeasure:
    ours, quantity = scans_for_99(selection), "scans for 99 %"
    return ClaimMeasure({quantity: (ours, COUNT)}, is_about(ours, stated_number(claim, quantity)))
