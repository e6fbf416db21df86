"""Truths that a person drew from a real recording's points, and plans moved onto them.

A GeoJSON in metres of the map frame, with features by `kind`: `room` (Polygon; `name`, `entered`),
`opening` (LineString; `type`), `surface` (stretches of wall that returns support), `unseen` (edges
of rooms that hardly any does), `ignore` (ground of which nothing is said).
"""

import numpy as np
import shapely
from scipy.optimize import OptimizeResult, minimize
from scipy.spatial import KDTree

from scanplan.geometry import overlays
from scanplan.lab.evaluation.scores.drawn_plan import DrawnPlan
from scanplan.lab.evaluation.scores.scene import (
    DOORS,
    Scene,
    TrueOpenings,
    no_lines,
    outline_sides_m,
)
from scanplan.lab.evaluation.scores.scene_file import object_array, read_parts
from scanplan.types import Array, FilePath, FloatArray

_GAP_M = 0.3  # of a surface beside an opening or an edge that nothing supports: drawn by eye
_SAMPLE_M = 0.05  # between places of a surface, and
_DRAWN_M = 0.1  # of a plan's faces, that the motion is fitted by
_FARTHEST_M = 0.4  # a surface that is farther from all faces is missing, and pulls no more
_STARTS_M = (-0.3, 0.0, 0.3)  # a registration shifts a map by no more
_STARTS_RAD = (-0.01, 0.0, 0.01)
_STEP_M = 0.2  # of the search's first simplex, and
_STEP_RAD = 0.01
_COARSE = 8  # every so many places tell which start is best
_DOOR_M = 0.5  # from the middle of a door drawn by eye; or a third of its width


def read_hand_scene(path: FilePath) -> Scene:
    """Read a truth drawn by hand, as a scene that is a part of a floor.

    Raises
    ------
    StageError
        If it is no GeoJSON, or a feature has no geometry that can be read.
    """
    parts = read_parts(path)
    drawn_openings = parts.get("opening", [])
    cuts = overlays.unite_shapes([g for k in ("opening", "unseen") for _, g in parts.get(k, [])])
    surfaces = [
        overlays.subtract_lines(g, overlays.buffer_shapes(cuts, _GAP_M))
        for _, g in parts.get("surface", [])
    ]
    runs_m = [outline_sides_m(part) for g in surfaces for part in shapely.get_parts(g)]
    faces_m = np.concatenate([no_lines(), *runs_m])
    n_openings = len(drawn_openings)
    rooms = parts.get("room", [])
    return Scene(
        inner_m=faces_m[np.hypot(*(faces_m[:, 1] - faces_m[:, 0]).T) > 0],
        openings=TrueOpenings(
            lines_m=np.array(
                [shapely.get_coordinates(g)[[0, -1]] for _, g in drawn_openings], float
            ).reshape(-1, 2, 2),
            type=np.array([v.get("type", "door") for v, _ in drawn_openings], object),
            sill_m=np.full(n_openings, np.nan),
            lintel_m=np.full(n_openings, np.nan),
            thickness_m=np.zeros(n_openings),
            glazed=np.zeros(n_openings, bool),
            entered=np.ones(n_openings, bool),
            driven=np.zeros(n_openings, bool),
            shut=np.zeros(n_openings, bool),
        ),
        rooms=object_array([g for _, g in rooms]),
        names=np.array([str(v.get("name", "")) for v, _ in rooms], object),
        entered=np.array([bool(v.get("entered", True)) for v, _ in rooms], bool),
        ceiling_m=np.full((len(rooms), 2), np.nan),
        ignored=overlays.unite_areas([g for _, g in parts.get("ignore", [])]),
        opening_m=_DOOR_M,
        is_whole=False,
    )


def fit_motion(lines_m: FloatArray, scene: Scene) -> FloatArray:
    """Return the small rigid motion that brings a plan's faces nearest to a scene's surfaces.

    A registration may shift a map. It is the one with the least mean distance of places of the
    surfaces from the faces, of which more than 0.4 m counts as that; of 27 starts within 0.3 m and
    0.01 rad the best, by some of the places, and from there by all.

    Parameters
    ----------
    lines_m : (n, 2, 2) float
        Of the plan, in its own frame.

    Returns
    -------
    (4, 4) float64
        Level, to the frame of the scene; no motion where there is nothing to fit.
    """
    places_m, drawn_m = _sample(scene.inner_m, _SAMPLE_M), _sample(lines_m, _DRAWN_M)
    if not len(places_m) or not len(drawn_m):
        return np.eye(4)
    middle_m = places_m.mean(axis=0)
    tree = KDTree(drawn_m)

    def mean_distance_m(values: FloatArray, some_m: FloatArray) -> float:
        back = np.linalg.inv(_motion(values, middle_m))
        moved_m = some_m @ back[:2, :2].T + back[:2, 3]
        apart_m, _ = tree.query(moved_m, distance_upper_bound=_FARTHEST_M)
        return float(np.minimum(apart_m, _FARTHEST_M).mean())

    def search(start: FloatArray, some_m: FloatArray) -> OptimizeResult:
        simplex = {"initial_simplex": start + steps}
        return minimize(mean_distance_m, start, (some_m,), method="Nelder-Mead", options=simplex)

    steps = np.vstack([np.zeros(3), np.diag([_STEP_M, _STEP_M, _STEP_RAD])])
    starts = np.array(np.meshgrid(_STARTS_M, _STARTS_M, _STARTS_RAD)).reshape(3, -1).T
    found = [search(start, places_m[::_COARSE]) for start in starts]
    best = min(found, key=lambda result: float(result.fun))
    return _motion(search(best.x, places_m).x, middle_m)


def measure_hand_doors(plan: DrawnPlan, scene: Scene) -> dict[str, float]:
    """Return how many doors drawn by eye have a drawn door or passage near their middle.

    `hand_doors_true` and `hand_doors_found`: within 0.5 m, or a third of its width if that is more.
    """
    true = scene.openings.is_door
    middle_m = scene.openings.lines_m[true].mean(axis=1)
    width_m = np.hypot(*np.moveaxis(np.diff(scene.openings.lines_m[true], axis=1)[:, 0], -1, 0))
    drawn_m = plan.openings_m[np.isin(plan.type, DOORS)].mean(axis=1)
    apart_m = np.hypot(*np.moveaxis(middle_m[:, None] - drawn_m[None], -1, 0))
    found = apart_m.min(axis=1, initial=np.inf) < np.maximum(_DOOR_M, width_m / 3)
    return {"hand_doors_true": len(found), "hand_doors_found": int(found.sum())}


def _sample(lines_m: FloatArray, step_m: float) -> FloatArray:
    """Return places (k, 2) along lines, the first half a step from their starts."""
    places: list[Array] = [np.empty((0, 2))]
    for line_m in lines_m:
        length_m = float(np.hypot(*(line_m[1] - line_m[0])))
        if length_m > step_m:
            share = np.arange(step_m / 2, length_m, step_m)[:, None] / length_m
            places.append(line_m[0] + share * (line_m[1] - line_m[0]))
    return np.concatenate(places)


def _motion(values: FloatArray, middle_m: FloatArray) -> FloatArray:
    """Return the motion (4, 4) by x, y (m) and a turn (rad) about a place (2,)."""
    cosine, sine = np.cos(values[2]), np.sin(values[2])
    motion = np.eye(4)
    motion[:2, :2] = [[cosine, -sine], [sine, cosine]]
    motion[:2, 3] = middle_m + values[:2] - motion[:2, :2] @ middle_m
    return motion
