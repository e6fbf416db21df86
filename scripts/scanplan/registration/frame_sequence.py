"""Algorithm 3 with the previous five frames, whatever became of them (thesis, 3.5).

The thesis's two passes, all scans through the first gate and what is left through the second, are
one here: the first gate goes by the localiser's poses alone, the second by scans that lie before.
"""

from collections import deque
from dataclasses import dataclass, field, replace

import numpy as np

from scanplan.registration import constraints, icp
from scanplan.registration.constraints import PlacedScan, PoseConstraint
from scanplan.registration.registration_settings import SequentialSettings
from scanplan.registration.sequential import ScanRegistrar, ScanResult
from scanplan.types import FloatArray


@dataclass
class FrameRegistrar(ScanRegistrar):
    """Compares every candidate with the candidates just before it, and aligns it to the last.

    Those that a gate drops stay frames: the first gate's where the localiser says, the second's
    where they were aligned to. The first frame has none before it and is kept.
    """

    _frames: deque[PlacedScan] = field(init=False)
    # the same frames, those that passed the first gate where they were aligned to
    _aligned: deque[PlacedScan] = field(init=False)

    def __post_init__(self) -> None:
        self._frames = deque(maxlen=self.settings.n_previous)
        self._aligned = deque(maxlen=self.settings.n_previous)

    def register_scan(
        self, scan: PlacedScan, level_from_sensor: FloatArray
    ) -> tuple[ScanResult, list[PoseConstraint]]:
        """Gate a scan, align it, and gate it again."""
        frames = list(self._frames)
        aligned = list(self._aligned)
        prior = scan.world_from_cloud @ level_from_sensor
        prior_fitness, _ = self.measure_overlap(scan, frames) if frames else (np.nan, np.nan)
        self._frames.append(scan)
        if not frames or prior_fitness < self.settings.min_prior_fitness:
            self._aligned.append(scan)
            reason = "low_prior_fitness" if frames else "kept"
            return ScanResult(not frames, reason, prior, prior_fitness), []
        moved, edge = _align_scan(scan, aligned[-1], self.settings)
        self._aligned.append(moved)
        fitness, rmse_m = self.measure_overlap(moved, aligned)
        figures = (prior_fitness, fitness, rmse_m)
        if fitness < self.settings.min_refined_fitness:
            return ScanResult(False, "low_refined_fitness", prior, *figures), []
        return ScanResult(True, "kept", moved.world_from_cloud @ level_from_sensor, *figures), [
            edge
        ]


def _align_scan(
    scan: PlacedScan, target: PlacedScan, settings: SequentialSettings
) -> tuple[PlacedScan, PoseConstraint]:
    """Align a scan to another, without a limit; it stays where it is if there are no pairs."""
    fit = icp.align_clouds(
        scan.cloud,
        target.cloud,
        constraints.relative_pose(scan, target),
        icp.IcpSettings(
            method=settings.icp_method,
            distances_m=settings.icp_distances_m,
            max_iterations=settings.icp_max_iterations,
            n_points=settings.fitness_points,
        ),
    )
    moved = replace(scan, world_from_cloud=target.world_from_cloud @ fit.target_from_source)
    distance_m = settings.icp_distances_m[-1]
    fitness, rmse_m = constraints.measure_facing_overlap(moved, target, distance_m, settings)
    return moved, PoseConstraint(scan.scan_id, target.scan_id, "sequence", fitness, rmse_m, fit)
