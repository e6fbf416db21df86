"""The gates of algorithm 3 against the fitness distance, which the thesis does not state (3.5)."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from scanplan.geometry import se3
from scanplan.registration import constraints, icp, prepared_clouds
from scanplan.registration.constraints import PlacedScan
from scanplan.registration.frame_sequence import FrameRegistrar
from scanplan.registration.registration_settings import FRAMES, SequentialSettings
from scanplan.registration.sequential import ScanRegistrar, ScanResult, SequentialRegistrar
from scanplan.types import Array, Columns, FloatArray, IntArray

BY_FRAMES, BY_RETAINED, BY_NEAR_PAIRS = "frames", "retained", "frames, pairs within 0.1 m"
"""The previous 5 frames; the previous 5 retained; the first with pairs as the preset has them."""
PAIRED_METHODS = ("point_to_point", "point_to_plane", "gicp")
_DISTANCES_M = (0.4, 0.45, 0.5, 0.6, 0.8, 1.2)  # from next to none to most of the scans
_ASKED_POINTS = 1000  # of a scan: its fitness is known to half a per cent
_PAIR_DISTANCES_M = (0.1, 0.5)  # as the preset has pairs; near the thesis's 2 %
_MOST_PAIRS = 40  # of successive scans, over the whole drive
# the reading by retained scans knows no new starts and no limit of a correction
_WITHOUT_LIMITS = {
    "compare_with": BY_RETAINED,
    "icp_targets": 1,
    "icp_targets_planar": 1,
    "previous_apart_m": np.inf,
    "previous_turn_deg": np.inf,
    "min_facing_fitness": 0.0,
    "max_correction_m": np.inf,
    "max_correction_deg": np.inf,
    "localiser_sigma_m": 1000.0,
    "localiser_sigma_deg": 180.0,
    "localiser_sigma_tilt_deg": 180.0,
    "anchor_after": np.inf,
    "anchor_apart_m": np.inf,
}


@dataclass(frozen=True)
class Gate:
    """A reading of algorithm 3 and a fitness distance in metres."""

    reading: str
    distance_m: float


def list_gates() -> list[Gate]:
    """Return all that are compared."""
    readings = (BY_FRAMES, BY_NEAR_PAIRS, BY_RETAINED)
    return [Gate(reading, distance_m) for reading in readings for distance_m in _DISTANCES_M]


def make_registrar(gate: Gate, preset: SequentialSettings, *, planar: bool) -> ScanRegistrar:
    """Return algorithm 3 with a gate, on a part of the points."""
    near_m = list(preset.icp_distances_m)
    limits = replace(
        preset,
        compare_with=FRAMES,
        fitness_distance_m=gate.distance_m,
        fitness_points=_ASKED_POINTS,
        icp_distances_m=near_m if gate.reading == BY_NEAR_PAIRS else [gate.distance_m],
    )
    if gate.reading == BY_RETAINED:
        return SequentialRegistrar(replace(limits, **_WITHOUT_LIMITS), planar)
    return FrameRegistrar(limits, planar)


def pass_gates(
    gates: Sequence[Gate],
    candidates: Iterable[tuple[PlacedScan, FloatArray]],
    preset: SequentialSettings,
    planar: bool,
) -> list[list[ScanResult]]:
    """Pass the candidates through several gates, each prepared once.

    Parameters
    ----------
    candidates : iterable of (constraints.PlacedScan, (4, 4) float64)
        As `place_candidates` yields them, at the localiser's poses.

    Returns
    -------
    list of list of sequential.ScanResult
        Of every gate, of every candidate.
    """
    registrars = [make_registrar(gate, preset, planar=planar) for gate in gates]
    results: list[list[ScanResult]] = [[] for _ in gates]
    for scan, level in candidates:
        for registrar, of_gate in zip(registrars, results, strict=True):
            of_gate.append(registrar.register_scan(scan, level)[0])
    return results


def place_candidates(
    clouds_m: Iterable[Array],
    scan_ids: IntArray,
    poses: FloatArray,
    preset: SequentialSettings,
    *,
    planar: bool,
) -> Iterator[tuple[PlacedScan, FloatArray]]:
    """Yield thinned scans (n, 3) in the sensor's frame at given poses, with level_from_sensor."""
    for scan_id, xyz_m, pose in zip(scan_ids.tolist(), clouds_m, poses, strict=True):
        level = constraints.level_pose(pose, planar=planar)
        thinned_m = constraints.thin_scan(xyz_m, level, planar, preset)
        yield (
            constraints.place_scan(scan_id, thinned_m, pose, level, planar=planar, settings=preset),
            level,
        )


def gate_columns(
    gates: Sequence[Gate],
    results: Sequence[Sequence[ScanResult]],
    scan_ids: IntArray,
    places_m: FloatArray,
) -> Columns:
    """Return the columns of `thesis_schemas.GATES`; `places_m` (n, 2) are true positions."""
    n_scans = len(scan_ids)
    every = [result for of_gate in results for result in of_gate]
    columns = {
        "reading": np.repeat(np.array([gate.reading for gate in gates], object), n_scans),
        "distance_m": np.repeat([gate.distance_m for gate in gates], n_scans),
        "scan_id": np.tile(scan_ids, len(gates)),
        "passed": np.array([result.reason != "low_prior_fitness" for result in every]),
        "kept": np.array([result.kept for result in every]),
        "x_m": np.tile(places_m[:, 0], len(gates)),
        "y_m": np.tile(places_m[:, 1], len(gates)),
    }
    order = np.lexsort((columns["scan_id"], columns["distance_m"], columns["reading"].astype(str)))
    return {name: values[order] for name, values in columns.items()}


def choose_pairs(n_scans: int) -> IntArray:
    """Return the rows of the first of some pairs of successive scans, evenly over the drive."""
    n_pairs = min(_MOST_PAIRS, n_scans - 1)
    return np.unique(np.linspace(0, n_scans - 2, n_pairs).round().astype(np.int64))


def align_pairs(
    pairs: Iterable[tuple[PlacedScan, PlacedScan]], preset: SequentialSettings
) -> Columns:
    """Align pairs of scans (target, source) that are where they truly are.

    Returns
    -------
    dict of str to (m,) array
        The columns of `thesis_schemas.ALIGNMENTS`; those that cannot be aligned are left out.
    """
    rows = [
        row
        for target, source in pairs
        for method in PAIRED_METHODS
        for distance_m in _PAIR_DISTANCES_M
        for row in _align_pair(target, source, method, distance_m, preset)
    ]
    rows.sort(key=lambda row: (row["method"], row["distance_m"]))
    return {name: np.array([row[name] for row in rows]) for name in rows[0]} if rows else {}


def _align_pair(
    target: PlacedScan,
    source: PlacedScan,
    method: str,
    distance_m: float,
    preset: SequentialSettings,
) -> list[dict[str, Any]]:
    true_step = constraints.relative_pose(source, target)
    fit = icp.align_clouds(
        source.cloud,
        target.cloud,
        true_step,
        icp.IcpSettings(
            method=method, distances_m=[distance_m], max_iterations=preset.icp_max_iterations
        ),
    )
    if not fit.sound:
        return []
    error = se3.invert_pose(true_step) @ fit.target_from_source
    row = {
        "method": method,
        "distance_m": distance_m,
        "source": source.scan_id,
        "target": target.scan_id,
        "true_step_m": float(np.linalg.norm(true_step[:3, 3])),
        "step_m": float(np.linalg.norm(fit.target_from_source[:3, 3])),
        "error_m": float(np.linalg.norm(error[:3, 3])),
        "true_fitness": _fitness(source, target, true_step, distance_m),
        "fitness": _fitness(source, target, fit.target_from_source, distance_m),
    }
    return [row]


def _fitness(source: PlacedScan, target: PlacedScan, step: FloatArray, distance_m: float) -> float:
    return prepared_clouds.measure_overlap(source.cloud, target.cloud, step, distance_m=distance_m)[
        0
    ]
