"""The plan and its points in space, small enough to lie in the report's page."""

import base64
import gzip
from collections.abc import Iterable
from typing import Any

import numpy as np

from scanplan.exports.data.mesh import list_solids
from scanplan.exports.model_colours import COLOURS
from scanplan.plan.floorplan import FloorPlan
from scanplan.report.chart import MARGIN_M
from scanplan.types import Array, FloatArray, IntArray

_MOST_LETTERS = 2_000_000
"""Of bodies and points in the page together, in base64: a page is to be sent by mail."""
_CUBE_M, _COARSER = 0.03, 1.25
"""Side of the cubes that keep one point each: as returns are exact; by how much it grows."""
_MOST_KEPT = 4_000_000  # points at a time while scans are read: 50 MB, and more than fit the page
_MOST_STEPS = 2**16 - 1  # of 16 bits
_BODY_STEP_M, _POINT_STEP_M = 0.001, 0.01
"""What places are rounded to, or coarser on a floor of more than 65 m."""
_EFFORT = 6  # of gzip: 9 takes six times as long for 4 % less
_BEYOND_M = 0.3  # below the floor and above the ceiling: rays through doors to stairs are left out


def pack_script(text: str) -> str:
    """Return a script as it lies in the page until it is needed: gzip, in base64."""
    return _pack(text.encode())


def pack_view(plan: FloorPlan, scans: Iterable[tuple[int, Array]]) -> dict[str, Any]:
    """Return what the page draws in space: x and y of the map frame, height above the floor.

    Parameters
    ----------
    scans : iterable of (scan_id, (n, 3) array)
        Map frame, metres; read one at a time.

    Returns
    -------
    dict
        `low_m` and `high_m` (3) of all places; `floor_m` in the map frame; `height_m` of the
        storey, and what `heights` follow from, in words. `bodies`: `parts` (element, colour, number
        of triangles), and as `data` their corners. `points`: their number `n` of `n_all`, and
        `data`. Data are multiples of `step_m` above `low_m` in 16 bits, packed; those of points
        are differences, each axis by itself.
    """
    low_m, high_m = bound_view(plan)
    longest_m = float(np.max(high_m - low_m))
    bodies = _pack_bodies(plan, low_m, max(_BODY_STEP_M, longest_m / _MOST_STEPS))
    step_m = max(_POINT_STEP_M, longest_m / _MOST_STEPS)
    room = _MOST_LETTERS - len(bodies["data"])
    points = _pack_points(_read_steps(plan, scans, step_m), step_m, room)
    return {
        "low_m": low_m.tolist(),
        "high_m": high_m.tolist(),
        "floor_m": float(plan.storey_m[0]),
        "height_m": round(plan.storey_m[1], 3),
        "heights": describe_heights(plan),
        "bodies": bodies,
        "points": points,
    }


def bound_view(plan: FloorPlan) -> tuple[FloatArray, FloatArray]:
    """Return the least and the greatest place (3,) that is shown, height above the floor."""
    low_m, high_m = plan.bounds_m
    return (
        np.array([*(low_m - MARGIN_M), -_BEYOND_M]),
        np.array([*(high_m + MARGIN_M), plan.storey_m[1] + _BEYOND_M]),
    )


def describe_heights(plan: FloorPlan) -> str:
    """Return how high walls are drawn, and why, in a sentence."""
    height = f"{plan.storey_m[1]:.2f} m"
    if np.isnan(plan.least_height_m):
        return f"Heights are not known: walls are drawn {height} high, as assumed."
    if plan.height_from == "ceiling":
        return f"The ceiling is {height} above the floor."
    source = "the highest wall that was seen" if plan.height_from == "walls" else "assumed"
    return f"The ceiling was not seen: walls are drawn {height} high, as {source}."


def count_steps(
    xyz_m: Array, floor_m: float, bounds_m: tuple[FloatArray, FloatArray], step_m: float
) -> IntArray:
    """Return points (m, 3) of the map frame that are shown, in steps from the least place.

    Parameters
    ----------
    xyz_m : (n, 3) float
        Map frame, metres.
    floor_m : float
        Height of the floor there.
    bounds_m : ((3,), (3,))
        As `bound_view` returns them.
    """
    low_m, high_m = bounds_m
    above_m = xyz_m - np.array([0.0, 0.0, floor_m])
    shown_m = above_m[((above_m >= low_m) & (above_m <= high_m)).all(axis=1)]
    return np.rint((shown_m - low_m) / step_m).astype(np.int64)


def _pack_bodies(plan: FloorPlan, low_m: FloatArray, step_m: float) -> dict[str, Any]:
    solids = [solid for solid in list_solids(plan) if len(solid.triangles_m)]
    corners_m = [solid.triangles_m.reshape(-1, 3) for solid in solids]
    steps = np.rint((np.concatenate([np.zeros((0, 3)), *corners_m]) - low_m) / step_m)
    return {
        "step_m": step_m,
        "parts": [
            (f"{solid.kind} {solid.number}", COLOURS[solid.colour], len(solid.triangles_m))
            for solid in solids
        ],
        "data": _pack(steps.clip(0, _MOST_STEPS).astype("<u2").tobytes()),
    }


def _read_steps(
    plan: FloorPlan, scans: Iterable[tuple[int, Array]], step_m: float
) -> tuple[IntArray, int, float]:
    """Return points in steps, one a cube; how many there were; the side of the cubes, metres."""
    floor_m, bounds_m = plan.storey_m[0], bound_view(plan)
    cube_m = _CUBE_M
    kept: list[IntArray] = [np.zeros((0, 3), np.int64)]
    n_kept = n_all = 0
    for _, xyz_m in scans:
        steps = count_steps(xyz_m, floor_m, bounds_m, step_m)
        n_all += len(steps)
        kept.append(_thin(steps, cube_m / step_m))
        n_kept += len(kept[-1])
        while n_kept > _MOST_KEPT:
            kept = [_thin(np.concatenate(kept), cube_m / step_m)]
            n_kept = len(kept[0])
            cube_m *= _COARSER if n_kept > _MOST_KEPT / 2 else 1
    return _thin(np.concatenate(kept), cube_m / step_m), n_all, cube_m


def _thin(steps: IntArray, side: float) -> IntArray:
    """Return the first point of each cube, by cubes along x, then y, then z."""
    cubes = (steps / side).astype(np.int64)
    keys = (cubes[:, 2] << 40) | (cubes[:, 1] << 20) | cubes[:, 0]
    _, first = np.unique(keys, return_index=True)
    return steps[first]


def _pack_points(
    read: tuple[IntArray, int, float], step_m: float, most_letters: int
) -> dict[str, Any]:
    steps, n_all, cube_m = read
    while len(data := _pack_within(_difference(steps), most_letters)) > most_letters:
        cube_m *= _COARSER
        steps = _thin(steps, cube_m / step_m)
    return {"step_m": step_m, "n": len(steps), "n_all": n_all, "data": data}


def _pack_within(content: bytes, most_letters: int) -> str:
    """Return packed content, or far more of it than the most letters in a part of the time."""
    hasty = gzip.compress(content, 1)
    # letters are a third more than bytes: more effort does not save as much as that
    return base64.b64encode(hasty).decode() if len(hasty) > most_letters else _pack(content)


def _difference(steps: IntArray) -> bytes:
    """Return each axis as differences of 16 bits, lower bytes before upper ones: they pack well."""
    differences = np.diff(steps, axis=0, prepend=0).astype("<u2")
    parted = np.ascontiguousarray(differences.T).view(np.uint8).reshape(3, -1, 2)
    return np.ascontiguousarray(parted.transpose(0, 2, 1)).tobytes()


def _pack(content: bytes) -> str:
    return base64.b64encode(gzip.compress(content, _EFFORT, mtime=0)).decode()
