"""Whether chosen scans could be registered on their own, without those between them."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from scanplan.geometry import se3, twists
from scanplan.registration import icp, prepared_clouds
from scanplan.registration.prepared_clouds import PreparedCloud
from scanplan.registration.registration_settings import SequentialSettings
from scanplan.store.tables import ScanStore
from scanplan.types import FloatArray, IntArray
from thesis.beyond.measurements import Measurement

OVERLAPPING = "scans in the largest part that overlaps"
ALIGNED = "scans in the largest part that is registered"
PAIRS_ALIGNED = "pairs registered, of those that overlap"
_RIGHT_M, _RIGHT_DEG = 0.05, 0.5  # an alignment is right: half of what walls may be off by, at 6 m


def largest_part(n: int, pairs: Sequence[tuple[int, int]]) -> float:
    """Return the share of n scans in the largest part that pairs connect."""
    rows, columns = np.array(pairs, int).reshape(-1, 2).T
    graph = coo_array((np.ones(len(rows)), (rows, columns)), shape=(n, n))
    _, part = connected_components(graph, directed=False)
    return np.bincount(part).max() / n


class SubsetRegistration:
    """Registers pairs of a survey's scans from poses as wrong as a localiser's.

    Parameters
    ----------
    map_from_sensor : (n, 4, 4) float
        True poses of its scans, by row.
    seed : int
        Of the localiser's errors.
    """

    def __init__(
        self,
        store: ScanStore,
        map_from_sensor: FloatArray,
        limits: SequentialSettings,
        seed: int,
    ) -> None:
        self._store = store
        self._poses = map_from_sensor
        self._limits = limits
        self._seed = seed
        self._clouds: dict[int, PreparedCloud] = {}
        self._pairs: dict[tuple[int, int], tuple[bool, bool]] = {}

    def judge_pair(self, one: int, other: int) -> tuple[bool, bool]:
        """Return whether two scans overlap enough to be aligned, and whether that is then right."""
        if (one, other) not in self._pairs:
            self._pairs[one, other] = self._judge(one, other)
        return self._pairs[one, other]

    def _judge(self, one: int, other: int) -> tuple[bool, bool]:
        limits = self._limits
        source, target = self._cloud(one), self._cloud(other)
        true = se3.invert_pose(self._poses[other]) @ self._poses[one]
        fitness, _ = prepared_clouds.measure_overlap(
            source,
            target,
            true,
            distance_m=limits.fitness_distance_m,
            n_probes=limits.fitness_points,
        )
        if fitness < limits.min_prior_fitness:
            return False, False
        start = true @ self._draw_error(one, other)
        found = icp.align_clouds(
            source,
            target,
            start,
            icp.IcpSettings(
                method="gicp",
                distances_m=limits.icp_distances_m,
                max_iterations=limits.icp_max_iterations,
            ),
        )
        error = se3.invert_pose(true) @ found.target_from_source
        turn_deg = np.degrees(se3.turn_between_rad(np.eye(4), error))
        is_right = np.linalg.norm(error[:3, 3]) < _RIGHT_M and turn_deg < _RIGHT_DEG
        return True, bool(found.sound and is_right)

    def _draw_error(self, one: int, other: int) -> FloatArray:
        rng = np.random.default_rng([self._seed, one, other])
        limits = self._limits
        x_m, y_m = rng.normal(0, limits.localiser_sigma_m, 2)
        turn_rad = np.radians(rng.normal(0, limits.localiser_sigma_deg))
        return twists.twist_to_motion(np.array([x_m, y_m, 0, 0, 0, turn_rad]))

    def _cloud(self, row: int) -> PreparedCloud:
        if row not in self._clouds:
            xyz_m = self._store.read(int(self._store.scan_ids[row]))
            own_m = se3.transform_points(se3.invert_pose(self._poses[row]), xyz_m)
            planar = self._store.planar
            voxel_m = self._limits.voxel_planar_m if planar else self._limits.voxel_m
            thinned_m = prepared_clouds.thin_voxels(own_m, planar=planar, voxel_m=voxel_m)
            self._clouds[row] = prepared_clouds.prepare_cloud(thinned_m, planar=planar)
        return self._clouds[row]


def measure_registrability(
    subsets: SubsetRegistration,
    places_m: FloatArray,
    orders: Mapping[str, IntArray],
    sizes: Sequence[int],
) -> Iterator[Measurement]:
    """Measure how the first scans of orders hang together.

    Every chosen scan is tried with its five nearest: more links make the graph no better
    connected than their neighbours' do.

    Parameters
    ----------
    places_m : (n, 2) float
        Of the sensor at each scan.
    orders : dict of str to (n,) int
        Rows by method.
    sizes : sequence of int
        Numbers of scans.

    Yields
    ------
    Measurement
        `level` is the number of scans.
    """
    n_nearest = 5
    for method, order in orders.items():
        for size in [size for size in sizes if size <= len(order)]:
            rows = np.sort(order[:size])
            apart_m = np.hypot(*(places_m[rows][:, None] - places_m[rows]).transpose(2, 0, 1))
            nearest = np.argsort(apart_m, axis=1, kind="stable")[:, 1 : n_nearest + 1]
            pairs = sorted({(min(a, b), max(a, b)) for a in range(size) for b in nearest[a]})
            judged = [subsets.judge_pair(int(rows[a]), int(rows[b])) for a, b in pairs]
            outcomes = np.array(judged, bool).reshape(-1, 2)
            overlapping, aligned = (
                [pair for pair, is_so in zip(pairs, outcome, strict=True) if is_so]
                for outcome in outcomes.T
            )
            values = {
                OVERLAPPING: largest_part(size, overlapping),
                ALIGNED: largest_part(size, aligned),
                PAIRS_ALIGNED: len(aligned) / len(overlapping) if overlapping else np.nan,
            }
            for quantity, value in values.items():
                yield Measurement(method, size, 0, quantity, float(value))
