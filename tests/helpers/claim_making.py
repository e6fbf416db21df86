"""Tables of made-up results, for the thesis's claims to be judged by."""

from pathlib import Path

import numpy as np
import pandas as pd

from scanplan.store import schemas
from thesis import thesis_schemas

_ROOT = Path(__file__).resolve().parents[2]
_FOLDER = _ROOT / "workflow/thesis/page"
PAGE = [_FOLDER / "thesis.html.j2", _FOLDER / "thesis.css", _ROOT / "config/deviations.md"]
SIZES = (1, 15, 27, 40, 60, 80, 270)
# what the first 1, 15, 27, ... scans of every order find, false negatives being the rest
FOUND = {
    "cluster_hull": (0.1, 0.6, 0.8, 0.9, 0.95, 0.98, 1.0),
    "hull": (0.1, 0.55, 0.7, 0.75, 0.8, 0.85, 1.0),
    "random": (0.1, 0.5, 0.75, 0.85, 0.9, 0.95, 1.0),
    "sequential": (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 1.0),
    "oracle": (0.2, 0.7, 0.9, 0.97, 1.0, 1.0, 1.0),
}


def evaluation(**changes):
    """An evaluation; `changes` replaces what some orders find."""
    rows = []
    for method, found in (FOUND | changes).items():
        for extractor, per_scan in (("cluster_ransac", 10), ("iterative_ransac", 14)):
            for k, share in zip(SIZES, found, strict=True):
                row = dict.fromkeys(schemas.EVALUATION.columns, 0.0)
                row |= {"method": method, "extractor": extractor, "k": k, "n_walls": per_scan * k}
                row |= {"visible_completeness_010m": share, "visible_correctness_010m": 0.96}
                row |= {"entered_completeness_010m": share}
                row |= {"false_negative": (1 - share) / 20}
                row |= {
                    "false_positive": share / 100,
                    "walls_per_true_wall_of_a_scan": per_scan / 9,
                }
                row["correct_match"] = 1 - row["false_negative"] - row["false_positive"]
                rows.append(row)
    return pd.DataFrame(rows)


def growing(at_99, n=270, total_m2=1000.0):
    """An ordering that covers 99 % with so many scans."""
    rank = np.arange(1, n + 1)
    covered = np.where(rank >= at_99, total_m2, total_m2 * 0.98 * rank / at_99)
    return pd.DataFrame({"rank": rank, "covered_m2": covered})


def clusters(areas):
    """Growth by number of clusters: `areas` is number to (by 15 scans, by all).

    Each of the first three scans covers 30 m2 per number of clusters by itself.
    """
    rows = [
        (n, rank, some if rank <= 15 else every)
        for n, (some, every) in areas.items()
        for rank in range(1, 31)
    ]
    table = pd.DataFrame(rows, columns=["n_clusters", "rank", "covered_m2"])
    return table.assign(scan_id=table["rank"] - 1, area_m2=30 / table["n_clusters"])


def unevenness(**seen_m):
    """Uneven sampling: order to the wall seen with 1, 5 and 20 repeats.

    There are two crowds, a metre apart.
    """
    rows = [
        (order, crowd, times, value + crowd - 0.5)
        for order, values in seen_m.items()
        for crowd in (0, 1)
        for times, value in zip((1, 5, 20), values, strict=True)
    ]
    return pd.DataFrame(rows, columns=list(thesis_schemas.UNEVENNESS.columns))


def premises(one_wall, **ratios):
    """What is taken for granted: the share on one wall, and ratios of utilities."""
    values = {"points of a cluster on its wall": one_wall, "correct match": 1.0} | ratios
    rows = [(name, item, value) for name, value in values.items() for item in (0, 1)]
    return pd.DataFrame(rows, columns=list(thesis_schemas.PREMISES.columns))


def times(found=5, **seconds):
    """Run times: task to (sizes, seconds); `found` walls of each.

    The thesis's RANSAC finds twice as many.
    The sizes of a task are those of one item, but of an extractor those of scans of their own.
    """
    rows = [
        (task, size, i * task.startswith("plain"), found * (1 + (task == "plain_ransac")), s)
        for task, pairs in seconds.items()
        for i, (size, s) in enumerate(zip(*pairs, strict=True))
    ]
    return pd.DataFrame(rows, columns=["task", "size", "item", "found", "seconds"])


def steps(*n_scans):
    """Table 5.1."""
    n = len(n_scans)
    seconds, n_bytes = (
        np.array([360.0, np.nan, 90.0, 8.0, 0.5])[:n],
        np.array([4 * 10**9, thesis_schemas.NOT_WRITTEN, 10**7, 10**6, 10**6])[:n],
    )
    names = np.array(["Data collection", "Selecting", "Registering", "Hulls", "Selection"])[:n]
    return pd.DataFrame({
        "step": np.arange(1, n + 1),
        "name": names,
        "seconds": seconds,
        "n_scans": np.array(n_scans),
        "n_bytes": n_bytes,
    })  # fmt: skip


def candidates(near_walls):
    """Table of the candidates of two walls in one scan, by lines within 1 cm and 5 cm."""
    return pd.DataFrame({
        "model": ["line", "line"],
        "inlier_m": [0.01, 0.05],
        "scan_id": [0, 0],
        "candidates": [40, 40],
        "near_walls": near_walls,
        "walls": [2, 2],
    })  # fmt: skip


def rooms(**changes):
    """All tables of a survey of the rooms."""
    return {
        "rooms_walls": evaluation(),
        "rooms_hull": growing(8),
        "rooms_cluster_hull": growing(30),
        "rooms_clusters": clusters({1: (900.0, 950.0), 10: (700.0, 940.0)}),
        "rooms_areas": pd.DataFrame({
            "scan_id": np.arange(3), "full_hull_m2": np.array([20.0, 30, 40]),
            "cluster_hull_m2": np.array([11.0, 12, 13]), "seen_m2": np.array([10.0, 10, 10]),
            "full_hull_iou": np.array([0.5, 0.4, 0.3]),
            "cluster_hull_iou": np.array([0.9, 0.8, 0.7]),
            "full_hull_stray_m2": np.array([22.0, 33, 44]),
            "cluster_hull_stray_m2": np.array([11.11, 12.12, 13.13]),
        }),
        "rooms_unevenness": unevenness(
            random=(100.0, 90.0, 70.0), cluster_hull=(120.0, 120.0, 116.0)
        ),
        "rooms_premises": premises(0.95, **{"walls found": 1.5, "F1 of walls": 1.1}),
        "rooms_times": times(
            build_hulls=((1, 10), (0.1, 0.3)),
            build_sampled_hulls=((10,), (0.1,)),
            build_unsampled_hulls=((10,), (0.4,)),
            plain_clusters=((100, 200), (0.03, 0.05)),
        ),
    } | changes  # fmt: skip


def drive(**changes):
    """All tables of a drive."""
    return {
        "drive_walls": evaluation(),
        "drive_candidates": candidates([1, 3]),
        "drive_times": times(
            plain_clusters=((100, 200, 300), (0.03, 0.031, 0.03)),
            plain_ransac=((100, 200, 300), (0.05, 0.1, 0.15)),
            thinned_plain_clusters=((10, 20, 40), (0.03, 0.03, 0.03)),
            thinned_plain_ransac=((10, 20, 40), (0.05, 0.1, 0.2)),
            order_scans=((10, 90, 270), (0.01, 0.09, 0.27)),
            choose_scans=((20, 90, 270), (0.01, 0.045, 0.135)),
            order_scans_literally=((10, 30, 90), (0.01, 0.09, 0.81)),
            merge_segments=((100, 200, 400), (0.01, 0.02, 0.04)),
            build_hulls=((1, 10), (0.005, 0.02)),
        ),
        "drive_poses": pd.DataFrame(
            {
                "scan_id": np.array([0, 5]),
                "prior_error_m": np.array([0.03, 0.04]),
                "refined_error_m": np.array([0.01, 0.01]),
            }
        ),
        "drive_steps": steps(3600, 710, 700, 700, 15),
        "limits_steps": steps(3600, 130, 76, 76, 15),
    } | changes
