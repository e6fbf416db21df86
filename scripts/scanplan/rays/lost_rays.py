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
    columns = (low_m, n_columns, column_m)
    found: list[LostRays] = []
    for first in range(0, len(edges_m) - 1, _BANDS):
        edges = edges_m[first : first + _BANDS + 1].tolist()
        sent = expected_returns.count_sent_rays(rays, face, *columns, (edges[0], edges[-1]))
        missing = sent.missing()
        view, column = np.nonzero(missing)
        of_band = missing[view, column] / np.maximum(sent.expected[view, column], _TINY)
        scan = face.views.scan[sent.view[view]]
        for number, heights_m in enumerate(itertools.pairwise(edges)):
            # of a row that the beams hardly reach as little is lost
            _, of_row = expected_returns.expect_returns(rays, face, *columns, heights_m)
            own = np.minimum(of_row[view, column], sent.expected[view, column])
            row = np.full(len(view), first + number)
            found.append(LostRays(scan, column, row, own * of_band))
    return LostRays(*map(np.concatenate, zip(*found, strict=True)))
