"""Ray evidence of all scans on the surface of one line.

Returns, rays through it, and the raster of these.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.rays import face_raster
from scanplan.rays.face_raster import FaceRaster
from scanplan.rays.face_rays import cast_at_face
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import BEHIND_M, SKIRTING_M
from scanplan.types import FloatArray, IntArray


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
    """A line with what rays say of its surface: places along it, increasing.

    Attributes
    ----------
    line : lines.Line
    occupied_m, occupied_off_m, occupied_z_m : (h,) float64
        Returns at the surface: along the line, before it, above the floor.
    occupied_scan : (h,) int32
    free_m, free_z_m : (p,) float64
        Where rays go through it.
    low_m, low_z_m : (f,) float64
        Returns at it that are too low for a wall: a sill, or clutter.
    planar : bool
    low_end_m, high_end_m : float
        From where to where rays were gathered: of what is beyond nothing is known.
    """

    line: Line
    occupied_m: FloatArray
    occupied_off_m: FloatArray
    occupied_z_m: FloatArray
    occupied_scan: IntArray
    free_m: FloatArray
    free_z_m: FloatArray
    low_m: FloatArray
    low_z_m: FloatArray
    planar: bool
    low_end_m: float = -math.inf
    high_end_m: float = math.inf

    @cached_property
    def raster(self) -> FaceRaster:
        """The surface in cells of 5 cm, as far as anything is known of it."""
        places_m = np.concatenate([self.occupied_m, self.free_m])
        return face_raster.rasterise_rays(
            (self.occupied_m, self.occupied_z_m),
            (self.free_m, self.free_z_m),
            span_m=(places_m.min(initial=0.0), places_m.max(initial=0.0)),
            planar=self.planar,
        )

    def covers(self, low_m: float, high_m: float) -> bool:
        """Return whether rays were gathered all the way between two places."""
        return self.low_end_m <= low_m and high_m <= self.high_end_m

    def occupied_between(self, low_m: float, high_m: float) -> slice:
        """Return which returns lie between two places."""
        return _between(self.occupied_m, low_m, high_m)

    def free_between(self, low_m: float, high_m: float) -> slice:
        """Return which rays go through between two places."""
        return _between(self.free_m, low_m, high_m)

    def low_between(self, low_m: float, high_m: float) -> slice:
        """Return which returns too low for a wall lie between two places."""
        return _between(self.low_m, low_m, high_m)


def observe_face(
    rays: RaySet, line: Line, low_m: float, high_m: float, *, band_m: float
) -> FaceObservation:
    """Gather what scans show of a stretch of a line.

    Parameters
    ----------
    low_m, high_m : float
        The stretch along the line.
    band_m : float, > 0
        Returns this near to the line are at its surface; a ray goes through it that ends farther
        behind than that and what poses err by.
    """
    face = cast_at_face(rays, line, low_m, high_m, at_m=band_m, occluded_within_m=0.0)
    is_free = face.is_free(band_m + BEHIND_M)
    # most rays end before the surface and are not asked for by their place: sorting is for the rest
    met = np.flatnonzero(face.is_occupied | is_free)
    order = met.take(np.argsort(face.along_m.take(met), kind="stable"))
    is_occupied = face.is_occupied.take(order)
    is_upright = face.height_m.take(order) > SKIRTING_M
    occupied = order[is_occupied & is_upright]
    free = order[is_free.take(order)]
    low = order[is_occupied & ~is_upright]
    return FaceObservation(
        line=line,
        occupied_m=face.along_m[occupied],
        occupied_off_m=-face.behind_m[occupied],
        occupied_z_m=face.height_m[occupied],
        occupied_scan=face.scan[occupied].astype(np.int32),
        free_m=face.along_m[free],
        free_z_m=face.height_m[free],
        low_m=face.along_m[low],
        low_z_m=face.height_m[low],
        planar=rays.planar,
        low_end_m=low_m,
        high_end_m=high_m,
    )


def look_beyond(
    observation: FaceObservation, rays: RaySet, low_m: float, high_m: float, *, band_m: float
) -> FaceObservation:
    """Return an observation with the rays that go through a longer stretch of its line.

    Parameters
    ----------
    rays, low_m, high_m, band_m
        As of `observe_face`.
    """
    face = cast_at_face(rays, observation.line, low_m, high_m, at_m=band_m, occluded_within_m=0.0)
    free = np.flatnonzero(face.is_free(band_m + BEHIND_M))
    free = free.take(np.argsort(face.along_m.take(free), kind="stable"))
    return replace(
        observation,
        free_m=face.along_m[free],
        free_z_m=face.height_m[free],
        low_end_m=low_m,
        high_end_m=high_m,
    )


def _between(places_m: FloatArray, low_m: float, high_m: float) -> slice:
    return slice(
        int(np.searchsorted(places_m, low_m)), int(np.searchsorted(places_m, high_m, side="right"))
    )
