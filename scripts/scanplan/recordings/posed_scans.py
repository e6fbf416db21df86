"""A survey whose clouds lie in files, each with a pose or a stamp among poses."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property, partial

import numpy as np

from scanplan.recordings import clouds, frame_edges
from scanplan.recordings.cloud_reading import CloudReading
from scanplan.recordings.extrinsics import configured_extrinsics
from scanplan.recordings.integrity.damaged_clouds import DamagedClouds
from scanplan.recordings.motion import lidar_odometry, point_times
from scanplan.recordings.motion.pose_kind import ESTIMATED, FOUND
from scanplan.recordings.survey_protocol import NamedChain, TakenAtOnce
from scanplan.types import Array, FloatArray, IntArray


class PosedScans(ABC):
    """Clouds in files and their poses; what is read of a file is a subclass's.

    Parameters
    ----------
    where : str
        What the poses are from, for errors.
    track : frame_edges.FrameEdge
        The poses, map from sensor.
    stamps_ns : (n,) int64
        Of the clouds, in scan_id order.
    found_kind : str
        Of which kind the poses are where the settings do not say: see `pose_kind`.
    """

    def __init__(
        self,
        where: str,
        track: frame_edges.FrameEdge,
        stamps_ns: IntArray,
        found_kind: str,
        reading: CloudReading,
    ) -> None:
        self.where = where
        self._track = track
        self._stamps_ns = stamps_ns
        mounting = reading.base_from_sensor
        self._extrinsics = [] if mounting is None else configured_extrinsics(mounting)
        self._max_damaged_share = reading.max_damaged_share
        self._damaged = DamagedClouds(0, reading.max_damaged_share)
        self._pose_kind = found_kind if reading.pose_kind == FOUND else reading.pose_kind
        self._limits = reading.limits

    @abstractmethod
    def read_cloud(self, scan_id: int) -> tuple[FloatArray, Array | None]:
        """Return a cloud's xyz_m (n, 3) float32, sensor frame, and times as recorded, or None.

        Raises
        ------
        StageError
            If it is damaged.
        """
        ...

    def read_ahead(self, scan_ids: Sequence[int]) -> None:
        """Take note of which clouds will be read next, in this order."""
        return

    @property
    def planar(self) -> bool:
        """Whether the clouds are flat throughout."""
        return self._planar

    @cached_property
    def _planar(self) -> bool:
        scans = map(self._read_scan, range(len(self._stamps_ns)))
        return clouds.are_scans_planar(scan.xyz_m for scan in scans)

    @property
    def sweep_times(self) -> point_times.TimeConvention | None:
        """How the clouds' writer gives the time of a point, or None if it does not."""
        return self._sweep_times

    @cached_property
    def _sweep_times(self) -> point_times.TimeConvention | None:
        first = range(min(len(self._stamps_ns), clouds.SCANS_TO_JUDGE))
        return point_times.find_sweep_times(
            ((self._times_in_range(i), self._stamps_ns[i]) for i in first), self.where
        )

    def _times_in_range(self, scan_id: int) -> Array | None:
        xyz_m, time_raw = self.read_cloud(scan_id)
        if time_raw is None:
            return None
        return np.asarray(time_raw)[self._limits.include(xyz_m)]

    @property
    def pose_kind(self) -> str:
        """Of which kind the poses are: see `pose_kind.find_pose_kind`."""
        return self._pose_kind

    def stamps(self) -> IntArray:
        """Return the stamps of all clouds, (n,) int64, in scan_id order."""
        return self._stamps_ns

    def describe_rays(self) -> list[str]:
        """Return nothing: places, and what they saw, were recorded."""
        return []

    def describe_gaps(self) -> list[str]:
        """Return nothing: it is one recording."""
        return []

    def describe_damage(self) -> list[str]:
        """Return what could not be read so far, in sentences."""
        return self._damaged.describe()

    def pose_edges(self) -> list[frame_edges.FrameEdge]:
        """Return the chain of transforms whose product is world_from_sensor."""
        return [self._chosen_track, *self._extrinsics]

    @cached_property
    def _chosen_track(self) -> frame_edges.FrameEdge:
        if self._pose_kind != ESTIMATED:
            return self._track
        missing = f"{self.where}: advanced.input.pose_kind is {ESTIMATED}"
        return lidar_odometry.estimate_track(self, self._extrinsics, missing)

    def motion_chains(self) -> list[NamedChain]:
        """Return (name, edges) of all that states how the sensor moved: the poses."""
        return [(self.where, self.pose_edges())]

    def scans(
        self, wanted: Iterable[int], damaged: DamagedClouds | None = None
    ) -> Iterator[clouds.Scan]:
        """Iterate over the scans of the scan_ids in `wanted`, in scan_id order.

        Only these are read. `damaged` is as in `survey_protocol.Survey.scans`.

        Raises
        ------
        ValueError
            If there is no scan of one of the numbers.
        StageError
            If too many are damaged.
        """
        scan_ids = sorted({int(scan_id) for scan_id in wanted})
        n_scans = len(self._stamps_ns)
        if scan_ids and not 0 <= scan_ids[0] <= scan_ids[-1] < n_scans:
            raise ValueError(f"{self.where}: {n_scans} scans, asked for up to {scan_ids[-1]}")
        self._damaged = damaged or DamagedClouds(len(scan_ids), self._max_damaged_share)
        self.read_ahead(scan_ids)
        for scan_id in scan_ids:
            read = partial(self._read_scan, scan_id, self.sweep_times)
            yield self._damaged.read(scan_id, int(self._stamps_ns[scan_id]), read)

    def _read_scan(
        self, scan_id: int, sweep_times: point_times.TimeConvention | None = None
    ) -> clouds.Scan:
        xyz_m, time_raw = self.read_cloud(scan_id)
        stamp_ns = self._stamps_ns[scan_id]
        return clouds.keep_in_range(
            scan_id, stamp_ns, xyz_m, time_raw, self._limits, sweep_times=sweep_times
        )


class UntimedScans(TakenAtOnce, PosedScans):
    """Scans in space, of a sensor that stood still or with points that are free of its motion."""
