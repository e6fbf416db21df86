"""Closing loops over the drift: places that the way comes back to, found submap by submap.

A link counts where another one beside it says the same (pairwise consistency, Mangelson et al.
2018), or where so little drift is expected that nothing else lies within it.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra

from scanplan.geometry import se3, twists
from scanplan.registration import multiway, pose_graph
from scanplan.registration.constraints import PoseConstraint
from scanplan.registration.drift import recognition
from scanplan.registration.drift.submaps import Submap
from scanplan.registration.icp import IcpResult
from scanplan.registration.registration_settings import DriftSettings
from scanplan.types import FloatArray, IntArray

Solve = Callable[[Sequence[PoseConstraint]], tuple[FloatArray, FloatArray]]
"""Poses (n, 4, 4) with links as further constraints, and the weight (m,) of each link."""


@dataclass(frozen=True)
class Link:
    """A submap recognised on an earlier one; both by their number.

    Attributes
    ----------
    source, target : int
    found : recognition.Recognition
    """

    source: int
    target: int
    found: recognition.Recognition


class LoopCloser:
    """Finds the loops of a way that drifts.

    Parameters
    ----------
    scan_ids : (n,) int
    maps : sequence of submaps.Submap
        In the order of the way.
    way_m : (n,) float
        How far the sensor had come at each scan, with what breaks add (`measure_doubtful_way`).
    """

    def __init__(
        self,
        scan_ids: IntArray,
        maps: Sequence[Submap],
        way_m: FloatArray,
        drift: DriftSettings,
    ) -> None:
        self._scan_ids = scan_ids
        self._maps = maps
        self._rows = np.array([submap.row for submap in maps], np.int64)
        self._way_m = np.asarray(way_m, float)[self._rows]
        self._drift = drift
        self.links: list[Link] = []

    def close_loops(
        self, world_from_cloud: FloatArray, solve: Solve, run: Callable[..., Iterator[Any]]
    ) -> list[PoseConstraint]:
        """Find links over little drift first, place the scans by them, and look farther.

        Parameters
        ----------
        world_from_cloud : (n, 4, 4) float64
        solve : callable
            See `Solve`.
        run : callable
            As `workers.open_pool` gives it.
        """
        least_m = self._expect_drift(0.0)[0]
        # farther away one office is as good as the next
        farthest_m = min(self._expect_drift(float(np.ptp(self._way_m)))[0], 20 * least_m)
        # in the end those that had been out of reach once more, now that the drift is known
        reaches_m = [least_m * 2.0**n for n in range(1, 5) if least_m * 2.0**n < farthest_m]
        windows_m = [*pairwise([0.0, *reaches_m, farthest_m]), (0.0, 2 * least_m)]
        for nearest_m, most_m in windows_m:
            pairs = self._choose_pairs(world_from_cloud, nearest_m, most_m)
            found = self._find(pairs, world_from_cloud, run)
            new = self._consistent(found, world_from_cloud)
            if new:
                self.links += new
                world_from_cloud, weight = solve(self.constraints(world_from_cloud))
                is_kept = weight >= pose_graph.INLIER_WEIGHT
                self.links = [link for link, kept in zip(self.links, is_kept, strict=True) if kept]
        return self.constraints(world_from_cloud)

    def _expect_drift(self, way_m: FloatArray | float) -> tuple[Any, Any]:
        """Return by how much the chain of scans is off after a way: metres and radians.

        The scans of a submap are off by half a metre and 5 degrees already where a few of them
        were aligned badly.
        """
        turn_deg = 5.0 + self._drift.drift_deg_per_m * way_m
        return 0.5 + self._drift.drift_share * way_m, np.radians(turn_deg)

    def expected_way_m(self) -> FloatArray:
        """Return the least way (k, k) between submaps over which nothing stops the drift."""
        step_m = np.maximum(np.diff(self._way_m), 1e-3)
        before = np.arange(len(step_m))
        sources = np.array([link.source for link in self.links], np.int64)
        targets = np.array([link.target for link in self.links], np.int64)
        # a link is a place recognised: across it next to no way is driven
        weights = np.concatenate([step_m, np.full(len(sources), 1e-3)])
        ends = (np.concatenate([before, sources]), np.concatenate([before + 1, targets]))
        n = len(self._maps)
        graph = sparse.coo_array((weights, ends), shape=(n, n)).tocsr()
        return np.asarray(dijkstra(graph, directed=False))

    def constraints(self, world_from_cloud: FloatArray) -> list[PoseConstraint]:
        """Return the links as constraints between the middle scans of their submaps."""
        return [self._constraint(link, world_from_cloud) for link in self.links]

    def _choose_pairs(
        self, world_from_cloud: FloatArray, least_m: float, most_m: float
    ) -> list[tuple[int, int, float]]:
        """Return (source, target, drift expected) of submaps that may show the same place."""
        xy_m = world_from_cloud[self._rows, :2, 3]
        drift_m = self._expect_drift(self.expected_way_m())[0]
        linked = {(link.source, link.target) for link in self.links}
        apart_m = np.linalg.norm(xy_m[:, None] - xy_m[None], axis=2)
        driven_m = np.abs(self._way_m[:, None] - self._way_m[None])
        is_pair = (
            (driven_m > 2.5 * self._drift.submap_m) & (drift_m > least_m) & (drift_m <= most_m)
        )
        is_pair &= apart_m < 0.75 * self._drift.submap_m + drift_m
        return [
            (source, target, float(drift_m[source, target]))
            for source, target in np.argwhere(np.tril(is_pair)).tolist()
            if (source, target) not in linked
        ]

    def _find(
        self,
        pairs: Sequence[tuple[int, int, float]],
        world_from_cloud: FloatArray,
        run: Callable[..., Iterator[Any]],
    ) -> list[Link]:
        """Return the pairs of submaps that are recognised."""
        found = run(recognise_pairs, self._jobs(pairs, world_from_cloud))
        results = [result for of_job in found for result in of_job]
        return [
            Link(source, target, result)
            for (source, target, _), result in zip(pairs, results, strict=True)
            if result is not None
        ]

    def _jobs(
        self, pairs: Sequence[tuple[int, int, float]], world_from_cloud: FloatArray
    ) -> Iterable[tuple[Any, ...]]:
        world_from_level = se3.level_frame(world_from_cloud[self._rows])
        way_m = self.expected_way_m()
        n_of_job = 8
        for begin in range(0, len(pairs), n_of_job):
            job = []
            for source, target, drift_m in pairs[begin : begin + n_of_job]:
                start = se3.invert_pose(world_from_level[target]) @ world_from_level[source]
                # beyond an eighth of a turn a corner looks like the next
                turn_rad = min(self._expect_drift(float(way_m[source, target]))[1], np.pi / 4)
                job.append((self._maps[source], self._maps[target], start, drift_m, turn_rad))
            yield (job,)

    def _consistent(self, found: Sequence[Link], world_from_cloud: FloatArray) -> list[Link]:
        """Return the links that another one confirms, or that little drift leaves no doubt of."""
        world_from_level = se3.level_frame(world_from_cloud[self._rows])
        drift_m = self._expect_drift(self.expected_way_m())[0]
        known = [*self.links, *found]
        return [
            link
            for link in found
            if drift_m[link.source, link.target] <= 2 * self._expect_drift(0.0)[0]
            or any(self._agree(link, other, world_from_level) for other in known)
        ]

    def _agree(self, link: Link, other: Link, world_from_level: FloatArray) -> bool:
        """Return whether two links beside one another say the same of the drift between."""
        steps = (abs(link.source - other.source), abs(link.target - other.target))
        if link is other or max(steps) > 3 or steps == (0, 0):
            return False
        to_source = se3.invert_pose(world_from_level[link.source]) @ world_from_level[other.source]
        from_target = (
            se3.invert_pose(world_from_level[other.target]) @ world_from_level[link.target]
        )
        expected = from_target @ link.found.fit.target_from_source @ to_source
        measured = other.found.fit.target_from_source
        twist = twists.motion_to_twist(se3.invert_pose(measured) @ expected)
        most_m, most_rad = self._expect_drift(0.0)
        return bool(np.linalg.norm(twist[:2]) < most_m and abs(twist[5]) < most_rad)

    def _constraint(self, link: Link, world_from_cloud: FloatArray) -> PoseConstraint:
        rows = self._rows[[link.source, link.target]]
        level_from_cloud = (
            se3.invert_pose(se3.level_frame(world_from_cloud[rows])) @ world_from_cloud[rows]
        )
        fit = link.found.fit
        target_from_source = (
            se3.invert_pose(level_from_cloud[1]) @ fit.target_from_source @ level_from_cloud[0]
        )
        adjoint = twists.twist_adjoint(level_from_cloud[0])
        # submaps are rigid to a few centimetres, and their points are not independent
        sigma = np.repeat([0.05, np.radians(0.5)], 3)
        information = multiway.add_covariance(fit.information[None], np.diag(sigma**2))[0]
        information = adjoint.T @ information @ adjoint
        source, target = self._scan_ids[rows].tolist()
        return PoseConstraint(
            source,
            target,
            "loop",
            link.found.agreement.overlap,
            np.nan,
            IcpResult(target_from_source, information, fit.n_unobservable, sound=True),
        )


def recognise_pairs(
    job: Sequence[tuple[Submap, Submap, FloatArray, float, float]],
) -> list[recognition.Recognition | None]:
    """Return the pairs of submaps that show the same place beyond doubt, None for the others."""
    return [
        recognition.find_submap(source, target, start, reach_m=reach_m, turn_rad=turn_rad)
        for source, target, start, reach_m, turn_rad in job
    ]
