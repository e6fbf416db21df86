"""Selecting and registering continuous scans (thesis 3.5, algorithm 3)."""

from collections import deque
from dataclasses import dataclass, field

import numpy as np

from scanplan import icp, se3

# the method that leaves a survey as it is: its poses are exact, its scans all sound
GIVEN_POSES = "none"
_IDENTITY = np.eye(4)
# fewer occupied cubes fix no pose, however many points are in them
_FEWEST_PLACES = 10


@dataclass(frozen=True)
class Settings:
    """Limits of the registration; config/README.md explains each key of section `registration`."""

    voxel_m: float
    n_previous: int
    fitness_distance_m: float
    min_prior_fitness: float
    min_refined_fitness: float
    icp_method: str
    icp_targets: int
    icp_distance_m: float
    icp_max_iterations: int
    max_correction_m: float
    max_correction_deg: float
    localiser_share: float
    anchor_after: int
    min_points: int


@dataclass(frozen=True)
class Verdict:
    """What became of a candidate scan.

    Attributes
    ----------
    kept : bool
    reason : str
        `kept`, `anchor` (kept at the localiser's pose), `pose_gap`, `too_few_points`, `low_prior_fitness`,
        `icp_diverged` or `low_refined_fitness`.
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


@dataclass(frozen=True)
class _Placed:
    cloud: icp.Cloud
    world_from_cloud: np.ndarray


@dataclass
class Registrar:
    """Takes the candidate scans one after the other and says of each whether, and where, it is kept.

    Parameters
    ----------
    settings : Settings
    planar : bool
        Whether the sensor measures in one plane: then x, y and heading are refined, and height, roll and pitch stay
        the localiser's.
    threads : int
        Cores to use; the verdicts do not depend on it.
    """

    settings: Settings
    planar: bool
    threads: int = 1
    _previous: deque = field(init=False)
    _rejected_in_a_row: int = 0

    def __post_init__(self):
        self._previous = deque(maxlen=self.settings.n_previous)

    def add(self, xyz_m, prior):
        """Judge the next scan.

        Parameters
        ----------
        xyz_m : (n, 3) float
            Points in the sensor frame, finite.
        prior : (4, 4) float
            The localiser's world_from_sensor at the scan's stamp; NaN where it has none.

        Returns
        -------
        Verdict
        """
        if not np.isfinite(prior).all():
            return Verdict(False, "pose_gap", np.full((4, 4), np.nan))
        if len(xyz_m) < self.settings.min_points:
            return Verdict(False, "too_few_points", prior)
        if self.settings.icp_method == GIVEN_POSES:
            return Verdict(True, "kept", prior)
        level_from_sensor = _level_from_sensor(prior) if self.planar else _IDENTITY
        world_from_cloud = prior @ se3.inverse(level_from_sensor)
        cloud = icp.prepare(
            se3.transform(level_from_sensor, xyz_m),
            planar=self.planar,
            voxel_m=self.settings.voxel_m,
            threads=self.threads,
        )
        if len(cloud.xyz_m) < _FEWEST_PLACES:
            return Verdict(False, "too_few_points", prior)
        verdict = self._judge(_Placed(cloud, world_from_cloud), level_from_sensor)
        self._remember(cloud, verdict, level_from_sensor)
        return verdict

    def _judge(self, scan, level_from_sensor):
        prior = scan.world_from_cloud @ level_from_sensor
        if not self._previous:
            return Verdict(True, "anchor", prior)
        s = self.settings
        before = self._mean_fitness(scan)
        if before < s.min_prior_fitness:
            return self._rejected("low_prior_fitness", prior, before)
        refined, rmse_m, sound = self._refine(scan)
        if not sound:
            return self._rejected("icp_diverged", prior, before, rmse_m=rmse_m)
        after = self._mean_fitness(refined)
        if after < s.min_refined_fitness:
            return self._rejected("low_refined_fitness", prior, before, after, rmse_m)
        return Verdict(True, "kept", refined.world_from_cloud @ level_from_sensor, before, after, rmse_m)

    def _rejected(self, reason, prior, before, after=np.nan, rmse_m=np.nan):
        # a lost region is worse than a seam: after a run of rejections the localiser is believed again
        if self._rejected_in_a_row + 1 >= self.settings.anchor_after:
            return Verdict(True, "anchor", prior, before, after, rmse_m)
        return Verdict(False, reason, prior, before, after, rmse_m)

    def _remember(self, cloud, verdict, level_from_sensor):
        self._rejected_in_a_row = 0 if verdict.kept else self._rejected_in_a_row + 1
        if verdict.reason == "anchor":
            self._previous.clear()
        if verdict.kept:
            self._previous.append(_Placed(cloud, verdict.world_from_sensor @ se3.inverse(level_from_sensor)))

    def _mean_fitness(self, scan):
        return float(
            np.mean(
                [
                    icp.fitness(
                        scan.cloud,
                        target.cloud,
                        se3.inverse(target.world_from_cloud) @ scan.world_from_cloud,
                        distance_m=self.settings.fitness_distance_m,
                        threads=self.threads,
                    )
                    for target in self._previous
                ]
            )
        )

    def _refine(self, scan):
        s = self.settings
        world_from_target = self._previous[-1].world_from_cloud
        fit = icp.align(
            scan.cloud,
            self._target(),
            se3.inverse(world_from_target) @ scan.world_from_cloud,
            method=s.icp_method,
            distance_m=s.icp_distance_m,
            max_iterations=s.icp_max_iterations,
        )
        refined = se3.rigid(world_from_target @ fit.target_from_source)
        shift_m, turn_deg = _size(se3.inverse(scan.world_from_cloud) @ refined)
        sound = np.isfinite(fit.rmse_m) and shift_m <= s.max_correction_m and turn_deg <= s.max_correction_deg
        # a chain of alignments drifts without bound; a share of the localiser's unbiased pose holds it
        world_from_cloud = se3.between(refined, scan.world_from_cloud, s.localiser_share)
        return _Placed(scan.cloud, world_from_cloud), fit.rmse_m, bool(sound)

    def _target(self):
        """The last retained scans as one cloud, in the frame of the very last."""
        last = list(self._previous)[-self.settings.icp_targets :]
        if len(last) == 1:
            return last[0].cloud
        target_from_world = se3.inverse(last[-1].world_from_cloud)
        motions = [target_from_world @ placed.world_from_cloud for placed in last]
        return icp.merge(
            [placed.cloud for placed in last], motions, voxel_m=self.settings.voxel_m, threads=self.threads
        )


def _level_from_sensor(world_from_sensor):
    """Rotation part of a pose without its heading, and its height: what a planar survey's scans are levelled by."""
    heading = se3.yaw_rad(world_from_sensor)
    cos, sin = np.cos(heading), np.sin(heading)
    world_from_level = np.eye(4)
    world_from_level[:2, :2] = [[cos, -sin], [sin, cos]]
    world_from_level[:2, 3] = world_from_sensor[:2, 3]
    return se3.inverse(world_from_level) @ world_from_sensor


def _size(motion):
    """Length in metres and angle in degrees of a 4 x 4 motion."""
    cosine = np.clip((np.trace(motion[:3, :3]) - 1) / 2, -1, 1)
    return float(np.linalg.norm(motion[:3, 3])), float(np.degrees(np.arccos(cosine)))
