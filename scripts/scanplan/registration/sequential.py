"""Selecting continuous scans and registering them one after the other (thesis 3.5, algorithm 3)."""

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from scanplan.geometry import se3
from scanplan.registration import constraints, prepared_clouds
from scanplan.registration.constraints import PlacedScan, PoseConstraint
from scanplan.registration.drift import submaps
from scanplan.registration.registration_settings import SequentialSettings
from scanplan.types import FloatArray

GIVEN_POSES = "none"
"""The method that leaves a survey as it is: its poses are exact, its scans all sound."""
OTHER_MAP = "other_map"
"""Why a scan is not kept that lies in a map of its own."""


@dataclass(frozen=True)
class ScanResult:
    """Outcome of the registration of a candidate scan.

    Attributes
    ----------
    kept : bool
    reason : str
        `kept`, `anchor` (kept at the localiser's pose), `pose_gap`, `too_few_points`,
        `low_prior_fitness`, `icp_diverged`, `low_refined_fitness`, `unconfirmed` (see
        `mapping.find_unconfirmed`), or `OTHER_MAP` (see `mending`).
    world_from_sensor : (4, 4) float64
        After refinement where the scan is kept, but for one whose refinement is not believed; the
        localiser's otherwise; NaN without a pose.
    prior_fitness, refined_fitness, rmse_m : float
        Mean fitness against the previous retained scans before and after refinement, residual of
        the refinement; NaN where it did not come to that.
    covariance : (3, 3) float64
        See `multiway.OptimisedMap`; NaN of scans that are not in the map.
    """

    kept: bool
    reason: str
    world_from_sensor: FloatArray
    prior_fitness: float = np.nan
    refined_fitness: float = np.nan
    rmse_m: float = np.nan
    covariance: FloatArray = field(default_factory=lambda: np.full((3, 3), np.nan))


@dataclass
class ScanRegistrar(ABC):
    """Registers the candidate scans one after the other.

    Attributes
    ----------
    settings : registration_settings.SequentialSettings
    planar : bool
        Whether the sensor measures in one plane: then x, y and heading are refined, and height,
        roll and pitch stay the localiser's.
    edges : list of constraints.PoseConstraint
        From the scans kept so far to their predecessors.
    """

    settings: SequentialSettings
    planar: bool
    edges: list[PoseConstraint] = field(default_factory=list)
    _after_gap: bool = False

    def add(
        self, scan_id: int, xyz_m: FloatArray, prior: FloatArray
    ) -> tuple[ScanResult, FloatArray]:
        """Register the next scan.

        Parameters
        ----------
        xyz_m : (n, 3) float
            Points in the sensor frame, finite.
        prior : (4, 4) float
            The localiser's world_from_sensor at the scan's stamp; NaN where it has none.

        Returns
        -------
        ScanResult
        thinned_m : (m, 3) float32
            The points used, in the cloud's frame, as `prepared_clouds.prepare_cloud` takes them.
        """
        no_points = np.zeros((0, 3), np.float32)
        if not np.isfinite(prior).all():
            self._after_gap = True
            return ScanResult(False, "pose_gap", np.full((4, 4), np.nan)), no_points
        if len(xyz_m) < self.settings.min_points:
            return ScanResult(False, "too_few_points", prior), no_points
        if self.settings.icp_method == GIVEN_POSES:
            return ScanResult(True, "kept", prior), no_points
        level_from_sensor = constraints.level_pose(prior, planar=self.planar)
        thinned_m = constraints.thin_scan(xyz_m, level_from_sensor, self.planar, self.settings)
        # too few for normals fix no pose, however many were thinned to them
        if len(thinned_m) < prepared_clouds.NEIGHBOURS:
            return ScanResult(False, "too_few_points", prior), thinned_m
        scan = constraints.place_scan(
            scan_id,
            thinned_m,
            prior,
            level_from_sensor,
            planar=self.planar,
            settings=self.settings,
        )
        result, edges = self.register_scan(scan, level_from_sensor)
        self.edges += edges
        return result, thinned_m

    @abstractmethod
    def register_scan(
        self, scan: PlacedScan, level_from_sensor: FloatArray
    ) -> tuple[ScanResult, list[PoseConstraint]]:
        """Register a scan that is at the localiser's pose, and remember it for those after it.

        Parameters
        ----------
        level_from_sensor : (4, 4) float64
            Its cloud's frame from the sensor's.

        Returns
        -------
        ScanResult
        list of constraints.PoseConstraint
            To scans before it.
        """
        ...

    def measure_overlap(
        self, scan: PlacedScan, others: Sequence[PlacedScan]
    ) -> tuple[float, float]:
        """Return the mean fitness and rmse of a scan on others, one or more."""
        overlaps = [
            constraints.measure_scan_overlap(scan, other, self.settings) for other in others
        ]
        fitness, rmse_m = np.mean(overlaps, axis=0)
        return float(fitness), float(rmse_m)


@dataclass
class SequentialRegistrar(ScanRegistrar):
    """Compares every scan with the last ones retained; starts anew where they are lost."""

    _previous: deque[PlacedScan] = field(init=False)
    # the scans compared with before an anchor that no scan has confirmed yet
    _earlier: deque[PlacedScan] = field(init=False)
    _confirmed: bool = False
    _rejected_in_a_row: int = 0
    is_odometry: bool = False
    # of odometry: what it has drifted by up to the last retained scan
    _world_from_odometry: FloatArray = field(default_factory=lambda: np.eye(4))

    def __post_init__(self) -> None:
        self._previous = self._no_scans()
        self._earlier = self._no_scans()

    def register_scan(
        self, scan: PlacedScan, level_from_sensor: FloatArray
    ) -> tuple[ScanResult, list[PoseConstraint]]:
        """Gate a scan, align it to the last scans retained, and gate it again."""
        odometry_from_cloud = scan.world_from_cloud
        if self.is_odometry:
            # only the motion since the last retained scan is known
            moved = self._world_from_odometry @ odometry_from_cloud
            scan = replace(scan, world_from_cloud=moved)
        result, edges = self._register(scan, level_from_sensor)
        if self.is_odometry and result.kept:
            world_from_cloud = result.world_from_sensor @ se3.invert_pose(level_from_sensor)
            self._world_from_odometry = world_from_cloud @ se3.invert_pose(odometry_from_cloud)
        self._remember(scan, result, level_from_sensor, is_linked=bool(edges))
        return result, edges

    def _register(
        self, scan: PlacedScan, level_from_sensor: FloatArray
    ) -> tuple[ScanResult, list[PoseConstraint]]:
        prior = scan.world_from_cloud @ level_from_sensor
        if not self._previous:
            return ScanResult(True, "anchor", prior), []
        result, edges = self._compare(scan, level_from_sensor, self._previous)
        if not result.kept and not self._confirmed and self._earlier:
            # the anchor may have been the scan that was out of place
            earlier_result, earlier_edges = self._compare(scan, level_from_sensor, self._earlier)
            if earlier_result.kept:
                self._previous = self._earlier
                return earlier_result, earlier_edges
        if self._is_in_question(result):
            found = self._search(scan)
            if found is not None:
                searched, searched_edges = self._compare(found, level_from_sensor, self._previous)
                if searched.kept and self._is_surer(searched, searched_edges, result):
                    return searched, searched_edges
            if result.kept and self._has_slipped(result, prior):
                return self._keep_prior(scan, result, prior), []
        if not result.kept and self._is_anchor(scan):
            result = replace(result, kept=True, reason="anchor")
        return result, edges

    def _is_in_question(self, result: ScanResult) -> bool:
        """Return whether the scans before are to be searched for where a scan fits.

        That is where odometry's does not, and where one in the plane fits no better than before it
        was aligned: a few walls have it end in a place like its own.
        """
        if self.is_odometry:
            return not result.kept
        return self.planar and result.refined_fitness <= result.prior_fitness

    def _is_surer(
        self, found: ScanResult, edges: Sequence[PoseConstraint], result: ScanResult
    ) -> bool:
        """Return whether the place that a search found is to be preferred.

        To odometry's it is; to a localiser's where less than half as much of it does not fit,
        and its walls hold it in every direction: along a corridor any place is like the next.
        """
        if self.is_odometry:
            return True
        is_fixed = any(edge.fit.n_unobservable == 0 for edge in edges)
        return is_fixed and 2 * (1 - found.refined_fitness) < 1 - result.refined_fitness

    def _has_slipped(self, result: ScanResult, prior: FloatArray) -> bool:
        """Return whether an alignment that fits no better moved a scan by more than would show.

        Points that lie farther than `fitness_distance_m` from where they belong do not fit: a
        localiser that is off by more, and is corrected, fits better.
        """
        moved_m = np.linalg.norm((result.world_from_sensor - prior)[:3, 3])
        return bool(moved_m > self.settings.fitness_distance_m)

    def _keep_prior(self, scan: PlacedScan, result: ScanResult, prior: FloatArray) -> ScanResult:
        """Return the result of a scan that is left where it was before it was aligned."""
        comparable = constraints.comparable_scans(scan, self._previous, self.settings)
        fitness, rmse_m = self.measure_overlap(scan, comparable)
        return replace(result, world_from_sensor=prior, refined_fitness=fitness, rmse_m=rmse_m)

    def _compare(
        self, scan: PlacedScan, level_from_sensor: FloatArray, previous: deque[PlacedScan]
    ) -> tuple[ScanResult, list[PoseConstraint]]:
        """Register a scan against previous ones and gate the result."""
        settings = self.settings
        prior = scan.world_from_cloud @ level_from_sensor
        comparable = constraints.comparable_scans(scan, previous, settings)
        prior_fitness, _ = self.measure_overlap(scan, comparable)
        if prior_fitness < settings.min_prior_fitness:
            return ScanResult(False, "low_prior_fitness", prior, prior_fitness), []
        refined, edges = constraints.refine_scan(scan, self._choose_targets(previous), settings)
        if refined is None:
            return ScanResult(False, "icp_diverged", prior, prior_fitness), []
        fitness, rmse_m = self.measure_overlap(refined, comparable)
        figures = (prior_fitness, fitness, rmse_m)
        if fitness < settings.min_refined_fitness or not self._faces_any(edges):
            return ScanResult(False, "low_refined_fitness", prior, *figures), []
        return ScanResult(
            True, "kept", refined.world_from_cloud @ level_from_sensor, *figures
        ), edges

    def _choose_targets(self, previous: Sequence[PlacedScan]) -> list[PlacedScan]:
        """Return the scans to align to, the last one first.

        In space they are evenly chosen among the previous: one farther back holds the drift of a
        chain of alignments. In the plane they are the last ones: walls that a scan shows of a few
        points each are soon out of view.
        """
        newest = list(previous)[::-1]
        if self.planar:
            return newest[: self.settings.icp_targets_planar]
        n_targets = min(self.settings.icp_targets, len(newest))
        rows = np.linspace(0, len(newest) - 1, n_targets).round().astype(int)
        return [newest[row] for row in rows]

    def _search(self, scan: PlacedScan) -> PlacedScan | None:
        """Return a scan where its walls lie on those of the scans before it, by correlation.

        Wheels that slip turn a rover, and a localiser that jumps moves it, by more than an
        alignment finds back.
        """
        # scipy's 0.3 s, and few scans are searched for
        from scanplan.registration.drift import recognition

        previous = submaps.merge_scans(
            np.arange(len(self._previous)),
            [other.cloud for other in self._previous],
            np.array([other.world_from_cloud for other in self._previous]),
        )
        own = submaps.merge_scans(np.zeros(1, int), [scan.cloud], scan.world_from_cloud[None])
        if previous is None or own is None:
            return None
        middle = self._previous[previous.row].world_from_cloud
        world_from_target = se3.level_frame(middle)
        world_from_source = se3.level_frame(scan.world_from_cloud)
        found = recognition.find_submap(
            own,
            previous,
            se3.invert_pose(world_from_target) @ world_from_source,
            reach_m=2 * self.settings.max_correction_m,
            turn_rad=np.radians(4 * self.settings.max_correction_deg),
            # a localiser's scan was aligned, and odometry's fits nowhere yet
            elsewhere=not self.is_odometry,
        )
        if found is None:
            return None
        moved = world_from_target @ found.fit.target_from_source
        level_from_cloud = se3.invert_pose(world_from_source) @ scan.world_from_cloud
        # a search in the plane leaves the height
        moved[2, 3] = scan.world_from_cloud[2, 3]
        return replace(scan, world_from_cloud=moved @ level_from_cloud)

    def _faces_any(self, edges: list[PoseConstraint]) -> bool:
        """Return whether a scan's surfaces agree with those of any scan that it is aligned to.

        A floor agrees with any floor: this gates scans that show little else, as of a few level
        beams.
        """
        # in the plane a few beams on a wall often give no normal, and there is no floor
        if self.planar:
            return True
        return max(edge.fitness for edge in edges) >= self.settings.min_facing_fitness

    def _is_anchor(self, scan: PlacedScan) -> bool:
        """Return whether a scan that does not fit is kept at the localiser's pose.

        A lost region is worse than a seam: it is after a run of rejections, and at once where the
        scans before cannot be expected to show the same place.
        """
        is_long_run = self._rejected_in_a_row + 1 >= self.settings.anchor_after
        return is_long_run or self._after_gap or self._is_far(scan)

    def _is_far(self, scan: PlacedScan) -> bool:
        distances_m = [
            float(np.linalg.norm((other.world_from_cloud - scan.world_from_cloud)[:3, 3]))
            for other in self._previous
        ]
        return min(distances_m) > self.settings.anchor_apart_m

    def _remember(
        self,
        scan: PlacedScan,
        result: ScanResult,
        level_from_sensor: FloatArray,
        *,
        is_linked: bool,
    ) -> None:
        self._rejected_in_a_row = 0 if result.kept else self._rejected_in_a_row + 1
        if result.reason == "anchor":
            self._earlier = self._previous if self._confirmed else self._earlier
            self._previous = self._no_scans()
        if result.kept:
            self._confirmed = is_linked or (self._confirmed and result.reason == "kept")
            self._after_gap = False
            world_from_cloud = result.world_from_sensor @ se3.invert_pose(level_from_sensor)
            self._previous.append(replace(scan, world_from_cloud=world_from_cloud))

    def _no_scans(self) -> deque[PlacedScan]:
        return deque(maxlen=self.settings.n_previous)
