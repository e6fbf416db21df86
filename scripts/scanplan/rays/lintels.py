"""The floor by the lintels of doors that were driven through, where no floor was seen.

A sensor that looks upward sees no floor, and the lowest that it sees are tables. Doors are as high
everywhere.
"""

from collections.abc import Iterator, Mapping

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from scanplan.geometry.lines import Line
from scanplan.geometry.passages import find_passages
from scanplan.rays.ray_set import RaySet
from scanplan.types import Array, FloatArray

_DOWN, _DOWN_SHARE = 0.2, 0.01  # a slope of 11 degrees: of sensors that look down to 15 an eighth
_LINTEL_M = 2.05  # DIN 18101: openings of 2.005 and 2.13 m; 2.03 and 2.13 where doors are in feet
_LEAST_PLACES = 2  # one may be the arch of a hall
_DOUBT_M = 0.2  # doors of old houses, and of some countries, differ by so much
_AT_M, _BESIDE_M = 0.06, 0.2  # of a crossing: what errs, and half of a narrow door's width
_ABOVE_M, _BELOW_M = 0.2, 0.5  # the sensor: there a door is closed, and there it is open
_LEAST_RETURNS = 4
_OPEN_SHARE = 0.1  # of the returns above may lie below: edges, people
_LOW_PERCENT = 5
_PLACE_M = 1.0  # both faces of a wall are one, and every pass of a door


def settle_floor_z(rays: RaySet, segments: Mapping[str, Array], track_m: FloatArray) -> float:
    """Return the height of the floor: as it was seen, or else as the doors driven through have it.

    Parameters
    ----------
    segments : dict of str to (n,) array
        `scan_id`, `x0_m`, `y0_m`, `x1_m`, `y1_m` of walls that those scans saw.
    track_m : (k, 2) float64
        Where the sensor was, one place after the other.

    Returns
    -------
    float
        `rays.floor_z_m` where the sensor looks down, few doors were driven through, or both agree;
        NaN where all scans lie in one plane.
    """
    if np.isnan(rays.floor_z_m) or _looks_down(rays) or len(track_m) < 2:
        return rays.floor_z_m
    found = np.array(list(_find_lintels(rays, segments, track_m))).reshape(-1, 3)
    is_near = np.linalg.norm(found[:, None, :2] - found[:, :2], axis=2) <= _PLACE_M
    n_places, place = connected_components(csr_array(is_near), directed=False)
    of_places = [float(np.median(found[place == of, 2])) for of in range(n_places)]
    if len(of_places) < _LEAST_PLACES:
        return rays.floor_z_m
    floor_z_m = float(np.median(of_places)) - _LINTEL_M
    return rays.floor_z_m if abs(rays.floor_z_m - floor_z_m) <= _DOUBT_M else floor_z_m


def _looks_down(rays: RaySet) -> bool:
    """Return whether returns come from below: whoever looks down in a room sees its floor."""
    n_below = sum(
        np.count_nonzero(way_m[:, 2] < -_DOWN * np.hypot(way_m[:, 0], way_m[:, 1]))
        for _, way_m in rays.headings()
    )
    return bool(n_below > _DOWN_SHARE * len(rays.xyz_m))


def _find_lintels(
    rays: RaySet, segments: Mapping[str, Array], track_m: FloatArray
) -> Iterator[tuple[float, float, float]]:
    """Yield where the sensor went below what it saw of a wall, and how high that begins."""
    begin_m, end_m = (
        np.column_stack([segments[f"x{end}_m"], segments[f"y{end}_m"]]) for end in (0, 1)
    )
    scan = np.searchsorted(rays.scan_ids, segments["scan_id"])
    for row, line, place_m in _cross(begin_m, end_m, track_m):
        of = scan[row]
        xyz_m = rays.xyz_m[rays.first[of] : rays.first[of + 1]]
        is_near = np.abs(line.offset_m(xyz_m[:, :2])) <= _AT_M
        is_near &= np.abs(line.along_m(xyz_m[:, :2]) - place_m) <= _BESIDE_M
        z_m = xyz_m[is_near, 2] - rays.sensors_m[of, 2]
        above_m = z_m[z_m > _ABOVE_M]
        n_below = int(((z_m <= _ABOVE_M) & (z_m > -_BELOW_M)).sum())
        if len(above_m) >= _LEAST_RETURNS and n_below <= _OPEN_SHARE * len(above_m):
            lintel_m = float(np.percentile(above_m, _LOW_PERCENT))
            yield *line.at(place_m).tolist(), float(rays.sensors_m[of, 2]) + lintel_m


def _cross(
    begin_m: FloatArray, end_m: FloatArray, track_m: FloatArray
) -> Iterator[tuple[int, Line, float]]:
    """Yield the row of each segment (n, 2) that a way crosses, its line, and where along that."""
    way_m = end_m - begin_m
    length_m = np.linalg.norm(way_m, axis=1)
    normal = np.column_stack([-way_m[:, 1], way_m[:, 0]]) / length_m[:, None]
    for row, (centre, across) in enumerate(zip(begin_m, normal, strict=True)):
        line = Line(centre, across)
        place_m = find_passages(line, track_m)
        for along_m in place_m[(place_m >= 0) & (place_m <= length_m[row])].tolist():
            yield row, line, along_m
