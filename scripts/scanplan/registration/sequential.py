"""Selecting continuous scans and registering them one after the other (thesis 3.5, algorithm 3)."""

from collections import deque
from dataclasses import dataclass, field, replace

import numpy as np

from scanplan.geometry import se3, twists
from scanplan.registration import constraints, icp

# the method that leaves a survey as it is: its poses are exact, its scans all sound
GIVEN_POSES = "none"
_IDENTITY = np.eye(4)
# fewer occupied cubes fix no pose, however many points are in them
_FEWEST_PLACES = 10


@dataclass(frozen=True)
class SequentialSettings:
    """Limits of the registration; config/README.md explains each key of section `registration`."""

    voxel_m: float
    voxel_planar_m: float
    voxels: int
    n_previous: int
    previous_apart_m: float
    previous_turn_deg: float
    fitness_distance_m: float
    fitness_points: int
    min_prior_fitness: float
    min_refined_fitness: float
    min_facing_fitness: float
    icp_method: str
    icp_targets: int
    icp_distances_m: tuple
    icp_max_iterations: int
    max_correction_m: float
    max_correction_deg: float
    localiser_sigma_m: float
    localiser_sigma_deg: float
    localiser_sigma_tilt_deg: float
    anchor_after: int
    anchor_apart_m: float
    min_points: int

    def localiser_information(self, priors):
        """Inverse covariances (..., 6, 6) of poses (..., 4, 4) that the localiser gave, as twists in their frames."""
        heading, tilt = np.radians([self.localiser_sigma_deg, self.localiser_sigma_tilt_deg])
        return twists.pose_information([self.localiser_sigma_m] * 3 + [tilt, tilt, heading], priors)


@dataclass(frozen=True)
class ScanResult:
    """What became of a candidate scan.

    Attributes
    ----------
    kept : bool
    reason : str
        `kept`, `anchor` (kept at the localiser's pose), `pose_gap`, `too_few_points`, `low_prior_fitness`,
        `icp_diverged`, `low_refined_fitness`, or `unconfirmed` (see `confirmation`).
    world_from_sensor : (4, 4) float64
        After refinement where the scan is kept, the localiser's otherwise; NaN without a pose.
    prior_fitness, refined_fitness, rmse_m : float
        Mean fitness against the previous retained scans before and after refinement, residual of the refinement; NaN
        where it did not come to that.
    """

    kept: bool
    reason: str
    world_from_sensor: np.ndarray
    prior_fitness: float = np.nan
    refined_fitness: float = np.nan
    rmse_m: float = np.nan


@dataclass
class SequentialRegistrar:
    """Takes the candidate scans one after the other and says of each whether, and where, it is kept.

    Attributes
    ----------
    settings : Settings
    planar : bool
        Whether the sensor measures in one plane: then x, y and heading are refined, and height, roll and pitch stay
        the localiser's.
    edges : list of constraints.PoseConstraint
        Of the scans kept so far to their predecessors.
    """

    settings: SequentialSettings
    planar: bool
    edges: list = field(default_factory=list)
    _previous: deque = field(init=False)
    # what was looked back on before an anchor that no scan has confirmed yet
    _earlier: deque = field(init=False)
    _confirmed: bool = False
    _after_gap: bool = False
    _rejected_in_a_row: int = 0

    def __post_init__(self):
        self._previous, self._earlier = self._no_scans(), self._no_scans()

    def add(self, scan_id, xyz_m, prior):
        """Judge the next scan.

        Parameters
        ----------
        scan_id : int
        xyz_m : (n, 3) float
            Points in the sensor frame, finite.
        prior : (4, 4) float
            The localiser's world_from_sensor at the scan's stamp; NaN where it has none.

        Returns
        -------
        Verdict
        thinned_m : (m, 3) float32
            The points that fitting uses, in the cloud's frame: what `icp.prepare_cloud` takes.
        """
        nothing = np.zeros((0, 3), np.float32)
        if not np.isfinite(prior).all():
            self._after_gap = True
            return ScanResult(False, "pose_gap", np.full((4, 4), np.nan)), nothing
        if len(xyz_m) < self.settings.min_points:
            return ScanResult(False, "too_few_points", prior), nothing
        if self.settings.icp_method == GIVEN_POSES:
            return ScanResult(True, "kept", prior), nothing
        level_from_sensor = constraints.level_pose(prior) if self.planar else _IDENTITY
        thinned_m = constraints.thin_scan(xyz_m, level_from_sensor, self.planar, self.settings)
        if len(thinned_m) < _FEWEST_PLACES:
            return ScanResult(False, "too_few_points", prior), thinned_m
        cloud = icp.prepare_cloud(
            thinned_m, planar=self.planar, reach_m=constraints.neighbour_reach_m(self.settings)
        )
        verdict, edges = self._judge(
            constraints.PlacedScan(scan_id, cloud, prior @ se3.invert_pose(level_from_sensor)),
            level_from_sensor,
        )
        self.edges += edges
        self._remember(scan_id, cloud, verdict, level_from_sensor)
        return verdict, thinned_m

    def _judge(self, scan, level_from_sensor):
        prior = scan.world_from_cloud @ level_from_sensor
        if not self._previous:
            return ScanResult(True, "anchor", prior), []
        verdict, edges = self._compared(scan, level_from_sensor, self._previous)
        if not verdict.kept and not self._confirmed and self._earlier:
            # the anchor may have been the scan that was out of place
            back, edges_back = self._compared(scan, level_from_sensor, self._earlier)
            if back.kept:
                self._previous = self._earlier
                return back, edges_back
        if not verdict.kept and self._starts_anew(scan):
            verdict = replace(verdict, kept=True, reason="anchor")
        return verdict, edges

    def _compared(self, scan, level_from_sensor, previous):
        """Judge a scan by some that are in place."""
        prior, s = scan.world_from_cloud @ level_from_sensor, self.settings
        judges = constraints.comparable_scans(scan, previous, s)
        before = self._mean_overlap(scan, judges)[0]
        if before < s.min_prior_fitness:
            return ScanResult(False, "low_prior_fitness", prior, before), []
        refined, edges = constraints.refine_scan(scan, list(previous)[: -s.icp_targets - 1 : -1], s)
        if refined is None:
            return ScanResult(False, "icp_diverged", prior, before), []
        after, rmse_m = self._mean_overlap(refined, judges)
        if after < s.min_refined_fitness or not self._faces_any(edges):
            return ScanResult(False, "low_refined_fitness", prior, before, after, rmse_m), []
        return ScanResult(
            True, "kept", refined.world_from_cloud @ level_from_sensor, before, after, rmse_m
        ), edges

    def _faces_any(self, edges):
        """Whether the surfaces of a scan agree with those of another that it is aligned to.

        A floor agrees with any floor, so this tells of scans that show little of it, as a few level beams do.
        """
        # in the plane a few beams on a wall often give no normal, and there is no floor
        return (
            self.planar or max(edge.fitness for edge in edges) >= self.settings.min_facing_fitness
        )

    def _starts_anew(self, scan):
        """Whether a scan that does not fit is believed to be where the localiser says.

        A lost region is worse than a seam: it is after a run of rejections, and at once where the scans before cannot
        be expected to show the same place.
        """
        long_run = self._rejected_in_a_row + 1 >= self.settings.anchor_after
        return long_run or self._after_gap or self._is_far(scan)

    def _is_far(self, scan):
        way_m = [
            np.linalg.norm((p.world_from_cloud - scan.world_from_cloud)[:3, 3])
            for p in self._previous
        ]
        return min(way_m) > self.settings.anchor_apart_m

    def _remember(self, scan_id, cloud, verdict, level_from_sensor):
        self._rejected_in_a_row = 0 if verdict.kept else self._rejected_in_a_row + 1
        if verdict.reason == "anchor":
            self._earlier = self._previous if self._confirmed else self._earlier
            self._previous = self._no_scans()
        if verdict.kept:
            self._confirmed, self._after_gap = verdict.reason == "kept", False
            world_from_cloud = verdict.world_from_sensor @ se3.invert_pose(level_from_sensor)
            self._previous.append(constraints.PlacedScan(scan_id, cloud, world_from_cloud))

    def _mean_overlap(self, scan, previous):
        found = [
            constraints.measure_scan_overlap(scan, target, self.settings) for target in previous
        ]
        return tuple(float(mean) for mean in np.mean(found, axis=0))

    def _no_scans(self):
        return deque(maxlen=self.settings.n_previous)
