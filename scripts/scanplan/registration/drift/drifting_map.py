"""The poses of all retained scans at once where those recorded drift: odometry, loops, one anchor.

Between the map of a localiser (`multiway`) and this one the difference is what the recorded poses
say: here only how the sensor moved from scan to scan.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from scanplan.registration import multiway, pose_graph, prepared_clouds
from scanplan.registration.constraints import PoseConstraint, neighbour_reach_m
from scanplan.registration.drift import closing, folds, odometry, submaps
from scanplan.registration.registration_settings import RegistrationSettings, SequentialSettings
from scanplan.stage import log
from scanplan.types import FloatArray


def optimise_drifting_poses(
    scans: multiway.KeptScans,
    odometry_from_cloud: FloatArray,
    run: Callable[..., Iterator[Any]],
    settings: RegistrationSettings,
) -> multiway.OptimisedMap:
    """Find the poses of all retained scans at once.

    Parameters
    ----------
    scans, run, settings
        As of `multiway.optimise_poses`.
    odometry_from_cloud : (n, 4, 4) float64
        As recorded.
    """
    scan_ids, drift = scans.scan_ids, settings.drift
    graph = _DriftingGraph(scans, odometry_from_cloud, settings)
    way_m = odometry.measure_way(odometry_from_cloud)
    reach_m = neighbour_reach_m(settings.limits)
    clouds = prepared_clouds.PreparedScans(scans.thinned, scans.planar, reach_m)
    maps = submaps.make_submaps(submaps.cut_way(way_m, drift.submap_m), clouds, graph.poses)
    doubtful_m = odometry.measure_doubtful_way(scan_ids, way_m, graph.sequence)
    closer = closing.LoopCloser(scan_ids, maps, doubtful_m, drift)
    links = closer.close_loops(graph.poses, graph.solve_links, run)
    log.log_line(f"register_scans: {len(links):,} places recognised on {way_m[-1]:,.0f} m of way")
    near = graph.align_near_scans(run)
    # of two scans one constraint: that of their own points is the finer
    by_ends = {multiway.edge_ends(edge): edge for edge in [*links, *near, *graph.sequence]}
    all_edges = [by_ends[ends] for ends in sorted(by_ends)]
    solution = graph.solve(all_edges)
    weight = solution.weight[: len(all_edges)]
    ends = np.array([multiway.edge_ends(edge) for edge in all_edges], np.int64).reshape(-1, 2)
    source, target = np.searchsorted(scan_ids, ends[weight >= pose_graph.INLIER_WEIGHT]).T
    return multiway.OptimisedMap(
        solution.world_from_scan,
        all_edges,
        solution.residual[: len(all_edges)],
        weight,
        solution.weight[len(all_edges) :],
        solution.covariance,
        recorded="odometry's motions",
        witnesses=(
            folds.measure_loose_parts(len(scan_ids), source, target),
            *folds.measure_folds(folds.compare_places(maps, solution.world_from_scan, way_m)),
        ),
    )


class _DriftingGraph:
    """A pose graph of scans aligned one after the other, and of odometry where that is open.

    Attributes
    ----------
    sequence : list of constraints.PoseConstraint
        The scans' constraints to those before them.
    poses : (n, 4, 4) float64
        world_from_cloud by all that was solved for so far.
    """

    def __init__(
        self,
        scans: multiway.KeptScans,
        odometry_from_cloud: FloatArray,
        settings: RegistrationSettings,
    ) -> None:
        scan_ids = scans.scan_ids
        self._scans = scans
        self._odometry = odometry_from_cloud
        self._settings = settings
        self._row_of_scan = multiway.find_rows(scan_ids)
        self.sequence = multiway.edges_between(scans.edges, self._row_of_scan)
        self._steps = odometry.measure_steps(
            scan_ids, odometry_from_cloud, self.sequence, settings.drift
        )
        self._prior_information = _prior_information(odometry_from_cloud, settings.limits)
        self.poses = odometry.chain_scans(scan_ids, odometry_from_cloud, self.sequence)
        self.poses = self.solve(self.sequence, is_start=True).world_from_scan

    def solve(
        self, constraints: Sequence[PoseConstraint], *, is_start: bool = False
    ) -> pose_graph.PoseGraphSolution:
        """Solve for the poses from where they are; the constraints' weights come first."""
        measured = multiway.edge_motions(constraints, self._row_of_scan, self._settings.graph)
        return pose_graph.solve_pose_graph(
            self.poses,
            measured.join(self._steps),
            pose_graph.KnownPoses(
                odometry.level_priors(self.poses, self._odometry), self._prior_information
            ),
            planar=self._scans.planar,
            kernel=self._settings.graph.kernel_sigmas,
            is_start=is_start,
        )

    def solve_links(self, links: Sequence[PoseConstraint]) -> tuple[FloatArray, FloatArray]:
        """Move the poses to where links have them; see `closing.Solve`."""
        solution = self.solve([*self.sequence, *links], is_start=True)
        self.poses = solution.world_from_scan
        n = len(self.sequence)
        return self.poses, solution.weight[n : n + len(links)]

    def align_near_scans(self, run: Callable[..., Iterator[Any]]) -> list[PoseConstraint]:
        """Align scans that are near each other, as where a localiser placed them."""
        return multiway.align_visits(self._scans, self.poses, self.sequence, run, self._settings)


def _prior_information(odometry_from_cloud: FloatArray, limits: SequentialSettings) -> FloatArray:
    """Return what odometry says of heights and tilts, and that the first pose stays where it is."""
    information = limits.localiser_information(odometry_from_cloud)
    upright = odometry_from_cloud[:, 2, :3]
    shift = np.zeros((len(information), 3, 3))
    # heights that vary by less than 5 cm are those of wheels on a floor
    if np.ptp(odometry_from_cloud[:, 2, 3]) < 0.05:
        shift = upright[:, :, None] * upright[:, None, :] / limits.localiser_sigma_m**2
    tilt = np.eye(3) - upright[:, :, None] * upright[:, None, :]
    result = np.zeros_like(information)
    result[:, :3, :3] = shift
    result[:, 3:, 3:] = tilt / np.radians(limits.localiser_sigma_tilt_deg) ** 2
    # the one pose that is held: to a tenth of a millimetre and of a milliradian
    result[0] = np.eye(6) * 1e8
    return result
