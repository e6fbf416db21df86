"""Poses that are stamped later or earlier than the clouds: by how much, as turns show it.

Where the sensor begins or ceases to turn, neighbouring scans meet only if each is seen from where
the sensor was then.
"""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from scanplan.geometry import se3
from scanplan.recordings import candidates, scan_pairs
from scanplan.recordings.clouds import Scan
from scanplan.recordings.survey_protocol import Survey
from scanplan.stage import log
from scanplan.types import FloatArray, IntArray

if TYPE_CHECKING:
    from scipy.spatial import KDTree

MOST_S = 1.0
"""Clocks that are farther apart are told by times of receipt."""
LEAST_S = 0.15
"""Half a turn of a slow scanner, whose points have no times: less is not told from it."""
_STEP_S = 0.1  # at 30 degrees/s a wall 3 m away moves by 16 cm, within what points are matched by
_FINE_S = 0.02  # less moves it by 3 cm, the noise of ranges
_SHOWN_S = 0.5  # by so much of a delay pairs are chosen that show one
_SHOWN_M = 0.1  # that its turns have to move points 3 m away by
_APART_M = 0.5  # between the scans of a pair, which still overlap
_APART_DEG = 20.0
_MOST_PAIRS = 16
_EVERY = 3  # of the points of `thin_points`: all pairs have thousands, each asked 30 times
_FEWEST_PAIRS = 5
_FAR_M = 0.3  # a point without one so near is unmet, however far it is
_MEET_M = 0.15  # points of scans in place are less apart: 0.02 to 0.13 m in 27 sound surveys
_CLEARLY = 0.8  # share of the distance as stated that is left where a delay is right
_USUAL = 0.75  # share of the pairs that it is less in

PosesAt = Callable[[IntArray], FloatArray]


class _Pair(NamedTuple):
    target: "KDTree"
    source_m: FloatArray  # (n, 3)
    at_ns: IntArray  # (2,): in the middle of both sweeps


def find_delay_s(survey: Survey, poses_at: PosesAt, what: str) -> float:
    """Return how many seconds later than the clouds' the stamps of poses are, and log it.

    Parameters
    ----------
    poses_at : callable
        Returns the sensor's poses (m, 4, 4) at times (m,) of the poses' clock, NaN where not known.
    what : str
        What states the poses, for the log.

    Returns
    -------
    float
        0 where it is less than `LEAST_S`, more than `MOST_S`, or too few turns show it.
    """
    t_ns = survey.stamps()
    first = _choose_pairs(poses_at, t_ns)
    if len(first) < _FEWEST_PAIRS:
        return 0.0
    rows = np.unique(first)
    scans = {scan.scan_id: scan for scan in survey.scans(rows.tolist())}
    pairs = [
        _make_pair(scans[one], scans[other], planar=survey.planar)
        for one, other in first.tolist()
        if all(n in scans and len(scans[n].xyz_m) for n in (one, other))
    ]
    if len(pairs) < _FEWEST_PAIRS:
        return 0.0
    delay_s = choose_delay_s(pairs, poses_at)
    if delay_s:
        log.log_line(
            f"{what}: stamps are {abs(delay_s):.2f} s {'later' if delay_s > 0 else 'earlier'} than"
            " those of the clouds, by scans of turns: taken off them"
        )
    return delay_s


def choose_delay_s(pairs: Sequence[_Pair], poses_at: PosesAt) -> float:
    """Return the delay by which points of pairs lie nearest to one another; 0 of none clearly."""
    n_steps = round(MOST_S / _STEP_S) + 1  # beyond it: at the very end there is no least
    coarse_s = _STEP_S * np.arange(-n_steps, n_steps + 1)
    as_stated_m = _measure_apart(pairs, poses_at, 0.0, np.inf)
    stated = 0.0, as_stated_m
    best_s, best_m = _find_nearest(pairs, poses_at, coarse_s, stated, np.inf)
    if abs(best_s) > MOST_S:
        return 0.0
    most_m = min(_MEET_M, _CLEARLY * float(as_stated_m.mean()))
    n_fine = round(_STEP_S / _FINE_S)
    # up to the coarse ones beside it
    fine_s = best_s + _FINE_S * np.arange(1 - n_fine, n_fine)
    best_s, found_m = _find_nearest(pairs, poses_at, fine_s, (best_s, best_m), most_m)
    is_clear = found_m.mean() < most_m and (found_m < as_stated_m).mean() >= _USUAL
    return best_s if is_clear and abs(best_s) >= LEAST_S else 0.0


def _find_nearest(
    pairs: Sequence[_Pair],
    poses_at: PosesAt,
    delays_s: FloatArray,
    known: tuple[float, FloatArray],
    most_m: float,
) -> tuple[float, FloatArray]:
    """Return a delay that leaves points less than `most_m` apart, and less than a known one does.

    The least apart of all, and how far (pairs,): what is known where there is none.
    """
    for delay_s in delays_s.tolist():
        most_m = min(most_m, float(known[1].mean()))
        apart_m = _measure_apart(pairs, poses_at, delay_s, most_m)
        if apart_m.mean() < most_m:
            known = delay_s, apart_m
    return known


def _choose_pairs(poses_at: PosesAt, t_ns: IntArray) -> IntArray:
    """Return the scans (k, 2) between which a delay shows most."""
    poses = poses_at(t_ns)
    known = np.flatnonzero(np.isfinite(poses).all(axis=(1, 2)))
    if len(known) == 0:
        return np.empty((0, 2), int)
    apart = known[
        candidates.choose_candidates(
            poses[known], keep_every=len(known) + 1, max_step_m=_APART_M, max_turn_deg=_APART_DEG
        )
    ]
    if len(apart) < 2:
        return np.empty((0, 2), int)
    earlier, stated, later = (
        _moved_between(poses_at, t_ns[apart], by_s) for by_s in (-_SHOWN_S, 0.0, _SHOWN_S)
    )
    turned_rad = (se3.turn_between_rad(stated, other) for other in (earlier, later))
    shown_m = scan_pairs.ARM_M * np.fmax(*turned_rad)
    order = np.argsort(-shown_m, kind="stable")[:_MOST_PAIRS]
    order = np.sort(order[shown_m[order] > _SHOWN_M])
    return np.column_stack([apart[order], apart[order + 1]])


def _moved_between(poses_at: PosesAt, t_ns: IntArray, delay_s: float) -> FloatArray:
    """Return by a delay how the sensor moved from each of some times (n,) to the next."""
    poses = poses_at(t_ns + round(delay_s * 1e9))
    return se3.invert_pose(poses[:-1]) @ poses[1:]


def _make_pair(one: Scan, other: Scan, *, planar: bool) -> _Pair:
    """Return a pair of scans as if all their points were seen in the middle of their sweeps."""
    from scipy.spatial import KDTree  # 0.3 s, and few drives show a delay

    middle_s = [
        0.0 if scan.time_s is None else float(np.mean(scan.time_s)) for scan in (one, other)
    ]
    at_ns = np.array([one.t_ns, other.t_ns]) + np.round(1e9 * np.array(middle_s)).astype(np.int64)
    target_m = one.xyz_m[:, : 2 if planar else 3]
    return _Pair(KDTree(target_m), scan_pairs.thin_points(other.xyz_m), at_ns)


def _measure_apart(
    pairs: Sequence[_Pair], poses_at: PosesAt, delay_s: float, most_m: float
) -> FloatArray:
    """Return how far points of one scan lie from those of the other on average: (pairs,).

    Once it is clear that they lie more than `most_m` apart, other pairs are not looked at.
    """
    at_ns = np.concatenate([pair.at_ns for pair in pairs]) + round(delay_s * 1e9)
    poses = poses_at(at_ns)
    moved = se3.invert_pose(poses[::2]) @ poses[1::2]
    apart_m = np.full(len(pairs), _FAR_M)
    for i, pair in enumerate(pairs):
        if not np.isfinite(moved[i]).all():
            continue
        moved_m = se3.transform_points(moved[i], pair.source_m)[:, : pair.target.m]
        found_m, _ = pair.target.query(moved_m, distance_upper_bound=_FAR_M)
        apart_m[i] = np.minimum(found_m, _FAR_M).mean()
        if apart_m[: i + 1].sum() > most_m * len(pairs):
            break
    return apart_m
