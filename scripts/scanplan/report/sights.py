"""From where each doubtful element was seen best, and what was measured there: for the page."""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np
import shapely

from scanplan.exports.opening_extents import vertical_extent_m
from scanplan.geometry import overlays
from scanplan.geometry.lines import Line, left_normals
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.rays import face_rays, tolerances
from scanplan.rays.ray_set import RaySet, gather_rays
from scanplan.store.registered_scans import RegisteredScans
from scanplan.types import Array, FloatArray
from scanplan.validation import doubts
from scanplan.validation.confidence import END
from scanplan.validation.doubts import Doubt

_MOST_SCANS = 50  # read at a time: rays of 65,000 returns a scan take 100 MB
_CELL_M = 0.05  # along an element, in which one ray or many tell the same
_AROUND_M = 1.0  # beside an element, of which rays are shown, too
_AT_END_M = 0.75  # on both sides of an end that is not sure
_MOST_ROOM_M = 3.0  # from the middle of a room: what one turn of the head takes in
_MOST_RAYS = 100  # of one picture: more make it black
_PER_M = 100  # centimetres: returns are not exact to less
_NS = 1e9


def find_sights(
    plan: FloorPlan,
    scans: Iterable[tuple[int, Array]],
    registered: RegisteredScans,
    *,
    planar: bool,
) -> dict[str, Any]:
    """Return the best view of each element that is to be verified, among scans of a plan.

    It is the view in which rays reach most of the element, from the nearest place where several do.

    Parameters
    ----------
    scans : iterable of (scan_id, (n, 3) array)
        Map frame, metres, by increasing id; read some at a time.
    registered : registered_scans.RegisteredScans
        All scans that were kept: the sensor's way.

    Returns
    -------
    dict
        `planar`; the length `way_m` of the sensor's way; `of`, by element: `ends_m` of what is
        looked at, and its heights `low_m` and `high_m` above the floor; where the sensor was
        (`at_m`, height above the floor) as far along its way (`along_m`) and as many seconds
        (`t_s`) after its beginning, `far_m` from the element; `rays`: where rays at it and beside
        it end, x and y after each other, centimetres from the sensor. What no scan saw is left out.
    """
    asked = {doubt.element: _ask(plan, doubt) for doubt in doubts.list_doubts(plan)}
    steps_m = np.hypot(*np.diff(registered.map_from_sensor[:, :2, 3], axis=0).T)
    along_m = np.concatenate([[0.0], np.cumsum(steps_m)])
    row_of = {scan_id: row for row, scan_id in enumerate(registered.scan_ids.tolist())}
    sensors_m = {scan_id: registered.map_from_sensor[row, :3, 3] for scan_id, row in row_of.items()}
    found: dict[str, tuple[tuple[int, float], int, list[int]]] = {}
    waiting = iter(scans)
    while block := list(islice(waiting, _MOST_SCANS)):
        # the plan knows the floor better than some scans do
        rays = gather_rays(block, sensors_m, planar=planar, floor_z_m=plan.storey_m[0])
        for element, what in asked.items():
            worth, scan = _choose_scan(plan, rays, what)
            if worth > found.get(element, ((0, 0.0),))[0]:
                ends = _list_ends(plan, rays, scan, what)
                found[element] = worth, int(rays.scan_ids[scan]), ends
    sights = {}
    for element, ((_, far_m), scan_id, ends_cm) in found.items():
        row, what = row_of[scan_id], asked[element]
        above_m = sensors_m[scan_id] - [0.0, 0.0, plan.storey_m[0]]
        sights[element] = {
            "ends_m": what.line.at(what.reach_m).round(3).tolist(),
            "low_m": round(what.heights_m[0], 3),
            "high_m": round(what.heights_m[1], 3),
            "at_m": above_m.round(3).tolist(),
            "along_m": round(float(along_m[row]), 2),
            "t_s": round(float(registered.t_ns[row] - registered.t_ns[0]) / _NS, 1),
            "far_m": round(-far_m, 2),
            "rays": ends_cm,
        }
    return {"planar": planar, "way_m": round(float(along_m[-1]), 2), "of": sights}


@dataclass(frozen=True, eq=False)
class _Asked:
    """A stretch of a line that a doubt is about, its heights, and how near a return is of it."""

    line: Line
    reach_m: FloatArray
    heights_m: tuple[float, float]
    at_m: float


def _ask(plan: FloorPlan, doubt: Doubt) -> _Asked:
    columns, row = _find_row(plan, doubt)
    heights_m = _find_heights(plan, doubt, row)
    if doubt.kind == "room":
        low_x_m, _, high_x_m, _ = shapely.bounds(plan.areas[row])
        reach_m = np.clip([low_x_m, high_x_m] - doubt.place_m[0], -_MOST_ROOM_M, _MOST_ROOM_M)
        across = Line(doubt.place_m, np.array([0.0, 1.0]))
        return _Asked(across, reach_m, heights_m, tolerances.ON_M)
    axis = floorplan.draw_axis({name: values[row] for name, values in columns.items()})
    ends_m = shapely.get_coordinates(axis)[[0, -1]]
    line = Line(ends_m[0], left_normals(ends_m[None])[0])
    reach_m = np.array([0.0, np.hypot(*(ends_m[1] - ends_m[0]))])
    if doubt.about == END:
        reach_m = float(line.along_m(doubt.place_m)) + np.array([-_AT_END_M, _AT_END_M])
    # returns are of a wall's sides, its line is between them
    half_m = float(np.nan_to_num(columns["thickness_m"][row])) / 2 if doubt.kind != "face" else 0
    return _Asked(line, reach_m, heights_m, tolerances.ON_M + half_m)


def _find_row(plan: FloorPlan, doubt: Doubt) -> tuple[dict[str, Array], int]:
    columns = dict(getattr(plan, f"{doubt.kind}s"))
    return columns, int(np.flatnonzero(columns[doubt.kind] == doubt.number)[0])


def _find_heights(plan: FloorPlan, doubt: Doubt, row: int) -> tuple[float, float]:
    """Return from where to where above the floor an element is drawn."""
    if doubt.kind == "opening":
        return vertical_extent_m(plan, row)
    return 0.0, float(plan.heights_m[row]) if doubt.kind == "wall" else plan.storey_m[1]


def _choose_scan(plan: FloorPlan, rays: RaySet, what: _Asked) -> tuple[tuple[int, float], int]:
    """Return what the best view of a stretch is worth, the more the better, and its scan's row."""
    low_m, high_m = what.reach_m.tolist()
    met = face_rays.cast_at_face(rays, what.line, low_m, high_m, at_m=what.at_m)
    reaches = ~met.is_occluded & _is_between(plan, rays, met.height_m)
    reaches &= (met.along_m >= low_m) & (met.along_m <= high_m)
    cells = ((met.along_m[reaches] - low_m) / _CELL_M).astype(int)
    n_cells = int((high_m - low_m) / _CELL_M) + 1
    keys = np.unique(met.scan[reaches] * n_cells + cells)
    counts = np.bincount(keys // n_cells, minlength=len(rays.scan_ids))
    middle_m = what.line.at((low_m + high_m) / 2)
    far_m = np.hypot(*(rays.sensors_m[:, :2] - middle_m).T)
    best = int(np.lexsort([far_m, -counts])[0])
    return (int(counts[best]), -float(far_m[best])), best


def _is_between(plan: FloorPlan, rays: RaySet, height_m: FloatArray) -> Array:
    """Return which heights (n,) are neither the floor's nor the ceiling's."""
    if rays.planar:
        return np.ones(len(height_m), bool)
    top_m = plan.storey_m[1] - tolerances.SKIRTING_M
    return (height_m > tolerances.SKIRTING_M) & (height_m < top_m)


def _list_ends(plan: FloorPlan, rays: RaySet, scan: int, what: _Asked) -> list[int]:
    """Return where rays of a scan end that go at a stretch and beside it, from the sensor."""
    scans = np.array([scan])
    reach_m = what.reach_m + np.array([-_AROUND_M, _AROUND_M])
    low, high = rays.rows_between(what.line.at(reach_m)[:, None], scans)
    xyz_m, _ = rays.gather_rows(low, high, scans)
    shown_m = xyz_m[_is_between(plan, rays, xyz_m[:, 2] - plan.storey_m[0]), :2]
    thinned_m = shown_m[:: -(-len(shown_m) // _MOST_RAYS) or 1]
    return np.rint((thinned_m - rays.sensors_m[scan, :2]) * _PER_M).astype(int).ravel().tolist()


def simplify_track(registered: RegisteredScans) -> FloatArray:
    """Return the sensor's track (n, 2), map frame, as far as a drawing shows it."""
    places_m = registered.map_from_sensor[:, :2, 3]
    # a single scan is a track, too
    track = shapely.LineString(np.concatenate([places_m[:1], places_m]))
    return shapely.get_coordinates(overlays.simplify_shapes(track, _CELL_M))
