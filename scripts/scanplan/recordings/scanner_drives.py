"""Several scanners of one robot, as drives one after the other along the same way.

Each scan keeps the place of the scanner that took it, so that rays start where they did; each
drive but the first is told as if it came hours later, as nothing else could be driven meanwhile.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.recordings import frame_edges
from scanplan.recordings.clouds import Scan
from scanplan.recordings.frame_edges import FrameEdge
from scanplan.recordings.integrity.damaged_clouds import DamagedClouds
from scanplan.recordings.motion import point_times
from scanplan.recordings.motion.pose_kind import ESTIMATED
from scanplan.recordings.recorded_survey import BagSurvey
from scanplan.recordings.survey_protocol import NamedChain
from scanplan.stage import log
from scanplan.types import IntArray

_APART_NS = 3600 * 10**9
"""Between drives: so long that no limit of a drive's pace is met."""
_LONGEST_NS = 365 * 24 * _APART_NS  # of a drive: more is a clock that was not set, or a fault


class ScannerDrives:
    """The scans of several scanners; those of the second follow those of the first.

    Parameters
    ----------
    surveys : list of recorded_survey.BagSurvey
        One a scanner, of one recording; two or more.
    max_damaged_share : float
        Of the clouds that are read.

    Raises
    ------
    StageError
        If some measure in a plane and others in space, or no poses are recorded.
    """

    def __init__(self, surveys: Sequence[BagSurvey], *, max_damaged_share: float = 0.0) -> None:
        self._surveys = surveys
        self._max_damaged_share = max_damaged_share
        self._damaged = DamagedClouds(0, max_damaged_share)
        self._names = [survey.list_topics().cloud.name for survey in surveys]
        if self.pose_kind == ESTIMATED:
            raise StageError(
                f"input.cloud_topic: without recorded poses {' and '.join(self._names)} are not"
                " placed in one map; give one topic"
            )
        if len({survey.planar for survey in surveys}) > 1:
            raise StageError(
                f"input.cloud_topic: {', '.join(self._names)} measure in a plane and in space; give"
                " scanners of one kind"
            )

    @property
    def planar(self) -> bool:
        """Whether they measure in one plane only."""
        return self._surveys[0].planar

    @property
    def sweep_times(self) -> point_times.TimeConvention | None:
        """How a driver writes the time of a point: the first scanner's that has any."""
        return next(filter(None, (survey.sweep_times for survey in self._surveys)), None)

    @property
    def pose_kind(self) -> str:
        """Of which kind the poses are: see `pose_kind.find_pose_kind`."""
        return self._surveys[0].pose_kind

    @cached_property
    def _shifts_ns(self) -> list[int]:
        """What is added to the times of each drive."""
        of_each = [survey.stamps() for survey in self._surveys]
        of_poses = [t_ns for survey in self._surveys for t_ns in _times_of(survey.pose_edges())]
        first_ns, *_, last_ns = np.sort(np.concatenate([*of_each, *of_poses]))
        if last_ns - first_ns > _LONGEST_NS:
            raise StageError(
                f"input.cloud_topic: stamps of {' and '.join(self._names)} lie"
                f" {(last_ns - first_ns) / _APART_NS / 24:,.0f} days apart, at most"
                f" {_LONGEST_NS // _APART_NS // 24} are one drive's; leave out clouds of wrong"
                " stamps, or give one topic"
            )
        step_ns = (int(last_ns - first_ns) // _APART_NS + 2) * _APART_NS
        log.log_line(
            f"scanners {', '.join(self._names)}: {', '.join(f'{len(s):,}' for s in of_each)} scans,"
            f" each after the first counted as driven {step_ns // 10**9:,} s later"
        )
        return [i * step_ns for i in range(len(of_each))]

    @cached_property
    def _begins(self) -> list[int]:
        """The scan_id of the first scan of each drive, and of one beyond the last."""
        counts = [len(survey.stamps()) for survey in self._surveys]
        return [0, *np.cumsum(counts).tolist()]

    def stamps(self) -> IntArray:
        """Return the stamps of all clouds, (n,) int64, in scan_id order."""
        shifted = zip(self._surveys, self._shifts_ns, strict=True)
        return np.concatenate([survey.stamps() + shift_ns for survey, shift_ns in shifted])

    def pose_edges(self) -> list[FrameEdge]:
        """Return the chain of transforms whose product is world_from_sensor.

        Raises
        ------
        StageError
            If tf does not say how one scanner is mounted beside the others.
        """
        return self._pose_edges

    @cached_property
    def _pose_edges(self) -> list[FrameEdge]:
        edges = self._join_chains([survey.pose_edges() for survey in self._surveys])
        if edges is None:
            raise StageError(
                f"input.cloud_topic: tf does not place {' and '.join(self._names)} on what the"
                " poses are of, each where it is mounted; record /tf_static, leave out"
                " input.base_from_sensor, or give one topic"
            )
        return edges

    def motion_chains(self) -> list[NamedChain]:
        """Return all that states how the sensors moved, the smoothest first and the poses last."""
        of_each = [survey.motion_chains()[:-1] for survey in self._surveys]
        chains = []
        for same in zip(*of_each, strict=False):
            edges = self._join_chains([chain for _, chain in same])
            if edges is not None and len({name for name, _ in same}) == 1:
                chains.append((same[0][0], edges))
        return [*chains, (self._surveys[0].motion_chains()[-1][0], self.pose_edges())]

    def _join_chains(self, chains: Sequence[Sequence[FrameEdge]]) -> list[FrameEdge] | None:
        """Return the chain of all drives, None if they differ in more than mounts, or not in these.

        Parameters
        ----------
        chains : list of list of frame_edges.FrameEdge
            Of each scanner, over the same time.
        """
        parts = [_part_chain(chain) for chain in chains]
        frames = [[(edge.parent, edge.child) for edge in rigid[:-1]] for rigid, _ in parts]
        mounts = [mount for _, mount in parts]
        is_apart = all(
            np.abs(one - other).max() > SHORTEST_M
            for i, one in enumerate(mounts)
            for other in mounts[:i]
        )
        if any(rigid != frames[0] for rigid in frames) or not parts[0][0] or not is_apart:
            return None
        joined = []
        for edges in zip(*(rigid for rigid, _ in parts), strict=True):
            moving = [(edge.t_ns, edge.xyz_m, edge.quat_xyzw) for edge in edges]
            joined.append(self._join_edges(edges[0], moving))
        times_ns = [np.unique(np.concatenate(_times_of(rigid))) for rigid, _ in parts]
        still = [
            (t_ns, *se3.split_pose(np.repeat(mount[None], len(t_ns), axis=0)))
            for t_ns, mount in zip(times_ns, mounts, strict=True)
        ]
        mounting = FrameEdge(joined[-1].child, "scanners", still[0][1], still[0][2])
        return [*joined, self._join_edges(mounting, still)]

    def _join_edges(self, edge: FrameEdge, parts: Sequence[tuple]) -> FrameEdge:
        """Return an edge over all drives, given stamps, places and turns of each."""
        if parts[0][0] is None:
            return edge
        t_ns = [part[0] + shift_ns for part, shift_ns in zip(parts, self._shifts_ns, strict=True)]
        xyz_m, quat_xyzw = (np.concatenate([part[i] for part in parts]) for i in (1, 2))
        return replace(edge, t_ns=np.concatenate(t_ns), xyz_m=xyz_m, quat_xyzw=quat_xyzw)

    def describe_gaps(self) -> list[str]:
        """Return whether the recordings lie far apart in time, as a sentence."""
        return self._surveys[0].describe_gaps()

    def describe_rays(self) -> list[str]:
        """Return nothing: they were recorded."""
        return []

    def describe_damage(self) -> list[str]:
        """Return what could not be read so far, in sentences."""
        losses = [loss for survey in self._surveys for loss in survey.describe_losses()]
        return [*dict.fromkeys(losses), *self._damaged.describe()]

    def scans(self, wanted: Iterable[int], damaged: DamagedClouds | None = None) -> Iterator[Scan]:
        """Iterate over the scans of the scan_ids in `wanted`, in scan_id order.

        `damaged` is as in `survey_protocol.Survey.scans`.
        """
        scan_ids = np.unique(np.fromiter(wanted, np.int64))
        self._damaged = damaged or DamagedClouds(len(scan_ids), self._max_damaged_share)
        for i, survey in enumerate(self._surveys):
            begin, end = self._begins[i : i + 2]
            own = scan_ids[(scan_ids >= begin) & (scan_ids < end)] - begin
            for scan in survey.scans(own.tolist(), _LaterClouds(self._damaged, begin)):
                t_ns = scan.t_ns + self._shifts_ns[i]
                yield replace(scan, scan_id=scan.scan_id + begin, t_ns=t_ns)
        if len(scan_ids) and not 0 <= scan_ids[0] <= scan_ids[-1] < self._begins[-1]:
            raise ValueError(f"there is no scan {scan_ids[-1]}")


class _LaterClouds(DamagedClouds):
    """Damaged clouds of a drive, counted with those of others before it."""

    def __init__(self, of_all: DamagedClouds, n_before: int) -> None:
        self._of_all = of_all
        self._n_before = n_before

    def read(self, scan_id: int, t_ns: int, decode: Callable[[], Scan]) -> Scan:
        scan = self._of_all.read(scan_id + self._n_before, t_ns, decode)
        return replace(scan, scan_id=scan_id)


def _part_chain(chain: Sequence[FrameEdge]) -> tuple[list[FrameEdge], np.ndarray]:
    """Return a chain up to what moves last in it, and the mount (4, 4) of the scanner there."""
    last = max((i for i, edge in enumerate(chain) if edge.t_ns is not None), default=-1)
    mount = frame_edges.chain_poses(chain[last + 1 :], [0], max_gap_s=np.inf)[0][0]
    return list(chain[: last + 1]), mount


def _times_of(edges: Sequence[FrameEdge]) -> list[IntArray]:
    return [edge.t_ns for edge in edges if edge.t_ns is not None]
