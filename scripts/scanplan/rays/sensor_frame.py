"""A scan's points relative to its sensor."""

import numpy as np
import numpy.typing as npt

from scanplan.types import FloatArray, IntArray


def centre_on_sensor(xyz_m: npt.ArrayLike, sensor_xyz_m: npt.ArrayLike) -> FloatArray:
    """Return a scan's points relative to its sensor, in the order given.

    Parameters
    ----------
    xyz_m : (n, 3) float
        Map frame.
    sensor_xyz_m : (3,) float
        Map frame.

    Returns
    -------
    (n, 3) float64
        Axes of the map.

    Raises
    ------
    ValueError
        If a coordinate is not finite or the shapes are not (n, 3) and (3,).
    """
    points_m, sensor_m = np.asarray(xyz_m, float), np.asarray(sensor_xyz_m, float)
    if points_m.ndim != 2 or points_m.shape[1] != 3 or sensor_m.shape != (3,):
        raise ValueError(
            f"points (n, 3) and a position (3,), not {points_m.shape} and {sensor_m.shape}"
        )
    if not (np.isfinite(points_m).all() and np.isfinite(sensor_m).all()):
        raise ValueError("points and sensor position must be finite")
    return points_m - sensor_m


def centre_in_order(xyz_m: npt.ArrayLike, sensor_xyz_m: npt.ArrayLike) -> FloatArray:
    """Return a scan's points relative to its sensor, in an order that depends on the points alone.

    For what draws some of them at random, or takes one before another: as `centre_on_sensor`.
    """
    points_m = centre_on_sensor(xyz_m, sensor_xyz_m)
    return points_m.take(_order_points(np.asarray(xyz_m, float)), axis=0)


def _order_points(xyz_m: FloatArray) -> IntArray:
    """Return an order of points that depends on them alone."""
    mixed = xyz_m @ (1.0, np.sqrt(2), np.sqrt(3))
    order = np.argsort(mixed)
    tied = np.diff(mixed.take(order)) == 0
    # one number a point sorts faster than three, and seldom do different points share it
    return order if not tied.any() else np.lexsort([*xyz_m.T, mixed])
