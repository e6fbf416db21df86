"""Odometry in a pose graph: motions from scan to scan, each with the drift it may have."""

from collections.abc import Sequence

import numpy as np

from scanplan.geometry import se3, twists
from scanplan.registration.constraints import PoseConstraint
from scanplan.registration.graph_equations import MotionConstraints
from scanplan.registration.registration_settings import DriftSettings
from scanplan.types import BoolArray, FloatArray, IntArray

# of chi with two and three degrees of freedom; scipy.stats takes 0.4 s to say so
_MEDIANS = {2: 1.1774100225154749, 3: 1.5381722544550522}


def measure_way(odometry_from_cloud: FloatArray) -> FloatArray:
    """Return how far (n,) the sensor had come at each of its poses (n, 4, 4), metres."""
    step_m = np.linalg.norm(np.diff(odometry_from_cloud[:, :3, 3], axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(step_m)])


def chain_scans(
    scan_ids: IntArray, odometry_from_cloud: FloatArray, edges: Sequence[PoseConstraint]
) -> FloatArray:
    """Chain scans as they were aligned to one another, and by odometry where they were not.

    Parameters
    ----------
    scan_ids : (n,) int, increasing
    odometry_from_cloud : (n, 4, 4) float64
    edges : sequence of constraints.PoseConstraint
        From scans to those before them.

    Returns
    -------
    (n, 4, 4) float64
        world_from_cloud: the first scan where odometry has it.
    """
    row_of_scan = {int(scan_id): row for row, scan_id in enumerate(scan_ids)}
    latest: dict[int, PoseConstraint] = {}
    for edge in edges:
        if edge.source in row_of_scan and edge.target in row_of_scan:
            known = latest.get(edge.source)
            is_later = known is None or edge.target > known.target
            # a direction left open was filled by the poses of another batch
            if is_later and edge.fit.n_unobservable == 0:
                latest[edge.source] = edge
    world_from_cloud = np.array(odometry_from_cloud, float)
    for row in range(1, len(scan_ids)):
        edge = latest.get(int(scan_ids[row]))
        if edge is not None:
            before = world_from_cloud[row_of_scan[edge.target]]
            world_from_cloud[row] = before @ edge.fit.target_from_source
            continue
        step = se3.invert_pose(odometry_from_cloud[row - 1]) @ odometry_from_cloud[row]
        world_from_cloud[row] = world_from_cloud[row - 1] @ step
    return world_from_cloud


def measure_doubtful_way(
    scan_ids: IntArray, way_m: FloatArray, edges: Sequence[PoseConstraint]
) -> FloatArray:
    """Return the way (n,), metres, with what a scan adds that was aligned to none before it.

    There wheels slipped, the robot was carried, or nothing was seen: odometry may be anything.

    Parameters
    ----------
    scan_ids : (n,) int, increasing
    way_m : (n,) float
    edges : sequence of constraints.PoseConstraint
        From scans to those before them.
    """
    is_break = ~np.isin(scan_ids, [edge.source for edge in edges])
    is_break[0] = False
    # as much as a drive through a whole floor
    return way_m + 400.0 * np.cumsum(is_break)


def measure_steps(
    scan_ids: IntArray,
    odometry_from_cloud: FloatArray,
    edges: Sequence[PoseConstraint],
    drift: DriftSettings,
) -> MotionConstraints:
    """Return odometry's motions to the next scan as constraints, where alignments leave them open.

    Its errors are systematic: beside an alignment that determines the whole motion, however little
    it counted, it would bend the way by as much at every step. Along a corridor it says how far the
    sensor came, and where a scan was aligned to none before it, where it turned, too.

    Parameters
    ----------
    scan_ids : (n,) int, increasing
    odometry_from_cloud : (n, 4, 4) float64
    edges : sequence of constraints.PoseConstraint
        From scans to those before them.
    """
    whole = [edge.source for edge in edges if edge.fit.n_unobservable == 0]
    is_whole = np.isin(scan_ids, whole)
    motion = se3.invert_pose(odometry_from_cloud[:-1]) @ odometry_from_cloud[1:]
    source = np.flatnonzero(~is_whole[1:]) + 1
    information = _weigh_motions(motion, _are_linked(scan_ids, edges), drift)
    return MotionConstraints(source, source - 1, motion[source - 1], information[source - 1])


def constrain_placed_scans(
    scan_ids: IntArray,
    motion: FloatArray,
    edges: Sequence[PoseConstraint],
    drift: DriftSettings,
    *,
    planar: bool,
) -> MotionConstraints:
    """Return odometry's motions between scans that a localiser placed, too, as constraints.

    They count beside alignments, for the localiser bounds what their errors add up to: its own
    errors last for many scans, which in a room that is seen through its door alone nothing else
    tells. If they are farther off the alignments, in the median, than drift allows, as of wheels
    that are misscaled, all count for as much less.

    Parameters
    ----------
    scan_ids : (n,) int, increasing
    motion : (n - 1, 4, 4) float64
        Of each scan's cloud the pose of the next one by odometry; NaN where it does not know.
    edges : sequence of constraints.PoseConstraint
        From these scans to those before them.
    planar : bool
        Whether only shifts in the plane are aligned.
    """
    source = np.flatnonzero(np.isfinite(motion).all(axis=(1, 2))) + 1
    motion = motion[source - 1]
    information = _weigh_motions(motion, _are_linked(scan_ids, edges)[source - 1], drift)
    aligned = {
        (edge.source, edge.target): edge.fit.target_from_source[:3, 3]
        for edge in edges
        if edge.fit.n_unobservable == 0
    }
    ends = zip(scan_ids[source], scan_ids[source - 1], strict=True)
    shift_m = np.array([aligned.get(pair, [np.nan] * 3) for pair in ends]).reshape(-1, 3)
    n_free = 2 if planar else 3
    off_m = np.linalg.norm((motion[:, :3, 3] - shift_m)[:, :n_free], axis=1)
    off_sigmas = off_m * np.sqrt(information[:, 0, 0])
    off_sigmas = off_sigmas[np.isfinite(off_sigmas)]
    # half of normal errors are within so many standard deviations
    times = np.median(off_sigmas) / _MEDIANS[n_free] if len(off_sigmas) else 1.0
    return MotionConstraints(source, source - 1, motion, information / max(times, 1.0) ** 2)


def _are_linked(scan_ids: IntArray, edges: Sequence[PoseConstraint]) -> BoolArray:
    """Return which scans (n - 1,), the first left out, were aligned to one before them."""
    return np.isin(scan_ids, [edge.source for edge in edges])[1:]


def _weigh_motions(motion: FloatArray, is_linked: BoolArray, drift: DriftSettings) -> FloatArray:
    """Return the information (m, 6, 6) of odometry's motions; of turns where no scan shows them."""
    twist = twists.motion_to_twist(motion)
    way_m = np.linalg.norm(twist[:, :3], axis=1)
    turn_rad = np.linalg.norm(twist[:, 3:], axis=1)
    # encoders resolve a centimetre and a fifth of a degree: of a rover that stands, too
    sigma_m = np.hypot(0.01, drift.drift_share * way_m)
    drift_rad = np.radians(drift.drift_deg_per_m) * way_m + drift.drift_share * turn_rad
    sigma_rad = np.hypot(np.radians(0.2), drift_rad)
    information = np.zeros((len(motion), 6, 6))
    every = np.arange(3)
    information[:, every, every] = sigma_m[:, None] ** -2
    information[:, every + 3, every + 3] = np.where(is_linked, 0.0, sigma_rad**-2)[:, None]
    return information


def level_priors(world_from_cloud: FloatArray, odometry_from_cloud: FloatArray) -> FloatArray:
    """Return poses with the places and headings of some, and the heights and tilts of odometry.

    Wheels and gravity give these two without drift.

    Parameters
    ----------
    world_from_cloud, odometry_from_cloud : (n, 4, 4) float64
    """
    correction = world_from_cloud @ se3.invert_pose(odometry_from_cloud)
    turn_rad = np.arctan2(
        correction[:, 1, 0] - correction[:, 0, 1], correction[:, 0, 0] + correction[:, 1, 1]
    )
    planar = np.tile(np.eye(4), (len(correction), 1, 1))
    planar[:, 0, 0] = planar[:, 1, 1] = np.cos(turn_rad)
    planar[:, 1, 0] = np.sin(turn_rad)
    planar[:, 0, 1] = -planar[:, 1, 0]
    levelled = planar @ odometry_from_cloud
    levelled[:, :2, 3] = world_from_cloud[:, :2, 3]
    return levelled
