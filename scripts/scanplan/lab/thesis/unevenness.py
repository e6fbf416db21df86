"""What uneven sampling does to orders of scans: a survey in which the scans of a crowd were taken many times.

A rover that goes round an obstacle or waits at a door takes many scans at one place (thesis, 5.2). Here the tenth of a
survey's scans nearest to a place are taken 1, 5 or 20 times, and all others once. Each time the clusters of its hulls
are drawn anew, so that no two are the same to the order.
"""

import numpy as np

from scanplan.lab.evaluation import face_cells, visible_faces
from scanplan.selection import area_greedy, hulls

REPEATS = (1, 5, 20)
CROWD_SHARE, N_CROWDS, N_DRAWS = 0.1, 3, 200
RANDOM, AREA = "random", "cluster_hull"


def draw_crowds(places_m, seed):
    """Return the rows of the scans of each crowd: those nearest to a few of the places (n, 2), drawn at random."""
    centres = np.random.default_rng(seed).choice(
        len(places_m), min(N_CROWDS, len(places_m)), replace=False
    )
    size = max(1, round(CROWD_SHARE * len(places_m)))
    apart_m = np.hypot(*(places_m[centres][:, None] - places_m).transpose(2, 0, 1))
    return [np.sort(row) for row in np.argsort(apart_m, axis=1, kind="stable")[:, :size]]


def copy_hulls(scan_id, xyz_m, *, n_copies, seed, **sampling):
    """Return so many polygons of a scan, each of clusters of its own; see `hulls.make_cluster_hulls`."""
    seeds = np.random.default_rng([seed, scan_id]).integers(2**31, size=n_copies).tolist()
    made = [hulls.make_cluster_hulls(scan_id, xyz_m, seed=own, **sampling) for own in seeds]
    return np.concatenate([hulls.scan_polygons(columns)[1] for columns in made])


def view_cells(faces, placed, sight):
    """Return which cells of the true faces each pose (n, 4, 4) sees, (n, c) bool, and their lengths (c,), metres."""
    cells = face_cells.cut_faces(faces.inner_m)
    return visible_faces.cells_seen_by_each(cells, faces.outer_m, placed, sight), cells.length_m


def unevenness_columns(seen, length_m, polygons, repeated, crowd_rows, *, n_selected, seed):
    """Measure how much true wall the first scans see, by a random order and by cluster hulls.

    Parameters
    ----------
    seen : (n, c) bool
    length_m : (c,) float
    polygons : (n,) numpy.ndarray of shapely geometries
        Of every scan.
    repeated : dict of int to (m,) numpy.ndarray of shapely geometries
        Of the further times that a scan of a crowd was taken, by row; as many as the most repeats less one.
    crowd_rows : sequence of (k,) int
    n_selected : int
    seed : int

    Returns
    -------
    dict of str to numpy.ndarray
        The columns of `schemas.UNEVENNESS`; by cluster hulls there is one draw.
    """
    rows = []
    for crowd, of_it in enumerate(crowd_rows):
        for times in REPEATS:
            taken = np.concatenate([np.arange(len(seen)), np.repeat(of_it, times - 1)])
            shapes = np.concatenate([polygons, *(repeated[row][: times - 1] for row in of_it)])
            drawn = _draws(taken, n_selected, [seed, crowd, times])
            by_area = [taken[area_greedy.choose_first(shapes, n_selected)]]
            for order, chosen in ((AREA, by_area), (RANDOM, drawn)):
                seen_m = [_seen_m(seen, length_m, some) for some in chosen]
                rows += [(order, crowd, times, draw, value) for draw, value in enumerate(seen_m)]
    order, crowd, times, draw, seen_m = map(np.array, zip(*sorted(rows), strict=True))
    return {"order": order, "crowd": crowd, "repeats": times, "draw": draw, "seen_m": seen_m}


def lost_shares(columns, order):
    """Return the mean length seen with every scan taken once, metres, and the shares lost with each of the repeats."""
    of_it = columns["order"] == order
    mean_m = np.array(
        [columns["seen_m"][of_it & (columns["repeats"] == times)].mean() for times in REPEATS]
    )
    return mean_m[0], 1 - mean_m / mean_m[0] if mean_m[0] > 0 else np.full(len(REPEATS), np.nan)


def _draws(taken, n_selected, seed):
    """Return the first scans of random orders of all that was taken."""
    rng = np.random.default_rng(seed)
    return [rng.choice(taken, min(n_selected, len(taken)), replace=False) for _ in range(N_DRAWS)]


def _seen_m(seen, length_m, rows):
    return float(length_m[seen[rows].any(axis=0)].sum())
