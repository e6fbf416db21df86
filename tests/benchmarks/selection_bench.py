"""Hulls, orders and the one-pass choice on a simulated drive at ten scans a second."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import drive_scans
import numpy as np
import shapely
from sklearn.cluster import KMeans

from reference import hull_selection
from scanplan.project.stage_settings import select_hulls
from scanplan.selection import area_greedy, bounds, hulls, lazy_greedy, streaming
from scanplan.types import Array, FilePath, FloatArray, Settings

N_SCANS = 1200  # two minutes at 10 Hz, through all rooms
LITERAL_RANKS = 150  # about a minute of the literal algorithm
COPIES, COPIED, THIN = 10, 1000, 4  # ten buildings of a thousand scans, every fourth point
STREAMED, SLOTS = 600, (10, 40)  # every second scan; a small choice and a large one
_TOLD_RANKS = (5, 10, 20, 40, 80)

Say = Callable[[str], None]
Result = TypeVar("Result")


def bench(root: Path, settings: Settings) -> None:
    """Print all comparisons; the steps of one are timed in this process, one after the other."""
    building = root / "config/buildings/ring_office.geojson"
    compare_all(building, settings, lambda line: print(line, flush=True))


def compare_all(building: FilePath, settings: Settings, say: Say) -> None:
    """Compare hulls, orders, the one-pass choice, and a large survey with a small one.

    Parameters
    ----------
    building : path-like
    settings : dict
        The configuration.
    say : callable
        Takes a line of the result.
    """
    scans = drive_scans.simulate_scans(building, settings["simulate"], N_SCANS, route="rooms")
    hull_settings = select_hulls(settings)
    compare_hulls(scans[::100], hull_settings, say)
    polygons = drive_scans.scan_polygons(scans, hull_settings)
    compare_orders(polygons, say)
    compare_streaming(polygons[:: N_SCANS // STREAMED], say)
    compare_sizes(scans[:COPIED], hull_settings, say)


def compare_hulls(scans: list[FloatArray], settings: Settings, say: Say) -> None:
    """Algorithm 2: our hulls against sklearn's KMeans of all points and shapely's MultiPoints."""
    started = time.perf_counter()
    for i, xyz_m in enumerate(scans):
        hulls.make_cluster_hulls(i, xyz_m, **settings)
    middle = time.perf_counter()
    for xyz_m in scans:
        _plain_hulls(xyz_m[:, :2].astype(float), settings)
    ours_s = (middle - started) / len(scans)
    plain_s = (time.perf_counter() - middle) / len(scans)
    n_points = np.mean([len(xyz_m) for xyz_m in scans])
    say(
        f"hulls: {len(scans)} scans of {n_points:,.0f} points, {1e3 * ours_s:.1f} ms each against"
        f" {1e3 * plain_s:.0f} ms with KMeans and MultiPoint: {plain_s / ours_s:.0f} times faster"
    )


def _plain_hulls(xy_m: FloatArray, settings: Settings) -> list[shapely.Geometry]:
    n_clusters = settings["n_clusters"]
    label = KMeans(n_clusters, random_state=settings["seed"]).fit_predict(xy_m)
    return [shapely.MultiPoint(xy_m[label == c]).convex_hull for c in range(n_clusters)]


def compare_orders(polygons: Array, say: Say) -> None:
    """Algorithm 1: the whole order against the literal one, by the number of unions."""
    order, ours_s = measure(lambda: area_greedy.order_by_area(polygons))
    (literal, _), literal_s = measure(
        lambda: hull_selection.hull_selection(list(polygons), LITERAL_RANKS)
    )
    if literal != order.order[:LITERAL_RANKS].tolist():
        raise SystemExit("lazy greedy left algorithm 1's order")
    n = len(polygons)
    whole_s = literal_s * count_unions(n, n) / count_unions(n, LITERAL_RANKS)
    bound_m2, bound_s = measure(lambda: bounds.bound_any_subset(order))
    say(
        f"selection: complete order of {n:,} scans in {ours_s:.2f} s; the literal algorithm took"
        f" {literal_s:.0f} s for the first {LITERAL_RANKS}, the same scans, so {whole_s:.0f} s for"
        f" all (by the number of unions): {whole_s / ours_s:.0f} times faster"
    )
    share = order.covered / bound_m2
    shares = ", ".join(f"{share[k - 1]:.0%} at {k}" for k in _TOLD_RANKS)
    say(f"certificate: in {bound_s:.2f} s, at least {shares} scans of what any choice covers")


def compare_sizes(scans: list[FloatArray], settings: Settings, say: Say) -> None:
    """Surveys of the same density, one ten times as large as the other."""
    many = drive_scans.polygons_side_by_side(scans, settings, copies=COPIES, thin=THIN)
    _, few_s = measure(lambda: order_and_bound(many[: len(scans)]))
    _, many_s = measure(lambda: order_and_bound(many))
    say(
        f"selection: {len(scans):,} scans of one building in {few_s:.2f} s, {len(many):,} scans of"
        f" {COPIES} buildings in {many_s:.1f} s: {many_s / few_s:.1f} times the time"
    )


def compare_streaming(polygons: Array, say: Say) -> None:
    """The one-pass choice against greedy: area and what is held."""
    best = area_greedy.order_by_area(polygons)
    for k in SLOTS:
        (order, most_held), took_s = measure(
            lambda k=k: streaming.order_streaming(polygons, k=k),
        )
        share = area_greedy.area_gains(polygons, order[:k]).sum() / best.covered[k - 1]
        say(
            f"streaming: {k} of {len(polygons)} scans cover {share:.1%} of what greedy's do,"
            f" {most_held} held at most, {1e3 * took_s / len(polygons):.1f} ms a scan"
        )


def order_and_bound(polygons: Array) -> tuple[lazy_greedy.GreedyOrder, FloatArray]:
    """Return the order and the bound of every rank."""
    order = area_greedy.order_by_area(polygons)
    return order, bounds.bound_any_subset(order)


def count_unions(n: int, ranks: int) -> int:
    """Return how many unions the literal algorithm makes for the first ranks of n scans."""
    return sum(n - rank for rank in range(ranks))


def measure(function: Callable[[], Result]) -> tuple[Result, float]:
    """Return a function's result and the seconds of processor time that it took."""
    started = time.process_time()
    return function(), time.process_time() - started
