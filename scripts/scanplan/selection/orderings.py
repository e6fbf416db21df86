"""The orders in which scans can be taken into the plan: those of `methods.METHODS`.

Thesis, section 5.2.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from scanplan.selection import baselines, bounds, objectives, stopping, streaming
from scanplan.selection.lazy_greedy import GreedyOrder
from scanplan.selection.methods import AREA_METHOD, METHODS, Method
from scanplan.selection.objectives import Objective
from scanplan.selection.survey_scans import SurveyScans
from scanplan.types import Array, Columns, IntArray

_MODULES = {"baselines": baselines, "streaming": streaming}
_LOGGED_SHARE = 0.99  # of what all scans cover: the thesis's measure of how soon


def order_scans(
    method: str,
    columns: Columns,
    *,
    seed: int | None = None,
    others: Mapping[str, Columns] | None = None,
    min_overlap: float = 0.0,
    streaming_settings: Mapping[str, Any] | None = None,
    budget: int | None = None,
) -> dict[str, Array]:
    """Put all scans of a table of hulls in the order of one method.

    Parameters
    ----------
    method : str
        Greedy by an objective: `wall_length`, what the scans show of the walls; `visibility`, the
        free space they looked through; `cluster_hull`, the area of the union of clusters' hulls;
        `hull`, that of one convex hull per scan; `streaming`, the area of `cluster_hull` again, but
        in one pass over the scans as they were recorded. By nothing measured: `every_nth`, evenly
        over the recording; `distance`, always the one taken farthest from those before; `random`, a
        permutation drawn with `seed`; `sequential`, as recorded.
    columns : dict of str to (m,) numpy.ndarray
        `scan_id`, `n_points`, `cluster` and `geometry` of a table of hulls; or the first two alone,
        a scan a row, for a method with an objective that is no area.
    seed : int, >= 0
        For `random` only, which needs it.
    others : dict of str to columns, optional
        The tables that `methods.METHODS` names for the method.
    min_overlap : float, 0 to 1
        For objectives: what a scan must share with those before it, see
        `lazy_greedy.order_greedily`.
    streaming_settings : dict, optional
        For `streaming` only, keywords of `streaming.order_streaming`.
    budget : int, optional
        Points that the first scans may have together. Orders by an objective then begin with the
        scans that `budget.choose_in_budget` takes for it; a `min_overlap` is not asked of them.

    Returns
    -------
    dict of str to (n,) numpy.ndarray
        The columns of `schemas.SELECTION`. Areas are those of one convex hull per scan for `hull`
        and those of the clusters' hulls for the others, NaN without hulls; `bound_m2` at rank k is
        what no k scans, of any order, can exceed. `gain`, `covered` and `bound` are the same in the
        unit of the method's objective; areas for methods without one.

    Raises
    ------
    ValueError
        If there is no such method, or no seed for `random`.
    StageError
        If a table is not of the scans that have hulls.
    """
    if method not in METHODS:
        raise ValueError(f"no method {method!r}, only {', '.join(METHODS)}")
    chosen_method = METHODS[method]
    scan_ids = np.unique(columns["scan_id"])
    tables = {"hulls": columns, **(others or {})}
    scans = SurveyScans(scan_ids, tables, seed, streaming_settings or {})
    n_points = _count_points(columns)
    own = _make_objective(_measuring(chosen_method), scans)
    most = own.greedy()
    if chosen_method.order:
        order = _order_directly(chosen_method.order, scans)
    else:
        order = own.greedy(min_overlap).order if min_overlap > 0 else most.order
        order = order if budget is None else _put_affordable_first(own, n_points, budget, order)
    covered = _measure_along(order, own, most)
    if chosen_method.needs_hulls:
        areas = covered
    elif "geometry" in columns:
        areas = measure_area(order, columns)
    else:
        areas = {name: np.full(len(order), np.nan) for name in covered}
    return {
        "rank": np.arange(1, len(order) + 1, dtype=np.int32),
        "scan_id": scan_ids[order],
        "n_points": n_points[order],
        **{f"{name}_m2": values for name, values in areas.items()},
        **covered,
    }


def measure_area(order: IntArray, columns: Columns) -> dict[str, Array]:
    """Return the area of the hulls of clusters along any order.

    Parameters
    ----------
    order : (n,) int
        Rows of the scans.
    columns : dict of str to (m,) numpy.ndarray
        A table of hulls.

    Returns
    -------
    dict of str to (n,) float64
        `gain`, `covered` and `bound`, square metres.
    """
    scans = SurveyScans(np.unique(columns["scan_id"]), {"hulls": columns})
    area = _make_objective(METHODS[AREA_METHOD], scans)
    return _measure_along(order, area, area.greedy())


def _measuring(method: Method) -> Method:
    """Return the method whose objective measures what a method's order covers."""
    return method if method.objective else METHODS[AREA_METHOD]


def summarise_order(method: str, columns: Columns) -> str:
    """Return coverage, speed and guarantee of an order in a line."""
    covered = columns["covered"]
    first, _ = stopping.choose_n_scans(columns, area_share=_LOGGED_SHARE)
    bound = columns["bound"][first - 1]
    share = covered[first - 1] / bound if bound > 0 else 1.0
    return (
        f"{method}, {len(covered)} scans, {covered[-1]:.1f} {METHODS[method].unit};"
        f" {_LOGGED_SHARE:.0%} at {first} scans,"
        f" at least {np.floor(100 * share):.0f} % of what any {first} could cover"
    )


def _make_objective(method: Method, scans: SurveyScans) -> Objective:
    return getattr(objectives, str(method.objective))(scans)


def _order_directly(function: str, scans: SurveyScans) -> IntArray:
    """Call the function that a method names as module.function."""
    module, name = function.split(".")
    return getattr(_MODULES[module], name)(scans)


def _measure_along(order: IntArray, objective: Objective, best: GreedyOrder) -> dict[str, Array]:
    """Return gain, covered and bound (n,) along any order: the greedy order bounds them all."""
    gain = best.gain if order is best.order else objective.gains(order)
    covered = np.cumsum(gain)
    bound = np.maximum(bounds.bound_any_subset(best), covered)
    return {"gain": gain, "covered": covered, "bound": bound}


def _put_affordable_first(
    objective: Objective, n_points: IntArray, budget: int, order: IntArray
) -> IntArray:
    """Return the scans taken for a budget of points, then the others in their order."""
    if n_points.sum() <= budget:
        return order
    first = np.array(objective.within(n_points, budget), int)
    return np.concatenate([first, order[~np.isin(order, first)]])


def _count_points(columns: Columns) -> IntArray:
    """Return how many points (n,) each scan has."""
    _, row = np.unique(columns["scan_id"], return_inverse=True)
    return np.bincount(row, columns["n_points"]).astype(np.int64)
