"""Map of a drive whose poses are a localiser's: what is asked of it to find whether it can be."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from scanplan.geometry import se3
from scanplan.registration import constraints, joins, loops
from scanplan.registration.batches import CandidateScans
from scanplan.registration.drift import folds, submaps
from scanplan.registration.drift.odometry import measure_way
from scanplan.registration.multiway import OptimisedMap
from scanplan.registration.prepared_clouds import PreparedCloud, PreparedScans
from scanplan.registration.registration_settings import DriftSettings
from scanplan.types import FloatArray, IntArray

_STATION_M = 0.5  # scans nearer to one another add next to nothing to a submap


@dataclass(frozen=True, eq=False)
class DrivenMap:
    """Scans in the order of the drive, in one map.

    Attributes
    ----------
    scan_ids : (n,) int, increasing
    t_ns : (n,) int64
    world_from_sensor, world_from_cloud : (n, 4, 4) float64
        Of sensors, and of their level clouds.
    recorded : (n, 4, 4) float64
        World from cloud by the localiser.
    steps : (n - 1, 4, 4) float64 or None
        Of each cloud the pose of the next one by odometry; NaN where it does not know.
    optimised : multiway.OptimisedMap
    clouds : callable
        Returns those of some rows, as `prepared_clouds.PreparedScans` does.
    settled : sequence of int
        Rows of scans of which is known how they lie to the one before.
    """

    scan_ids: IntArray
    t_ns: IntArray
    world_from_sensor: FloatArray
    world_from_cloud: FloatArray
    recorded: FloatArray
    steps: FloatArray | None
    optimised: OptimisedMap
    clouds: Callable[[IntArray], list[PreparedCloud]]
    settled: Sequence[int] = ()

    @cached_property
    def jumps(self) -> list[joins.MapJump]:
        """Those that there are at all."""
        return self.find_jumps()

    def find_jumps(self, begins: Sequence[int] = ()) -> list[joins.MapJump]:
        """Return how the map differs from the known motion between two scans.

        Parameters
        ----------
        begins : sequence of int, increasing
            See `joins.find_tied`.
        """
        is_tied = joins.find_tied(self.scan_ids, self.optimised, begins)
        is_tied[np.asarray(self.settled, np.int64)] = True
        return joins.find_map_jumps(
            self.t_ns, self.world_from_cloud, is_tied, self.steps, self.clouds
        )

    @cached_property
    def places(self) -> folds.PassedTwice:
        """Places that were passed twice."""
        way_m = measure_way(self.world_from_cloud)
        return folds.compare_places(self.make_submaps(), self.world_from_cloud, way_m)

    def make_submaps(self, begin: int = 0, end: int | None = None) -> list[submaps.Submap]:
        """Return what is seen from every few metres of the way, from a scan on and up to another.

        Parameters
        ----------
        begin, end : int
            Rows of the first one and of the one after the last.
        """
        poses = self.world_from_cloud[begin:end]
        is_station = loops.choose_stations(poses, _STATION_M)
        cut = submaps.cut_way(measure_way(poses), DriftSettings.submap_m)
        pieces = [begin + rows[is_station[rows]] for rows in cut]
        return submaps.make_submaps(
            [rows for rows in pieces if len(rows)], self.clouds, self.world_from_cloud
        )


def take_map(
    survey: CandidateScans,
    t_ns: IntArray,
    world_from_sensor: FloatArray,
    optimised: OptimisedMap,
    clouds: PreparedScans,
    motions: FloatArray | None,
) -> DrivenMap:
    """Return the map of a survey's kept candidates.

    Parameters
    ----------
    survey : batches.CandidateScans
        Of the kept ones alone.
    t_ns : (n,) int64
    world_from_sensor : (n, 4, 4) float64
    motions : (n - 1, 4, 4) float64, optional
        How the sensor moved from each to the next by odometry, see `mapping.optimise_map`.
    """
    levels = [constraints.level_pose(prior, planar=survey.planar) for prior in survey.priors]
    level_from_sensor = np.array(levels)
    sensor_from_level = se3.invert_pose(level_from_sensor)
    steps = None
    if motions is not None:
        steps = level_from_sensor[:-1] @ motions @ sensor_from_level[1:]
    return DrivenMap(
        scan_ids=survey.scan_ids,
        t_ns=t_ns,
        world_from_sensor=world_from_sensor,
        world_from_cloud=world_from_sensor @ sensor_from_level,
        recorded=survey.priors @ sensor_from_level,
        steps=steps,
        optimised=optimised,
        clouds=clouds,
    )
