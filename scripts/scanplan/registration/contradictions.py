"""Contradictions between a registration and the stated units, mounting and clock."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from scanplan.registration import joins, pauses, pose_lean, pose_scale
from scanplan.registration.drift import folds
from scanplan.registration.driven_map import DrivenMap
from scanplan.registration.misreading import NONE_MEETS, UNTRIED, Misreading
from scanplan.registration.sequential import OTHER_MAP, ScanResult
from scanplan.stage.witness_table import CUT, WITNESSES
from scanplan.stage.witnesses import Measured, state_witness
from scanplan.types import FloatArray, IntArray

_STILL = 1e-3  # metres, and of a turn radians: less than any localiser's noise
_UNASKED = ("too_few_points", "pose_gap", OTHER_MAP)
_FEET = 0.3048  # metres
_NEAR_FEET = 0.1  # of that: so few alignments are right where units differ
_ASKED = 10  # scans whose points tell how far walls are
_SURE = 2.0  # standard deviations of a scale
_ALL_BUT = (2.0, 98.0)  # percent of heights: a pose or two that err are no storey


def measure_standstill(priors: FloatArray, scan_results: Sequence[ScanResult]) -> Measured:
    """Return how many scans do not fit the others where all poses are the same.

    Parameters
    ----------
    priors : (n, 4, 4) float64
        World from sensor by the recorded poses, NaN without one.
    """
    poses = priors[np.isfinite(priors).all(axis=(1, 2))]
    n_left = sum(not r.kept for r in scan_results if r.reason not in _UNASKED)
    stands = n_left > 0 and np.ptp(poses, axis=0).max() <= _STILL
    return state_witness("standstill", n_left if stands else 0)


def measure_misfit(
    scan_results: Sequence[ScanResult],
    *,
    is_odometry: bool = False,
    find_cause: Callable[[], Misreading] = lambda: UNTRIED,
) -> Measured:
    """Return which share of the scans does not fit the others at their poses.

    Parameters
    ----------
    scan_results : sequence of sequential.ScanResult
        One per candidate.
    is_odometry : bool
        Whether the poses do not know where the robot is if it is carried.
    find_cause : callable
        Returns which reading lets scans meet, `UNTRIED` or `NONE_MEETS`; it is asked of scans that
        do not fit.
    """
    asked = [result for result in scan_results if result.reason not in _UNASKED]
    n_kept = sum(result.kept for result in asked)
    n_left = len(asked) - n_kept
    # one scan alone may be of a door that closed
    share = n_left / len(asked) if n_left > 1 else 0.0
    counts = {"n_kept": n_kept, "n_asked": len(asked)}
    found = state_witness("misfit", share, **counts)
    if not found.is_beyond:
        return found
    misread = find_cause()
    if misread not in (UNTRIED, NONE_MEETS):
        return state_witness("misread", share, **counts, **misread._asdict())
    carried = ", or the robot was carried" if is_odometry else ""
    return found.add(cause=f"{misread.cause}{carried}", remedy=misread.remedy)


def measure_repeats(n_repeated: int, n_asked: int) -> Measured:
    """Return how many candidates have the points of an earlier one."""
    return state_witness(
        "repeats", n_repeated / max(n_asked, 1), n_repeated=n_repeated, n_asked=n_asked
    )


def measure_map(driven: DrivenMap) -> list[Measured]:
    """Measure whether a map of a localiser's poses can be."""
    scan_ids, t_ns, optimised = driven.scan_ids, driven.t_ns, driven.optimised
    scale, sigma = pose_scale.estimate_scale(scan_ids, driven.recorded, optimised.edges)
    xyz_m = driven.world_from_sensor[:, :3, 3]
    lean = state_witness("lean", pose_lean.measure_lean_deg(xyz_m))
    height_m = float(np.ptp(np.percentile(xyz_m[:, 2], _ALL_BUT)))
    return [
        *_measure_jumps(driven.jumps, scan_ids, t_ns),
        _measure_scale(scale, sigma),
        pauses.measure_untied(scan_ids, t_ns, optimised),
        lean,
        # where the map leans heights say nothing
        state_witness("storeys", 0.0 if lean.is_beyond else height_m),
        *folds.measure_folds(driven.places, drifts=False, t_ns=t_ns),
    ]


def measure_ranges(scans_xyz_m: Iterable[FloatArray]) -> Measured:
    """Return how far half of the points of some scans, in the sensor's frame, are from it."""
    medians_m = [float(np.median(np.linalg.norm(xyz_m, axis=1))) for xyz_m in scans_xyz_m]
    return state_witness("far walls", float(np.median(medians_m)) if medians_m else np.nan)


def choose_some(rows: IntArray) -> IntArray:
    """Return a few rows of many, spread evenly."""
    return rows[:: -(-len(rows) // _ASKED) or 1]


def _measure_scale(scale: float, sigma: float) -> Measured:
    """Return the least error of a scale, and the unit that explains it."""
    off = float(np.clip(abs(scale - 1) - _SURE * sigma, 0.0, None))
    cause = "the scale of ranges or of poses is wrong"
    remedy = "calibrate both against a tape"
    for which, key, of in (("poses", "pose_unit", _FEET), ("ranges", "cloud_unit", 1 / _FEET)):
        if abs(scale / of - 1) <= _NEAR_FEET:
            cause, remedy = f"{which} are in feet", f"set advanced.input.{key}: ft"
    return state_witness("scale", off, scale=scale, sigma=sigma, cause=cause, remedy=remedy)


def _measure_jumps(
    jumps: Sequence[joins.MapJump], scan_ids: IntArray, t_ns: IntArray
) -> list[Measured]:
    """Return the longest and the widest of jumps."""
    found = []
    for name, sizes in (
        ("map jump", [jump.shift_m for jump in jumps]),
        ("map turn", [jump.turn_deg for jump in jumps]),
    ):
        if not sizes:
            found.append(state_witness(name, 0.0))
            continue
        worst = jumps[int(np.argmax(sizes))]
        after_s = float(t_ns[worst.row] - t_ns[0]) / 1e9
        n_jumps = int(np.sum(np.array(sizes) > WITNESSES[name].limit))
        found.append(
            state_witness(
                name,
                max(sizes),
                n_jumps=n_jumps,
                turn_deg=worst.turn_deg,
                after_s=after_s,
                scan_id=int(scan_ids[worst.row]),
                by=worst.by,
                remedy=_remedy_jump(worst.by, after_s),
            )
        )
    return found


def _remedy_jump(by: str, after_s: float) -> str:
    """Return the remedy of a map that jumps: odometry that goes on there, else a cut."""
    cut = CUT.format(after_s=after_s)
    if by != joins.ODOMETRY:
        return cut
    return f"set input.pose_topic to the odometry's, which goes on there, or {cut}"
