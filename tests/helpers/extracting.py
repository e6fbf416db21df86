"""Wall segments as a stage finds them, with settings that suit the toy room."""

from dataclasses import replace

import numpy as np

from helpers import toy_rooms
from scanplan.extraction.extractors import EXTRACTORS, find_wall_segments, make_wall_finder

_CLUSTERS = {"reach_deg": 3.5, "bandwidth_m": 0.3, "projection": "normal"}
_THESIS = {"max_tilt_deg": 15.0, "model": "line", "max_trials": 50}
SETTINGS = {
    "cluster_ransac": toy_rooms.LIMITS
    | {"reach_deg": 3.5, "max_tilt_deg": 15.0, "bandwidth_m": 0.3, "trials": 64},
    "iterative_ransac": toy_rooms.LIMITS | {"max_tilt_deg": 15.0, "trials": 200, "max_planes": 20},
    "thesis_cluster_ransac": toy_rooms.LIMITS | _CLUSTERS | _THESIS,
    "thesis_iterative_ransac": toy_rooms.LIMITS | _THESIS,
}


def extract(name, xyz_m, sensor_xyz_m=toy_rooms.SENSOR, *, planar=False, max_rmse_m=None, **more):
    """Return the wall segments of a scan; `more` are further settings."""
    finder = make_wall_finder(EXTRACTORS[name], SETTINGS[name] | more, planar=planar)
    if max_rmse_m is not None:
        finder = replace(finder, max_rmse_m=max_rmse_m)
    place_m = np.asarray(sensor_xyz_m, float)
    return find_wall_segments(3, xyz_m, sensor_xyz_m=place_m, finder=finder)


def values(found):
    """Return what is known of wall segments as columns."""
    return np.column_stack(
        [found.start_m, found.end_m, found.normal, found.n_points, found.rmse_m, found.z_range_m]
    )
