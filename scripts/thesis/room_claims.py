"""Our measurement of the thesis's claims about orders and areas, from a survey of the rooms.

Every public function measures the claim that it is called like, from the tables of one seed.
"""

import numpy as np
import pandas as pd

from thesis import premises, unevenness
from thesis.claim_measures import (
    AREA,
    BUILDING,
    CORRECT,
    COUNT,
    FOUND,
    METRES,
    NUMBER,
    OURS,
    PLAIN_CLUSTERS,
    SAMPLED,
    SECONDS,
    SHARE,
    UNSAMPLED,
    ClaimMeasure,
    Quantities,
    Tables,
    count_clusters,
    count_scans_to,
    least_kept,
    mean_over_first,
    measure_at,
    measure_tenth,
    of_unit,
    scans_for_99,
)
from thesis.stated_claims import Judged, Sizes

_NAMES = {
    "cluster_hull": "cluster hulls",
    "hull": "one hull",
    "random": "random",
    "sequential": "sequential",
}


def sequential_poorest(tables: Tables) -> ClaimMeasure:
    """Compare the orders by what they miss."""
    missed = _mean_of_each(tables, "false_negative")
    behind = missed["sequential"] - missed.drop("sequential").max()
    return ClaimMeasure(of_unit(missed.to_dict(), SHARE), behind, SHARE)


def sequential_poorest_match(tables: Tables) -> ClaimMeasure:
    """Compare the orders by the share of cells that agree."""
    matched = _mean_of_each(tables, "correct_match")
    literal = _mean_of_each(tables, "literal_correct_match").add_prefix("in the literal grid, ")
    behind = matched.drop("sequential").min() - matched["sequential"]
    values = of_unit(matched.to_dict() | literal.to_dict(), SHARE)
    return ClaimMeasure(values, behind, SHARE)


def others_similar(tables: Tables) -> ClaimMeasure:
    """Compare how far the other three orders lie apart with how far sequential lies behind."""
    missed = _mean_of_each(tables, "false_negative")
    others = missed.drop("sequential")
    apart = others.max() - others.min()
    behind = missed["sequential"] - others.max()
    values = {"range of the other three": apart, "sequential behind them": behind}
    return ClaimMeasure(of_unit(values, SHARE), behind - apart, SHARE)


def full_hull_overestimates(tables: Tables) -> ClaimMeasure:
    """Compare the areas of whole scans' hulls with what the scans truly see."""
    areas = _seeing_scans(tables)
    ratio = areas["full_hull_m2"] / areas["seen_m2"]
    over_share = (ratio > 1).mean() if len(ratio) else np.nan
    values: Quantities = {
        "hull per seen area, median": (ratio.median(), NUMBER),
        "share of scans over-estimated": (over_share, SHARE),
    }
    return ClaimMeasure(values, ratio.median() - 1)


def cluster_hull_closer(tables: Tables) -> ClaimMeasure:
    """Compare how far the areas of either kind of hull are from what the scans truly see."""
    areas = _seeing_scans(tables)
    values, error = {}, {}
    for hull, name in (("cluster_hull", "cluster hulls"), ("full_hull", "one hull")):
        error[hull] = (areas[f"{hull}_m2"] / areas["seen_m2"] - 1).abs().median()
        values[f"error of the area, {name}, median"] = error[hull]
        values[f"intersection over union, {name}, median"] = areas[f"{hull}_iou"].median()
    margin = Judged.MUCH - error["cluster_hull"] / error["full_hull"]
    return ClaimMeasure(of_unit(values, SHARE), margin, SHARE)


def outliers_harm_one_hull(tables: Tables) -> ClaimMeasure:
    """Compare what a stray return adds to the area of either kind of hull."""
    areas = _seeing_scans(tables)
    added = {
        name: (areas[f"{hull}_stray_m2"] / areas[f"{hull}_m2"] - 1).mean()
        for hull, name in (("cluster_hull", "cluster hulls"), ("full_hull", "one hull"))
    }
    values = {f"area added by one stray return, {name}": share for name, share in added.items()}
    margin = Judged.MUCH - added["cluster hulls"] / added["one hull"]
    return ClaimMeasure(of_unit(values, SHARE), margin, SHARE)


def full_hull_99(tables: Tables) -> ClaimMeasure:
    """Count the scans for 99 % of the area by one hull per scan."""
    return ClaimMeasure({"scans for 99 %": (scans_for_99(tables["rooms_hull"]), COUNT)})


def cluster_hull_99(tables: Tables) -> ClaimMeasure:
    """Count the scans for 99 % of the area by cluster hulls."""
    return ClaimMeasure({"scans for 99 %": (scans_for_99(tables["rooms_cluster_hull"]), COUNT)})


def full_hull_sooner(tables: Tables) -> ClaimMeasure:
    """Compare those two numbers."""
    full = scans_for_99(tables["rooms_hull"])
    cluster = scans_for_99(tables["rooms_cluster_hull"])
    values = of_unit({"one hull": full, "cluster hulls": cluster}, COUNT)
    return ClaimMeasure(values, cluster - full, COUNT)


def slower_is_better(tables: Tables) -> ClaimMeasure:
    """Compare what later scans of both orders bring."""
    walls = tables["rooms_walls"]
    cluster = measure_at(walls, "cluster_hull", OURS, Sizes.MANY, FOUND)
    full = measure_at(walls, "hull", OURS, Sizes.MANY, FOUND)
    values = {
        f"walls found by {Sizes.MANY}, cluster hulls": cluster,
        f"walls found by {Sizes.MANY}, one hull": full,
    }
    return ClaimMeasure(of_unit(values, SHARE), cluster - full, SHARE)


def more_clusters_less_area(tables: Tables) -> ClaimMeasure:
    """Compare the areas by numbers of clusters, for every number of scans."""
    table = tables["rooms_clusters"]
    covered_m2 = table.pivot(index="rank", columns="n_clusters", values="covered_m2")
    less_m2 = -covered_m2.diff(axis=1).iloc[:, 1:].max(axis=1)
    ranks = {str(Sizes.SUBSET): Sizes.SUBSET} if len(covered_m2) > Sizes.SUBSET else {}
    values: Quantities = {}
    for scans, rank in (ranks | {"all": len(covered_m2)}).items():
        for number in (covered_m2.columns.min(), covered_m2.columns.max()):
            quantity = f"by {scans} scans, {count_clusters(number)}"
            values[quantity] = covered_m2.loc[rank, number], AREA
    values["numbers of scans at which it holds"] = (less_m2 > 0).mean(), SHARE
    return ClaimMeasure(values, less_m2.min(), AREA)


def more_clusters_more_time(tables: Tables) -> ClaimMeasure:
    """Compare run times by numbers of clusters."""
    seconds = _building_seconds(tables)
    values = {count_clusters(number): s for number, s in seconds.items()}
    step = (seconds / seconds.shift()).min() - 1
    whole = seconds.iloc[-1] / seconds.iloc[0] - 1
    return ClaimMeasure(
        of_unit(values, SECONDS), min(step + Judged.LOADED, whole - Judged.LOADED), SHARE
    )


def area_adjustable(tables: Tables) -> ClaimMeasure:
    """Compare the hulls' areas with what scans truly see, by number of clusters."""
    areas = _seeing_scans(tables)[["scan_id", "seen_m2"]]
    own = tables["rooms_clusters"].merge(areas, on="scan_id")
    ratio = (own["area_m2"] / own["seen_m2"]).groupby(own["n_clusters"]).median()
    values = {f"area per seen area, {count_clusters(n)}": r for n, r in ratio.items()}
    margin = min(ratio.max() - 1, 1 - ratio.min()) if len(ratio) else np.nan
    return ClaimMeasure(of_unit(values, NUMBER), margin)


def clusters_save_time(tables: Tables) -> ClaimMeasure:
    """Compare the time until most walls are found by one hull and by clusters, hulls included."""
    walls, times = tables["rooms_walls"], tables["rooms_times"]
    building = times[times["task"] == BUILDING].set_index("size")
    hull_s = (building["seconds"] / building["found"]).sort_index()
    extraction_s = times.loc[times["task"] == PLAIN_CLUSTERS, "seconds"].mean()
    n_scans = walls["k"].max()
    values, total_s = {}, {}
    for method, name, of_hull_s in (
        ("hull", "one hull", hull_s.iloc[0]),
        ("cluster_hull", "the most clusters", hull_s.iloc[-1]),
    ):
        needed = count_scans_to(walls, method, Judged.ALMOST)
        total_s[method] = n_scans * of_hull_s + needed * extraction_s
        values[f"scans needed, {name}"] = needed, COUNT
        values[f"time, {name}"] = total_s[method], SECONDS
    saved = 1 - total_s["cluster_hull"] / total_s["hull"]
    return ClaimMeasure(values, saved - Judged.LOADED, SHARE)


def sample_saves_time(tables: Tables) -> ClaimMeasure:
    """Compare run times of clustering a sample of the points and all of them."""
    times = tables["rooms_times"].groupby("task")["seconds"].sum()
    sampled_s, every_s = times.get(SAMPLED, np.nan), times.get(UNSAMPLED, np.nan)
    values = {"a sample of the points": sampled_s, "all points": every_s}
    return ClaimMeasure(of_unit(values, SECONDS), every_s / sampled_s - 1 - Judged.LOADED, SHARE)


def fifteen_almost_complete(tables: Tables) -> ClaimMeasure:
    """Compare what the thesis's subset finds with what the best one of its size finds."""
    walls = tables["rooms_walls"]
    found = measure_at(walls, "cluster_hull", OURS, Sizes.SUBSET, FOUND)
    best = measure_at(walls, "oracle", OURS, Sizes.SUBSET, FOUND)
    values = {
        "walls found": found,
        "length that is wall": measure_at(walls, "cluster_hull", OURS, Sizes.SUBSET, CORRECT),
        "walls found by all scans": measure_at(walls, "cluster_hull", OURS, np.inf, FOUND),
        "walls found by the best 15": best,
        "walls found by the first 15 recorded": measure_at(
            walls, "sequential", OURS, Sizes.SUBSET, FOUND
        ),
    }
    scans = {"of how many scans": (walls["k"].max(), COUNT)}
    return ClaimMeasure(of_unit(values, SHARE) | scans, least_kept([found], [best]), SHARE)


def tenth_little_loss(tables: Tables) -> ClaimMeasure:
    """Compare what a tenth of the scans finds with what all find."""
    walls = tables["rooms_walls"]
    tenth, some, every = measure_tenth(walls, (FOUND, CORRECT))
    values = {
        "walls found, a tenth": some[0],
        "walls found, the best tenth": measure_at(walls, "oracle", OURS, tenth, FOUND),
        "walls found, all": every[0],
        "length that is wall, a tenth": some[1],
        "length that is wall, all": every[1],
    }
    scans = {"scans": (tenth, COUNT)}
    return ClaimMeasure(scans | of_unit(values, SHARE), least_kept(some, every), SHARE)


def uneven_harms_random(tables: Tables) -> ClaimMeasure:
    """Compare what both orders lose where the scans of a crowd were taken many times."""
    even_m, lost = unevenness.lost_shares(tables["rooms_unevenness"])
    values: Quantities = {}
    for order, name in ((unevenness.RANDOM, "random"), (unevenness.AREA, "cluster hulls")):
        values[f"seen, {name}, each scan once"] = even_m[order], METRES
        for repeats, share in lost[order].iloc[1:].items():
            values[f"lost, {name}, crowd {repeats} times"] = share, SHARE
    random, area = lost[unevenness.RANDOM], lost[unevenness.AREA]
    harm = 1 - Judged.ALMOST
    parts = [random.diff().min(), random.iloc[-1] - harm, harm - area.max()]
    return ClaimMeasure(values, min(parts) if lost.notna().all(axis=None) else np.nan, SHARE)


def utility_submodular(tables: Tables) -> ClaimMeasure:
    """Measure the submodularity ratio of what scans find of the walls."""
    table = tables["rooms_premises"]
    ratios = table[table["premise"].isin(premises.UTILITIES)].groupby("premise")["value"]
    values = {f"ratio, {name}": ratio for name, ratio in ratios.mean().items()}
    margin = min(ratios.mean().reindex(premises.UTILITIES)) - Judged.ALMOST
    return ClaimMeasure(of_unit(values, NUMBER), margin)


def clusters_are_walls(tables: Tables) -> ClaimMeasure:
    """Measure how many of a scan's clustered points lie on their cluster's wall."""
    table = tables["rooms_premises"]
    share = table.loc[table["premise"] == premises.ONE_WALL, "value"].median()
    values = {"points on their cluster's wall, median scan": share}
    return ClaimMeasure(of_unit(values, SHARE), share - Judged.ALMOST, SHARE)


def first_sixty(tables: Tables) -> ClaimMeasure:
    """Measure how the walls of the first 60 scans agree with the truth."""
    columns = {
        "false negative": "false_negative",
        "correct match": "correct_match",
        "false positive": "false_positive",
        "in the literal grid, false negative": "literal_false_negative",
        "in the literal grid, correct match": "literal_correct_match",
        "in the literal grid, false positive": "literal_false_positive",
        "walls found (0.10 m)": FOUND,
        "length that is wall (0.10 m)": CORRECT,
    }
    walls = tables["rooms_walls"]
    values = {
        name: measure_at(walls, "cluster_hull", OURS, Sizes.MANY, column)
        for name, column in columns.items()
    }
    n_segments = measure_at(walls, "cluster_hull", OURS, Sizes.MANY, "n_walls")
    return ClaimMeasure(of_unit(values, SHARE) | {"segments": (n_segments, COUNT)})


def survey_of_rooms(tables: Tables) -> ClaimMeasure:
    """Count the scans of the survey."""
    return ClaimMeasure({"scans": (tables["rooms_walls"]["k"].max(), COUNT)})


def _mean_of_each(tables: Tables, column: str) -> pd.Series:
    """Return the means of a column over the first scans of the thesis's orders, by their names."""
    return mean_over_first(tables["rooms_walls"], column)[list(_NAMES)].rename(index=_NAMES)


def _seeing_scans(tables: Tables) -> pd.DataFrame:
    """Return the rows of the scans that see any area."""
    areas = tables["rooms_areas"]
    return areas[areas["seen_m2"] > 0]


def _building_seconds(tables: Tables) -> pd.Series:
    """Return the seconds of making hulls and ordering them, by number of clusters."""
    times = tables["rooms_times"]
    return times[times["task"] == BUILDING].set_index("size")["seconds"].sort_index()
