"""Scans, poses and settings as a program gives them, checked."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from scanplan.geometry import se3
from scanplan.project.settings import SCHEMA_FILE, Layer, settings_of_dataset
from scanplan.project.settings_schema import default_settings, read_schema
from scanplan.recordings import clouds
from scanplan.registration.results import move_to_map
from scanplan.store.registered_scans import RegisteredScans
from scanplan.types import BoolArray, FloatArray, IntArray, Settings

_STEP_NS = 10**8  # ten scans a second, where nobody says when they were taken
_RIGID = 1e-3  # of a rotation's products: what three printed digits leave


@dataclass(frozen=True, eq=False)
class GivenScans:
    """Scans in the sensor's frame, and all settings.

    Attributes
    ----------
    scans : list of n clouds.Scan
        Without points that are not finite or out of range.
    t_ns : (n,) int64
    planar : bool
        Whether the sensor measures in one plane only.
    settings : dict
    """

    scans: list[clouds.Scan]
    t_ns: IntArray
    planar: bool
    settings: Settings


class Placed(Protocol):
    """Registered scans in the map frame, with all settings of a plan."""

    settings: Settings
    planar: bool
    known: RegisteredScans
    sensors_m: dict[int, FloatArray]

    @property
    def left_out(self) -> Mapping[int, BoolArray]:
        """Sectors of azimuth (72,) in which not all points of a scan are given, by scan."""
        ...

    @property
    def scan_ids(self) -> IntArray:
        """(n,) int32, increasing."""
        ...

    @property
    def n_points(self) -> IntArray:
        """How many points each scan has, (n,) int64."""
        ...

    @property
    def parts(self) -> Sequence["Placed"]:
        """Those of each kind of sensor, in space or in one plane, numbered as here."""
        ...

    def scans(self, scan_ids: Iterable[int] | None = None) -> Iterator[tuple[int, FloatArray]]:
        """Iterate over (scan_id, xyz_m (n, 3) float32) of all scans, or of those asked for."""
        ...

    def rows(self, scan_ids: IntArray) -> IntArray:
        """Return the rows (k,) of registered scans."""
        ...


class PlacedScans:
    """Registered scans in the map frame, read as those of a `tables.ScanStore` are."""

    def __init__(self, given: GivenScans, known: RegisteredScans) -> None:
        if known.scan_ids.max(initial=-1) >= len(given.scans):
            last = known.scan_ids.max()
            raise ValueError(f"poses: has scan {last}, must be of the {len(given.scans)} given")
        self.settings = given.settings
        self.planar = given.planar
        self.known = known
        self.scan_ids = known.scan_ids
        self.sensors_m = {
            i: pose[:3, 3]
            for i, pose in zip(known.scan_ids.tolist(), known.map_from_sensor, strict=True)
        }
        self.left_out: dict[int, BoolArray] = {}
        self._given = given

    @property
    def n_points(self) -> IntArray:
        """How many points each scan has, (n,) int64."""
        return np.array([len(self._given.scans[i].xyz_m) for i in self.scan_ids], np.int64)

    @property
    def parts(self) -> list["PlacedScans"]:
        """All of them: they are of one sensor."""
        return [self]

    def scans(self, scan_ids: Iterable[int] | None = None) -> Iterator[tuple[int, FloatArray]]:
        """Iterate over (scan_id, xyz_m (n, 3) float32) of all scans, or of those asked for."""
        wanted = self.scan_ids if scan_ids is None else np.array([*scan_ids], np.int64)
        rows = self.rows(wanted)
        for i, row in zip(self.scan_ids[rows].tolist(), rows, strict=True):
            pose = self.known.map_from_sensor[row]
            yield i, move_to_map(i, self._given.scans[i].xyz_m, pose).astype(np.float32)

    def rows(self, scan_ids: IntArray) -> IntArray:
        """Return the rows (k,) of registered scans."""
        return np.searchsorted(self.scan_ids, scan_ids)


def read_given(
    scans: Sequence[npt.ArrayLike], t_ns: npt.ArrayLike | None, settings: Settings | None
) -> GivenScans:
    """Check scans, their stamps and settings; see `array_plan.register_scans`.

    Raises
    ------
    ValueError
        If an array is of the wrong shape, or stamps do not increase.
    StageError
        If a setting is out of its range.
    """
    schema = read_schema(SCHEMA_FILE)
    own = [Layer("settings", dict(settings or {}))]
    complete = settings_of_dataset(default_settings(schema), own, schema)
    stamps = _read_stamps(t_ns, len(scans))
    limits = clouds.RangeLimits(complete["input"]["min_range_m"], complete["input"]["max_range_m"])
    read = [
        clouds.keep_in_range(number, int(stamps[number]), _read_points(number, scan), None, limits)
        for number, scan in enumerate(scans)
    ]
    planar = clouds.are_scans_planar(scan.xyz_m for scan in read)
    return GivenScans(read, stamps, planar, complete)


def read_poses(poses: npt.ArrayLike, count: int) -> FloatArray:
    """Return the poses (n, 4, 4) float64 of so many scans, their rotations true; NaN stays.

    Raises
    ------
    ValueError
        If they are of another shape, or one is no rigid motion.
    """
    pose = np.array(poses, float)
    if pose.shape != (count, 4, 4):
        raise ValueError(f"poses: of shape {pose.shape}, must be ({count}, 4, 4), one a scan")
    known = np.flatnonzero(np.isfinite(pose).all(axis=(1, 2)))
    turn = pose[known, :3, :3]
    off = np.abs(np.swapaxes(turn, 1, 2) @ turn - np.eye(3)).max(axis=(1, 2))
    is_rigid = (off <= _RIGID) & (np.linalg.det(turn) > 0)
    is_rigid &= (pose[known, 3] == (0, 0, 0, 1)).all(axis=1)
    if not is_rigid.all():
        wrong = known[~is_rigid][0]
        raise ValueError(f"poses[{wrong}]: is no rigid motion, must be world_from_sensor")
    for row in known:
        pose[row] = se3.nearest_rigid(pose[row])
    return pose


def _read_points(number: int, scan: npt.ArrayLike) -> FloatArray:
    try:
        xyz_m = np.asarray(scan, np.float32)
    except ValueError as error:
        raise ValueError(f"scans[{number}]: is no array of numbers: {error}") from None
    if xyz_m.ndim != 2 or xyz_m.shape[1] not in (2, 3):
        raise ValueError(f"scans[{number}]: of shape {xyz_m.shape}, must be (n, 3) or (n, 2)")
    return np.pad(xyz_m, ((0, 0), (0, 3 - xyz_m.shape[1])))


def _read_stamps(t_ns: npt.ArrayLike | None, count: int) -> IntArray:
    stamps = np.arange(count) * _STEP_NS if t_ns is None else np.asarray(t_ns)
    is_whole = stamps.dtype.kind in "iu"
    if not is_whole or stamps.shape != (count,) or (np.diff(stamps) <= 0).any():
        raise ValueError(f"t_ns: must be {count} increasing whole nanoseconds, one a scan")
    return stamps.astype(np.int64)
