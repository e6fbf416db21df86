"""Shares of frames at the gates of algorithm 3, and settings that some would pass."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from scanplan.errors import StageError
from scanplan.registration import constraints, prepared_clouds
from scanplan.registration.batches import CandidateScans
from scanplan.registration.constraints import PlacedScan
from scanplan.registration.registration_settings import FRAMES, SequentialSettings
from scanplan.registration.sequential import ScanResult
from scanplan.types import FilePath, FloatArray, IntArray

ReadPoints = Callable[[IntArray], Iterable[FloatArray]]
_MOST_ASKED = 40  # frames: a share of a tenth is known to a few per cent
_SOME = 0.1  # of the frames: "some", which is enough for a drive through a building
_STEP_M = 0.05  # distances are named in steps that one would set


def check_any_survives(
    scan_results: Sequence[ScanResult],
    survey: CandidateScans,
    read_points: ReadPoints,
    limits: SequentialSettings,
    where: FilePath,
) -> None:
    """Raise StageError if no frame but the first passes both gates; say what would let some pass.

    Parameters
    ----------
    scan_results : sequence of sequential.ScanResult
        One per candidate.
    read_points : callable
        `read_points(rows)` iterates over the points of these candidates.
    limits : registration_settings.SequentialSettings
        Of which `compare_with` is `FRAMES`; nothing is checked otherwise.
    where : path-like
        The recording.
    """
    is_compared = np.array([np.isfinite(result.prior_fitness) for result in scan_results], bool)
    is_kept = np.array([result.kept for result in scan_results], bool)
    if limits.compare_with != FRAMES or is_kept[is_compared].any() or not is_compared.any():
        return
    passes = [result.prior_fitness >= limits.min_prior_fitness for result in scan_results]
    share = np.mean(np.array(passes)[is_compared])
    frames = np.flatnonzero(is_compared | is_kept)
    distance_m = find_passing_distance_m(survey, frames, read_points, limits)
    raise StageError(
        f"{where}: of {is_compared.sum()} scans {100 * share:.1f} % pass the first gate"
        f" (registration.min_prior_fitness {limits.min_prior_fitness:g} within fitness_distance_m"
        f" {limits.fitness_distance_m:g} m) and 0 % the second (min_refined_fitness"
        f" {limits.min_refined_fitness:g}); {_advise(distance_m, survey.take(frames), limits)}"
    )


def _advise(distance_m: float, frames: CandidateScans, limits: SequentialSettings) -> str:
    """Return what to set where a tenth of the frames would pass at a distance.

    One beyond which scans show other rooms (`previous_apart_m`) is no remedy: any scan would fit.
    """
    leave_out = "leave config/thesis.yaml out"
    take_all = "set poses.keep_every to 1 in config/thesis.yaml, or leave that file out"
    if distance_m <= limits.previous_apart_m:
        return (
            f"set registration.fitness_distance_m to {distance_m:.2f}, with which about a tenth"
            f" would pass, or {leave_out}"
        )
    step_m = np.median(np.linalg.norm(np.diff(frames.priors[:, :3, 3], axis=0), axis=1))
    is_thinned = bool(np.median(np.diff(frames.scan_ids)) > 1)
    return (
        f"scans that lie {step_m:.1f} m apart show too little of one another for these limits"
        f" ({distance_m:.1f} m would do, at which rooms lie on other rooms);"
        f" {take_all if is_thinned else leave_out}"
    )


def find_passing_distance_m(
    survey: CandidateScans, frames: IntArray, read_points: ReadPoints, limits: SequentialSettings
) -> float:
    """Return the fitness distance, metres, at which a tenth of the frames pass both gates.

    As the localiser's poses have it; alignment makes fitness larger.

    Parameters
    ----------
    frames : (n,) int
        Rows of the candidates that have a pose and points, n >= 2.
    read_points : callable
        As of `check_any_survives`.
    """
    n_asked = min(_MOST_ASKED, len(frames) - 1)
    asked = np.unique(np.linspace(1, len(frames) - 1, n_asked).round().astype(int))
    share = max(limits.min_prior_fitness, limits.min_refined_fitness)
    needed_m = []
    for last in asked.tolist():
        rows = frames[max(0, last - limits.n_previous) : last + 1]
        *previous, scan = _place_scans(survey, rows, read_points, limits)
        distances_m = [
            prepared_clouds.measure_distances(
                scan.cloud,
                other.cloud,
                constraints.relative_pose(scan, other),
                n_probes=limits.fitness_points,
            )
            for other in previous
        ]
        needed_m.append(np.quantile(distances_m, share))
    return float(np.ceil(np.quantile(needed_m, _SOME) / _STEP_M) * _STEP_M)


def _place_scans(
    survey: CandidateScans, rows: IntArray, read_points: ReadPoints, limits: SequentialSettings
) -> list[PlacedScan]:
    """Return scans at the localiser's poses."""
    planar = survey.planar
    placed = []
    for row, xyz_m in zip(rows.tolist(), read_points(rows), strict=True):
        prior = survey.priors[row]
        level = constraints.level_pose(prior, planar=planar)
        thinned_m = constraints.thin_scan(xyz_m, level, planar, limits)
        scan_id = int(survey.scan_ids[row])
        placed.append(
            constraints.place_scan(scan_id, thinned_m, prior, level, planar=planar, settings=limits)
        )
    return placed
