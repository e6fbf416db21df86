"""The rays of scans that a plan was not made of: a test set that every survey has."""

from collections.abc import Iterator

import numpy as np

from scanplan.plan.floorplan import FloorPlan
from scanplan.rays.ray_set import RaySet, gather_rays
from scanplan.rays.tolerances import SKIRTING_M
from scanplan.store.registered_scans import RegisteredScans, ScanReader
from scanplan.types import FloatArray, IntArray
from scanplan.validation.prediction import ValidationSettings


def draw_left_out_rays(
    store: ScanReader,
    registered: RegisteredScans,
    chosen_ids: IntArray,
    plan: FloorPlan,
    limits: ValidationSettings,
) -> RaySet:
    """Draw rays of registered scans that a plan was not made of, see `draw_rays`.

    Parameters
    ----------
    chosen_ids : (k,) int
        The scans that the plan was made of.

    Returns
    -------
    RaySet
        Of at most `limits.max_scans` scans, which its `scan_ids` names.
    """
    seed = limits.seed
    left_out_ids = np.setdiff1d(registered.scan_ids, chosen_ids)
    scan_ids = draw_left_out_scans(left_out_ids, limits.max_scans, seed)
    rows = np.searchsorted(registered.scan_ids, scan_ids)
    sensors_m = registered.map_from_sensor[rows, :3, 3]
    storey_z_m = (plan.storey_m[0], plan.ceiling_z_m)
    return draw_rays(store, scan_ids, sensors_m, storey_z_m, max_rays=limits.max_rays, seed=seed)


def draw_left_out_scans(left_out_ids: IntArray, max_scans: int, seed: int) -> IntArray:
    """Return at most so many of the scans left out, increasing, drawn without replacement."""
    n = min(max_scans, len(left_out_ids))
    return np.sort(np.random.default_rng(seed).choice(left_out_ids, n, replace=False))


def draw_rays(
    store: ScanReader,
    scan_ids: IntArray,
    sensors_m: FloatArray,
    storey_z_m: tuple[float, float],
    *,
    max_rays: int,
    seed: int,
) -> RaySet:
    """Draw rays of scans that say something of walls: those that end between floor and ceiling.

    Which these are depends on the returns alone, and not on what the plan predicts.

    Parameters
    ----------
    scan_ids : (s,) int, increasing
    sensors_m : (s, 3) float
        Map frame.
    storey_z_m : (float, float)
        Heights of floor and ceiling in the map frame, NaN where not known.
    max_rays : int
        Of all scans together, as many of each.
    """
    random = np.random.default_rng(seed)
    of_each = max_rays // max(len(scan_ids), 1)
    floor_m, ceiling_m = storey_z_m

    def drawn() -> Iterator[tuple[int, FloatArray]]:
        for scan_id, xyz_m in store.scans(scan_ids):
            usable_m = xyz_m
            if not store.planar:
                is_low = usable_m[:, 2] <= floor_m + SKIRTING_M
                is_high = usable_m[:, 2] >= ceiling_m - SKIRTING_M
                usable_m = usable_m[~is_low & ~is_high]
            n = min(of_each, len(usable_m))
            yield scan_id, usable_m[random.choice(len(usable_m), n, replace=False)]

    positions_m = dict(zip(scan_ids.tolist(), sensors_m, strict=True))
    return gather_rays(drawn(), positions_m, planar=store.planar)
