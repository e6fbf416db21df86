"""What to say where the gates of algorithm 3 leave nothing: shares, and what would pass."""

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
    """Raise StageError if no frame but the first passes both gates; name a distance for some.

    Parameters
    ----------
    scan_results : sequence of sequential.ScanResult
        One per candidate.
    survey : batches.CandidateScans
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
    distance_m = find_passing_distance_m(
        survey, np.flatnonzero(is_compared | is_kept), read_points, limits
    )
    raise StageError(
        f"{where}: of {is_compared.sum()} scans {100 * share:.1f} % pass the first gate"
        f" (registration.min_prior_fitness {limits.min_prior_fitness:g} within fitness_distance_m"
        f" {limits.fitness_distance_m:g} m) and 0 % the second (min_refined_fitness"
        f" {limits.min_refined_fitness:g}); set registration.fitness_distance_m to"
        f" {distance_m:.2f}, with which about a tenth would pass, or leave config/thesis.yaml out"
    )


def find_passing_distance_m(
    survey: CandidateScans, frames: IntArray, read_points: ReadPoints, limits: SequentialSettings
) -> float:
    """Return the fitness distance, metres, at which a tenth of the frames pass both gates.

    As the localiser's poses have it; alignment makes fitness larger.

    Parameters
    ----------
    survey : batches.CandidateScans
    frames : (n,) int
        Rows of the candidates that have a pose and points, n >= 2.
    read_points : callable
        As of `check_any_survives`.
    limits : registration_settings.SequentialSettings
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
