"""Tables of made-up results, for the thesis's claims to be judged by."""

from pathlib import Path

import numpy as np

from scanplan.store import schemas

_FOLDER = Path(__file__).resolve().parents[2] / "workflow/report/page"
PAGE = [_FOLDER / "thesis.html.j2", _FOLDER / "thesis.css"]
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
    """Columns of an evaluation; `changes` replaces what some orders find."""
    rows = []
    for method, found in (FOUND | changes).items():
        for extractor, per_scan in (("cluster_ransac", 10), ("iterative_ransac", 14)):
            for k, share in zip(SIZES, found, strict=True):
                row = dict.fromkeys(schemas.EVALUATION.columns, 0.0)
                row |= {"method": method, "extractor": extractor, "k": k, "n_walls": per_scan * k}
                row |= {"visible_completeness_010m": share, "visible_correctness_010m": 0.96}
                row |= {"false_negative": (1 - share) / 20}
                row |= {
                    "false_positive": share / 100,
                    "walls_per_true_wall_of_a_scan": per_scan / 9,
                }
                row["correct_match"] = 1 - row["false_negative"] - row["false_positive"]
                rows.append(row)
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def growing(at_99, n=270, total_m2=1000.0):
    """Columns of an ordering that covers 99 % with so many scans."""
    rank = np.arange(1, n + 1)
    covered = np.where(rank >= at_99, total_m2, total_m2 * 0.98 * rank / at_99)
    return {"rank": rank, "covered_m2": covered}


def clusters(areas):
    """Columns of growth by number of clusters: `areas` is number to (by 15 scans, by all)."""
    rows = [
        (n, rank, some if rank <= 15 else every)
        for n, (some, every) in areas.items()
        for rank in range(1, 31)
    ]
    n, rank, covered = np.array(rows).T
    return {"n_clusters": n.astype(int), "rank": rank.astype(int), "covered_m2": covered}


def unevenness(**seen_m):
    """Columns of uneven sampling: order to the wall seen with 1, 5 and 20 repeats.

    There are two crowds, a metre apart.
    """
    rows = [
        (order, crowd, times, 0, value + crowd - 0.5)
        for order, values in seen_m.items()
        for crowd in (0, 1)
        for times, value in zip((1, 5, 20), values, strict=True)
    ]
    return dict(
        zip(schemas.UNEVENNESS.columns, map(np.array, zip(*rows, strict=True)), strict=True)
    )


def times(found=5, **seconds):
    """Columns of run times: task to (sizes, seconds); `found` walls of each.

    The thesis's RANSAC finds twice as many.
    The sizes of a task are those of one item, but of an extractor those of scans of their own.
    """
    rows = [
        (task, size, i * task.startswith("plain"), found * (1 + (task == "plain_ransac")), s)
        for task, pairs in seconds.items()
        for i, (size, s) in enumerate(zip(*pairs, strict=True))
    ]
    names = ("task", "size", "item", "found", "seconds")
    return dict(zip(names, map(np.array, zip(*rows, strict=True)), strict=True))


def steps(*n_scans):
    """Columns of table 5.1."""
    n = len(n_scans)
    seconds, n_bytes = (
        np.array([360.0, np.nan, 90.0, 8.0, 0.5])[:n],
        np.array([4 * 10**9, schemas.NOT_WRITTEN, 10**7, 10**6, 10**6])[:n],
    )
    names = np.array(["Data collection", "Selecting", "Registering", "Hulls", "Selection"])[:n]
    return {
        "step": np.arange(1, n + 1),
        "name": names,
        "seconds": seconds,
        "n_scans": np.array(n_scans),
        "n_bytes": n_bytes,
    }


def rooms(**changes):
    """All tables of a survey of the rooms."""
    return {
        "rooms_walls": evaluation(),
        "rooms_hull": growing(8),
        "rooms_cluster_hull": growing(30),
        "rooms_clusters": clusters({1: (900.0, 950.0), 10: (700.0, 940.0)}),
        "rooms_areas": {
            "scan_id": np.arange(3), "full_hull_m2": np.array([20.0, 30, 40]),
            "cluster_hull_m2": np.array([11.0, 12, 13]), "seen_m2": np.array([10.0, 10, 10]),
            "full_hull_iou": np.array([0.5, 0.4, 0.3]),
            "cluster_hull_iou": np.array([0.9, 0.8, 0.7]),
        },
        "rooms_unevenness": unevenness(
            random=(100.0, 90.0, 70.0), cluster_hull=(120.0, 120.0, 116.0)
        ),
        "rooms_times": times(build_hulls=((1, 10), (0.1, 0.3))),
    } | changes  # fmt: skip


def drive(**changes):
    """All tables of a drive."""
    return {
        "drive_walls": evaluation(),
        "drive_times": times(
            plain_clusters=((100, 200, 300), (0.03, 0.031, 0.03)),
            plain_ransac=((100, 200, 300), (0.05, 0.1, 0.15)),
            thinned_plain_clusters=((10, 20, 40), (0.03, 0.03, 0.03)),
            thinned_plain_ransac=((10, 20, 40), (0.05, 0.1, 0.2)),
            order_scans=((10, 90, 270), (0.01, 0.09, 0.27)),
            choose_scans=((20, 90, 270), (0.01, 0.045, 0.135)),
        ),
        "drive_poses": {
            "scan_id": np.array([0, 5]),
            "prior_error_m": np.array([0.03, 0.04]),
            "refined_error_m": np.array([0.01, 0.01]),
        },
        "drive_steps": steps(3600, 710, 700, 700, 15),
        "limits_steps": steps(3600, 130, 76, 76, 15),
    } | changes
