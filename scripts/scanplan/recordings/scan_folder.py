"""One survey as a folder of clouds, *.pcd or *.ply, with their poses in poses.tum."""

import re
from collections.abc import Iterator, Sequence
from decimal import Decimal
from functools import cached_property
from pathlib import Path

import numpy as np

from scanplan.errors import StageError
from scanplan.project import dataset_entries, dataset_files
from scanplan.recordings import clocks, frame_edges, registered_clouds, table_points
from scanplan.recordings.cloud_reading import CloudReading
from scanplan.recordings.integrity.pcd_size import check_pcd_size
from scanplan.recordings.integrity.ply_size import check_ply_size
from scanplan.recordings.messages import TIME_FIELDS
from scanplan.recordings.motion.pose_kind import ESTIMATED, LOCALISER
from scanplan.recordings.posed_scans import PosedScans
from scanplan.stage import log
from scanplan.store import tum
from scanplan.types import Array, FloatArray, IntArray


class ScanFolder(PosedScans):
    """Clouds in files and their poses.

    File names that are all stamps (decimal seconds with a point, or nanoseconds of 16 and more
    digits) order the scans and have their poses interpolated. Otherwise the i-th file in natural
    order has the i-th pose.

    Parameters
    ----------
    files : sequence of str
        The clouds and poses.tum.
    reading : CloudReading
        By default the poses are a localiser's.

    Raises
    ------
    StageError
        If the poses are damaged or do not fit the files.
    """

    def __init__(self, files: Sequence[str], reading: CloudReading) -> None:
        self._unit_m = reading.units.cloud_m
        paths = [Path(file) for file in files]
        poses_path = next(p for p in paths if p.name == dataset_files.POSES_FILE)
        pose_ns, rows = tum.read_tum(poses_path)
        rows[:, :3] *= reading.units.pose_m
        track = _make_track(poses_path, pose_ns, rows)
        self._clouds, stamps_ns = _order_clouds(
            [path for path in paths if path != poses_path], pose_ns, poses_path
        )
        super().__init__(str(poses_path), track, stamps_ns, LOCALISER, reading)

    def read_cloud(self, scan_id: int) -> tuple[FloatArray, Array | None]:
        """Return what a file holds: see `posed_scans.PosedScans.read_cloud`."""
        xyz_m, time_raw = read_cloud_file(self._clouds[scan_id], self._unit_m)
        if not self._is_in_map:
            return xyz_m, time_raw
        # points in the map are free of the sensor's motion
        return registered_clouds.to_sensor(xyz_m, self._world_from_sensor[scan_id]), None

    @cached_property
    def _is_in_map(self) -> bool:
        if self.pose_kind == ESTIMATED:
            return False

        def read(rows: IntArray) -> Iterator[FloatArray]:
            for row in rows.tolist():
                path = self._clouds[row]
                yield registered_clouds.read_finite(
                    lambda path=path: read_cloud_file(path, self._unit_m)[0]
                )

        return registered_clouds.are_in_map(self._world_from_sensor, read, self.where)

    @cached_property
    def _world_from_sensor(self) -> FloatArray:
        return frame_edges.chain_poses(self.pose_edges(), self.stamps(), max_gap_s=np.inf)[0]


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
    others = [path for path in paths if not dataset_entries.is_stamp(path.stem)]
    n_stamps = len(paths) - len(others)
    if others and n_stamps >= len(others):
        noun = "a stamp" if n_stamps == 1 else f"{n_stamps} stamps"
        fault = f"its name is no stamp, beside {noun} as names of clouds"
        raise StageError(f"{others[0]}: {fault}; move it away, or name it by its stamp in seconds")
    if not others:
        stems = [path.stem for path in paths]
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


def read_cloud_file(path: Path, unit_m: float = 1.0) -> tuple[FloatArray, Array | None]:
    """Read xyz_m (n, 3) float32 and the per-point times as recorded, or None.

    Parameters
    ----------
    unit_m : float
        How many metres the unit of the points has.

    Raises
    ------
    StageError
        If it is damaged, or takes more memory than is allowed.
    """
    n_stated = (check_ply_size if path.suffix.lower() == ".ply" else check_pcd_size)(path)
    table = table_points.describe_table(path)
    xyz_m, times = _read_by_open3d(path) if table is None else table_points.read_whole(table)
    if n_stated != len(xyz_m):
        raise table_points.say_cut_short(path, n_stated, len(xyz_m))
    with np.errstate(over="ignore"):
        return unit_m * xyz_m.astype(np.float32), times


def _read_by_open3d(path: Path) -> tuple[FloatArray, Array | None]:
    """Return points (n, 3) and times (n,), where there are any, of what is no table."""
    import open3d

    try:
        cloud = open3d.t.io.read_point_cloud(path)
        fields = {name: cloud.point[name].numpy() for name in cloud.point}
    except Exception as error:
        reason = " ".join(str(error).split())[:100]
        raise StageError(f"{path}: damaged ({reason}); write it again") from error
    times = [fields[name].reshape(-1) for name in TIME_FIELDS if name in fields]
    return fields.get("positions", np.empty((0, 3))), times[0] if times else None
