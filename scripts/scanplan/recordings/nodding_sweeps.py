"""A 2-D laser on a mount that nods or turns, as a sensor in space: sweeps of a nod are one scan.

tf tells how the mount moves; odometry or the poses, how it was carried meanwhile.
"""

import zlib
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.recordings import frame_edges, topics
from scanplan.recordings.clouds import Scan
from scanplan.recordings.frame_edges import FrameEdge
from scanplan.recordings.integrity.damaged_clouds import DamagedClouds
from scanplan.recordings.motion import deskew, trajectory
from scanplan.recordings.recorded_survey import BagSurvey
from scanplan.recordings.survey_protocol import NamedChain, OfSurvey, Survey, TakenAtOnce
from scanplan.stage import log
from scanplan.types import FloatArray, IntArray

_LEAST_SWING = np.radians(20.0)  # of the mount: wheels on a ramp and hands tilt a laser by less
_MOST_REACH_M = 0.5  # of the laser on its mount: what goes farther is carried by a robot or a hand
_USUAL = (0.05, 0.95)  # of the mount's angles: the rest is how it came to begin
_MOST_ALONG = 0.5  # of an axis along the laser's own, about which its plane stays the same
_TURNS_BACK = 0.1  # of the swing: less is how a motor holds
_HALF_TURN = np.pi  # of a mount that goes round: its plane has seen everything
_MOST_GAP_S = 2.0  # as between poses


class Nods(NamedTuple):
    """How a mount moves.

    Attributes
    ----------
    n_edges : int
        So many of the last edges of a chain lead from what the mount is on to the laser.
    sweeps : list of (k,) int64
        The sweeps of each nod.
    mount_from_laser : (n, 4, 4) float64
        At each sweep; NaN where it is not known.
    axis : (3,) float64
        That it turns about, on what it is on.
    """

    n_edges: int
    sweeps: list[IntArray]
    mount_from_laser: FloatArray
    axis: FloatArray


def take_nods(survey: BagSurvey) -> Survey:
    """Return a survey as it is, or of nods where its laser is on a mount that nods or turns."""
    if survey.list_topics().cloud.msgtype not in topics.LASERS:
        return survey
    nods = None
    # what is wrong with poses is told where they are asked for
    with suppress(StageError):
        nods = find_nods(survey.pose_edges(), survey.stamps())
    return survey if nods is None else NoddingSweeps(survey, nods)


def find_nods(edges: Sequence[FrameEdge], t_ns: IntArray) -> Nods | None:
    """Return the nods of the mount at the end of a chain, None if its plane hardly turns.

    Parameters
    ----------
    edges : list of frame_edges.FrameEdge
        From the world to the laser.
    t_ns : (n,) int64
        Of the sweeps.
    """
    moving = [i for i, edge in enumerate(edges) if edge.t_ns is not None]
    if not moving:
        return None
    mount = edges[moving[-1] :]
    pose, _, covered = frame_edges.chain_poses(mount, t_ns, max_gap_s=_MOST_GAP_S)
    known = np.flatnonzero(covered)
    if len(known) < 3 or np.ptp(pose[known, :3, 3], axis=0).max() > _MOST_REACH_M:
        return None
    angle_rad, axis = _follow_angle(pose[known, :3, :3])
    swing_rad = float(np.ptp(np.quantile(angle_rad, _USUAL)))
    if swing_rad < _LEAST_SWING:
        return None
    sweeps: list[IntArray] = [known[begin:end] for begin, end in part_nods(angle_rad, swing_rad)]
    return Nods(len(mount), sweeps, pose, axis) if sweeps else None


def _follow_angle(turn: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the angle (n,) about the axis (3,) that a mount turns about, and this axis.

    The angle is zero if it is the laser's own.

    Parameters
    ----------
    turn : (n, 3, 3) float
        Of the laser on the mount.
    """
    step = np.swapaxes(turn[:-1], 1, 2) @ turn[1:]
    # the skew part of a small turn is its rotation vector
    skew = np.stack([step[:, 2, 1], step[:, 0, 2], step[:, 1, 0]], axis=1)
    skew -= np.stack([step[:, 1, 2], step[:, 2, 0], step[:, 0, 1]], axis=1)
    axis = np.linalg.eigh(skew.T @ skew)[1][:, -1]
    on_mount = (turn @ axis).mean(axis=0)
    on_mount /= np.linalg.norm(on_mount)
    if abs(axis[2]) > _MOST_ALONG:
        return np.zeros(len(turn)), on_mount
    along = skew @ axis / 2
    angle_rad = np.arctan2(along, (np.trace(step, axis1=1, axis2=2) - 1) / 2)
    return np.concatenate([[0.0], np.cumsum(angle_rad)]), on_mount


def part_nods(angle_rad: FloatArray, swing_rad: float) -> list[tuple[int, int]]:
    """Return where nods begin and end: where the angle (n,) turns back, or after half a turn.

    Those of less than half of the usual swing, as at the begin and the end, are left out.
    """
    begin, farthest = 0, 0
    ends = []
    for i, angle in enumerate(angle_rad.tolist()):
        gone = angle_rad[farthest] - angle_rad[begin]
        if (angle - angle_rad[farthest]) * (gone or angle - angle_rad[begin]) >= 0:
            farthest = i
        back = abs(angle - angle_rad[farthest])
        if back > _TURNS_BACK * swing_rad or abs(angle - angle_rad[begin]) >= _HALF_TURN:
            ends.append((begin, farthest + 1))
            begin = farthest
            farthest = i
    ends.append((begin, len(angle_rad)))
    swung = [np.ptp(angle_rad[begin:end]) for begin, end in ends]
    least = min(swing_rad, _HALF_TURN) / 2
    return [end for end, by in zip(ends, swung, strict=True) if by >= least]


class NoddingSweeps(TakenAtOnce, OfSurvey):
    """The nods of a laser; each is one scan, seen from where the laser is on the mount in the mean.

    The z axis of that place is what the mount turns about, as a scanner's is what its beams turn
    about: how many rays are sent up and down says nothing of a mount that nods.

    Parameters
    ----------
    survey : recorded_survey.BagSurvey
        The sweeps.
    """

    def __init__(self, survey: BagSurvey, nods: Nods) -> None:
        super().__init__(survey)
        self._nods = nods
        # the sweep at which a mount turns back is of two nods
        used = np.unique(np.concatenate(nods.sweeps))
        self._mean = np.eye(4)
        self._mean[:3, :3] = Rotation.align_vectors(nods.axis, [0, 0, 1])[0].as_matrix()
        self._mean[:3, 3] = nods.mount_from_laser[used, :3, 3].mean(axis=0)
        log.log_line(
            f"{survey.list_topics().cloud}: the mount of the laser nods or turns, by tf: of"
            f" {len(used):,} of {len(survey.stamps()):,} sweeps {len(nods.sweeps):,} scans in space"
            " are made, one of each nod"
        )

    def stamps(self) -> IntArray:
        """Return the stamps of all nods, (n,) int64: of the sweep in the middle of each."""
        return self._survey.stamps()[self._middle]

    @cached_property
    def _middle(self) -> IntArray:
        return np.array([sweeps[len(sweeps) // 2] for sweeps in self._nods.sweeps])

    def pose_edges(self) -> list[FrameEdge]:
        """Return the chain of transforms whose product is world_from_sensor."""
        return self._end_on_mount(self._survey.pose_edges())

    def _end_on_mount(self, edges: Sequence[FrameEdge]) -> list[FrameEdge]:
        carried = list(edges[: -self._nods.n_edges])
        parent = edges[-self._nods.n_edges].parent
        return [*carried, frame_edges.make_static_edge(parent, "nods", self._mean)]

    def motion_chains(self) -> list[NamedChain]:
        """Return all that states how the mount moved, the smoothest first and the poses last."""
        return [(name, self._end_on_mount(edges)) for name, edges in self._survey.motion_chains()]

    def scans(self, wanted: Iterable[int], damaged: DamagedClouds | None = None) -> Iterator[Scan]:
        """Iterate over the scans of the scan_ids in `wanted`, in scan_id order.

        Damaged sweeps are counted by themselves, not in `damaged`.
        """
        scan_ids = np.unique(np.fromiter(wanted, np.int64))
        if len(scan_ids) and not 0 <= scan_ids[0] <= scan_ids[-1] < len(self._middle):
            raise ValueError(f"there is no scan {scan_ids[-1]}")
        members = [self._nods.sweeps[scan_id] for scan_id in scan_ids.tolist()]
        asked = sorted({number for own in members for number in own.tolist()})
        sweeps = self._survey.scans(asked)
        waiting: dict[int, Scan] = {}
        for scan_id, own in zip(scan_ids.tolist(), members, strict=True):
            waiting = {number: sweep for number, sweep in waiting.items() if number >= own[0]}
            while not waiting or max(waiting) < own[-1]:
                sweep = next(sweeps)
                waiting[sweep.scan_id] = sweep
            yield self._join_sweeps(scan_id, [waiting[number] for number in own.tolist()])

    @cached_property
    def _motion(self) -> trajectory.SensorMotion:
        """How the laser itself moved, with its mount."""
        return trajectory.choose_motion(
            self._survey.motion_chains(), self._survey.stamps(), max_gap_s=_MOST_GAP_S
        )

    def _join_sweeps(self, scan_id: int, sweeps: Sequence[Scan]) -> Scan:
        middle = self._middle[scan_id]
        t_ns = int(self._survey.stamps()[middle])
        laser_from_mount = se3.invert_pose(self._nods.mount_from_laser[middle])
        parts = [np.empty((0, 3), np.float32)]
        n_dropped = sum(sweep.n_dropped for sweep in sweeps)
        for sweep in sweeps:
            at = self._motion.at([t_ns, sweep.t_ns])
            is_timed = sweep.time_s is not None and len(sweep.xyz_m) > 0
            xyz_m = deskew.deskew_scan(sweep, self._motion) if is_timed else sweep.xyz_m
            if at is None or xyz_m is None:
                n_dropped += len(sweep.xyz_m)
                continue
            world_from_nod = at[0] @ laser_from_mount @ self._mean
            moved = se3.invert_pose(world_from_nod) @ at[1]
            parts.append(se3.transform_points(moved, xyz_m).astype(np.float32))
        joined_m = np.ascontiguousarray(np.concatenate(parts))
        return Scan(scan_id, t_ns, joined_m, None, n_dropped, zlib.crc32(joined_m.data))
