"""The scans of several surveys of a floor as those of one, less what later ones have overtaken."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from typing import NamedTuple

import numpy as np

from scanplan.changes.comparison import Scans
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.scan_plane import is_mounted_at
from scanplan.changes.stale_rays import StalePlaces
from scanplan.plan.floorplan import FloorPlan
from scanplan.rays.azimuth_sectors import N_SECTORS, number_sectors
from scanplan.store.registered_scans import RegisteredScans
from scanplan.types import BoolArray, FloatArray, IntArray, Settings

_USUAL_M = 0.3
"""ASSUME of a planar scanner whose recording does not say: below sills, above skirting boards."""


class _Kept(NamedTuple):
    """Which points (n,) of a scan no later survey has overtaken, and sectors (72,) of others."""

    points: BoolArray
    left_out: BoolArray


@dataclass(frozen=True, eq=False)
class Drive:
    """The scans of one survey in the frame of the first, read as those of a `tables.ScanStore` are.

    Attributes
    ----------
    name : str
    own : Scans
        In its own frame.
    motion : PlaneMotion
        To the frame of the first.
    lift_m : float
        Up, likewise.
    floor_m : float
        Height of the floor in that frame; 0 where heights mean nothing.
    stale : tuple of StalePlaces
        What later surveys found changed.
    """

    name: str
    own: Scans
    motion: PlaneMotion
    lift_m: float
    floor_m: float
    stale: tuple[StalePlaces, ...] = ()

    @property
    def planar(self) -> bool:
        """Whether the sensor measures in one plane only."""
        return self.own[0].planar

    @cached_property
    def known(self) -> RegisteredScans:
        """The scans of which something is kept, in the frame of the first."""
        registered = self.own[1]
        rows = np.searchsorted(registered.scan_ids, np.array(list(self._kept), np.int64))
        moved = np.eye(4)
        moved[:2, :2] = self.motion.rotation
        moved[:3, 3] = self.motion.x_m, self.motion.y_m, self.lift_m
        # x and y turn with the frame, errors of heading stay as they are
        turn = np.eye(3)
        turn[:2, :2] = self.motion.rotation
        return RegisteredScans(
            registered.scan_ids[rows],
            registered.t_ns[rows],
            moved @ registered.map_from_sensor[rows],
            turn @ registered.covariance[rows] @ turn.T,
        )

    @property
    def n_points(self) -> IntArray:
        """How many points are kept of each scan of `known`, (n,) int64."""
        return np.array([kept.points.sum() for kept in self._kept.values()], np.int64)

    @property
    def left_out(self) -> list[BoolArray]:
        """Of each scan of `known`, in which sectors of azimuth (72,) rays were overtaken."""
        return [kept.left_out for kept in self._kept.values()]

    def scans(self, scan_ids: Iterable[int] | None = None) -> Iterator[tuple[int, FloatArray]]:
        """Iterate over (scan_id, xyz_m (n, 3) float32) of all scans, or of those asked for."""
        wanted = self.known.scan_ids.tolist() if scan_ids is None else list(map(int, scan_ids))
        for scan_id, xyz_m in self.own[0].scans(wanted):
            yield scan_id, self._move(xyz_m[self._kept[scan_id].points]).astype(np.float32)

    def _move(self, xyz_m: FloatArray) -> FloatArray:
        xyz_m = xyz_m.astype(float)
        return np.column_stack([self.motion.move(xyz_m[:, :2]), xyz_m[:, 2] + self.lift_m])

    @cached_property
    def _kept(self) -> dict[int, _Kept]:
        """What is kept of each scan, by its number; of none whose points all were overtaken."""
        store, registered = self.own
        sensors_m = self._move(registered.map_from_sensor[:, :3, 3]) - [0, 0, self.floor_m]
        scans = store.scans(registered.scan_ids)
        found = {}
        for (scan_id, xyz_m), sensor_m in zip(scans, sensors_m, strict=True):
            is_kept = np.ones(len(xyz_m), bool)
            left_out = np.zeros(N_SECTORS, bool)
            if self.stale:
                ends_m = self._move(xyz_m) - [0, 0, self.floor_m]
                for places in self.stale:
                    is_kept &= ~places.find_rays(sensor_m, ends_m, planar=store.planar)
                way_x_m, way_y_m = (ends_m - sensor_m)[~is_kept, :2].T
                left_out[number_sectors(np.arctan2(way_y_m, way_x_m))] = True
            if is_kept.any():
                found[scan_id] = _Kept(is_kept, left_out)
        return found


def place_drive(
    scans: Scans, plan: FloorPlan, motion: PlaneMotion, level: FloorPlan | None
) -> Drive:
    """Return the scans of a survey on the floor of one in space, or under its ceiling.

    Where neither was seen by both, heights are taken as those of one map. Planar scans lie as high
    above the floor as their own map says, if a scanner may be mounted there.

    Parameters
    ----------
    plan : FloorPlan
        Of the survey.
    motion : PlaneMotion
        From the frame of the survey to that of the first.
    level : FloorPlan, optional
        Of the first survey in space; without one heights mean nothing.
    """
    if level is None:
        return Drive(plan.name, scans, motion, 0.0, 0.0)
    floor_m = level.storey_m[0]
    if not scans[0].planar:
        return Drive(plan.name, scans, motion, find_lift_m(plan, level) or 0.0, floor_m)
    own_m = float(np.median(scans[1].map_from_sensor[:, 2, 3]))
    height_m = own_m if is_mounted_at(own_m) else _USUAL_M
    return Drive(plan.name, scans, motion, floor_m + height_m - own_m, floor_m)


def find_lift_m(plan: FloorPlan, level: FloorPlan) -> float | None:
    """Return how far a survey lies below another; None where nothing level was seen by both."""
    for height in ("floor_z_m", "ceiling_z_m"):
        lift_m = getattr(level, height) - getattr(plan, height)
        if np.isfinite(lift_m):
            return float(lift_m)
    return None


class JoinedScans:
    """Scans of several surveys in the frame of the first, read as those of a `ScanStore` are.

    Planar scans among others are scans of one elevation: of what they do not show at other heights
    nothing is known to be lost.

    Attributes
    ----------
    settings : dict
        What a plan of them is made with.
    planar : bool
        Whether all of them are.
    known : RegisteredScans
        Numbered survey after survey, planar ones last.
    sensors_m : dict of int to (3,) float64
    n_points : (n,) int64
    left_out : dict of int to (72,) bool
        Sectors of azimuth in which rays of a scan were overtaken, or are of one elevation.
    """

    def __init__(self, drives: Sequence[Drive], settings: Settings, first_id: int = 0) -> None:
        drives = sorted(drives, key=lambda drive: drive.planar)
        self.settings = settings
        self.planar = drives[0].planar
        self._drives = drives
        counts = [len(drive.known.scan_ids) for drive in drives]
        self._first_ids = first_id + np.cumsum([0, *counts])
        self.known = RegisteredScans(
            np.arange(first_id, self._first_ids[-1], dtype=np.int32),
            *(
                np.concatenate([getattr(drive.known, name) for drive in drives])
                for name in ("t_ns", "map_from_sensor", "covariance")
            ),
        )
        self.n_points = np.concatenate([drive.n_points for drive in drives])
        places_m = self.known.map_from_sensor[:, :3, 3]
        self.sensors_m = dict(zip(self.scan_ids.tolist(), places_m, strict=True))
        left_out = [
            sectors | (drive.planar and not self.planar)
            for drive in drives
            for sectors in drive.left_out
        ]
        self.left_out = dict(zip(self.scan_ids.tolist(), left_out, strict=True))

    @property
    def scan_ids(self) -> IntArray:
        """(n,) int32, increasing."""
        return self.known.scan_ids

    @property
    def parts(self) -> list["JoinedScans"]:
        """Those in space and those in the plane, numbered as here."""
        flat = [drive for drive in self._drives if drive.planar]
        solid = self._drives[: -len(flat)] if flat else self._drives
        if not flat or not solid:
            return [self]
        first_id = int(self._first_ids[len(solid)])
        return [JoinedScans(solid, self.settings), JoinedScans(flat, self.settings, first_id)]

    def scans(self, scan_ids: Iterable[int] | None = None) -> Iterator[tuple[int, FloatArray]]:
        """Iterate over (scan_id, xyz_m (n, 3) float32) of all scans, or of those asked for."""
        wanted = self.scan_ids.tolist() if scan_ids is None else list(map(int, scan_ids))
        # a file is opened once for those that follow one another
        for of, ids in groupby(wanted, self._find_drive):
            drive, numbers = self._drives[of], list(ids)
            own = [int(drive.known.scan_ids[i - self._first_ids[of]]) for i in numbers]
            for number, (_, xyz_m) in zip(numbers, drive.scans(own), strict=True):
                yield number, xyz_m

    def rows(self, scan_ids: IntArray) -> IntArray:
        """Return the rows (k,) of registered scans."""
        return np.searchsorted(self.scan_ids, scan_ids)

    def _find_drive(self, scan_id: int) -> int:
        return int(np.searchsorted(self._first_ids, scan_id, side="right")) - 1
