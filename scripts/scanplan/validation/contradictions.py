"""Contradictions between a plan and the stated units, mounting and clock."""

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.plan.floorplan import FloorPlan, centrelines_m, line_shapes
from scanplan.plan.tolerances import CORNER_M, END_M, ENOUGH_RAYS
from scanplan.rays.range_bias import RangeBiasSettings, measure_common_bias
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import STRETCH_M
from scanplan.stage.witnesses import Measured, state_witness
from scanplan.types import Columns, FloatArray


def measure_drawn_walls(plan: FloorPlan, rays: RaySet, track_m: FloatArray) -> list[Measured]:
    """Measure whether returns lie on a plan's walls, and ways lead through none.

    Parameters
    ----------
    rays : ray_set.RaySet
        Of the chosen scans.
    track_m : (k, 2) float64
        Where the sensor was, of all registered scans in the order of recording.
    """
    near = 1.0
    if rays.planar or np.isfinite(plan.floor_z_m):
        near = measure_share_on_walls(plan, rays)
    return [
        state_witness("returns off walls", 1 - near, near=near),
        state_witness("way through walls", measure_share_through_walls(plan, track_m)),
    ]


def measure_range_offset(
    rays: RaySet, segments: Columns, settings: RangeBiasSettings, band_m: float, up: FloatArray
) -> Measured:
    """Measure by how much all ranges are surely too long or too short, by how bent walls look.

    Parameters
    ----------
    rays, segments, settings, band_m, up
        See `range_bias.estimate_range_bias`.
    """
    median_m, sure_m = measure_common_bias(rays, segments, settings.max_incidence_deg, band_m, up)
    which, otherwise = ("long", "shorter") if median_m > 0 else ("short", "longer")
    told = {"offset_m": abs(median_m), "which": which, "otherwise": otherwise}
    return state_witness("range offset", sure_m, **told)


def measure_share_on_walls(plan: FloorPlan, rays: RaySet) -> float:
    """Return the share of returns between floor and ceiling that lie near a drawn face or pane.

    Those that rays went through a pane to are not asked. Of a survey in space that never saw the
    floor, most returns may be of furniture.
    """
    xyz_m = rays.xyz_m
    row = np.arange(len(xyz_m))
    if not rays.planar:
        # comparisons with a ceiling that was not seen are false
        is_flat = xyz_m[:, 2] < plan.floor_z_m + STRETCH_M
        is_flat |= xyz_m[:, 2] > plan.ceiling_z_m - STRETCH_M
        row = np.flatnonzero(~is_flat)
    # as many as one scan has tell enough
    row = row[:: len(rays.scan_ids)]
    end_m = xyz_m[row, :2]
    sensor_m = rays.sensors_m[np.searchsorted(rays.first, row, "right") - 1, :2]
    panes = line_shapes(centrelines_m(plan.openings)[plan.openings["type"] == "glass"])
    drawn = shapely.STRtree([*line_shapes(centrelines_m(plan.faces)), *panes])
    points = np.asarray(shapely.points(end_m), object)
    near = drawn.query(points, predicate="dwithin", distance=END_M)[0]
    beams = line_shapes(np.stack([sensor_m, end_m], axis=1))
    beyond = np.setdiff1d(shapely.STRtree(panes).query(beams, predicate="intersects")[0], near)
    return len(np.unique(near)) / max(len(row) - len(beyond), 1)


def measure_share_through_walls(plan: FloorPlan, track_m: FloatArray) -> float:
    """Return the share of the steps between two scans that cross a wall where there is no way.

    A straight line between scans farther apart than a thick wall and what a rover keeps from both
    of its sides may cut the corner that it drove around, and is not judged. Nothing is said of few
    steps.
    """
    steps = line_shapes(np.stack([track_m[:-1], track_m[1:]], axis=1))
    length_m = shapely.length(steps)
    steps = steps[(length_m > SHORTEST_M) & (length_m <= 2 * (CORNER_M + STRETCH_M))]
    if len(steps) < ENOUGH_RAYS:
        return 0.0
    open_area = overlays.unite_areas(overlays.buffer_shapes(plan.gaps, END_M, quad_segs=8))
    walls = overlays.subtract_lines(overlays.unite_lines(plan.axes), open_area)
    return float(shapely.intersects(steps, walls).mean())
