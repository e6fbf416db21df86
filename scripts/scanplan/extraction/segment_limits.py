"""What a wall segment of one scan must be, and how an extractor returns it."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

DIAGONAL = np.cos(np.radians(45))
"""Cosine of half a right angle: what turns more stands across, or points up rather than out."""


class SegmentRow(NamedTuple):
    """A segment as `segments.cut_line` returns it.

    A row of the table of segments, relative to the sensor.
    """

    x0_m: float
    y0_m: float
    x1_m: float
    y1_m: float
    nx: float
    ny: float
    n_points: int
    rmse_m: float
    z_min_m: float
    z_max_m: float


MAX_TILT_DEG = 15.0
"""Of a wall's normal against the horizontal: ASSUME noise of few points turns it by less."""
LEAST_POINTS = 30
"""ASSUME fewer points of a 3-D scan do not tell a wall from clutter."""
LEAST_POINTS_PLANAR = 6
"""The same of a 2-D scan, all of whose points at a wall lie on one line."""


@dataclass(frozen=True, kw_only=True)
class ExtractorSettings:
    """What the settings of every extractor begin with.

    Attributes
    ----------
    inlier_m : float
        Largest distance of a wall's point from its line.
    min_points : int
        Of a 3-D scan.
    min_points_planar : int
        Of a scan of a 2-D laser scanner.
    seed : int
        For the random draws; a scan's draws depend on it and on the `scan_id` alone.
    """

    inlier_m: float
    min_points: int = LEAST_POINTS
    min_points_planar: int = LEAST_POINTS_PLANAR
    seed: int

    def least_points(self, planar: bool) -> int:
        """Return the fewest points of a segment."""
        return self.min_points_planar if planar else self.min_points


@dataclass(frozen=True, kw_only=True)
class SegmentLimits(ExtractorSettings):
    """What a wall segment must be, where lines are cut at gaps.

    Attributes
    ----------
    max_gap_m : float
        A longer part of the line without points ends the segment.
    min_length_m : float
    min_height_m : float
        Least vertical extent; for 3-D scans alone.
    door_height_m : float
        Above the scan's floor; higher points bridge no gap: they may be the wall above a door. For
        3-D scans alone.
    corner_m : float
        Strips of wall above furniture pause for no longer.
    """

    max_gap_m: float
    min_length_m: float
    min_height_m: float
    door_height_m: float
    corner_m: float
