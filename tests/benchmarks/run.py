"""The stages against the algorithms written literally, on the demo survey, each pair timed in this one process.

Usage: run.py [registration] [selection] [walls]
"""

import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests")]

import selecting  # noqa: E402

from reference import cluster_ransac as literal_clusters  # noqa: E402
from reference import registration as literal_registration  # noqa: E402
from scanplan import (  # noqa: E402
    cluster_ransac,
    configuration,
    iterative_ransac,
    registration,
    surveys,
    tables,
    verdicts,
    walls,
)

DEMO = ROOT / "results" / "demo"
SETTINGS = configuration.read_yaml(ROOT / "config/config.yaml")


def timed(function):
    """Call a function without arguments; return its result and the seconds it took."""
    started = time.perf_counter()
    return function(), time.perf_counter() - started


def bench_registration(n_candidates=60):
    """Algorithm 3: this stage's registrar against Open3D on full clouds, point to point."""
    candidates = tables.read(DEMO / "poses.parquet", tables.POSES)
    priors = verdicts.poses(candidates)[:n_candidates]
    with surveys.open_survey([str(DEMO / "survey/survey.bag")], **SETTINGS["input"]) as survey:
        scans = [scan.xyz_m for scan in survey.scans(candidates["scan_id"][:n_candidates].tolist())]
    settings = registration.Settings(**SETTINGS["registration"])

    def ours():
        registrar = registration.Registrar(settings, planar=False, threads=2)
        return [registrar.add(*pair) for pair in zip(scans, priors, strict=True)]

    def literally():
        limits = (settings.min_prior_fitness, settings.min_refined_fitness)
        return literal_registration.register(
            scans,
            priors,
            keep_every=1,
            distance_m=settings.fitness_distance_m,
            min_prior_fitness=limits[0],
            min_refined_fitness=limits[1],
        )

    report("registration", n_candidates, "candidates", timed(ours)[1], timed(literally)[1])


def bench_selection():
    """Algorithms 1 and 2 on a drive through a large office."""
    selecting.run(ROOT / "config/buildings/ring_office.geojson", SETTINGS, lambda line: print(line, flush=True))


def bench_walls(n_scans=6):
    """Cluster RANSAC against iterative RANSAC, and against itself written literally with sklearn's MeanShift."""
    store = tables.ScanStore(DEMO / "scans.parquet")
    scan_ids = store.scan_ids[:: max(1, len(store.scan_ids) // n_scans)][:n_scans]
    sensors = walls.sensor_positions(
        tables.read(DEMO / "registration.parquet", tables.REGISTRATION), store.scan_ids, DEMO / "registration.parquet"
    )
    scans = list(store.scans(scan_ids))

    def all_scans(method, name):
        settings = method.Settings(**SETTINGS["walls"][name])
        return timed(
            lambda: [method.extract(i, xyz, **sensors[i], planar=False, settings=settings) for i, xyz in scans]
        )

    cluster_s = all_scans(cluster_ransac, "cluster_ransac")[1]
    iterative_s = all_scans(iterative_ransac, "iterative_ransac")[1]
    report("cluster RANSAC against iterative", len(scans), "scans", cluster_s, iterative_s)
    chosen = SETTINGS["walls"]["cluster_ransac"]
    keys = ("reach_deg", "max_tilt_deg", "bandwidth_m", "inlier_m", "min_points")
    centred = [np.asarray(xyz, float) - sensors[i]["sensor_xyz_m"] for i, xyz in scans[:1]]
    literal_s = timed(
        lambda: [
            literal_clusters.lines(
                xyz, **{k: chosen[k] for k in keys}, rng=np.random.default_rng(1), max_trials=chosen["trials"]
            )
            for xyz in centred
        ]
    )[1]
    report("cluster RANSAC against the literal one", 1, "scan", cluster_s / len(scans), literal_s)


def report(what, count, unit, ours_s, reference_s):
    """Print one line: both times and their ratio."""
    print(
        f"{what}: {count} {unit}, {1e3 * ours_s / count:.1f} ms each against {1e3 * reference_s / count:.1f} ms:"
        f" {reference_s / ours_s:.1f} times faster",
        flush=True,
    )


if __name__ == "__main__":
    benches = {"registration": bench_registration, "selection": bench_selection, "walls": bench_walls}
    unknown = set(sys.argv[1:]) - set(benches)
    if unknown:
        sys.exit(f"no benchmark {', '.join(sorted(unknown))}; there are {', '.join(benches)}")
    for name in sys.argv[1:] or benches:
        benches[name]()
