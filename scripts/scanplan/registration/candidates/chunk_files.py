"""Files between the jobs that register a long survey's chunks and the one that joins them.

Matrices are written number by number, so that nothing is rounded on the way.
"""

import json
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from scanplan.errors import StageError
from scanplan.registration.candidates.registered_candidates import (
    RegisteredCandidates,
    expect_damaged,
    read_candidates,
)
from scanplan.registration.constraints import PoseConstraint
from scanplan.registration.icp import IcpResult
from scanplan.registration.sequential import ScanResult
from scanplan.store import schemas, tables
from scanplan.store.scan_cache import ScanCache
from scanplan.types import Array, Columns, FilePath, FloatArray, IntArray, Settings

_DROPPED, _REPEATED = "n_dropped", "n_repeated"
_FAULTS = "faults"


class ChunkFiles(NamedTuple):
    """The files of a chunk: results, constraints, points of kept candidates, and those thinned."""

    candidates: FilePath
    constraints: FilePath
    points: FilePath
    thinned: FilePath


def write_chunk(files: ChunkFiles, found: RegisteredCandidates, thinned: ScanCache) -> None:
    """Write what joining the chunks needs of one.

    Parameters
    ----------
    found : registered_candidates.RegisteredCandidates
        The chunk's.
    thinned : scan_cache.ScanCache
        The thinned points of its kept candidates.
    """
    notes = {_DROPPED: json.dumps(found.n_dropped), _FAULTS: json.dumps(found.faults)}
    notes[_REPEATED] = json.dumps(found.n_repeated)
    columns = _candidate_columns(found.survey.scan_ids, found.results)
    tables.write_table(
        files.candidates, schemas.CHUNK_CANDIDATES, columns, allow_empty=True, notes=notes
    )
    columns = _constraint_columns(found.edges)
    tables.write_table(files.constraints, schemas.CHUNK_CONSTRAINTS, columns, allow_empty=True)
    kept_ids = found.survey.scan_ids[found.kept]
    planar = found.survey.planar
    _write_points(files.points, kept_ids, found.read_points(found.kept), planar=planar)
    _write_points(files.thinned, kept_ids, thinned.part(range(len(thinned))), planar=planar)


def read_chunks(
    chunks: Sequence[ChunkFiles], poses: FilePath, thinned: ScanCache, reading: Settings
) -> RegisteredCandidates:
    """Join the chunks of a survey.

    Parameters
    ----------
    chunks : sequence of ChunkFiles
        Of all chunks, in their order.
    poses : path-like
        poses.parquet.
    thinned : scan_cache.ScanCache
        Empty; left with the thinned points of the kept candidates.
    reading : dict
        Keywords of `survey.open_survey`.

    Raises
    ------
    StageError
        If they are not the chunks of this survey, or more of it is damaged.
    """
    planar = _open_points(chunks[0].points).planar
    survey = read_candidates(poses, planar=planar)
    damaged = expect_damaged(len(survey.scan_ids), reading)
    scan_results: list[ScanResult] = []
    edges: list[PoseConstraint] = []
    ids_of_chunk: list[IntArray] = []
    n_dropped = n_repeated = 0
    for files in chunks:
        columns = tables.read_table(files.candidates, schemas.CHUNK_CANDIDATES, allow_empty=True)
        notes = tables.read_notes(files.candidates, schemas.CHUNK_CANDIDATES)
        ids_of_chunk.append(columns["scan_id"])
        scan_results += _read_results(columns)
        edges += _read_constraints(files.constraints)
        n_dropped += json.loads(notes[_DROPPED])
        n_repeated += json.loads(notes.get(_REPEATED, "0"))
        for fault in json.loads(notes[_FAULTS]):
            damaged.leave_out(fault)
        for _, xyz_m in _open_points(files.thinned).scans():
            thinned.add(xyz_m)
    if not np.array_equal(np.concatenate(ids_of_chunk), survey.scan_ids):
        raise StageError(f"{poses}: the chunks are of other candidates; {tables.RERUN_ALL}")

    def read_points(rows: IntArray) -> Iterator[FloatArray]:
        wanted = survey.scan_ids[rows]
        for files, ids in zip(chunks, ids_of_chunk, strict=True):
            of_chunk = wanted[np.isin(wanted, ids)]
            yield from (xyz_m for _, xyz_m in _open_points(files.points).scans(of_chunk))

    return RegisteredCandidates(
        survey=survey,
        results=scan_results,
        edges=edges,
        read_points=read_points,
        n_dropped=n_dropped,
        n_repeated=n_repeated,
        faults=damaged.faults,
        damage=damaged.describe(),
    )


def _candidate_columns(scan_ids: IntArray, scan_results: Sequence[ScanResult]) -> dict[str, Array]:
    return {
        "scan_id": scan_ids,
        "kept": np.array([result.kept for result in scan_results], bool),
        "reason": np.array([result.reason for result in scan_results], object),
        "prior_fitness": np.array([result.prior_fitness for result in scan_results], float),
        "refined_fitness": np.array([result.refined_fitness for result in scan_results], float),
        "rmse_m": np.array([result.rmse_m for result in scan_results], float),
        "world_from_sensor": _pack_matrices(result.world_from_sensor for result in scan_results),
    }


def _read_results(columns: Columns) -> list[ScanResult]:
    poses = _unpack_matrices(columns["world_from_sensor"], 4)
    outcomes = _iterate_rows(columns, "kept", "reason")
    figures = _iterate_rows(columns, "prior_fitness", "refined_fitness", "rmse_m")
    return [
        ScanResult(kept, reason, pose, *numbers)
        for (kept, reason), pose, numbers in zip(outcomes, poses, figures, strict=True)
    ]


def _constraint_columns(edges: Sequence[PoseConstraint]) -> dict[str, Array]:
    fits = [edge.fit for edge in edges]
    return {
        "constraint": np.arange(len(edges)),
        "source": np.array([edge.source for edge in edges], int),
        "target": np.array([edge.target for edge in edges], int),
        "kind": np.array([edge.kind for edge in edges], object),
        "fitness": np.array([edge.fitness for edge in edges], float),
        "rmse_m": np.array([edge.rmse_m for edge in edges], float),
        "target_from_source": _pack_matrices(fit.target_from_source for fit in fits),
        "information": _pack_matrices(fit.information for fit in fits),
        "unobservable": np.array([fit.n_unobservable for fit in fits], int),
        "sound": np.array([fit.sound for fit in fits], bool),
    }


def _read_constraints(path: FilePath) -> list[PoseConstraint]:
    columns = tables.read_table(path, schemas.CHUNK_CONSTRAINTS, allow_empty=True)
    motions = _unpack_matrices(columns["target_from_source"], 4)
    information = _unpack_matrices(columns["information"], 6)
    states = _iterate_rows(columns, "unobservable", "sound")
    fits = [
        IcpResult(motion, inverse, *state)
        for motion, inverse, state in zip(motions, information, states, strict=True)
    ]
    measured = _iterate_rows(columns, "source", "target", "kind", "fitness", "rmse_m")
    return [PoseConstraint(*values, fit=fit) for values, fit in zip(measured, fits, strict=True)]


def _iterate_rows(columns: Columns, *names: str) -> Iterator[tuple[Any, ...]]:
    """Iterate over the values of some columns, row by row."""
    return zip(*(columns[name].tolist() for name in names), strict=True)


def _pack_matrices(matrices: Iterable[FloatArray]) -> Array:
    """Return the bytes of matrices of float64, row by row: (n,) object."""
    packed = [np.ascontiguousarray(matrix, float).tobytes() for matrix in matrices]
    return np.array([*packed, None], object)[:-1]


def _unpack_matrices(packed: Array, n: int) -> FloatArray:
    """Return the matrices (m, n, n) that `_pack_matrices` packed."""
    return np.frombuffer(b"".join(packed)).reshape(-1, n, n).copy()


def _write_points(
    path: FilePath, scan_ids: IntArray, scans_xyz_m: Iterable[FloatArray], *, planar: bool
) -> None:
    with tables.open_scan_writer(
        path, planar=planar, schema=schemas.CHUNK_POINTS, allow_empty=True
    ) as write_scan:
        for scan_id, xyz_m in zip(scan_ids, scans_xyz_m, strict=True):
            # of poses that are taken as they are given no point is thinned
            if len(xyz_m):
                write_scan(scan_id, xyz_m)


def _open_points(path: FilePath) -> tables.ScanStore:
    return tables.ScanStore(path, schemas.CHUNK_POINTS, allow_empty=True)
