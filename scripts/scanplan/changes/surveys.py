"""A survey as it is compared with another: its plan, its faces, and rays of its scans."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np
from shapely.geometry.base import BaseGeometry

from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.ray_cells import AT_M, Looks, look_at, place_returns
from scanplan.changes.scan_plane import ScanPlane, find_plane
from scanplan.changes.seen_faces import SeenFaces, list_seen_faces
from scanplan.changes.seen_floors import find_free_floor, place_shape
from scanplan.geometry.lines import Line
from scanplan.plan.floorplan import FloorPlan
from scanplan.rays.ray_set import RaySet, gather_rays
from scanplan.rays.tolerances import SKIRTING_M
from scanplan.store.registered_scans import RegisteredScans, ScanReader
from scanplan.types import FloatArray, IntArray

_MOST_SCANS = 300  # evenly over the drive: every wall of a floor is seen by many of them
_MOST_RAYS = 3_000_000  # of all of them: 100 MB, and a second to sort
_OPEN_M = 0.1  # below the ceiling nothing is asked: of a lintel or a beam


class Sight(Protocol):
    """What is known of the places of a floor beside its plan, in the common frame."""

    @property
    def plane(self) -> ScanPlane | None:
        """That all of it lies in; None where it has many heights."""
        ...

    def look_at(self, line: Line, span_m: tuple[float, float], half_m: float) -> Looks:
        """Return what it shows of a stretch of wall, see `ray_cells.look_at`."""
        ...

    def place_returns(self, line: Line, span_m: tuple[float, float], reach_m: float) -> FloatArray:
        """Return how far surfaces lie before a face, see `ray_cells.place_returns`."""
        ...


@dataclass(frozen=True, eq=False)
class RaySight:
    """What rays show.

    Attributes
    ----------
    rays : ray_set.RaySet
        In the common frame, heights above the floor.
    slack_m : float
        What they are off by at walls, see `ray_cells.look_at`.
    """

    rays: RaySet
    slack_m: float = AT_M

    @property
    def plane(self) -> ScanPlane | None:
        """That the rays lie in, see `scan_plane.find_plane`."""
        return self._plane

    @cached_property
    def _plane(self) -> ScanPlane | None:
        return find_plane(self.rays)

    def look_at(self, line: Line, span_m: tuple[float, float], half_m: float) -> Looks:
        """Return what rays show of a stretch of wall, see `ray_cells.look_at`."""
        looks = look_at(self.rays, line, span_m, half_m, self.slack_m)
        return replace(looks, plane=self.plane)

    def place_returns(self, line: Line, span_m: tuple[float, float], reach_m: float) -> FloatArray:
        """Return how far returns lie before a face, see `ray_cells.place_returns`."""
        return place_returns(self.rays, line, span_m, reach_m)


@dataclass(frozen=True, eq=False)
class Survey:
    """A survey, or what was drawn.

    Attributes
    ----------
    plan : floorplan.FloorPlan
        In its own frame.
    sight : Sight
        In the frame that `motion` leads to.
    motion : PlaneMotion
        From its own frame to the common one.
    """

    plan: FloorPlan
    sight: Sight
    motion: PlaneMotion

    @cached_property
    def faces(self) -> SeenFaces:
        """The faces that it shows, in the common frame."""
        return list_seen_faces(self.plan).moved(self.motion)

    @cached_property
    def free(self) -> BaseGeometry:
        """The floor that rays went over, in the common frame."""
        return self.place(find_free_floor(self.plan))

    def place(self, shape: BaseGeometry) -> BaseGeometry:
        """Return a shape of the plan in the common frame."""
        return place_shape(shape, self.motion)


def read_rays(
    store: ScanReader, registered: RegisteredScans, plan: FloorPlan, motion: PlaneMotion
) -> RaySet:
    """Return rays of scans all over a drive in another frame, heights above the plan's floor.

    Those that end at the floor or the ceiling say nothing of walls and are left out. Where the
    floor was not seen heights mean nothing, as of planar scans. Of long recordings scans are
    thinned evenly, and of dense scans rays by chance.

    Parameters
    ----------
    motion : PlaneMotion
        From the survey's frame.
    """
    scan_ids = _thin(registered.scan_ids, _MOST_SCANS)
    rows = np.searchsorted(registered.scan_ids, scan_ids)
    most = _MOST_RAYS // len(scan_ids)
    planar = store.planar or not np.isfinite(plan.floor_z_m)
    floor_m, height_m = (0.0, np.inf) if planar else plan.storey_m
    high_m = height_m - _OPEN_M if plan.height_from == "ceiling" else np.inf

    def moved_m(xyz_m: FloatArray) -> FloatArray:
        return np.column_stack([motion.move(xyz_m[:, :2]), xyz_m[:, 2] - floor_m])

    def thinned() -> Iterator[tuple[int, FloatArray]]:
        for scan_id, xyz_m in store.scans(scan_ids):
            placed_m = moved_m(xyz_m.astype(float))
            is_wanted = (placed_m[:, 2] > SKIRTING_M) & (placed_m[:, 2] < high_m)
            placed_m = placed_m if planar else placed_m[is_wanted]
            if len(placed_m) > most:
                # by chance: every second of sixteen beams would be always the same ones
                random = np.random.default_rng(scan_id)
                placed_m = placed_m[random.choice(len(placed_m), most, replace=False)]
            yield scan_id, placed_m

    sensors_m = moved_m(registered.map_from_sensor[rows, :3, 3])
    places_m = dict(zip(scan_ids.tolist(), sensors_m, strict=True))
    floor_z_m = np.nan if planar else 0.0
    return gather_rays(thinned(), places_m, planar=planar, floor_z_m=floor_z_m)


def _thin(values: IntArray, most: int) -> IntArray:
    """Return at most so many values, evenly chosen."""
    if len(values) <= most:
        return values
    return values[np.unique(np.linspace(0, len(values) - 1, most).round().astype(np.int64))]
