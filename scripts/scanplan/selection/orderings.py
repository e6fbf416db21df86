"""The orders in which scans can be taken into the plan: by objectives, and those that look at no point (thesis, 5.2).

An objective is a file `objective_<method>.py` with its `UNIT` and a function `objective(scan_ids, columns)`, which
returns an object with `greedy(min_overlap)`, a `area_greedy.AreaOrder`, and `gains(order)`.
"""

import numpy as np

from scanplan.errors import StageError
from scanplan.selection import (
    baselines,
    bounds,
    hulls,
    objective_cluster_hull,
    objective_hull,
    objective_visibility,
    objective_wall_length,
    stopping,
    streaming,
)
from scanplan.selection.methods import METHODS

_AREAS = {"cluster_hull": objective_cluster_hull, "hull": objective_hull}
_OBJECTIVES = {"wall_length": objective_wall_length, "visibility": objective_visibility}
_BASELINES = {
    "every_nth": baselines.order_every_nth,
    "distance": baselines.order_by_distance,
    "random": baselines.order_randomly,
    "sequential": baselines.order_sequentially,
}
_STREAMING = "streaming"
_TOLD_SCANS = 15
_TOLD_SHARE = 0.99


def order_scans(
    method,
    columns,
    *,
    seed=None,
    others=None,
    min_overlap=0.0,
    streaming_settings=None,
    budget=None,
):
    """Put all scans of a table of hulls in the order of one method.

    Parameters
    ----------
    method : str
        Greedy by an objective: `wall_length`, what the scans show of the walls; `visibility`, the free space they
        looked through; `cluster_hull`, the area of the union of clusters' hulls; `hull`, that of one convex hull per
        scan; `streaming`, the area of `cluster_hull` again, but in one pass over the scans as they were recorded. By
        nothing measured: `every_nth`, evenly over the recording; `distance`, always the one taken farthest from those
        before; `random`, a permutation drawn with `seed`; `sequential`, as recorded.
    columns : dict of str to (m,) numpy.ndarray
        `scan_id`, `n_points` and `geometry` of a table of hulls.
    seed : int, >= 0
        For `random` only, which needs it.
    others : dict of str to columns, optional
        The tables that `methods.TABLES` names for the method.
    min_overlap : float, 0 to 1
        For objectives: what a scan must share with those before it, see `lazy_greedy.order_greedily`.
    streaming_settings : dict, optional
        For `streaming` only, keywords of `streaming.order_streaming`.
    budget : int, optional
        Points that the first scans may have together. Orders by an objective then begin with the scans that
        `budget.choose_in_budget` takes for it; a `min_overlap` is not asked of them.

    Returns
    -------
    dict of str to (n,) numpy.ndarray
        The columns of `schemas.SELECTION`. Areas are those of one convex hull per scan for `hull` and those of the
        clusters' hulls for the others; `bound_m2` at rank k is what no k scans, of any order, can exceed. `gain`,
        `covered` and `bound` are the same in the unit of the method's objective; areas for methods without one.

    Raises
    ------
    ValueError
        If there is no such method, or no seed for `random`.
    StageError
        If a table is not of the scans that have hulls.
    """
    if method not in METHODS:
        raise ValueError(f"no method {method!r}, only {', '.join(METHODS)}")
    if method == "random" and seed is None:
        raise ValueError("a random order needs a seed")
    scan_ids, survey = np.unique(columns["scan_id"]), {"hulls": columns, **(others or {})}
    area = _AREAS.get(method, objective_cluster_hull).objective(scan_ids, survey)
    most_area = area.greedy()
    own, most = area, most_area
    if method in _OBJECTIVES:
        own = _OBJECTIVES[method].objective(scan_ids, survey)
        most = own.greedy()
    if method in _BASELINES:
        chosen = _baseline(method, scan_ids, survey, seed)
    elif method == _STREAMING:
        chosen = streaming.order_streaming(
            hulls.scan_polygons(columns)[1], **(streaming_settings or {})
        )[0]
    else:
        chosen = own.greedy(min_overlap).order if min_overlap > 0 else most.order
        chosen = chosen if budget is None else _within(own, _points(columns), budget, chosen)
    areas = _along(chosen, area, most_area)
    return {
        "rank": np.arange(1, len(chosen) + 1, dtype=np.int32),
        "scan_id": scan_ids[chosen],
        "n_points": _points(columns)[chosen],
        **{f"{name}_m2": values for name, values in areas.items()},
        **(areas if own is area else _along(chosen, own, most)),
    }


def summarise_order(method, columns):
    """Say in a line what an order covers, how soon, and how good its beginning is at least."""
    n, covered = len(columns["rank"]), columns["covered"]
    soon, _ = stopping.choose_n_scans(columns, area_share=_TOLD_SHARE)
    first = min(_TOLD_SCANS, n)
    bound = columns["bound"][first - 1]
    share = covered[first - 1] / bound if bound > 0 else 1.0
    unit = (
        _OBJECTIVES[method].UNIT
        if method in _OBJECTIVES
        else _AREAS.get(method, objective_cluster_hull).UNIT
    )
    return (
        f"{method}, {n} scans, {covered[-1]:.1f} {unit}; {_TOLD_SHARE:.0%} at {soon} scans;"
        f" first {first} cover at least {np.floor(100 * share):.0f} % of what any {first} could"
    )


def _along(chosen, objective, best):
    """Return gain, covered and bound (n,) along an order, whatever order it is: the greedy order bounds them all."""
    gain = best.gain_m2 if chosen is best.order else objective.gains(chosen)
    covered = np.cumsum(gain)
    return {
        "gain": gain,
        "covered": covered,
        "bound": np.maximum(bounds.bound_any_subset(best), covered),
    }


def _within(objective, n_points, budget, then):
    """Return the scans taken for a budget of points, then the others in their order."""
    if n_points.sum() <= budget:
        return then
    first = np.array(objective.within(n_points, budget), int)
    return np.concatenate([first, then[~np.isin(then, first)]])


def _points(columns):
    """Return how many points (n,) each scan has."""
    _, row = np.unique(columns["scan_id"], return_inverse=True)
    return np.bincount(row, columns["n_points"]).astype(np.int64)


def _baseline(method, scan_ids, survey, seed):
    n = len(scan_ids)
    if method == "distance":
        return baselines.order_by_distance(_positions(scan_ids, survey["registration"]))
    return baselines.order_randomly(n, seed) if method == "random" else _BASELINES[method](n)


def _positions(scan_ids, registered):
    """Return where (n, 2) the sensor was at scans."""
    row = {int(s): i for i, s in enumerate(registered["scan_id"])}
    unknown = [s for s in scan_ids.tolist() if s not in row]
    xy_m = np.column_stack([registered["x_m"], registered["y_m"]])[
        [row[s] for s in scan_ids.tolist() if s in row]
    ]
    if unknown or not np.isfinite(xy_m).all():
        raise StageError(
            f"registration: no position of {len(unknown) or 'some'} of the {len(scan_ids)} scans that have hulls;"
            " delete the results of this dataset and run again"
        )
    return xy_m
