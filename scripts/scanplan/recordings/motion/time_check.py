"""Holding what points' times say of a sweep against the points themselves.

Whether a driver lists the beams in the order it fired them, and stamps the scan with its first or its last, nobody
states, and some drivers do otherwise than their message type demands. The scans tell: where the sensor's turning
changes, neighbouring scans lie on each other only if each is freed of its motion in the right way.
"""

from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry import plane_scatter, se3
from scanplan.recordings.motion import deskew
from scanplan.stage import log

_WINDOW_S = 3.0
_MOST_WINDOWS, _SCANS_A_WINDOW, _POINTS_A_SCAN = 8, 10, 3000
_NEAREST_M, _FARTHEST_M = 0.3, 30.0
_RADIUS_M, _PLACES_A_WINDOW, _SEED = 0.2, 200, 1
# what the change of turning must move a point 5 m away by, for a scan to tell
_REACH_M, _LEAST_EFFECT_M = 5.0, 0.02
# another reading than the stated one must make surfaces this much crisper
_CLEARLY = 0.9
_FEWEST_PLACES = 100


@dataclass(frozen=True)
class TimeReading:
    """A way to read points' times: seconds after the stamp are `scale` times those stated, plus `shift_s`."""

    name: str
    scale: float
    shift_s: float


def list_time_readings(first_s, last_s):
    """Return the ways to read times that the driver states to run from `first_s` to `last_s`; as stated comes first."""
    other_end_s = (first_s - last_s) if abs(first_s) < abs(last_s) else (last_s - first_s)
    return [
        TimeReading("as stated", 1.0, 0.0),
        TimeReading("in reversed order", -1.0, first_s + last_s),
        TimeReading("with the stamp at the other end", 1.0, other_end_s),
        TimeReading("in reversed order with the stamp at the other end", -1.0, 0.0),
        TimeReading("not at all", 0.0, 0.0),
    ]


def check_point_times(survey, motion):
    """Return the motion with the reading of points' times that makes the survey's surfaces clearly crisper.

    Parameters
    ----------
    survey : object
        As `survey.open_survey` yields it.
    motion : trajectory.SensorMotion

    Returns
    -------
    trajectory.SensorMotion
        As given where the times are read best as stated, or nothing can be told.
    """
    if survey.sweep_times is None:
        return motion
    chosen = choose_turning_windows(survey.stamps(), motion)
    wanted = np.concatenate(chosen) if chosen else []
    scans = {
        scan.scan_id: _thinned(scan) for scan in survey.scans(wanted) if scan.time_s is not None
    }
    groups = [[scans[i] for i in window if i in scans and len(scans[i].xyz_m)] for window in chosen]
    groups = [group for group in groups if len(group) > 2]
    if not groups:
        log.log_line("times of points: the sensor's turning changes too little to check them")
        return motion
    best, told = choose_reading(groups, motion, planar=survey.planar)
    log.log_line(f"times of points are read {best.name}; surfaces by each reading: {told}")
    return replace(motion, time_scale=best.scale, time_shift_s=best.shift_s)


def choose_turning_windows(t_ns, motion):
    """Choose where the sensor's turning changes most.

    Parameters
    ----------
    t_ns : (n,) int64
        Stamps of the scans.
    motion : trajectory.SensorMotion

    Returns
    -------
    list of (k,) int64
        Indices of the scans of each window, at most `_SCANS_A_WINDOW`, which are within one piece of the motion.
    """
    found, ends = [], np.searchsorted(t_ns, t_ns + int(_WINDOW_S * 1e9))
    step = max(1, int(np.median(ends - np.arange(len(t_ns)))) // 2)
    for start in range(0, len(t_ns), step):
        window = np.arange(start, ends[start])
        pose = motion.at(t_ns[window]) if len(window) > 3 else None
        if pose is None or (np.diff(t_ns[window]) <= 0).any():
            continue
        gap_s = np.diff(t_ns[window]) / 1e9
        turn = se3.invert_pose(pose[:-1])[:, :3, :3] @ pose[1:, :3, :3]
        # the skew part of a small turn is its rotation vector
        rate = np.stack(
            [
                turn[:, 2, 1] - turn[:, 1, 2],
                turn[:, 0, 2] - turn[:, 2, 0],
                turn[:, 1, 0] - turn[:, 0, 1],
            ],
            1,
        )
        rate = rate / 2 / gap_s[:, None]
        effect_m = np.linalg.norm(rate.std(axis=0)) * np.median(gap_s) * _REACH_M
        if effect_m >= _LEAST_EFFECT_M:
            found.append((effect_m, window))
    best = sorted(found, key=lambda item: -item[0])
    apart = [w for i, (_, w) in enumerate(best) if not any(_overlap(w, v) for _, v in best[:i])][
        :_MOST_WINDOWS
    ]
    return [w[np.linspace(0, len(w) - 1, min(len(w), _SCANS_A_WINDOW)).astype(int)] for w in apart]


def choose_reading(groups, motion, *, planar):
    """Tell which reading of points' times makes surfaces crispest.

    Parameters
    ----------
    groups : list of list of clouds.Scan
        Neighbouring scans with times.
    motion : trajectory.SensorMotion
    planar : bool

    Returns
    -------
    Reading
        The one as stated, unless another is clearly better.
    told : str
        The crispness by each of them.
    """
    first_s = float(np.median([scan.time_s.min() for group in groups for scan in group]))
    last_s = float(np.median([scan.time_s.max() for group in groups for scan in group]))
    ways = list_time_readings(first_s, last_s)
    sigma_m = np.concatenate([_sigmas(group, ways, motion, planar) for group in groups], axis=1)
    sigma_m = sigma_m[:, np.isfinite(sigma_m).all(axis=0)]
    if sigma_m.shape[1] < _FEWEST_PLACES:
        return ways[0], f"only {sigma_m.shape[1]} places tell, too few"
    median_m = np.median(sigma_m, axis=1)
    best = int(np.argmin(median_m))
    told = ", ".join(f"{way.name} {1000 * m:.1f} mm" for way, m in zip(ways, median_m, strict=True))
    return ways[best if median_m[best] < _CLEARLY * median_m[0] else 0], told


def _sigmas(group, ways, motion, planar):
    """The spread across surfaces at the same places, by each of the readings: (ways, places)."""
    maps = [
        _merged(group, replace(motion, time_scale=w.scale, time_shift_s=w.shift_s)) for w in ways
    ]
    if any(m is None for m in maps):
        return np.empty((len(ways), 0))
    owners = np.concatenate([np.full(len(scan.xyz_m), scan.scan_id) for scan in group])
    chosen = {"planar": planar, "radius_m": _RADIUS_M}
    centres_m = plane_scatter.choose_places(
        maps[0], **chosen, most_places=_PLACES_A_WINDOW, seed=_SEED
    )
    return np.array(
        [
            plane_scatter.measure_scatter(xyz_m, owners, centres_m, **chosen).sigma_m
            for xyz_m in maps
        ]
    )


def _merged(group, motion):
    parts = []
    for scan in group:
        moved, pose = deskew.deskew_scan(scan, motion), motion.at([scan.t_ns])
        if moved is None or pose is None:
            return None
        parts.append(se3.transform_points(pose[0], moved))
    return np.concatenate(parts)


def _thinned(scan):
    """The scan with a random share of its points, neither the rover's own nor far ones, which turns move too much."""
    range_m = np.linalg.norm(scan.xyz_m, axis=1)
    (near,) = np.nonzero((range_m > _NEAREST_M) & (range_m < _FARTHEST_M))
    rng = np.random.default_rng([_SEED, scan.scan_id])
    taken = np.sort(rng.choice(near, min(len(near), _POINTS_A_SCAN), replace=False))
    return replace(scan, xyz_m=scan.xyz_m[taken], time_s=scan.time_s[taken])


def _overlap(one, other):
    return one[0] <= other[-1] and other[0] <= one[-1]
