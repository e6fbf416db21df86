"""One survey as a folder of clouds, scans/*.pcd or *.ply, with their poses in poses.tum."""

import re
from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal
from functools import cached_property, partial
from pathlib import Path

import numpy as np

from scanplan.errors import StageError
from scanplan.project import dataset_files
from scanplan.recordings import clocks, clouds, frame_edges
from scanplan.recordings.extrinsics import configured_extrinsics
from scanplan.recordings.integrity.damaged_clouds import DamagedClouds
from scanplan.recordings.integrity.pcd_size import check_pcd_size
from scanplan.recordings.integrity.ply_size import check_ply_size
from scanplan.recordings.messages import TIME_FIELDS
from scanplan.recordings.motion import lidar_odometry, point_times
from scanplan.recordings.motion.pose_kind import ESTIMATED, FOUND, LOCALISER
from scanplan.recordings.survey_protocol import NamedChain
from scanplan.stage import log
from scanplan.store import tum
from scanplan.types import Array, FloatArray, IntArray

_SECONDS = re.compile(r"\d+\.\d+")
_NANOSECONDS = re.compile(r"\d{16,}")


class ScanFolder:
    """Clouds in files and their poses.

    File names that are all stamps (decimal seconds with a point, or nanoseconds of 16 and more
    digits) order the scans and have their poses interpolated. Otherwise the i-th file in natural
    order has the i-th pose.

    Parameters
    ----------
    files : sequence of str
        The clouds and poses.tum.
    base_from_sensor : (6,) float or None
        x, y, z in metres, roll, pitch, yaw in degrees; by default the poses are the sensor's own.
    min_range_m, max_range_m : float
    max_damaged_share : float
        Of the clouds that are read.
    pose_kind : str, optional
        By default the poses are a localiser's.

    Raises
    ------
    StageError
        If the poses are damaged or do not fit the files.
    """

    def __init__(
        self,
        files: Sequence[str],
        *,
        base_from_sensor: Sequence[float] | None,
        min_range_m: float,
        max_range_m: float,
        max_damaged_share: float = 0.0,
        pose_kind: str = FOUND,
    ) -> None:
        paths = [Path(file) for file in files]
        self._poses_path = next(p for p in paths if p.name == dataset_files.POSES_FILE)
        self._extrinsics = (
            [] if base_from_sensor is None else configured_extrinsics(base_from_sensor)
        )
        self._max_damaged_share = max_damaged_share
        self._damaged = DamagedClouds(0, max_damaged_share)
        self._pose_kind = LOCALISER if pose_kind == FOUND else pose_kind
        self._limits = {"min_range_m": min_range_m, "max_range_m": max_range_m}
        pose_ns, rows = tum.read_tum(self._poses_path)
        self._track = _make_track(self._poses_path, pose_ns, rows)
        self._clouds, self._stamps_ns = _order_clouds(
            [path for path in paths if path != self._poses_path], pose_ns, self._poses_path
        )

    @property
    def planar(self) -> bool:
        """Whether the clouds are flat throughout."""
        return self._planar

    @cached_property
    def _planar(self) -> bool:
        scans = map(self._read_scan, range(len(self._clouds)))
        return clouds.are_scans_planar(scan.xyz_m for scan in scans)

    @property
    def sweep_times(self) -> point_times.TimeConvention | None:
        """How the clouds' writer gives the time of a point, or None if it does not."""
        return self._sweep_times

    @cached_property
    def _sweep_times(self) -> point_times.TimeConvention | None:
        first = range(min(len(self._clouds), clouds.SCANS_TO_JUDGE))
        return point_times.find_sweep_times(
            ((self._times_in_range(i), self._stamps_ns[i]) for i in first),
            str(self._poses_path.parent),
        )

    def _times_in_range(self, scan_id: int) -> Array | None:
        xyz_m, time_raw = _read_cloud(self._clouds[scan_id])
        if time_raw is None:
            return None
        return np.asarray(time_raw)[clouds.is_in_range(xyz_m, **self._limits)]

    @property
    def pose_kind(self) -> str:
        """Of which kind the poses are: see `pose_kind.find_pose_kind`."""
        return self._pose_kind

    def stamps(self) -> IntArray:
        """Return the stamps of all clouds, (n,) int64, in scan_id order."""
        return self._stamps_ns

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
        missing = f"{self._poses_path.parent}: advanced.input.pose_kind is {ESTIMATED}"
        return lidar_odometry.estimate_track(self, self._extrinsics, missing)

    def motion_chains(self) -> list[NamedChain]:
        """Return (name, edges) of all that states how the sensor moved: the poses."""
        return [(str(self._poses_path), self.pose_edges())]

    def scans(
        self, wanted: Iterable[int], damaged: DamagedClouds | None = None
    ) -> Iterator[clouds.Scan]:
        """Iterate over the scans of the scan_ids in `wanted`, in scan_id order.

        Only these files are read. `damaged` is as in `survey_protocol.Survey.scans`.

        Raises
        ------
        ValueError
            If there is no scan of one of the numbers.
        StageError
            If too many files are damaged.
        """
        scan_ids = sorted({int(scan_id) for scan_id in wanted})
        if scan_ids and not 0 <= scan_ids[0] <= scan_ids[-1] < len(self._clouds):
            raise ValueError(
                f"{self._poses_path.parent}: {len(self._clouds)} scans,"
                f" asked for up to {scan_ids[-1]}"
            )
        self._damaged = damaged or DamagedClouds(len(scan_ids), self._max_damaged_share)
        for scan_id in scan_ids:
            read = partial(self._read_scan, scan_id, self.sweep_times)
            yield self._damaged.read(scan_id, int(self._stamps_ns[scan_id]), read)

    def _read_scan(
        self, scan_id: int, sweep_times: point_times.TimeConvention | None = None
    ) -> clouds.Scan:
        xyz_m, time_raw = _read_cloud(self._clouds[scan_id])
        stamp_ns = self._stamps_ns[scan_id]
        return clouds.keep_in_range(
            scan_id, stamp_ns, xyz_m, time_raw, sweep_times=sweep_times, **self._limits
        )


def _make_track(poses_path: Path, pose_ns: IntArray, rows: FloatArray) -> frame_edges.FrameEdge:
    track, counts = frame_edges.make_track_edge("map", "sensor", pose_ns, pose_ns, rows)
    if faults := clocks.summarise_faults(counts):
        log.log_line(f"{poses_path}: poses {faults}")
    if track is None:
        raise StageError(f"{poses_path}: no usable pose; lines are `t tx ty tz qx qy qz qw`")
    return track


def _order_clouds(
    paths: Sequence[Path], pose_ns: IntArray, poses_path: Path
) -> tuple[list[Path], IntArray]:
    """Return the clouds in scan_id order and their stamps (n,) int64."""
    stems = [path.stem for path in paths]
    if all(_SECONDS.fullmatch(s) or _NANOSECONDS.fullmatch(s) for s in stems):
        stamps = [int(Decimal(s) * 10**9) if "." in s else int(s) for s in stems]
        if not max(stamps) < tum.END_NS:
            longest = max(paths, key=lambda path: len(path.stem))
            raise StageError(
                f"{longest}: its name is no stamp in seconds or nanoseconds; rename the clouds"
            )
        pairs = sorted(zip(stamps, paths, strict=True))
        return [path for _, path in pairs], np.array([t for t, _ in pairs], np.int64)
    if len(paths) != len(pose_ns):
        raise StageError(
            f"{poses_path}: {len(pose_ns)} poses for {len(paths)} clouds, whose names are not"
            " stamps; give one pose for each cloud, or name the clouds by their stamps in seconds"
        )
    if (np.diff(pose_ns) <= 0).any():
        raise StageError(
            f"{poses_path}: stamps do not increase, but the clouds are taken in their order;"
            " sort them"
        )
    log.log_line(f"{poses_path}: the i-th cloud in natural order of the names has the i-th pose")
    return sorted(paths, key=_natural_key), pose_ns


def _natural_key(path: Path) -> list[tuple[int, str]]:
    parts = re.split(r"(\d+)", path.name)
    return [(int(part), "") if part.isdigit() else (-1, part) for part in parts]


def _read_cloud(path: Path) -> tuple[FloatArray, Array | None]:
    """Read xyz_m (n, 3) float32 and the per-point times as recorded, or None."""
    n_stated = (check_ply_size if path.suffix.lower() == ".ply" else check_pcd_size)(path)
    fields = _read_fields(path)
    xyz_m = fields.get("positions", np.empty((0, 3)))
    if n_stated != len(xyz_m):
        raise StageError(
            f"{path}: damaged: states {n_stated} points, {len(xyz_m)} can be read; write it again"
        )
    times = [fields[name].reshape(-1) for name in TIME_FIELDS if name in fields]
    with np.errstate(over="ignore"):
        return xyz_m.astype(np.float32), times[0] if times else None


def _read_fields(path: Path) -> dict[str, Array]:
    """Return the positions and the times, where there are any, that Open3D reads."""
    import open3d

    try:
        cloud = open3d.t.io.read_point_cloud(path)
        names = [name for name in ("positions", *TIME_FIELDS) if name in cloud.point]
        return {name: cloud.point[name].numpy() for name in names}
    except Exception as error:
        reason = " ".join(str(error).split())[:100]
        raise StageError(f"{path}: damaged ({reason}); write it again") from error
