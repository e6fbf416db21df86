"""Checking the stated times of a sweep's points against the points themselves.

Whether a driver lists the beams in the order it fired them, and stamps the scan with its first or
its last, nobody states, and some drivers do otherwise than their message type demands. The scans
show it: where the sensor's turning changes, neighbouring scans lie on each other only if each is
deskewed in the right way.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry import plane_scatter, se3
from scanplan.recordings.clouds import Scan
from scanplan.recordings.motion import deskew
from scanplan.recordings.motion.trajectory import SensorMotion
from scanplan.recordings.survey_protocol import Survey
from scanplan.stage import log
from scanplan.types import BoolArray, FloatArray, IntArray

_WINDOW_S = 3.0  # a turn begins and ends within it, and the rover stays in a room
_MOST = 10  # windows, and scans of each: more are long decoded and seldom change the answer
_POINTS_A_SCAN = 3000  # some on every wall of a room
_RADIUS_M = 0.2  # of a place: less than the distance of two walls
_LEAST_EFFECT_RAD = 0.004  # the change of turning within a sweep: at 5 m the noise of a range
_CLEARLY = 0.9  # share of the scatter as stated that another reading must fall below
_PLACES_A_WINDOW = 200
_SEED = 1  # of the choice of points and places
_FEWEST_PLACES = 100  # of fewer the median scatters by more than that


@dataclass(frozen=True)
class TimeReading:
    """A way to read points' times: seconds after the stamp are `scale` * stated + `shift_s`."""

    name: str
    scale: float
    shift_s: float

    def apply_to(self, motion: SensorMotion) -> SensorMotion:
        """Return the motion with this reading of points' times."""
        return replace(motion, time_scale=self.scale, time_shift_s=self.shift_s)


def list_time_readings(first_s: float, last_s: float) -> list[TimeReading]:
    """Return the ways to read times that run, as stated, from `first_s` to `last_s`.

    The way as stated comes first.
    """
    other_end_s = (first_s - last_s) if abs(first_s) < abs(last_s) else (last_s - first_s)
    return [
        TimeReading("as stated", 1.0, 0.0),
        TimeReading("in reversed order", -1.0, first_s + last_s),
        TimeReading("with the stamp at the other end", 1.0, other_end_s),
        TimeReading("in reversed order with the stamp at the other end", -1.0, 0.0),
        TimeReading("not at all", 0.0, 0.0),
    ]


def check_point_times(survey: Survey, motion: SensorMotion) -> SensorMotion:
    """Return the motion with the reading of points' times that makes the surfaces thinnest.

    Returns
    -------
    trajectory.SensorMotion
        As given where no reading is clearly better than the stated one, or the scans do not show
        it.
    """
    if survey.sweep_times is None:
        return motion
    windows = choose_turning_windows(survey.stamps(), motion)
    groups = [group for group in _read_windows(survey, windows) if len(group) > 2]
    if not groups:
        log.log_line("times of points: the sensor's turning changes too little to check them")
        return motion
    best, scatters = choose_reading(groups, motion, planar=survey.planar)
    log.log_line(f"times of points are read {best.name}; surfaces by each reading: {scatters}")
    return best.apply_to(motion)


def _read_windows(survey: Survey, windows: Sequence[IntArray]) -> list[list[Scan]]:
    """Return the scans of each window that have points and times, thinned."""
    wanted = np.concatenate(windows).tolist() if windows else []
    scans = {
        scan.scan_id: thin_scan(scan) for scan in survey.scans(wanted) if scan.time_s is not None
    }
    filled = {scan_id: scan for scan_id, scan in scans.items() if len(scan.xyz_m)}
    return [[filled[i] for i in window.tolist() if i in filled] for window in windows]


def choose_turning_windows(t_ns: IntArray, motion: SensorMotion) -> list[IntArray]:
    """Choose where the sensor's turning changes most.

    Parameters
    ----------
    t_ns : (n,) int64
        Stamps of the scans.

    Returns
    -------
    list of (k,) int64
        Indices of the scans of each window, at most `_MOST`, which are within one piece
        of the motion.
    """
    windows = []
    for window in list_windows(t_ns):
        effect_rad = _turning_effect_rad(t_ns[window], motion)
        if effect_rad >= _LEAST_EFFECT_RAD:
            windows.append((effect_rad, window))
    windows.sort(key=lambda item: -item[0])
    apart: list[IntArray] = []
    for rank, (_, window) in enumerate(windows):
        if not any(_overlap(window, better) for _, better in windows[:rank]):
            apart.append(window)
    return [spread_scans(window) for window in apart[:_MOST]]


def list_windows(t_ns: IntArray) -> list[IntArray]:
    """Return the scans of windows of some seconds, each of which begins in the middle of another.

    Parameters
    ----------
    t_ns : (n,) int64
        Stamps of the scans.
    """
    ends = np.searchsorted(t_ns, t_ns + int(_WINDOW_S * 1e9))
    step = max(1, int(np.median(ends - np.arange(len(t_ns)))) // 2)
    return [np.arange(start, ends[start]) for start in range(0, len(t_ns), step)]


def _turning_effect_rad(t_ns: IntArray, motion: SensorMotion) -> float:
    """Return by how much turning between scans (n,) changes; 0 where it is not known."""
    pose = motion.at(t_ns) if len(t_ns) > 3 else None
    gap_s = np.diff(t_ns) / 1e9
    if pose is None or (gap_s <= 0).any():
        return 0.0
    turn = se3.invert_pose(pose[:-1])[:, :3, :3] @ pose[1:, :3, :3]
    # the skew part of a small turn is its rotation vector
    skew = np.stack(
        [
            turn[:, 2, 1] - turn[:, 1, 2],
            turn[:, 0, 2] - turn[:, 2, 0],
            turn[:, 1, 0] - turn[:, 0, 1],
        ],
        axis=1,
    )
    rate = skew / 2 / gap_s[:, None]
    return float(np.linalg.norm(rate.std(axis=0)) * np.median(gap_s))


def _overlap(one: IntArray, other: IntArray) -> bool:
    return bool(one[0] <= other[-1] and other[0] <= one[-1])


def spread_scans(window: IntArray) -> IntArray:
    """Return at most `_MOST` scans of a window (n,), evenly."""
    n = min(len(window), _MOST)
    return window[np.linspace(0, len(window) - 1, n).astype(int)]


def choose_reading(
    groups: Sequence[Sequence[Scan]], motion: SensorMotion, *, planar: bool
) -> tuple[TimeReading, str]:
    """Return the reading of points' times that makes surfaces thinnest.

    Parameters
    ----------
    groups : list of list of clouds.Scan
        Neighbouring scans with times.

    Returns
    -------
    reading : TimeReading
        The one as stated, unless another is clearly better, over all and in most groups: where
        a localiser jumps any reading may be.
    scatters : str
        The median scatter across surfaces by each of them, in the groups that were measured: once
        no reading can be clearly better any more, the others are not.
    """
    times_s = [scan.time_s for group in groups for scan in group if scan.time_s is not None]
    first_s = float(np.median([time_s.min() for time_s in times_s]))
    last_s = float(np.median([time_s.max() for time_s in times_s]))
    readings = list_time_readings(first_s, last_s)
    of_groups: list[FloatArray] = []
    for group in groups:
        sigma_m = _measure_scatters(group, readings, motion, planar)
        of_groups.append(sigma_m[:, np.isfinite(sigma_m).all(axis=0)])
        n_places = sum(measured.shape[1] for measured in of_groups)
        if n_places >= _FEWEST_PLACES and _is_settled(of_groups, len(groups)):
            break
    sigma_m = np.concatenate(of_groups, axis=1)
    n_places = sigma_m.shape[1]
    if n_places < _FEWEST_PLACES:
        return readings[0], f"only {n_places} places to compare, too few"
    median_m = np.median(sigma_m, axis=1)
    best = int(np.argmin(median_m))
    scatters = ", ".join(
        f"{reading.name} {1000 * m:.1f} mm" for reading, m in zip(readings, median_m, strict=True)
    )
    is_clear = median_m[best] < _CLEARLY * median_m[0] and _is_usual(of_groups, best)
    return readings[best if is_clear else 0], scatters


def _is_usual(of_groups: Sequence[FloatArray], reading: int) -> bool:
    """Return whether a reading's surfaces are thinner than as stated in three of four groups.

    Of ten, as likely one way as the other, eight or more agree five times in a hundred.
    """
    return bool(np.mean(_are_thinner(of_groups)[:, reading]) > 3 / 4)


def _is_settled(of_groups: Sequence[FloatArray], n_groups: int) -> bool:
    """Return whether no reading can become usual any more, whatever the other groups show."""
    n_thicker = (~_are_thinner(of_groups)).sum(axis=0)
    return bool((n_thicker >= n_groups / 4).all())


def _are_thinner(of_groups: Sequence[FloatArray]) -> BoolArray:
    """Return in which groups with places (n, readings) surfaces are thinner than as stated."""
    medians_m = [np.median(sigma_m, axis=1) for sigma_m in of_groups if sigma_m.size]
    as_array = np.array(medians_m).reshape(len(medians_m), len(of_groups[0]))
    return as_array < as_array[:, :1]


def _measure_scatters(
    group: Sequence[Scan], readings: Sequence[TimeReading], motion: SensorMotion, planar: bool
) -> FloatArray:
    """Return the scatter across surfaces around points by each reading: (readings, points).

    Around the same points, wherever a reading moves them: a place that stays may be on a wall by
    one reading, on the floor by another, and floors are thinner.
    """
    maps = []
    for reading in readings:
        merged = merge_scans(group, reading.apply_to(motion))
        if merged is None:
            return np.empty((len(readings), 0))
        maps.append(merged)
    owners = np.concatenate([np.full(len(scan.xyz_m), scan.scan_id) for scan in group])
    rows = plane_scatter.choose_places(
        maps[0],
        planar=planar,
        radius_m=_RADIUS_M,
        most_places=_PLACES_A_WINDOW,
        seed=_SEED,
    )
    scatters = [
        plane_scatter.measure_scatter(xyz_m, owners, xyz_m[rows], planar=planar, radius_m=_RADIUS_M)
        for xyz_m in maps
    ]
    return np.array([scatter.sigma_m for scatter in scatters])


def merge_scans(group: Sequence[Scan], motion: SensorMotion) -> FloatArray | None:
    """Return the deskewed points of all scans in one frame, or None where the motion has gaps."""
    parts = []
    for scan in group:
        deskewed = deskew.deskew_scan(scan, motion)
        pose = motion.at([scan.t_ns])
        if deskewed is None or pose is None:
            return None
        parts.append(se3.transform_points(pose[0], deskewed))
    return np.concatenate(parts)


def thin_scan(scan: Scan) -> Scan:
    """Return the scan with a random share of its points."""
    rng = np.random.default_rng([_SEED, scan.scan_id])
    n_points = len(scan.xyz_m)
    rows = np.sort(rng.choice(n_points, min(n_points, _POINTS_A_SCAN), replace=False))
    time_s = None if scan.time_s is None else scan.time_s[rows]
    return replace(scan, xyz_m=scan.xyz_m[rows], time_s=time_s)
