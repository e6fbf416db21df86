"""Contradictions of a plan with its own rays and sizes: numbers with limits."""

import numpy as np
import shapely

from scanplan.plan.floorplan import WAYS, FloorPlan, centrelines_m, line_shapes
from scanplan.plan.tolerances import END_M
from scanplan.rays.ray_set import RaySet
from scanplan.stage.witnesses import Measured, state_witness
from scanplan.types import FloatArray
from scanplan.validation.mirrors import measure_mirrored_share
from scanplan.validation.prediction import Validation

_LEAST_STOREY_M = 2.3  # clear height of rooms: where no floor was seen, it is as far down
_NARROWEST = 1.0  # percent of the way: a scan or two may lie beside it
_LOOKS = 60  # places along the way: of more, pairs that are parted are no other share
_PARTED = 0.2  # of pairs of places: a drive of several rooms; in a hall all see one another


def measure_plan(
    plan: FloorPlan, rays: RaySet, xyz_m: FloatArray, found: Validation
) -> list[Measured]:
    """Measure whether a plan can be.

    Parameters
    ----------
    rays : ray_set.RaySet
        Of scans that it was not made of.
    xyz_m : (n, 3) float64
        Where the sensor was, of all registered scans.
    found : prediction.Validation
        What these rays say of it.
    """
    whole = {name: values[-1] for name, values in found.elements.items()}
    share = float(whole["share"])
    mirrored, where = measure_mirrored_share(plan, rays, xyz_m[:, :2])
    # a grid map is in metres by its own statement
    door_m = np.nan if rays.planar else measure_narrowest_door(plan)
    sensor_z_m = np.nan if rays.planar else float(np.median(xyz_m[:, 2]))
    above_m = plan.ceiling_z_m - sensor_z_m
    return [
        state_witness("contradicted rays", 1 - share, share=share),
        state_witness("rays through walls", float(whole["n_passed"]) / max(whole["n_rays"], 1)),
        state_witness("mirrored rays", mirrored, where=where),
        state_witness("narrowest place", measure_narrowest(plan, xyz_m[:, :2])),
        state_witness("sensor height", sensor_z_m - plan.floor_z_m),
        state_witness("wide doors", door_m),
        state_witness("head room", measure_head_room(plan, sensor_z_m), above_m=above_m),
    ]


def measure_head_room(plan: FloorPlan, sensor_z_m: float) -> float:
    """Return the sensor's height as a share of the room's, 0 to 1.

    NaN where no ceiling was seen, or most doors stand on the floor that was seen: it is one.
    """
    openings = plan.openings
    is_door = openings["type"] == "door"
    stands = is_door & (openings["sill_m"] < END_M)
    if np.isfinite(plan.floor_z_m) and stands.sum() > is_door.sum() / 2:
        return np.nan
    height_m = np.fmax(plan.ceiling_z_m - plan.floor_z_m, _LEAST_STOREY_M)
    return 1 - (plan.ceiling_z_m - sensor_z_m) / height_m


def measure_narrowest_door(plan: FloorPlan) -> float:
    """Return how wide the narrowest door or passage is, metres, where no rays were recorded.

    NaN of others: where a sensor was carried tells more.
    """
    widths_m = plan.openings["width_m"][np.isin(plan.openings["type"], WAYS)]
    return float(widths_m.min()) if plan.doubted.rayless and len(widths_m) else np.nan


def measure_narrowest(plan: FloorPlan, track_m: FloatArray) -> float:
    """Return how near the sensor came to a wall where it was nearest; NaN of a drive in one room.

    Parameters
    ----------
    track_m : (n, 2) float64
    """
    faces = line_shapes(centrelines_m(plan.faces))
    places_m = track_m[:: max(1, len(track_m) // _LOOKS)]
    source, target = np.triu_indices(len(places_m), 1)
    if len(source) == 0:
        return np.nan
    views = line_shapes(np.stack([places_m[source], places_m[target]], axis=1))
    hidden = np.unique(shapely.STRtree(faces).query(views, predicate="intersects")[0])
    if len(hidden) < _PARTED * len(views):
        return np.nan
    _, apart_m = shapely.STRtree(faces).query_nearest(
        shapely.points(track_m), return_distance=True, all_matches=False
    )
    return float(np.percentile(apart_m, _NARROWEST))
