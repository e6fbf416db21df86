"""The level plane that rays of a planar survey lie in: how high it is, and whether two are one."""

from dataclasses import dataclass

import numpy as np

from scanplan.rays.ray_set import RaySet

ROW_M = 0.25
"""Up: between two beams of 2 degrees at 7 m."""
_MOUNTED_M = (0.1, 2.0)  # above the floor: from a robot's bumper to overhead
_LIKE_BEAMS = 0.05  # what spacings of one scanner differ by: it turns as well while it drives


@dataclass(frozen=True)
class ScanPlane:
    """The level plane that all rays of a survey lie in.

    Attributes
    ----------
    height_m : float
        Above the floor, NaN where its map does not say.
    beam_rad : float
        Between beams.
    """

    height_m: float
    beam_rad: float = 0.0

    @property
    def row(self) -> int:
        """Of the heights above the floor, -1 where it is not known."""
        return int(self.height_m / ROW_M) if np.isfinite(self.height_m) else -1

    def may_be(self, other: "ScanPlane") -> bool:
        """Return whether both are one, as far as is known.

        They are by their heights, or by their beams where one is not known: a scanner stays where
        it is mounted. A plane that is tilted comes to the rows beside its own.
        """
        if min(self.row, other.row) >= 0:
            return abs(self.row - other.row) <= 1
        most_rad = max(self.beam_rad, other.beam_rad)
        return abs(self.beam_rad - other.beam_rad) <= _LIKE_BEAMS * most_rad


def are_one_plane(one: ScanPlane | None, other: ScanPlane | None) -> bool:
    """Return whether two surveys may be compared as if they looked at the same heights.

    None is of a survey that does not lie in one plane.
    """
    return one is None or other is None or one.may_be(other)


def find_plane(rays: RaySet) -> ScanPlane | None:
    """Return the plane that rays lie in; None of those in space, or of many unknown heights.

    It is as high as its own map says, if a scanner may be mounted there.
    """
    if not rays.planar or _spread_m(rays) > ROW_M:
        return None
    height_m = float(rays.sensors_m[0, 2]) if len(rays.sensors_m) else 0.0
    per_deg = rays.beams.per_deg
    per_deg = per_deg[per_deg > 0]
    beam_rad = float(np.deg2rad(1 / np.median(per_deg))) if len(per_deg) else 0.0
    return ScanPlane(height_m if is_mounted_at(height_m) else np.nan, beam_rad)


def is_mounted_at(height_m: float) -> bool:
    """Return whether a planar scanner may be as high above the floor."""
    lowest_m, highest_m = _MOUNTED_M
    return lowest_m <= height_m <= highest_m


def _spread_m(rays: RaySet) -> float:
    """Return how far apart most returns are in height."""
    if not len(rays.xyz_m):
        return 0.0
    low_m, high_m = np.percentile(rays.xyz_m[:: max(len(rays.xyz_m) // 1000, 1), 2], (5, 95))
    return float(high_m - low_m)
