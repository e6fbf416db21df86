"""How many candidates RANSAC finds for each wall of a scan, by its model and its inlier band."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from scanplan.extraction import extractors
from scanplan.geometry.consensus import MODELS
from scanplan.lab.evaluation import wall_findings
from scanplan.store import tables
from scanplan.types import FloatArray, IntArray, Settings

BANDS_M = (0.05, 0.02, 0.01)
"""Largest distances of inliers: five, two and one standard deviation of a range's noise."""


def count_candidates(
    store: tables.ScanStore,
    scan_ids: IntArray | Sequence[int],
    sensors: Mapping[int, Mapping[str, Any]],
    faces_m: FloatArray,
    settings: Settings,
) -> Iterator[dict[str, Any]]:
    """Extract the walls of scans by RANSAC with removal of inliers, and match them to true faces.

    Parameters
    ----------
    store : tables.ScanStore
        Scans registered where they were truly taken, or nearly so.
    scan_ids : (n,) int
    sensors : dict of int to dict
        See `per_registered_scan.sensor_keywords`.
    faces_m : (f, 2, 2) float
        The true faces.
    settings : dict
        Of `thesis_ransac.ThesisIterativeSettings`; model and inlier band are replaced.

    Yields
    ------
    dict of str to Any
        Rows of `thesis_schemas.CANDIDATES`.
    """
    method = extractors.EXTRACTORS["thesis_iterative_ransac"]
    for scan_id, xyz_m in store.scans(scan_ids):
        for model in MODELS:
            for inlier_m in BANDS_M:
                given = {**settings, "model": model, "inlier_m": inlier_m}
                finder = extractors.make_wall_finder(method, given, planar=store.planar)
                found = extractors.find_wall_segments(
                    scan_id, xyz_m, finder=finder, **sensors[scan_id]
                )
                lines_m = np.stack([found.start_m, found.end_m], axis=1)
                face = wall_findings.find_main_faces(lines_m, faces_m)
                yield {
                    "model": model,
                    "inlier_m": inlier_m,
                    "scan_id": scan_id,
                    "candidates": len(face),
                    "near_walls": int((face >= 0).sum()),
                    "walls": len(np.unique(face[face >= 0])),
                }
