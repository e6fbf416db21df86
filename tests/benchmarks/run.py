"""The stages against the algorithms written literally, each pair timed in this one process.

Usage: run.py [registration] [selection] [walls] [wall_quality]

Without a name all of them but wall_quality, which takes minutes.
"""

import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests")]

import registrationbench  # noqa: E402
import wallbench  # noqa: E402

from reference import hull_selection  # noqa: E402
from scanplan import (  # noqa: E402
    configuration,
    greedy,
    hulls,
    tables,
)

DEMO = ROOT / "results" / "demo"
SETTINGS = configuration.read_yaml(ROOT / "config/config.yaml")


def timed(function):
    """Call a function without arguments; return its result and the seconds it took."""
    started = time.perf_counter()
    return function(), time.perf_counter() - started


def bench_registration():
    """Algorithm 3: this whole stage, from bag to registered scans, against Open3D on full clouds, point to point."""
    registrationbench.bench(ROOT, SETTINGS)


def bench_selection(n_scans=150):
    """Algorithm 1: lazy greedy against all unions in every round; the orders must be the same."""
    columns = tables.read(DEMO / "hulls.parquet", tables.HULLS)
    _, polygons = hulls.scan_polygons(columns)
    polygons = polygons[:n_scans]
    lazy, lazy_s = timed(lambda: greedy.greedy_order(polygons))
    literal, literal_s = timed(lambda: hull_selection.hull_selection(list(polygons)))
    order = literal[0] if isinstance(literal, tuple) else literal
    assert list(lazy.order) == list(order), "lazy greedy left algorithm 1's order"
    report("selection, the same order", len(polygons), "scans", lazy_s, literal_s)


def bench_walls():
    """Cluster RANSAC against iterative RANSAC, and against itself written literally with sklearn's MeanShift."""
    wallbench.speed(ROOT, SETTINGS)


def bench_wall_quality():
    """What both extractors and a line detector on a raster of all points find of the truth."""
    wallbench.quality(ROOT, SETTINGS)


def report(what, count, unit, ours_s, reference_s):
    """Print one line: both times and their ratio."""
    print(
        f"{what}: {count} {unit}, {1e3 * ours_s / count:.1f} ms each against {1e3 * reference_s / count:.1f} ms:"
        f" {reference_s / ours_s:.1f} times faster",
        flush=True,
    )


if __name__ == "__main__":
    benches = {"registration": bench_registration, "selection": bench_selection, "walls": bench_walls}
    more = {"wall_quality": bench_wall_quality}
    unknown = set(sys.argv[1:]) - set(benches | more)
    if unknown:
        sys.exit(f"no benchmark {', '.join(sorted(unknown))}; there are {', '.join(benches | more)}")
    for name in sys.argv[1:] or benches:
        (benches | more)[name]()
