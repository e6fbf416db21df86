"""The floor area that scans cover: by their clusters' hulls, and as they truly see it."""

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.lab.evaluation import visible_faces
from scanplan.lab.evaluation.truth_file import TrueFaces
from scanplan.selection import area_greedy, hulls
from scanplan.stage import per_scan
from scanplan.types import Array, Columns, FilePath, FloatArray


def cluster_growth_columns(
    scans_path: FilePath,
    n_clusters: Sequence[int],
    *,
    threads: int = 1,
    **sampling: Any,
) -> Columns:
    """Return how the covered area grows with every number of clusters (thesis, figure 5.7).

    Parameters
    ----------
    scans_path : path-like
        scans.parquet.
    n_clusters : sequence of int
        The numbers of clusters to compare, in any order.
    **sampling
        See `hulls.make_cluster_hulls`.

    Returns
    -------
    dict of str to numpy.ndarray
        The columns of `thesis_schemas.CLUSTERS`, greedy orders of all scans by their clusters'
        hulls; rows by number of clusters, then by rank.
    """
    parts = []
    for number in sorted(n_clusters):
        scan_hulls = per_scan.map_scans(
            partial(hulls.make_cluster_hulls, n_clusters=number, **sampling),
            scans_path,
            label=f"measure_coverage, {number} clusters",
            threads=threads,
        )
        parts.append(_growth_columns(hulls.concatenate_hulls(scan_hulls), number))
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def _growth_columns(columns: Columns, n_clusters: int) -> Columns:
    scan_ids, polygons = hulls.scan_polygons(columns)
    order = area_greedy.order_by_area(polygons)
    return {
        "n_clusters": np.full(len(scan_ids), n_clusters),
        "rank": np.arange(1, len(scan_ids) + 1),
        "scan_id": scan_ids[order.order],
        "area_m2": shapely.area(polygons[order.order]),
        "covered_m2": order.covered,
    }


def stray_area_columns(scan_id: int, xyz_m: Array, *, seed: int, **sampling: Any) -> Columns:
    """Return the areas of a scan's hulls with one stray return more.

    It is as far from the middle of the scan's points as the farthest of them, in a direction drawn
    at random.

    Parameters
    ----------
    xyz_m : (n, 2) or (n, 3) float
    **sampling
        See `hulls.make_cluster_hulls`.

    Returns
    -------
    dict of str to (1,) numpy.ndarray
        `full_hull_stray_m2` and `cluster_hull_stray_m2` of `thesis_schemas.AREAS`.
    """
    middle_m = xyz_m[:, :2].mean(axis=0)
    reach_m = np.hypot(*(xyz_m[:, :2] - middle_m).T).max()
    turn_rad = np.random.default_rng([seed, scan_id]).uniform(0, 2 * np.pi)
    stray_m = middle_m + reach_m * np.array([np.cos(turn_rad), np.sin(turn_rad)])
    xy_m = np.concatenate([xyz_m[:, :2], stray_m[None]])
    columns = hulls.make_cluster_hulls(scan_id, xy_m, seed=seed, **sampling)
    _, full = hulls.scan_full_hulls(columns)
    _, clusters = hulls.scan_polygons(columns)
    return {
        "full_hull_stray_m2": np.asarray(shapely.area(full)),
        "cluster_hull_stray_m2": np.asarray(shapely.area(clusters)),
    }


def seen_polygons(faces: TrueFaces, places_m: FloatArray, *, max_range_m: float) -> Array:
    """Return what can be seen from each place: to the first true face, and within the range.

    Parameters
    ----------
    places_m : (n, 2) float

    Returns
    -------
    (n,) numpy.ndarray of shapely Polygon or MultiPolygon
    """
    occluding_m = np.concatenate([faces.inner_m, faces.outer_m])
    outlines = [
        visible_faces.visible_polygon(occluding_m, place_m, open_m=2 * max_range_m)
        for place_m in places_m
    ]
    # neighbouring corners that coincide make an outline touch itself; a line has no area
    touching = np.array([shapely.Polygon(outline) for outline in outlines])
    seen_areas = overlays.repair_areas(touching, method="structure", keep_collapsed=False)
    discs = overlays.buffer_shapes(shapely.points(places_m), max_range_m, quad_segs=8)
    return np.asarray(overlays.intersect_areas(seen_areas, discs))


def polygon_iou(polygons: Array, seen_areas: Array) -> FloatArray:
    """Return intersection over union of polygons (n,) with what their scans see (n,).

    It is 0 where both are empty.
    """
    shared_m2 = np.asarray(shapely.area(overlays.intersect_areas(polygons, seen_areas)))
    joint_m2 = np.asarray(shapely.area(overlays.unite_each(polygons, seen_areas)))
    return np.divide(shared_m2, joint_m2, out=np.zeros(len(shared_m2)), where=joint_m2 > 0)
