"""Taking the sensor's motion during a sweep out of its scans."""

from dataclasses import replace

import numpy as np

from scanplan.geometry import se3
from scanplan.recordings.motion import point_times
from scanplan.stage import log

# in a hundredth of a sweep a rover turns so little that the chord is within a tenth of a millimetre of the arc
_KNOTS = 101


def move_to_stamp(xyz_m, time_s, stamp_from_knots):
    """Move points to where the sensor, at the moment of the scan's stamp, would have seen them.

    Parameters
    ----------
    xyz_m : (n, 3) float32
        Each in the sensor's frame at its own moment.
    time_s : (n,) float64
        That moment.
    stamp_from_knots : (k, 4, 4) float64, k >= 2
        The sensor's pose, seen from its pose at the stamp, at k moments evenly from the least to the largest of
        `time_s`. In between every point goes straight.

    Returns
    -------
    (n, 3) float32
        In the sensor's frame at the stamp.
    """
    # beams that fire together share a moment: its matrix is made once
    first = np.concatenate([[0], np.flatnonzero(np.diff(time_s)) + 1])
    n_together = np.diff(np.append(first, len(time_s)))
    entry = np.ascontiguousarray(np.moveaxis(_between(stamp_from_knots, time_s[first]), 0, -1))
    coordinates = np.ascontiguousarray(xyz_m.T, np.float32)

    def of_points(row, column):
        return np.repeat(entry[row, column], n_together)

    # one entry of the matrices after the other: half the time of a matrix for every point
    rows = [
        sum((of_points(i, j) * coordinates[j] for j in range(3)), of_points(i, 3)) for i in range(3)
    ]
    return np.column_stack(rows)


def _between(knots, time_s):
    """Return (n, 3, 4) float32 of knots (k, 4, 4) that lie evenly from the least to the largest of the times (n,)."""
    table, first_s = knots[:, :3].astype(np.float32), time_s.min()
    at = (time_s - first_s) * ((len(table) - 1) / max(time_s.max() - first_s, 1e-9))
    knot = np.minimum(at.astype(np.intp), len(table) - 2)
    share = (at - knot).astype(np.float32)[:, None, None]
    return table[knot] + share * np.diff(table, axis=0)[knot]


def control_poses(time_s, t_ns, motion):
    """Return `stamp_from_knots` of `move_to_stamp` for a sweep, or None if the motion is not known throughout.

    Parameters
    ----------
    time_s : (n,) float64, n >= 1
    t_ns : int
        The scan's stamp.
    motion : trajectory.SensorMotion
    """
    moments_s = np.linspace(time_s.min(), time_s.max(), _KNOTS)
    pose = motion.at(np.append(t_ns + np.round(moments_s * 1e9).astype(np.int64), t_ns))
    return None if pose is None else se3.invert_pose(pose[-1]) @ pose[:-1]


def deskew_scan(scan, motion):
    """Return a scan's points (n, 3) float32 as seen at its stamp, or None if the motion is not known throughout.

    Parameters
    ----------
    scan : clouds.Scan
        With times, n >= 1.
    motion : trajectory.SensorMotion
        It also tells how the times are to be read.
    """
    if motion.time_scale == 0:
        return scan.xyz_m
    time_s = motion.time_scale * scan.time_s + motion.time_shift_s
    stamp_from_knots = control_poses(time_s, scan.t_ns, motion)
    return None if stamp_from_knots is None else move_to_stamp(scan.xyz_m, time_s, stamp_from_knots)


class DeskewedSurvey:
    """A survey whose scans are free of the motion during their sweeps.

    A scan is left as recorded where its points carry no time, where their times cannot be those of one sweep, or where
    the sensor's motion is not known for all of its sweep and its stamp: motion is never extrapolated. Each is counted.

    Parameters
    ----------
    survey : object
        As `survey.open_survey` yields it.
    motion : trajectory.SensorMotion
    """

    def __init__(self, survey, motion):
        self._survey, self._motion = survey, motion

    @property
    def planar(self):
        """Whether the sensor measures in one plane only."""
        return self._survey.planar

    @property
    def sweep_times(self):
        """How the clouds tell when each point was measured, a point_times.TimeConvention, or None."""
        return self._survey.sweep_times

    def stamps(self):
        """Return the stamps of all clouds, (n,) int64, in scan_id order."""
        return self._survey.stamps()

    def pose_edges(self):
        """Return the chain of transforms whose product is world_from_sensor, a list of tf_tree.FrameEdge."""
        return self._survey.pose_edges()

    def scans(self, wanted):
        """Iterate over the scans asked for like the survey itself, each with its points at its stamp."""
        counts, farthest_m = dict.fromkeys(("moved", "untimed", "unknown"), 0), 0.0
        for scan in self._survey.scans(wanted):
            outcome, moved = self._moved(scan)
            counts[outcome] += 1
            if outcome == "moved":
                farthest_m = max(farthest_m, _farthest_m(scan.xyz_m, moved.xyz_m))
            yield moved
        self._tell(counts, farthest_m)

    def _moved(self, scan):
        if scan.time_s is None or len(scan.xyz_m) == 0:
            return "untimed", scan
        xyz_m = deskew_scan(scan, self._motion)
        return ("unknown", scan) if xyz_m is None else ("moved", replace(scan, xyz_m=xyz_m))

    def _tell(self, counts, farthest_m):
        if self.sweep_times is None:
            return
        told = f"deskew: {counts['moved']} scans with points at their stamps, moved by at most {farthest_m:.3f} m"
        if self._motion.time_scale == 0:
            told = "deskew: scans left as recorded, as their points' times do not fit them"
        if counts["unknown"]:
            told += f"; {counts['unknown']} beyond the known motion left as recorded"
        if counts["untimed"]:
            limit = f"within {point_times.LONGEST_SWEEP_S} s"
            told += f"; {counts['untimed']} without points, or with times that are not {limit}, left as recorded"
        log.log_line(told)


def _farthest_m(before_m, after_m):
    """The largest way of a point, from every 16th of them."""
    moved = (after_m - before_m)[::16]
    return float(np.sqrt(np.einsum("ij,ij->i", moved, moved).max()))
