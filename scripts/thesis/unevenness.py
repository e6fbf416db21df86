"""What uneven sampling does to orders of scans: the scans of a crowd were taken many times.

A rover that goes round an obstacle or waits at a door takes many scans at one place (thesis, 5.2).
Here the tenth of a survey's scans nearest to a place are taken 1, 5 or 20 times, and all others
once. Each time the clusters of its hulls are drawn anew, so that no two are the same to the order.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from scanplan.lab.evaluation import face_cells, visible_faces
from scanplan.lab.evaluation.truth_file import TrueFaces
from scanplan.lab.evaluation.visible_faces import SensorView
from scanplan.selection import area_greedy, hulls
from scanplan.types import Array, BoolArray, Columns, FloatArray, IntArray

REPEATS = (1, 5, 20)  # from even sampling to a rover that stands still for some seconds
CROWD_SHARE = 0.1  # of all scans: a place, not half of the survey
N_CROWDS = 3  # places: one alone may be where nothing is to be seen
RANDOM, AREA = "random", "cluster_hull"


def draw_crowds(places_m: FloatArray, seed: int) -> list[IntArray]:
    """Return the rows of the scans of each crowd.

    They are those nearest to a few of the places (n, 2), drawn at random.
    """
    n_scans = len(places_m)
    rng = np.random.default_rng(seed)
    centres = rng.choice(n_scans, min(N_CROWDS, n_scans), replace=False)
    size = max(1, round(CROWD_SHARE * n_scans))
    apart_m = np.hypot(*(places_m[centres][:, None] - places_m).transpose(2, 0, 1))
    return [np.sort(row) for row in np.argsort(apart_m, axis=1, kind="stable")[:, :size]]


def copy_hulls(scan_id: int, xyz_m: Array, *, n_copies: int, seed: int, **sampling: Any) -> Array:
    """Return so many polygons of a scan, each of clusters of its own.

    See `hulls.make_cluster_hulls`.
    """
    seeds = np.random.default_rng([seed, scan_id]).integers(2**31, size=n_copies)
    polygons = []
    for own_seed in seeds.tolist():
        columns = hulls.make_cluster_hulls(scan_id, xyz_m, seed=own_seed, **sampling)
        polygons.append(hulls.scan_polygons(columns)[1])
    return np.concatenate(polygons)


def view_cells(
    faces: TrueFaces, placed: FloatArray, sight: SensorView
) -> tuple[BoolArray, FloatArray]:
    """Return which cells of the true faces each pose (n, 4, 4) sees, and the cells' lengths.

    Returns
    -------
    seen : (n, c) bool
    length_m : (c,) float64
    """
    cells = face_cells.cut_faces(faces.inner_m)
    return visible_faces.cells_seen_by_each(cells, faces.outer_m, placed, sight), cells.length_m


def unevenness_columns(
    seen: BoolArray,
    length_m: FloatArray,
    polygons: Array,
    repeated: Mapping[int, Array],
    crowd_rows: Sequence[IntArray],
    *,
    n_selected: int,
) -> Columns:
    """Measure how much true wall the first scans see, by a random order and by cluster hulls.

    Of random orders it is what is to be expected: a cell of the walls is not seen where all scans
    drawn are among those that do not see it.

    Parameters
    ----------
    seen : (n, c) bool
    length_m : (c,) float
    polygons : (n,) numpy.ndarray of shapely geometries
        Of every scan.
    repeated : dict of int to (m,) numpy.ndarray of shapely geometries
        Of the further times that a scan of a crowd was taken, by row; as many as the most repeats
        less one.
    crowd_rows : sequence of (k,) int

    Returns
    -------
    dict of str to numpy.ndarray
        The columns of `thesis_schemas.UNEVENNESS`.
    """
    rows = []
    for crowd, members in enumerate(crowd_rows):
        for repeats in REPEATS:
            scans = np.concatenate([np.arange(len(seen)), np.repeat(members, repeats - 1)])
            further = [repeated[row][: repeats - 1] for row in members]
            shapes = np.concatenate([polygons, *further])
            by_area = scans[area_greedy.choose_first(shapes, n_selected)]
            seen_m = {
                AREA: length_m[seen[by_area].any(axis=0)].sum(),
                RANDOM: length_m @ _chance_seen(seen[scans], n_selected),
            }
            rows += [(order, crowd, repeats, float(m)) for order, m in seen_m.items()]
    names = ("order", "crowd", "repeats", "seen_m")
    return dict(zip(names, map(np.array, zip(*sorted(rows), strict=True)), strict=True))


def lost_shares(table: pd.DataFrame) -> tuple[pd.Series, pd.DataFrame]:
    """Return the mean length seen with every scan taken once, and the shares lost with repeats.

    Parameters
    ----------
    table : pandas.DataFrame
        `thesis_schemas.UNEVENNESS`.

    Returns
    -------
    even_m : pandas.Series
        By order.
    lost : pandas.DataFrame
        By repeats and order; NaN where nothing is seen.
    """
    seen_m = table.pivot_table(index="repeats", columns="order", values="seen_m")
    even_m = seen_m.iloc[0]
    return even_m, 1 - seen_m / even_m.where(even_m > 0)


def _chance_seen(seen: BoolArray, n_selected: int) -> FloatArray:
    """Return how likely each cell is seen by so many of the scans (n, c), drawn at random."""
    n_scans = len(seen)
    n_blind = n_scans - seen.sum(axis=0)
    drawn = np.arange(min(n_selected, n_scans))
    # one after the other: the next one, too, is one of the blind that are left
    blind = np.maximum(n_blind[:, None] - drawn, 0) / (n_scans - drawn)
    return 1 - blind.prod(axis=1)
