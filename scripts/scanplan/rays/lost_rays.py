"""Missing returns at a surface, by height: the sign of glass."""

import itertools
from typing import NamedTuple

import numpy as np

from scanplan.rays import expected_returns
from scanplan.rays.face_rays import FaceRays
from scanplan.rays.ray_set import RaySet
from scanplan.types import FloatArray, IntArray

_BANDS = 2  # rows that are asked together: of single ones too little is expected
_TINY = 1e-9  # rays: none


class LostRays(NamedTuple):
    """How many rays of single scans are missing at the cells of a surface.

    Attributes
    ----------
    scan, column, row : (n,) int64
    n_rays : (n,) float64
    """

    scan: IntArray
    column: IntArray
    row: IntArray
    n_rays: FloatArray


def find_lost(
    rays: RaySet, face: FaceRays, low_m: float, n_columns: int, column_m: float, edges_m: FloatArray
) -> LostRays:
    """Return the rays that a surface lost.

    Parameters
    ----------
    face : face_rays.FaceRays
        Of these, with what is occluded within `expected_returns.NEAR_M`.
    low_m : float
        Where along its line the first column begins.
    edges_m : (r + 1,) float64
        Of the rows of heights; those of planar scans are infinite.
    """
    columns = expected_returns.watch_columns(rays, face, low_m, n_columns, column_m)
    found: list[LostRays] = []
    # each of an edge once: it takes most of the time
    below = map(columns.per_deg_below, edges_m.tolist())
    low_per_deg = next(below)
    for first in range(0, len(edges_m) - 1, _BANDS):
        edges = edges_m[first : first + _BANDS + 1].tolist()
        of_edges = [low_per_deg, *itertools.islice(below, len(edges) - 1)]
        low_per_deg = of_edges[-1]
        expected = columns.expect_returns(of_edges[0], of_edges[-1])
        sent = columns.count_sent((edges[0], edges[-1]), expected)
        missing = sent.missing()
        view, column = np.nonzero(missing)
        of_band = missing[view, column] / np.maximum(expected[view, column], _TINY)
        scan = face.views.scan[sent.view[view]]
        for number, of_heights in enumerate(itertools.pairwise(of_edges)):
            # of a row that the beams hardly reach as little is lost
            of_row = columns.expect_returns(*of_heights)
            own = np.minimum(of_row[view, column], expected[view, column])
            row = np.full(len(view), first + number)
            found.append(LostRays(scan, column, row, own * of_band))
    return LostRays(*map(np.concatenate, zip(*found, strict=True)))
