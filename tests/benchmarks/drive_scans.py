"""A simulated drive at ten scans a second, with exact poses and without sweep, for selection."""

from typing import Any

import numpy as np
import shapely
import wall_scans

from scanplan.lab.simulation import raycast, survey_setup
from scanplan.selection import hulls
from scanplan.types import Array, FilePath, FloatArray, Settings

RATE_HZ = 10.0  # of a VLP-16
SPEED_M_S = 0.75  # of a rover indoors


def simulate_scans(building: FilePath, settings: Settings, n: int, **site: Any) -> list[FloatArray]:
    """Simulate the first n scans of a drive.

    Parameters
    ----------
    building : path-like
    settings : dict
        The section `simulate` of the configuration.
    n : int
    **site
        Instead of settings of `simulate.site`.

    Returns
    -------
    list of (m, 3) float32
        Points in the map, of each scan.
    """
    drive = {"speed_m_s": SPEED_M_S}
    _, survey = wall_scans.prepare_unswept(
        building, settings, seed=1, rate_hz=RATE_HZ, drive=drive, **site
    )
    scene = raycast.RayScene(survey.mesh)
    poses = survey_setup.true_poses(survey)[1][:n]
    return [wall_scans.scan_points(survey, scene, i, pose) for i, pose in enumerate(poses)]


def scan_polygons(scans: list[FloatArray], settings: Settings, *, thin: int = 1) -> Array:
    """Return the polygons (n,) of scans; `settings` are those of `hulls`."""
    parts = [
        hulls.make_cluster_hulls(i, xyz_m[::thin], **settings) for i, xyz_m in enumerate(scans)
    ]
    return hulls.scan_polygons(hulls.concatenate_hulls(parts))[1]


def polygons_side_by_side(
    scans: list[FloatArray], settings: Settings, *, copies: int, thin: int
) -> Array:
    """Return the polygons of many equal buildings in two rows, each with clusters of its own.

    Parameters
    ----------
    scans : list of (m, 3) float32
        Of the first building.
    settings : dict
        Of `hulls`.
    copies : int
        Number of buildings.
    thin : int
        One point in so many is clustered.
    """
    points_m = np.concatenate([xyz_m[:, :2] for xyz_m in scans])
    width_m = np.ceil(points_m.max(axis=0) - points_m.min(axis=0))
    floors = []
    for i in range(copies):
        shift_m = width_m * [i % (copies // 2), i // (copies // 2)]
        polygons = scan_polygons(scans, {**settings, "seed": i}, thin=thin)
        floors.append(shapely.transform(polygons, lambda xy, shift_m=shift_m: xy + shift_m))
    return np.concatenate(floors)
