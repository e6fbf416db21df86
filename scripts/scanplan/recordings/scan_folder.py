"""One survey as a folder of recorded clouds, scans/*.pcd or *.ply, with their poses in poses.tum."""

import re
from decimal import Decimal
from functools import cached_property
from pathlib import Path

import numpy as np

from scanplan.errors import StageError
from scanplan.project import dataset_files
from scanplan.recordings import clouds, tf_tree
from scanplan.recordings.extrinsics import configured_extrinsics
from scanplan.recordings.motion import point_times
from scanplan.stage import log
from scanplan.store import tum

_SECONDS, _NANOSECONDS = re.compile(r"\d+\.\d+"), re.compile(r"\d{16,}")
_DECLARED = re.compile(rb"^(?:POINTS|element vertex) +(\d+)\s*$", re.MULTILINE)
_HEADER_BYTES = 8192
_TIME_FIELDS = ("time", "t", "timestamp")


class ScanFolder:
    """Clouds in files and their poses.

    File names that are all stamps (decimal seconds with a point, or nanoseconds of 16 and more digits) order the scans
    and have their poses interpolated. Otherwise the i-th file in natural order has the i-th pose.

    Parameters
    ----------
    files : sequence of str
        The clouds and poses.tum.
    base_from_sensor : (6,) float or None
        x, y, z in metres, roll, pitch, yaw in degrees; by default the poses are the sensor's own.
    min_range_m, max_range_m : float

    Raises
    ------
    StageError
        If the poses are damaged or do not fit the files.
    """

    def __init__(self, files, *, base_from_sensor, min_range_m, max_range_m):
        paths = [Path(file) for file in files]
        self._poses_path = next(p for p in paths if p.name == dataset_files.POSES_FILE)
        self._mount = [] if base_from_sensor is None else configured_extrinsics(base_from_sensor)
        self._limits = {"min_range_m": min_range_m, "max_range_m": max_range_m}
        pose_ns, rows = tum.read_tum(self._poses_path)
        self._track, found = tf_tree.make_track_edge("map", "sensor", pose_ns, pose_ns, rows)
        told = ", ".join(f"{count} {kind}" for kind, count in found.items() if count)
        if told:
            log.log_line(f"{self._poses_path}: poses {told}")
        if self._track is None:
            raise StageError(
                f"{self._poses_path}: no usable pose; lines are `t tx ty tz qx qy qz qw`"
            )
        self._clouds, self._stamps_ns = _order(
            [p for p in paths if p != self._poses_path], pose_ns, self._poses_path
        )

    @cached_property
    def planar(self):
        """Whether the clouds are flat throughout."""
        return clouds.are_scans_planar(
            scan.xyz_m for scan in map(self._scan, range(len(self._clouds)))
        )

    @cached_property
    def sweep_times(self):
        """How the clouds tell when each point was measured: a point_times.TimeConvention, or None if they do not."""
        first = range(min(len(self._clouds), clouds.SCANS_TO_JUDGE))
        found = point_times.find_time_convention(
            (self._times(i), self._stamps_ns[i]) for i in first
        )
        if found:
            log.log_line(f"{self._poses_path.parent}: times of points are {found}")
        return found

    def _times(self, scan_id):
        xyz_m, time_raw = _read_cloud(self._clouds[scan_id])
        return (
            None
            if time_raw is None
            else np.asarray(time_raw)[clouds.is_in_range(xyz_m, **self._limits)]
        )

    def stamps(self):
        """Return the stamps of all clouds, (n,) int64, in scan_id order."""
        return self._stamps_ns

    def pose_edges(self):
        """Return the chain of transforms whose product is world_from_sensor, a list of tf_tree.FrameEdge."""
        return [self._track, *self._mount]

    def motion_chains(self):
        """Return (name, list of tf_tree.FrameEdge) of all that tells how the sensor moved: the poses."""
        return [(str(self._poses_path), self.pose_edges())]

    def scans(self, wanted):
        """Iterate over the scans of the scan_ids in `wanted`, in scan_id order; only these files are read.

        Raises
        ------
        ValueError
            If there is no scan of one of the numbers.
        StageError
            If a file is damaged.
        """
        wanted = sorted({int(scan_id) for scan_id in wanted})
        if wanted and not 0 <= wanted[0] <= wanted[-1] < len(self._clouds):
            raise ValueError(
                f"{self._poses_path.parent}: {len(self._clouds)} scans, asked for up to {wanted[-1]}"
            )
        for scan_id in wanted:
            yield self._scan(scan_id, self.sweep_times)

    def _scan(self, scan_id, sweep_times=None):
        read = _read_cloud(self._clouds[scan_id])
        return clouds.keep_in_range(
            scan_id, self._stamps_ns[scan_id], *read, sweep_times=sweep_times, **self._limits
        )


def _order(paths, pose_ns, poses_path):
    """Return the clouds in scan_id order and their stamps (n,) int64."""
    stems = [path.stem for path in paths]
    if all(_SECONDS.fullmatch(s) or _NANOSECONDS.fullmatch(s) for s in stems):
        stamps = [int(Decimal(s) * 10**9) if "." in s else int(s) for s in stems]
        pairs = sorted(zip(stamps, paths, strict=True))
        return [path for _, path in pairs], np.array([t for t, _ in pairs], np.int64)
    if len(paths) != len(pose_ns):
        raise StageError(
            f"{poses_path}: {len(pose_ns)} poses for {len(paths)} clouds, whose names are not stamps;"
            " give one pose for each cloud, or name the clouds by their stamps in seconds"
        )
    if (np.diff(pose_ns) <= 0).any():
        raise StageError(
            f"{poses_path}: stamps do not increase, but the clouds are taken in their order; sort them"
        )
    log.log_line(f"{poses_path}: the i-th cloud in natural order of the names has the i-th pose")
    return sorted(paths, key=_natural), pose_ns


def _natural(path):
    return [
        (int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", path.name)
    ]


def _read_cloud(path):
    """Read xyz_m (n, 3) float32 and the per-point times as recorded, or None."""
    import open3d

    with path.open("rb") as file:
        declared = _DECLARED.search(file.read(_HEADER_BYTES))
    try:
        cloud = open3d.t.io.read_point_cloud(str(path))
        fields = {
            name: cloud.point[name].numpy()
            for name in ("positions", *_TIME_FIELDS)
            if name in cloud.point
        }
    except Exception as error:
        raise StageError(
            f"{path}: damaged ({' '.join(str(error).split())[:100]}); write it again"
        ) from error
    xyz_m = fields.get("positions", np.empty((0, 3)))
    if declared is None or int(declared[1]) != len(xyz_m):
        count = "no number of" if declared is None else int(declared[1])
        raise StageError(
            f"{path}: damaged: declares {count} points, {len(xyz_m)} can be read; write it again"
        )
    times = [fields[name].reshape(-1) for name in _TIME_FIELDS if name in fields]
    with np.errstate(over="ignore"):
        return xyz_m.astype(np.float32), times[0] if times else None
