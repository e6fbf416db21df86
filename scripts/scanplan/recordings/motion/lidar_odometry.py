"""Poses from the clouds alone, where none are recorded: LiDAR odometry.

Each cloud is aligned to those before it by KISS-ICP (Vizzo et al. 2023, "KISS-ICP: In defense of
point-to-point ICP"), an optional package. The poses drift; registration finds the loops.

KISS-ICP moves the points of a sweep by how the sensor moved from the last cloud to the one before:
what is wrong there goes into the next cloud, and on. So the motion ahead is the median of the last
few, and the clouds of what rolls are aligned once more, moved by the steady way that the first time
has found. In rooms that halves the errors of the motion and of the drift (measured on simulated
drives, against KISS-ICP's own prediction and one time).
"""

import itertools
from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3, twists
from scanplan.recordings import frame_edges
from scanplan.recordings.clouds import Scan
from scanplan.recordings.motion.deskew import DeskewedSurvey
from scanplan.recordings.motion.trajectory import SensorMotion
from scanplan.recordings.survey_protocol import Survey
from scanplan.stage import log
from scanplan.types import BoolArray, FloatArray, IntArray

if TYPE_CHECKING:
    from kiss_icp.kiss_icp import KissICP

WORLD = "map"
"""The frame of the poses: that of the rover at the first cloud, turned upright."""


def estimate_track(
    survey: Survey, mounting: Sequence[frame_edges.FrameEdge], missing: str
) -> frame_edges.FrameEdge:
    """Estimate how a rover moved from its clouds.

    Parameters
    ----------
    survey : survey_protocol.Survey
        All its scans are read.
    mounting : sequence of frame_edges.FrameEdge
        From the rover to the sensor, as far as it is known: it says where up is.
    missing : str
        Why there are no other poses, as the begin of an error.

    Returns
    -------
    frame_edges.FrameEdge
        The rover in `WORLD`: level and at one height where it rolls, as `is_rolling` has it.

    Raises
    ------
    StageError
        If the sensor is planar, KISS-ICP is not installed or loses the way, or no cloud has
        points.
    """
    if survey.planar:
        raise StageError(
            f"{missing}; 2-D scans alone do not say where they were taken: record the poses of a"
            " localiser, odometry (/odom), or slam_toolbox's /pose or /tf, run live or on this"
            " recording"
        )
    n_scans = len(survey.stamps())
    t_ns, first_from_sensor = _align_clouds(survey.scans(range(n_scans)), n_scans, missing)
    world_from_base = _move_base(t_ns, first_from_sensor, mounting)
    ground = "heights and tilts are kept"
    if is_rolling(t_ns, world_from_base):
        if survey.sweep_times is not None:
            motion = SensorMotion(
                t_ns,
                *se3.split_pose(steady_way(t_ns, first_from_sensor)),
                piece=np.zeros(len(t_ns), np.int32),
            )
            log.log_line("estimate_poses: once more, sweeps moved by the way so far")
            deskewed = DeskewedSurvey(survey, motion).scans(range(n_scans))
            at_stamps = (replace(scan, time_s=None) for scan in deskewed)
            t_ns, first_from_sensor = _align_clouds(at_stamps, n_scans, missing)
            world_from_base = _move_base(t_ns, first_from_sensor, mounting)
        world_from_base = se3.level_frame(world_from_base)
        world_from_base[:, 2, 3] = 0.0
        ground = "it rolls on a level floor: heights and tilts are taken for drift"
    way_m = np.linalg.norm(np.diff(world_from_base[:, :3, 3], axis=0), axis=1).sum()
    log.log_line(f"estimate_poses: {len(t_ns):,} clouds placed on {way_m:,.0f} m of way; {ground}")
    xyz_m, quat_xyzw = se3.split_pose(world_from_base)
    rows = np.column_stack([xyz_m, quat_xyzw])
    track, _ = frame_edges.make_track_edge(WORLD, "", t_ns, t_ns, rows)
    if track is None:
        raise StageError(f"{missing}; and no stamp of the clouds is usable; check the clocks")
    return track


def is_rolling(t_ns: IntArray, world_from_base: FloatArray) -> bool:
    """Return whether something moves on wheels over a level floor, by how its tilt changes.

    What is carried sways by degrees at every step; a rover's tilt changes by the odometry's noise
    alone, though that may add up.

    Parameters
    ----------
    t_ns : (n,) int64
        Increasing.
    world_from_base : (n, 4, 4) float64
    """
    # a step takes about half a second
    later = np.minimum(np.searchsorted(t_ns, t_ns + 500_000_000), len(t_ns) - 1)
    upright = world_from_base[:, :3, 2]
    cosine = np.einsum("ij,ij->i", upright, upright[later])
    sway_deg = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
    # what stands still tells nothing: half a second at a fifth of a metre a second
    way_m = np.linalg.norm(world_from_base[later, :3, 3] - world_from_base[:, :3, 3], axis=1)
    is_moving = way_m > 0.1
    if is_moving.any():
        sway_deg = sway_deg[is_moving]
    # noise is some tenths of a degree (measured in rooms); who walks sways by several
    return float(np.median(sway_deg)) < 1.0


def steady_track(track: frame_edges.FrameEdge) -> frame_edges.FrameEdge:
    """Return how a rover moved within sweeps, by its estimated track; what is carried as it is."""
    if track.t_ns is None:
        return track
    world_from_base = se3.pose_matrix(track.xyz_m, track.quat_xyzw)
    if not is_rolling(track.t_ns, world_from_base):
        return track
    xyz_m, quat_xyzw = se3.split_pose(steady_way(track.t_ns, world_from_base))
    return replace(track, xyz_m=xyz_m, quat_xyzw=quat_xyzw)


def steady_way(t_ns: IntArray, world_from_base: FloatArray) -> FloatArray:
    """Return the way of a rover that moves at each moment as it does for most of half a second.

    From cloud to cloud estimates jump, forth and back, by more than a rover moves between them; and
    points of a sweep are moved by what they say of it. Wheels go steadily. On the whole the way
    drifts farther than the estimates do.

    Parameters
    ----------
    t_ns : (n,) int64
        Increasing.
    world_from_base : (n, 4, 4) float64

    Returns
    -------
    (n, 4, 4) float64
        From the same first pose on, by the median of the velocities ahead, aside, and of the turn.
    """
    duration_s = np.diff(t_ns) / 1e9
    if not duration_s.any():
        return world_from_base
    steady = _steady_velocity(t_ns, world_from_base)
    moved = twists.twist_to_motion(steady * duration_s[:, None])
    # products of matrices drift off true rotations
    poses = itertools.accumulate(
        [world_from_base[0], *moved], lambda pose, motion: se3.nearest_rigid(pose @ motion)
    )
    return np.array(list(poses))


def _steady_velocity(t_ns: IntArray, world_from_base: FloatArray) -> FloatArray:
    """Return the twists a second (n - 1, 6) of `steady_way`; some time has to pass."""
    from scipy.ndimage import median_filter  # 0.2 s, and most recordings have poses

    duration_s = np.diff(t_ns) / 1e9
    step = se3.invert_pose(world_from_base[:-1]) @ world_from_base[1:]
    per_s = 1 / np.where(duration_s > 0, duration_s, np.inf)
    velocity = twists.motion_to_twist(step) * per_s[:, None]
    n_beside = round(0.25 / float(np.median(duration_s[duration_s > 0])))
    return median_filter(velocity, size=(2 * n_beside + 1, 1), mode="nearest")


def find_steady(track: frame_edges.FrameEdge, motion: SensorMotion, t_ns: IntArray) -> BoolArray:
    """Return during which sweeps it is known how a rover turned.

    Clouds say how it moved from one to the next: where a turn begins or ends within a sweep nothing
    says when, and points five metres away err by decimetres. What is carried turns all the time,
    and all of its sweeps are as good.

    Parameters
    ----------
    track : frame_edges.FrameEdge
        Estimated from the clouds.
    motion : trajectory.SensorMotion
        That points of sweeps are moved by. Where it is not the clouds', it knows more than these.
    t_ns : (n,) int64
        Stamps of the sweeps.

    Returns
    -------
    (n,) bool
    """
    is_steady = np.ones(len(t_ns), bool)
    if track.t_ns is None or len(track.t_ns) < 2 or not np.isin(motion.t_ns, track.t_ns).all():
        return is_steady
    world_from_base = se3.pose_matrix(track.xyz_m, track.quat_xyzw)
    if not is_rolling(track.t_ns, world_from_base):
        return is_steady
    turn_rad_s = _steady_velocity(track.t_ns, world_from_base)[:, 3:]
    # a median of half a second moves the begin of a turn by up to half of it, and a sweep of a
    # tenth lies before its stamp or after it; of slow scanners the steps beside
    begin_ns, near_ns = track.t_ns[:-1], 350_000_000
    inside = np.searchsorted(begin_ns, t_ns, side="right") - 1
    first = np.minimum(np.searchsorted(begin_ns, t_ns - near_ns), np.maximum(inside - 1, 0))
    last = np.maximum(np.searchsorted(begin_ns, t_ns + near_ns), inside + 2)
    for row, (low, high) in enumerate(zip(first.tolist(), last.tolist(), strict=True)):
        spread_rad_s = np.ptp(turn_rad_s[low:high], axis=0).max()
        # half a degree in a sweep: a scan's own walls bend by as much as its ranges err
        is_steady[row] = spread_rad_s < np.radians(5)
    return is_steady


def _start_odometry(missing: str) -> "KissICP":
    try:
        from kiss_icp.config import KISSConfig
        from kiss_icp.kiss_icp import KissICP
    except ImportError as error:
        raise StageError(
            f"{missing}; KISS-ICP estimates them from 3-D clouds, and cannot be read ({error}): run"
            " `make kiss-icp` (of a wheel: pip install 'scanplan[kiss-icp]'), or record the poses"
            " of a localiser or odometry"
        ) from error
    config = KISSConfig()
    # nearer returns are the rover's own body
    config.data.min_range = 0.5
    # rooms end within it, and what it takes for near where a turn begins grows with it
    config.data.max_range = 30.0
    # a quarter of a metre tells two walls of a narrow room apart; coarser, the way through rooms is
    # lost, finer takes four times as long (tried: 1.0, 0.5, 0.25, 0.1)
    config.mapping.voxel_size = 0.25
    # a millimetre: finer takes half as long again, and its way is no better (tried: 0.0001)
    config.registration.convergence_criterion = 0.001
    # sums in an order of their own would differ from run to run
    config.registration.max_num_threads = 1
    return KissICP(config)


def _align_clouds(scans: Iterable[Scan], n_scans: int, missing: str) -> tuple[IntArray, FloatArray]:
    """Align all clouds of a survey; what they say of the times of points is used.

    Returns
    -------
    t_ns : (n,) int64, n >= 1, strictly increasing
    first_from_sensor : (n, 4, 4) float64
    """
    scans = log.report_progress(scans, "estimate_poses", n_scans)
    t_ns, first_from_sensor = _align_scans(_start_odometry(missing), scans, missing)
    if len(t_ns) == 0:
        raise StageError(f"{missing}; and no cloud has points to estimate poses from; record again")
    t_ns, first = np.unique(t_ns, return_index=True)
    return t_ns, first_from_sensor[first]


def _move_base(
    t_ns: IntArray, first_from_sensor: FloatArray, mounting: Sequence[frame_edges.FrameEdge]
) -> FloatArray:
    """Return the poses (n, 4, 4) of what the sensor is mounted on, from its own first one."""
    base_from_sensor, _, _ = frame_edges.chain_poses(mounting, t_ns, max_gap_s=np.inf)
    return base_from_sensor[0] @ first_from_sensor @ se3.invert_pose(base_from_sensor)


def _align_scans(
    odometry: "KissICP", scans: Iterable[Scan], missing: str
) -> tuple[IntArray, FloatArray]:
    """Return the moments (n,) of the scans that have points, and first_from_sensor (n, 4, 4)."""
    moments_ns = []
    poses = []
    # of the last three, one may be wrong
    motions = deque(maxlen=3)
    for scan in scans:
        if len(scan.xyz_m) == 0:
            continue
        time_s = np.zeros(0) if scan.time_s is None else scan.time_s
        odometry.register_frame(scan.xyz_m.astype(np.float64), time_s)
        if not np.isfinite(odometry.last_pose).all():
            raise StageError(
                f"{missing}; and KISS-ICP loses the way at scan {scan.scan_id}, at"
                f" {scan.t_ns / 1e9:.3f} s; record poses, or cut the recording there"
            )
        # its products of matrices drift off true rotations, on a long way without bound
        odometry.last_pose = se3.nearest_rigid(odometry.last_pose)
        motions.append(twists.motion_to_twist(odometry.last_delta))
        odometry.last_delta = twists.twist_to_motion(np.median(motions, axis=0))
        # it moves points to where they would have been seen at the end of the sweep
        end_s = 0.0 if scan.time_s is None else float(scan.time_s.max())
        moments_ns.append(scan.t_ns + round(end_s * 1e9))
        poses.append(np.array(odometry.last_pose))
    order = np.argsort(moments_ns, kind="stable")
    return np.array(moments_ns, np.int64)[order], np.array(poses).reshape(-1, 4, 4)[order]
