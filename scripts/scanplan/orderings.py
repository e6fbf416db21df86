"""The orders in which scans can be taken into the plan: the thesis's two and the two it compares them with (5.2)."""

import numpy as np

from scanplan import certificate, greedy, hulls, stopping

METHODS = ("cluster_hull", "hull", "random", "sequential")

_TOLD_SCANS = 15
_TOLD_SHARE = 0.99


def order(method, columns, *, seed):
    """Put all scans of a table of hulls in the order of one method.

    Parameters
    ----------
    method : str
        `cluster_hull`: greedy by the area of the union of clusters' hulls; `hull`: greedy by the area of one convex
        hull per scan; `random`: a permutation drawn with `seed`; `sequential`: as recorded.
    columns : dict of str to (m,) numpy.ndarray
        `scan_id` and `geometry` of a table of hulls.
    seed : int, >= 0
        For `random` only.

    Returns
    -------
    dict of str to (n,) numpy.ndarray
        The columns of `tables.SELECTION`. Areas are those of one convex hull per scan for `hull` and those of the
        clusters' hulls for the others; `bound_m2` at rank k is what no k scans, of any order, can exceed.

    Raises
    ------
    ValueError
        If there is no such method.
    """
    if method not in METHODS:
        raise ValueError(f"no method {method!r}, only {', '.join(METHODS)}")
    scan_ids, polygons = (hulls.scan_full_hulls if method == "hull" else hulls.scan_polygons)(columns)
    best = greedy.greedy_order(polygons)
    chosen = _GIVEN[method](len(scan_ids), seed) if method in _GIVEN else best.order
    gain_m2 = greedy.gains_of_order(polygons, chosen) if method in _GIVEN else best.gain_m2
    return {
        "rank": np.arange(1, len(chosen) + 1, dtype=np.int32),
        "scan_id": scan_ids[chosen],
        "gain_m2": gain_m2,
        "covered_m2": np.cumsum(gain_m2),
        # the same polygons, so the greedy order's bound holds for every order of them
        "bound_m2": np.maximum(certificate.upper_bound(best), np.cumsum(gain_m2)),
    }


def summary(method, columns):
    """Say in a line what an order covers, how soon, and how good its beginning is at least."""
    n, covered_m2 = len(columns["rank"]), columns["covered_m2"]
    soon, _ = stopping.n_scans(columns, area_share=_TOLD_SHARE)
    first = min(_TOLD_SCANS, n)
    bound_m2 = columns["bound_m2"][first - 1]
    share = covered_m2[first - 1] / bound_m2 if bound_m2 > 0 else 1.0
    return (
        f"{method}, {n} scans, {covered_m2[-1]:.1f} m2; {_TOLD_SHARE:.0%} at {soon} scans;"
        f" first {first} cover at least {np.floor(100 * share):.0f} % of what any {first} could"
    )


def _random(n, seed):
    return np.random.default_rng(seed).permutation(n)


def _sequential(n, _seed):
    return np.arange(n)


_GIVEN = {"random": _random, "sequential": _sequential}
