"""Panes along a line: told by the rays that never came back.

Whatever is opaque sends back the rays that reach it, be it the wall, what stands before it, or what is seen through
its openings. Glass lets most through, to where there may be nothing, and mirrors others away. Of the rays themselves
nothing is known but their returns: how many a scan sent at an elevation is told by those that come back elsewhere.
"""

import numpy as np

from scanplan.rays import expected_returns
from scanplan.rays.face_profile import COLUMN_M

_BANDS_M = (
    (0.2, 0.7),
    (0.9, 1.6),
)  # between skirting and sill; above sills and below the lintels of low doors
_LEAST_LENGTH_M = 0.3  # narrower panes are in doors and stairs
_LEAST_SCANS = 3  # two may share what stands too near to be measured
_LEAST_SHARE = 0.5  # of the rays; a dark or glossy wall still gives more back


def find_missing_returns(rays, line, low_m, high_m):
    """Find where along a line less than half of the rays come back that reach it, low and at the height of a chest.

    A wall below a window is wall, and so is one above an oven: both bands of height have to show it. Where few rays are
    to be expected nothing is said.

    Parameters
    ----------
    rays : ray_set.RaySet
        Of scans in space.
    line : lines.Line
    low_m, high_m : float
        The stretch of the line to look at.

    Returns
    -------
    (n, 2) float64
        From where to where along the line, in order.
    """
    count = max(int(np.ceil((high_m - low_m) / COLUMN_M)), 1)
    lost = np.full(count, True)
    for heights_m in _BANDS_M:
        if lost.any():
            reached, back, _ = expected_returns.count_sent_rays(
                rays, line, low_m, count, heights_m
            ).reached(least_scans=_LEAST_SCANS)
            lost &= back < _LEAST_SHARE * reached
    edges_m = low_m + COLUMN_M * np.flatnonzero(
        np.diff(np.concatenate([[False], lost, [False]]).astype(np.int8))
    )
    spans_m = edges_m.reshape(-1, 2)
    return spans_m[np.diff(spans_m, axis=1)[:, 0] >= _LEAST_LENGTH_M]
