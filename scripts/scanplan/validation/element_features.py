"""Features of a plan's elements: their evidence, and their fit to their surroundings."""

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.geometry.lines import line_lengths_m
from scanplan.plan.floorplan import WAYS, FloorPlan, centrelines_m
from scanplan.types import Columns, FloatArray, IntArray
from scanplan.validation import surroundings
from scanplan.validation.drawn_surfaces import FACE

REASONS = {
    "agreement": "rays of other scans contradict it",
    "worst_span": "rays of other scans contradict a part of it",
    "points": "few points, or none",
    "observed": "partly or wholly inferred",
    "length": "short",
    "smooth": "points scatter",
    "undoubled": "another surface just behind or before it",
    "joined": "its ends meet nothing",
    "bounding": "bounds no room",
    "kind": "kind uncertain",
    "usual": "no floor was seen beyond it, or a window inside",
    "wall": "in no wall, or rays of other scans contradict that",
    "alone": "another opening beside it",
    "width": "wide for what it is",
    "walled": "outline partly not seen",
    "faced": "outline partly without walls",
    "broad": "small or narrow",
}
"""Features of elements, each the better the greater, and the doubt where one is low."""
FIXED = ("length", "width", "broad")
"""Features that are the same however often an element is seen."""
OF_WALL = ("wall",)
"""Features that an opening in no wall never has."""


def describe_elements(plan: FloorPlan, validation: Columns) -> dict[str, dict[str, FloatArray]]:
    """Return the features of the rows of each table of a plan, (n,) float64 by name.

    Parameters
    ----------
    validation : dict of str to (n,) array
        The columns of `schemas.VALIDATION`.
    """
    faces = _describe_faces(plan, validation)
    walls = _describe_walls(plan, faces)
    return {
        "walls": walls,
        "faces": faces,
        "openings": _describe_openings(plan, walls["agreement"]),
        "rooms": _describe_rooms(plan, validation),
    }


def _describe_faces(plan: FloorPlan, validation: Columns) -> dict[str, FloatArray]:
    faces, lines_m = plan.faces, centrelines_m(plan.faces)
    length_m = np.maximum(line_lengths_m(lines_m), 0.1)
    normals = np.column_stack([faces["nx"], faces["ny"]])
    undoubled = 1 - surroundings.share_doubled(lines_m, normals)
    # rays that end at two surfaces one behind the other speak for one of them
    agreement, worst = (
        np.where(odds > 0, odds * undoubled, odds)
        for odds in _agreements(validation, faces["face"])
    )
    return {
        "agreement": agreement,
        "worst_span": worst,
        "points": np.log1p(faces["n_points"] / length_m),
        "observed": (faces["state"] == "observed").astype(float),
        "length": np.log(length_m),
        "smooth": -np.nan_to_num(faces["rmse_m"], nan=0.0) * 100,
        "undoubled": undoubled,
        "joined": surroundings.count_joined_ends(lines_m, lines_m, same=True).astype(float),
        "bounding": surroundings.share_along(lines_m, plan.areas),
    }


def _describe_walls(plan: FloorPlan, faces: dict[str, FloatArray]) -> dict[str, FloatArray]:
    """Return the features of walls (n,): means of their faces' by length, and their least."""
    row_of = {wall: row for row, wall in enumerate(plan.walls["wall"].tolist())}
    host = np.array([row_of.get(wall, -1) for wall in plan.faces["wall"].tolist()], np.int64)
    n, has_host = len(row_of), host >= 0
    length_m = line_lengths_m(centrelines_m(plan.faces))
    whole_m = np.bincount(host[has_host], length_m[has_host], n)

    def mean(name: str) -> FloatArray:
        sums = np.bincount(host[has_host], (faces[name] * length_m)[has_host], n)
        return np.divide(sums, whole_m, out=np.zeros(n), where=whole_m > 0)

    least = np.zeros(n)
    np.minimum.at(least, host[has_host], faces["worst_span"][has_host])
    wall_m = np.maximum(line_lengths_m(centrelines_m(plan.walls)), 0.1)
    means = ("agreement", "observed", "undoubled", "joined", "bounding")
    return {name: mean(name) for name in means} | {
        "worst_span": least,
        "points": np.log1p(plan.walls["n_points"] / wall_m),
        "length": np.log(wall_m),
    }


def _describe_openings(plan: FloorPlan, of_walls: FloatArray) -> dict[str, FloatArray]:
    openings, lines_m = plan.openings, centrelines_m(plan.openings)
    # rays of one gap depend on each other: what they say beyond 19 to 1 is not surer. A passage in
    # no wall is narrow floor, of whatever kind
    stated = np.nan_to_num(openings["p_kind"], nan=0.95).astype(float)
    p_kind = np.clip(stated, 0.05, 0.95)
    is_way = np.isin(openings["type"].astype(str), WAYS)
    is_inner = np.minimum(openings["room_a"], openings["room_b"]) >= 0
    is_between = is_inner & (openings["room_a"] != openings["room_b"])
    # having been driven through makes a kind as sure, or an open leaf before floor that was seen
    is_known = is_between | (stated > 0.95)
    left_m, right_m = (np.append(side_m, 0.0)[plan.hosts] for side_m in plan.sides_m)
    floor = overlays.unite_areas(shapely.from_wkb(np.asarray(plan.free["geometry"], object)))
    beyond = surroundings.share_floor_beyond(
        lines_m, np.column_stack([left_m, -right_m]), plan.areas, floor
    )
    is_hosted = plan.hosts >= 0
    observed_m = centrelines_m(plan.faces)[plan.faces["state"] == "observed"]
    return {
        # whether a way out is one or a pane is asked below, by what speaks for either
        "kind": np.where(is_way & ~is_inner, np.log(19), np.log(p_kind / (1 - p_kind))),
        "usual": np.where(is_way, np.where(is_known, 1.0, beyond), ~is_inner),
        "wall": np.where(is_hosted, np.append(of_walls, 0.0)[plan.hosts], 0.0),
        "joined": surroundings.count_joined_ends(lines_m, observed_m, same=False).astype(float),
        "alone": surroundings.stand_alone(lines_m),
        "width": -np.log(np.maximum(openings["width_m"], 0.1)),
    }


def _describe_rooms(plan: FloorPlan, validation: Columns) -> dict[str, FloatArray]:
    rooms = plan.rooms
    is_bare = validation["kind"] == "outline"
    bare_m = _sum_by_room(
        rooms["room"],
        validation["number"][is_bare],
        line_lengths_m(centrelines_m(validation)[is_bare]),
    )
    perimeter_m = np.maximum(rooms["perimeter_m"], 0.1)
    return {
        "walled": 1 - bare_m / perimeter_m,
        "faced": surroundings.share_faced(plan.areas, centrelines_m(plan.faces)),
        "broad": np.log(np.maximum(surroundings.measure_breadth(plan.areas), 0.1)),
    }


def _sum_by_room(rooms: IntArray, numbers: IntArray, lengths_m: FloatArray) -> FloatArray:
    """Return the sum (r,) of the lengths that have each room's number."""
    return np.array([lengths_m[numbers == room].sum() for room in rooms.tolist()], np.float64)


def _agreements(validation: Columns, numbers: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return logarithms of odds (n,) that rays left out agree with faces, and with their worst.

    Spans that no ray tells of are as likely as not.
    """
    rows = np.flatnonzero(validation["kind"] == FACE)
    row_of = {number: row for row, number in enumerate(numbers.tolist())}
    element = np.array([row_of.get(number, -1) for number in validation["number"][rows]], np.int64)
    rows, element = rows[element >= 0], element[element >= 0]
    good, all_rays = validation["n_explained"][rows], validation["n_rays"][rows]
    n = len(numbers)
    of_spans = np.log((good + 1) / (all_rays - good + 1))
    worst = np.full(n, np.inf)
    np.minimum.at(worst, element, of_spans)
    sums = (np.bincount(element, values, n) for values in (good, all_rays - good))
    n_good, n_bad = sums
    return np.log((n_good + 1) / (n_bad + 1)), np.where(np.isfinite(worst), worst, 0.0)
