"""What the rays of one scan show of faces.

How high each is, what passes over and through it, which expected returns are missing.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.geometry.tolerances import ROUNDING
from scanplan.rays.expected_returns import count_sent_rays
from scanplan.rays.face_raster import CELL_M, SCAN_COLUMN_M, highest_of_each, seen_tops_m
from scanplan.rays.face_rays import cast_at_face, cast_at_faces
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import BEHIND_M, ON_M, SKIRTING_M, STRAY_SHARE, STRETCH_M
from scanplan.types import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class FaceEvidence:
    """What rays show of faces, (k,) float64 each.

    Attributes
    ----------
    top_m : array
        Height above the floor up to which it is seen over a good part of its length.
    over : array
        How surely it ends at some height, see `over_shares`.
    through : array
        Rays through it below its top, per ray that ends at it.
    missing : array
        Share of the returns expected within its outline that are nowhere.
    """

    top_m: FloatArray
    over: FloatArray
    through: FloatArray
    missing: FloatArray


def weigh_faces(
    scan: RaySet, ends_m: FloatArray, normal: FloatArray, heights_m: FloatArray
) -> FaceEvidence:
    """Return what one scan's rays show of faces.

    Parameters
    ----------
    scan : ray_set.RaySet
    ends_m : (k, 2, 2) float
        Start and end of each, its normal on the left of the way.
    normal : (k, 2) float
    heights_m : (k, 2) float
        Of its returns, above the floor.
    """
    face = cast_at_faces(scan, ends_m, normal, at_m=ON_M, least_side_m=ROUNDING)
    way_m = ends_m[:, 1] - ends_m[:, 0]
    count = (np.hypot(way_m[:, 0], way_m[:, 1]) / SCAN_COLUMN_M).astype(np.int64) + 1
    is_on, is_beyond = face.is_occupied, face.is_free(BEHIND_M)
    tops_m, free_tops_m = (
        _column_tops_m(face.view[kind], face.along_m[kind], face.height_m[kind], count)
        for kind in (is_on, is_beyond)
    )
    top_m = seen_tops_m(tops_m, SCAN_COLUMN_M)
    is_raised = face.height_m > SKIRTING_M
    is_through = is_beyond & is_raised & (face.height_m < top_m.take(face.view))
    n_through, n_on = (
        np.bincount(face.view[kind], minlength=len(count))
        for kind in (is_through, is_on & is_raised)
    )
    sent = count_sent_rays(scan, face, 0.0, count, SCAN_COLUMN_M, heights_m)
    missing = np.zeros(len(count))
    missing[sent.view] = sent.missing_share
    over = over_shares(tops_m, free_tops_m, count)
    return FaceEvidence(top_m, over, n_through / np.maximum(n_on, 1), missing)


def over_shares(top_m: FloatArray, free_top_m: FloatArray, count: IntArray) -> FloatArray:
    """Return how surely surfaces end at some height (k,).

    The share of what rays cross above it that is free.

    Of all heights at which a good part of the surface is free, the one that divides best; 0 where
    none is.

    Parameters
    ----------
    top_m, free_top_m : (k, c) float64
        Height of the highest return and of the highest ray through each column; minus infinity
        without any.
    count : (k,) int
        Columns that each surface has of these.
    """
    ends_m = np.arange(SKIRTING_M, top_m.max(initial=SKIRTING_M) + CELL_M, CELL_M)[:, None, None]
    is_met = top_m > ends_m
    is_free = (free_top_m > ends_m + CELL_M) & ~is_met & np.isfinite(top_m)
    n_met, n_free = is_met.sum(axis=2), is_free.sum(axis=2)
    enough = n_free >= np.maximum(STRETCH_M / SCAN_COLUMN_M, STRAY_SHARE * count)
    return np.max(n_free / np.maximum(n_free + n_met, 1) * enough, axis=0, initial=0.0)


def _column_tops_m(
    view: IntArray, along_m: FloatArray, height_m: FloatArray, count: IntArray
) -> FloatArray:
    """Return the height (k, c) of the highest ray in each column of faces that have `count`."""
    most = count.max(initial=0)
    column = np.clip((along_m / SCAN_COLUMN_M).astype(np.int64), 0, count.take(view) - 1)
    return highest_of_each(view * most + column, height_m, len(count) * most).reshape(-1, most)


def gap_leads_on(rays: RaySet, line: Line, span_m: tuple[float, float], depth_m: float) -> bool:
    """Return whether a gap in a wall leads on, as a door does and a niche does not.

    Parameters
    ----------
    rays : ray_set.RaySet
    line : lines.Line
    span_m : (float, float)
        The gap along the line.
    depth_m : float
        A niche is no deeper.

    Returns
    -------
    bool
        Whether a good part of the rays through it get deeper; true if there are none.
    """
    face = cast_at_face(rays, line, *span_m, at_m=ON_M, least_side_m=ROUNDING)
    behind_m = face.behind_m[face.is_free(BEHIND_M) & (face.height_m > SKIRTING_M)]
    return not len(behind_m) or bool(np.mean(behind_m > depth_m) > STRAY_SHARE)
