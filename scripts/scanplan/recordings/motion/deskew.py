"""Deskewing: taking the sensor's motion during a sweep out of its scans."""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from scanplan.geometry import se3
from scanplan.recordings.clouds import Scan
from scanplan.recordings.frame_edges import FrameEdge
from scanplan.recordings.integrity.damaged_clouds import DamagedClouds
from scanplan.recordings.motion import point_times
from scanplan.recordings.motion.trajectory import SensorMotion
from scanplan.recordings.survey_protocol import NamedChain, OfSurvey, Survey
from scanplan.stage import log
from scanplan.types import FloatArray, IntArray

# in a hundredth of a sweep a rover turns so little that the chord is within 0.1 mm of the arc
_N_CONTROL_POSES = 101


def move_to_stamp(
    xyz_m: FloatArray, time_s: FloatArray, stamp_from_control: FloatArray
) -> FloatArray:
    """Move points to where the sensor, at the moment of the scan's stamp, would have seen them.

    Parameters
    ----------
    xyz_m : (n, 3) float32
        Each in the sensor's frame at its own moment.
    time_s : (n,) float64
        That moment.
    stamp_from_control : (k, 4, 4) float64, k >= 2
        The control poses: the sensor's, seen from its pose at the stamp, at k moments evenly from
        the least to the largest of `time_s`. In between every point goes straight.

    Returns
    -------
    (n, 3) float32
        In the sensor's frame at the stamp.
    """
    # beams that fire together share a moment: its matrix is made once
    first = np.concatenate([[0], np.flatnonzero(np.diff(time_s)) + 1])
    n_together = np.diff(np.append(first, len(time_s)))
    matrices = _interpolate_control_poses(stamp_from_control, time_s[first])
    entry = np.ascontiguousarray(np.moveaxis(matrices, 0, -1))
    coordinates = np.ascontiguousarray(xyz_m.T, np.float32)

    def of_points(row: int, column: int) -> FloatArray:
        return np.repeat(entry[row, column], n_together)

    # one entry of the matrices after the other: half the time of a matrix for every point
    moved = np.empty((len(xyz_m), 3), np.float32)
    for row in range(3):
        total = of_points(row, 3)
        for column in range(3):
            total = total + of_points(row, column) * coordinates[column]
        moved[:, row] = total
    return moved


def _interpolate_control_poses(control: FloatArray, time_s: FloatArray) -> FloatArray:
    """Return (n, 3, 4) float32 at times (n,), of poses (k, 4, 4) evenly over all of these times."""
    table = control[:, :3].astype(np.float32)
    first_s = time_s.min()
    position = (time_s - first_s) * ((len(table) - 1) / max(time_s.max() - first_s, 1e-9))
    before = np.minimum(position.astype(np.intp), len(table) - 2)
    share = (position - before).astype(np.float32)[:, None, None]
    return table[before] + share * np.diff(table, axis=0)[before]


def control_poses(time_s: FloatArray, t_ns: int, motion: SensorMotion) -> FloatArray | None:
    """Return the control poses of `move_to_stamp`, or None if the motion has gaps in the sweep.

    Parameters
    ----------
    time_s : (n,) float64, n >= 1
    t_ns : int
        The scan's stamp.
    """
    moments_s = np.linspace(time_s.min(), time_s.max(), _N_CONTROL_POSES)
    moments_ns = t_ns + np.round(moments_s * 1e9).astype(np.int64)
    pose = motion.at(np.append(moments_ns, t_ns))
    return None if pose is None else se3.invert_pose(pose[-1]) @ pose[:-1]


def deskew_scan(scan: Scan, motion: SensorMotion) -> FloatArray | None:
    """Return a scan's points (n, 3) float32 as seen at its stamp, or None if the motion has gaps.

    Parameters
    ----------
    scan : clouds.Scan
        With times, n >= 1.
    motion : trajectory.SensorMotion
        It states, too, how the times are to be read.
    """
    if motion.time_scale == 0:
        return scan.xyz_m
    if scan.time_s is None:
        raise ValueError(f"scan {scan.scan_id} has no times")
    time_s = motion.time_scale * scan.time_s + motion.time_shift_s
    control = control_poses(time_s, scan.t_ns, motion)
    return None if control is None else move_to_stamp(scan.xyz_m, time_s, control)


class DeskewedSurvey(OfSurvey):
    """A survey whose scans are free of the motion during their sweeps.

    A scan is left as recorded where its points carry no time, where their times cannot be those of
    one sweep, or where the sensor's motion is not known for all of its sweep and its stamp: motion
    is never extrapolated. Each is counted.
    """

    def __init__(self, survey: Survey, motion: SensorMotion) -> None:
        super().__init__(survey)
        self._motion = motion

    @property
    def planar(self) -> bool:
        """Whether the sensor measures in one plane only."""
        return self._survey.planar

    @property
    def sweep_times(self) -> point_times.TimeConvention | None:
        """How the driver writes the time of a point, or None if it does not."""
        return self._survey.sweep_times

    def stamps(self) -> IntArray:
        """Return the stamps of all clouds, (n,) int64, in scan_id order."""
        return self._survey.stamps()

    def pose_edges(self) -> list[FrameEdge]:
        """Return the chain of transforms whose product is world_from_sensor."""
        return self._survey.pose_edges()

    def motion_chains(self) -> list[NamedChain]:
        """Return (name, edges) of all that states how the sensor moved, the smoothest first."""
        return self._survey.motion_chains()

    def scans(self, wanted: Iterable[int], damaged: DamagedClouds | None = None) -> Iterator[Scan]:
        """Iterate over the scans asked for like the survey itself, with points at their stamps."""
        counts: Counter[str] = Counter()
        farthest_m = 0.0
        for scan in self._survey.scans(wanted, damaged):
            outcome, deskewed = self._deskew(scan)
            counts[outcome] += 1
            if outcome == "moved":
                farthest_m = max(farthest_m, _farthest_m(scan.xyz_m, deskewed.xyz_m))
            yield deskewed
        self._log_outcomes(counts, farthest_m)

    def _deskew(self, scan: Scan) -> tuple[str, Scan]:
        if scan.time_s is None or len(scan.xyz_m) == 0:
            return "untimed", scan
        xyz_m = deskew_scan(scan, self._motion)
        if xyz_m is None:
            return "unknown", scan
        return "moved", replace(scan, xyz_m=xyz_m)

    def _log_outcomes(self, counts: Counter[str], farthest_m: float) -> None:
        if self.sweep_times is None:
            return
        if self._motion.time_scale == 0:
            line = "deskew: scans left as recorded, as their points' times do not fit them"
        else:
            line = (
                f"deskew: {counts['moved']} scans with points at their stamps,"
                f" moved by at most {farthest_m:.3f} m"
            )
        if counts["unknown"]:
            line += f"; {counts['unknown']} beyond the known motion left as recorded"
        if counts["untimed"]:
            line += (
                f"; {counts['untimed']} without points, or with times that are not within"
                f" {point_times.LONGEST_SWEEP_S} s, left as recorded"
            )
        log.log_line(line)


def _farthest_m(before_m: FloatArray, after_m: FloatArray) -> float:
    """Return the largest way of a point, of every 16th of them."""
    way_m = (after_m - before_m)[::16]
    return float(np.sqrt(np.einsum("ij,ij->i", way_m, way_m).max()))
