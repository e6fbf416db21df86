"""Candidates of a recorded survey, registered before the poses of all are optimised together.

All of them, or a chunk: the batches of some contiguous part of a long survey.
"""

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from scanplan.recordings.clouds import Scan
from scanplan.recordings.integrity.damaged_clouds import DamagedClouds
from scanplan.recordings.motion import pose_kind, trajectory
from scanplan.recordings.survey import Reading, open_survey
from scanplan.registration import batches, mapping
from scanplan.registration.batches import CandidateScans
from scanplan.registration.constraints import PoseConstraint
from scanplan.registration.registration_settings import (
    RegistrationSettings,
    registration_settings,
)
from scanplan.registration.sequential import ScanResult
from scanplan.stage import log, witnesses
from scanplan.store import pose_columns, schemas, tables
from scanplan.types import FilePath, FloatArray, IntArray, Settings


@dataclass(frozen=True)
class RecordedCandidates:
    """Candidates that have not been read.

    Attributes
    ----------
    recordings : list of str
        The dataset's files.
    reading : dict
        Keywords of `survey.open_survey`.
    poses : path-like
        poses.parquet: the candidates and their poses.
    moved : path-like, optional
        motion.parquet: how the sensor moved. Without it scans are not deskewed.
    """

    recordings: Sequence[str]
    reading: Settings
    poses: FilePath
    moved: FilePath | None = None


@dataclass(frozen=True)
class RegisteredCandidates:
    """What registration knows of candidates before it optimises their poses.

    Attributes
    ----------
    survey : batches.CandidateScans
        These candidates.
    results : list of sequential.ScanResult
        One per candidate.
    edges : list of constraints.PoseConstraint
        From kept ones to their predecessors, which may be of the chunk before.
    read_points : callable
        `read_points(rows)` iterates over the points (n, 3) float32, sensor frame, of kept ones.
    n_dropped : int
        Points that were not finite or out of range.
    n_repeated : int
        Candidates whose points were those of an earlier one, as they were recorded.
    faults : list of str
        What is wrong with each candidate that could not be decoded.
    damage : list of str
        What of the recordings could not be read, in sentences.
    """

    survey: CandidateScans
    results: list[ScanResult]
    edges: list[PoseConstraint]
    read_points: Callable[[IntArray], Iterable[FloatArray]]
    n_dropped: int
    n_repeated: int
    faults: list[str]
    damage: list[str]

    @property
    def kept(self) -> IntArray:
        """Rows (n,) of the candidates that are kept."""
        return find_kept(self.results)


def find_kept(scan_results: Sequence[ScanResult]) -> IntArray:
    """Return the rows (n,) of the candidates that are kept."""
    return np.flatnonzero([result.kept for result in scan_results])


def read_candidates(poses: FilePath, *, planar: bool) -> CandidateScans:
    """Return the candidates that a poses.parquet lists.

    Parameters
    ----------
    planar : bool
        Whether the sensor measures in one plane only.
    """
    columns = tables.read_table(poses, schemas.POSES)
    is_odometry = pose_kind.is_drifting(tables.read_note(poses, schemas.POSES, pose_kind.NOTE))
    priors = pose_columns.pose_matrices(columns)
    return CandidateScans(columns["scan_id"], priors, planar, is_odometry=is_odometry)


def read_known_stamps(poses: FilePath) -> dict[int, int] | None:
    """Return the candidates' stamps by scan_id where these are all that reading them again needs.

    Parameters
    ----------
    poses : path-like
        poses.parquet.
    """
    if tables.read_note(poses, schemas.POSES, schemas.AS_RECORDED) != "true":
        return None
    columns = tables.read_table(poses, schemas.POSES, ["scan_id", "t_ns"])
    return dict(zip(columns["scan_id"].tolist(), columns["t_ns"].tolist(), strict=True))


def read_settings(poses: FilePath, section: Settings) -> RegistrationSettings:
    """Return the settings of registration as they hold for a survey's kind of poses.

    Parameters
    ----------
    poses : path-like
        poses.parquet.
    section : dict
        Section `registration` of the settings.
    """
    found = registration_settings(section)
    kind = tables.read_note(poses, schemas.POSES, pose_kind.NOTE)
    return found.of_stations() if kind == pose_kind.STATIONS else found


def read_odometry(moved: FilePath, t_ns: IntArray) -> mapping.StepsBetween | None:
    """Return what was measured of the motion between candidates beside their poses.

    Parameters
    ----------
    moved : path-like
        motion.parquet.
    t_ns : (n,) int64
        Stamps of the candidates.

    Returns
    -------
    callable or None
        See `mapping.optimise_map`; None where the poses alone say how the sensor moved.
    """
    motion = read_motion(moved)
    if motion.of_poses:
        return None
    return lambda rows: motion.steps(t_ns[rows])


def read_smear(moved: FilePath) -> witnesses.Measured:
    """Return by how much thicker surfaces are in turns of motion.parquet."""
    smear_mm = tables.read_note(moved, schemas.MOTION, schemas.SMEAR_MM) or "nan"
    return witnesses.state_witness("smeared turns", float(smear_mm))


def expect_damaged(n_candidates: int, reading: Settings, begin: int = 0) -> DamagedClouds:
    """Return what counts the damaged clouds among a survey's candidates from a scan on.

    Parameters
    ----------
    n_candidates : int
        Of the whole survey.
    reading : dict
        Keywords of `survey.open_survey`.
    """
    return DamagedClouds(n_candidates, reading.get("max_damaged_share", 0.0), begin)


def register_recorded(
    recorded: RecordedCandidates,
    caches: mapping.CandidateCaches,
    run: Callable[..., Iterator[Any]],
    settings: RegistrationSettings,
    chunk: str | None = None,
) -> RegisteredCandidates:
    """Read candidates of a survey and register them one after the other.

    Parameters
    ----------
    caches : mapping.CandidateCaches
        Empty; left with the points of all scans that were read, and with the thinned points of the
        kept ones.
    run : callable
        As `workers.open_pool` gives it.
    chunk : str, optional
        Which batches, see `batches.cut_survey`; by default all.
    """
    motion = None if recorded.moved is None else read_motion(recorded.moved)
    with open_survey(
        recorded.recordings,
        Reading(**recorded.reading),
        motion=motion,
        known_t_ns=read_known_stamps(recorded.poses),
    ) as opened:
        survey = read_candidates(recorded.poses, planar=opened.planar)
        n_candidates = len(survey.scan_ids)
        cut = batches.cut_survey(n_candidates, settings, chunk)
        first, begin, end = (cut[0][0], cut[0][1], cut[-1][2]) if cut else (0, 0, 0)
        own = survey.take(np.arange(begin, end))
        own_begin = int(own.scan_ids[0]) if cut else 0
        # what those before are registered against is told by the chunk that they belong to
        damaged = expect_damaged(n_candidates, recorded.reading, own_begin)
        counted = _CountedScans(opened.scans(survey.scan_ids[first:end], damaged), own_begin)
        scans = log.report_progress(counted, "register_scans", total=end - first)
        scan_results, edges = mapping.register_candidates(survey, cut, scans, caches, run, settings)
        damage = opened.describe_damage()
    return RegisteredCandidates(
        survey=own,
        results=scan_results,
        edges=edges,
        read_points=lambda rows: caches.raw.part(rows + (begin - first)),
        n_dropped=counted.n_dropped,
        n_repeated=counted.n_repeated,
        faults=damaged.faults,
        damage=damage,
    )


class _CountedScans:
    """Scans to iterate over once, and what was counted so far from some scan on.

    Attributes
    ----------
    n_dropped, n_repeated : int
        As in `RegisteredCandidates`.
    """

    def __init__(self, scans: Iterable[Scan], begin: int) -> None:
        self._scans = scans
        self._begin = begin
        self.n_dropped = self.n_repeated = 0

    def __iter__(self) -> Iterator[Scan]:
        known: set[int] = set()
        for scan in self._scans:
            if scan.scan_id >= self._begin:
                self.n_dropped += scan.n_dropped
                self.n_repeated += len(scan.xyz_m) > 0 and scan.digest in known
            known.add(scan.digest)
            yield scan


def read_motion(moved: FilePath) -> trajectory.SensorMotion:
    """Return how the sensor moved, of motion.parquet."""
    of_poses = json.loads(tables.read_note(moved, schemas.MOTION, schemas.OF_POSES) or "true")
    columns = tables.read_table(moved, schemas.MOTION)
    return trajectory.motion_from_columns(columns, of_poses=of_poses)
