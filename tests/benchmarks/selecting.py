"""Hulls, orders and the one-pass choice on a simulated drive at ten scans a second."""

import time

import drivescans
import numpy as np
import shapely
from sklearn.cluster import KMeans

from reference import hull_selection
from scanplan.project.stage_settings import select_hulls
from scanplan.selection import area_greedy, bounds, hulls, streaming

N_SCANS = 1200
LITERAL_RANKS = 150
COPIES, COPIED, THIN = 10, 1000, 4
STREAMED, SLOTS = 600, (10, 40)


def run(building, settings, say):
    """Run all of them; the steps of one comparison are timed in this process, one after the other.

    Parameters
    ----------
    building : path-like
    settings : dict
        The configuration.
    say : callable
        Takes a line of the result.
    """
    scans = drivescans.scans(building, settings["simulate"], N_SCANS, route="rooms")
    built(scans[::100], select_hulls(settings), say)
    polygons = drivescans.polygons(scans, select_hulls(settings))
    ordered(polygons, say)
    streamed(polygons[:: N_SCANS // STREAMED], say)
    scaled(scans[:COPIED], select_hulls(settings), say)


def built(scans, settings, say):
    """Algorithm 2: our hulls against sklearn's KMeans of all points and hulls of shapely's MultiPoints."""

    def plainly(xy_m):
        label = KMeans(settings["n_clusters"], random_state=settings["seed"]).fit_predict(xy_m)
        return [
            shapely.MultiPoint(xy_m[label == c]).convex_hull for c in range(settings["n_clusters"])
        ]

    started = time.perf_counter()
    for i, xyz_m in enumerate(scans):
        hulls.make_cluster_hulls(i, xyz_m, **settings)
    middle = time.perf_counter()
    for xyz_m in scans:
        plainly(xyz_m[:, :2].astype(float))
    ours_s, plain_s = (middle - started) / len(scans), (time.perf_counter() - middle) / len(scans)
    n_points = np.mean([len(xyz_m) for xyz_m in scans])
    say(
        f"hulls: {len(scans)} scans of {n_points:,.0f} points, {1e3 * ours_s:.1f} ms each against"
        f" {1e3 * plain_s:.0f} ms with KMeans and MultiPoint: {plain_s / ours_s:.0f} times faster"
    )


def ordered(polygons, say):
    """Algorithm 1: the complete order against the literal one, whose later ranks take as long a union as the first."""
    order, ours_s = timed(lambda: area_greedy.order_by_area(polygons))
    (literal, _), literal_s = timed(
        lambda: hull_selection.hull_selection(list(polygons), LITERAL_RANKS)
    )
    if literal != order.order[:LITERAL_RANKS].tolist():
        raise SystemExit("lazy greedy left algorithm 1's order")
    n = len(polygons)
    whole_s = literal_s * unions(n, n) / unions(n, LITERAL_RANKS)
    bound_m2, bound_s = timed(lambda: bounds.bound_any_subset(order))
    say(
        f"selection: complete order of {n:,} scans in {ours_s:.2f} s; the literal algorithm took {literal_s:.0f} s for"
        f" the first {LITERAL_RANKS}, the same scans, so {whole_s:.0f} s for all (by the number of unions):"
        f" {whole_s / ours_s:.0f} times faster"
    )
    told = ", ".join(
        f"{order.covered[k - 1] / bound_m2[k - 1]:.0%} at {k}" for k in (5, 10, 20, 40, 80)
    )
    say(f"certificate: in {bound_s:.2f} s, at least {told} scans of what any choice covers")


def scaled(scans, settings, say):
    """Surveys of the same density, one ten times as large as the other."""
    many = drivescans.side_by_side(scans, settings, copies=COPIES, thin=THIN)
    few_s, many_s = (timed(lambda p=p: certified(p))[1] for p in (many[: len(scans)], many))
    say(
        f"selection: {len(scans):,} scans of one building in {few_s:.2f} s, {len(many):,} scans of {COPIES} buildings"
        f" in {many_s:.1f} s: {many_s / few_s:.1f} times the time"
    )


def streamed(polygons, say):
    """The one-pass choice against greedy: area and what is held."""
    best = area_greedy.order_by_area(polygons)
    for k in SLOTS:
        (order, most_held), taken_s = timed(lambda k=k: streaming.order_streaming(polygons, k=k))
        share = area_greedy.area_gains(polygons, order[:k]).sum() / best.covered[k - 1]
        say(
            f"streaming: {k} of {len(polygons)} scans cover {share:.1%} of what greedy's do, {most_held} held at most,"
            f" {1e3 * taken_s / len(polygons):.1f} ms a scan"
        )


def certified(polygons):
    """Return the order and the bound of every rank."""
    order = area_greedy.order_by_area(polygons)
    return order, bounds.bound_any_subset(order)


def unions(n, ranks):
    """Count the unions that the literal algorithm makes for the first ranks of n scans."""
    return sum(n - rank for rank in range(ranks))


def timed(function):
    """Call a function without arguments; return its result and the seconds of processor time it took."""
    started = time.process_time()
    return function(), time.process_time() - started
