"""What points and rays tell about a line, in columns of 5 cm along it."""

from dataclasses import dataclass, field

import numpy as np

from scanplan.geometry.lines import Line

COLUMN_M = 0.05
_LEAST_PASSES = 3
_OVER_SHARE = 0.15
_FRAMED_SHARE = 0.5


@dataclass(frozen=True)
class RaySettings:
    """How points and rays are read.

    Attributes
    ----------
    band_m : float, > 0
        Points this near to a line are at it.
    reach_m : float, >= 0
        How far beyond what was extracted of a line more of it is looked for.
    max_gap_m : float, >= 0
        Longest pause that is wall all the same where no ray went through.
    door_height_m : float, > 0
        Above the floor; what is higher says nothing about a way through.
    """

    band_m: float
    reach_m: float
    max_gap_m: float
    door_height_m: float


@dataclass(frozen=True, eq=False)
class FaceObservation:
    """A line with what rays tell about it: positions along it, increasing.

    Attributes
    ----------
    line : lines.Line
    hit_m, hit_off_m, hit_z_m : (h,) float64
    hit_scan : (h,) int64
    pass_m, pass_z_m : (p,) float64
    pass_scan : (p,) int64
    foot_m, foot_z_m : (f,) float64
        Points at the line that are too low for a wall: a sill, or clutter.
    panes_m : (n, 2) float64
        From where to where too few of the rays towards the line came back for what is opaque.
    profiles : dict
        Those that were asked for.
    """

    line: Line
    hit_m: np.ndarray
    hit_off_m: np.ndarray
    hit_z_m: np.ndarray
    hit_scan: np.ndarray
    pass_m: np.ndarray
    pass_z_m: np.ndarray
    pass_scan: np.ndarray
    foot_m: np.ndarray = field(default_factory=lambda: np.empty(0))
    foot_z_m: np.ndarray = field(default_factory=lambda: np.empty(0))
    panes_m: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))
    profiles: dict = field(default_factory=dict)

    def columns(self, reading, *, planar):
        """Return the line in columns, a `FaceProfile`."""
        key = (reading, planar)
        if key not in self.profiles:
            self.profiles[key] = _profile(self, reading, planar=planar)
        return self.profiles[key]

    @property
    def framed_m(self):
        """Of the panes those (k, 2) that points are at, of whatever height, along most of their length.

        Glass has a frame, a sill or a lintel; a line that merely goes on before a pane has none.
        """
        at_it_m = np.sort(np.concatenate([self.hit_m, self.foot_m]))
        share = [filled_share(at_it_m, *span_m) for span_m in self.panes_m]
        return self.panes_m[np.array(share, float) >= _FRAMED_SHARE]

    def hits(self, low_m, high_m):
        """Return the slice of the points between two places."""
        return slice(
            np.searchsorted(self.hit_m, low_m), np.searchsorted(self.hit_m, high_m, side="right")
        )

    def passes(self, low_m, high_m):
        """Return the slice of the crossings between two places."""
        return slice(
            np.searchsorted(self.pass_m, low_m), np.searchsorted(self.pass_m, high_m, side="right")
        )

    def feet(self, low_m, high_m):
        """Return the slice of the points too low for a wall between two places."""
        return slice(
            np.searchsorted(self.foot_m, low_m), np.searchsorted(self.foot_m, high_m, side="right")
        )


@dataclass(frozen=True, eq=False)
class FaceProfile:
    """A line in columns of 5 cm, the first beginning at `first_m`; all else (n,) bool.

    Attributes
    ----------
    first_m : float
    solid : array
        Points are at it, and hardly a ray went through.
    crossed : array
        More rays went through below a door's height than ended there,
    opened : array
        and not just one or two.
    overlooked : array
        Rays went through above whatever is there.
    """

    first_m: float
    solid: np.ndarray
    crossed: np.ndarray
    opened: np.ndarray
    overlooked: np.ndarray

    def between(self, low_m, high_m):
        """Return the slice of the columns whose middles lie between two places."""
        low, high = np.ceil((np.array([low_m, high_m]) - self.first_m) / COLUMN_M - 0.5).astype(
            np.int64
        )
        return slice(max(low, 0), max(high, 0))


def filled_share(places_m, low_m, high_m):
    """Return the share of the columns between two places that hold any of sorted places."""
    inside_m = places_m[np.searchsorted(places_m, low_m) : np.searchsorted(places_m, high_m)]
    columns = max(round((high_m - low_m) / COLUMN_M), 1)
    return len(np.unique(((inside_m - low_m) / COLUMN_M).astype(np.int64))) / columns


def _profile(seen, reading, *, planar):
    """Tell for every 5 cm of a line whether there is wall, a way through, or furniture.

    Returns
    -------
    Profile
    """
    edges_m = np.concatenate([seen.hit_m, seen.pass_m])
    first_m = edges_m.min(initial=0.0)
    count = int((edges_m.max(initial=0.0) - first_m) / COLUMN_M) + 1
    hit, crossing = (
        ((place - first_m) / COLUMN_M).astype(np.int64) for place in (seen.hit_m, seen.pass_m)
    )
    low_hit = np.full(len(hit), True) if planar else seen.hit_z_m <= reading.door_height_m
    low_pass = np.full(len(crossing), True) if planar else seen.pass_z_m <= reading.door_height_m
    hits = np.bincount(hit[low_hit], minlength=count)
    passes = np.bincount(crossing[low_pass], minlength=count)
    top_m = np.full(count, -np.inf)
    np.maximum.at(top_m, hit, seen.hit_z_m)
    over = (
        passes
        if planar
        else np.bincount(crossing[seen.pass_z_m > top_m[crossing]], minlength=count)
    )
    crossed = passes > hits
    opened = crossed & (passes >= _LEAST_PASSES)
    overlooked = (over >= _LEAST_PASSES) & (over >= _OVER_SHARE * hits)
    return FaceProfile(first_m, (hits > 0) & ~opened, crossed, opened, overlooked)
