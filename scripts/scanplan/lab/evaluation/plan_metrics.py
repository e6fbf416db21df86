"""How good a plan is: its faces, walls, openings and rooms against the true ones."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.lines import left_normals, line_lengths_m
from scanplan.lab.evaluation import length_metrics, opening_metrics, wall_findings
from scanplan.lab.evaluation.face_cells import FaceCells
from scanplan.lab.evaluation.true_plan import TruePlan
from scanplan.lab.evaluation.wall_findings import JUDGED, WITHIN_M, VisibleTruth
from scanplan.plan.floorplan import centrelines_m, find_hosts, find_reveals
from scanplan.rays.face_raster import CELL_M
from scanplan.store import schemas, tables
from scanplan.types import BoolArray, Columns, FilePath, FloatArray, IntArray

_MISPLACED_M = 0.30  # farther off a face is another one: twice a thin wall's thickness
_DOORS = ("door", "passage")
_WINDOWS = ("window", "glass")
_NO_HEIGHTS = ", as no heights are known, without which windows cannot be found"
_TABLES = {
    "faces": schemas.FACES,
    "walls": schemas.PLAN_WALLS,
    "openings": schemas.OPENINGS,
    "rooms": schemas.ROOMS,
    "furniture": schemas.FURNITURE,
}


def read_plan_tables(plan: Mapping[str, FilePath]) -> dict[str, Columns]:
    """Read the tables of a plan that are measured, columns by name, from paths by name."""
    return {
        name: tables.read_table(plan[name], schema, allow_empty=True)
        for name, schema in _TABLES.items()
    }


def leave_unseen_sides(drawn: Mapping[str, Columns]) -> dict[str, Columns]:
    """Return a plan's tables without sides of straight walls that nobody saw, and reveals.

    Of these, inferred from how deep openings are, true faces that rooms look at say nothing.
    """
    faces, walls = drawn["faces"], drawn["walls"]
    host = find_hosts(walls, faces)
    left = np.append(left_normals(centrelines_m(walls)), [[0.0, 0.0]], axis=0)[host]
    turn = np.sum(left * np.column_stack([faces["nx"], faces["ny"]]), axis=1)
    side = 2 * host + (turn > 0)
    is_along = ~find_reveals(walls, faces)
    is_observed = np.asarray(faces["state"] == "observed", bool)
    is_free = np.append(np.isfinite(walls["arc_radius_m"].astype(float)), True)[host]
    kept = is_free | (is_along & np.isin(side, side[is_observed & is_along]))
    return {**drawn, "faces": {name: values[kept] for name, values in faces.items()}}


def evidence_scan_ids(evidence: FilePath) -> IntArray:
    """Return the scan_ids (n,) that a table of evidence at a path names, increasing."""
    return np.unique(tables.read_table(evidence, schemas.EVIDENCE, ["wall", "scan_id"])["scan_id"])


def measure_plan(
    drawn: Mapping[str, Columns], motion: FloatArray, true: TruePlan, floor: VisibleTruth
) -> dict[str, float]:
    """Measure a plan.

    Parameters
    ----------
    drawn : dict of str to dict
        As `read_plan_tables` returns it.
    motion : (4, 4) float
        Level rigid motion that the plan is moved by first.
    floor : wall_findings.VisibleTruth
        The true faces, and what of them the survey and the chosen scans could see.

    Returns
    -------
    dict of str to float
        Columns of `schemas.PLAN_EVALUATION`.
    """
    faces_m = moved_faces_m(drawn, motion)
    # sides of columns, which follow the faces, are all fitted to returns
    observed = np.full(len(faces_m), True)
    observed[: len(drawn["faces"]["state"])] = drawn["faces"]["state"] == "observed"
    seen = np.asarray(floor.seen.any(axis=0))
    walls_m = _moved(length_metrics.table_lines_m(drawn["walls"]), motion)
    openings_m = _moved(length_metrics.table_lines_m(drawn["openings"]), motion)
    kinds = drawn["openings"]["type"]
    doors_m, windows_m = (openings_m[np.isin(kinds, of)] for of in (_DOORS, _WINDOWS))
    rooms = shapely.transform(
        shapely.from_wkb(drawn["rooms"]["geometry"]),
        lambda xy_m: np.asarray(_moved(xy_m, motion), np.float64),
    )
    return {
        "length_m": float(line_lengths_m(faces_m).sum()),
        **measure_faces(faces_m, observed, floor.cells, floor.visible, seen),
        **measure_walls(walls_m, drawn["walls"]["thickness_m"], true.walls_m, true.thickness_m),
        **opening_metrics.measure_doors(doors_m, true.doors_m, true.rooms, true.visited),
        **opening_metrics.measure_windows(windows_m, true.windows_m, floor.cells, floor.visible),
        **measure_rooms(list(rooms), true.rooms, true.visited),
    }


def moved_faces_m(drawn: Mapping[str, Columns], motion: FloatArray) -> FloatArray:
    """Return the faces (n, 2, 2) of a plan, then the sides of its columns, after a rigid motion.

    A side that a column stands against a wall with is no surface, and is left out.
    """
    faces_m = length_metrics.table_lines_m(drawn["faces"])
    walls = overlays.buffer_shapes(overlays.unite_lines(shapely.linestrings(faces_m)), CELL_M)
    sides_m = _column_sides_m(drawn["furniture"])
    is_free = ~shapely.covers(walls, shapely.linestrings(sides_m))
    return _moved(np.concatenate([faces_m, sides_m[is_free]]), motion)


def _column_sides_m(furniture: Columns) -> FloatArray:
    """Return the sides (n, 2, 2) of the columns among what stands in rooms."""
    is_column = np.asarray(furniture["kind"]) == schemas.COLUMN
    outlines = shapely.from_wkb(np.asarray(furniture["geometry"], object)[is_column])
    corners_m = [shapely.get_coordinates(outline) for outline in outlines]
    sides_m = [np.stack([ring_m[:-1], ring_m[1:]], axis=1) for ring_m in corners_m]
    return np.concatenate([np.empty((0, 2, 2)), *sides_m])


def _moved(xy_m: FloatArray, motion: FloatArray) -> FloatArray:
    return xy_m @ motion[:2, :2].T + motion[:2, 3]


def measure_faces(
    drawn_m: FloatArray, observed: BoolArray, cells: FaceCells, visible: BoolArray, seen: BoolArray
) -> dict[str, float]:
    """Measure faces.

    Parameters
    ----------
    drawn_m : (n, 2, 2) float
    observed : (n,) bool
        Whether a face was observed, not inferred.
    cells : face_cells.FaceCells
        Of the true faces.
    visible, seen : (c,) bool
        Whether the survey, and the chosen scans, could see a cell.

    Returns
    -------
    dict of str to float
        Shares of length at 0.10 m. What is missed of the visible is parted into what the chosen
        scans could not see, what is drawn within 0.30 m, and the rest.
    """
    length_m, within_m = cells.length_m, WITHIN_M[JUDGED]
    found = _found_cells(cells, drawn_m, within_m)
    found_nearby = _found_cells(cells, drawn_m, _MISPLACED_M)
    found_observed = _found_cells(cells, drawn_m[observed], within_m)
    missed = visible & ~found
    visible_m = length_m[visible].sum()
    observed_agreement = length_metrics.compare_lines(drawn_m[observed], cells.faces_m, within_m)
    return {
        "seen_completeness_010m": length_metrics.safe_share(
            length_m[seen & found].sum(), length_m[seen].sum()
        ),
        "observed_correctness_010m": observed_agreement.correctness,
        "observed_visible_completeness_010m": length_metrics.safe_share(
            length_m[visible & found_observed].sum(), visible_m
        ),
        "missed_not_seen": _part(length_m, missed & ~seen, visible_m),
        "missed_misplaced": _part(length_m, missed & seen & found_nearby, visible_m),
        "missed_misextracted": _part(length_m, missed & seen & ~found_nearby, visible_m),
    }


def _part(length_m: FloatArray, chosen: BoolArray, whole_m: float) -> float:
    return float(length_m[chosen].sum() / whole_m) if whole_m > 0 else 0.0


def _found_cells(cells: FaceCells, drawn_m: FloatArray, within_m: float) -> BoolArray:
    """Return which cells (c,) have a drawn line within a distance of their middles."""
    _, begins, ends = wall_findings.find_cells(cells, drawn_m, within_m)
    found = np.zeros(len(cells.face), bool)
    for begin, end in zip(begins.tolist(), ends.tolist(), strict=True):
        found[begin:end] = True
    return found


def measure_walls(
    drawn_m: FloatArray,
    thickness_m: FloatArray,
    true_m: FloatArray,
    true_thickness_m: FloatArray,
) -> dict[str, float]:
    """Measure walls: each drawn one belongs to the true one that it runs beside for longest.

    Parameters
    ----------
    drawn_m : (n, 2, 2) float
    thickness_m : (n,) float
        NaN where not known.
    true_m : (m, 2, 2) float
    true_thickness_m : (m,) float

    Returns
    -------
    dict of str to float
        Walls that belong to no true one count in `n_plan_walls` alone.
    """
    true_wall = _match_walls(drawn_m, true_m)
    is_matched = true_wall >= 0
    n_matched_true = len(np.unique(true_wall[is_matched]))
    is_known = is_matched & np.isfinite(thickness_m)
    error_m = np.abs(thickness_m[is_known] - true_thickness_m[true_wall[is_known]])
    return {
        "n_plan_walls": len(drawn_m),
        "plan_walls_per_true_wall": is_matched.sum() / n_matched_true
        if is_matched.any()
        else np.nan,
        "n_thickness": int(is_known.sum()),
        "thickness_error_m": float(np.median(error_m)) if is_known.any() else np.nan,
        "worst_thickness_error_m": float(error_m.max()) if is_known.any() else np.nan,
    }


def _match_walls(drawn_m: FloatArray, true_m: FloatArray) -> IntArray:
    """Return the true wall (n,) that each drawn one runs beside for longest; -1 without any."""
    near = length_metrics.find_near_intervals(drawn_m, true_m, opening_metrics.WALL_M)
    direction = opening_metrics.unit_directions(drawn_m)[near.line]
    true_way = opening_metrics.unit_directions(true_m)[near.other]
    alike = np.abs(np.einsum("ij,ij->i", direction, true_way)) >= opening_metrics.PARALLEL
    line, other = near.line[alike], near.other[alike]
    # the longest last, and of equals the first
    order = np.lexsort((-other, (near.high_m - near.low_m)[alike], line))
    true_wall = np.full(len(drawn_m), -1)
    true_wall[line[order]] = other[order]
    return true_wall


def measure_rooms(
    drawn: Sequence[BaseGeometry], true: Sequence[BaseGeometry], visited: BoolArray
) -> dict[str, float]:
    """Measure rooms by intersection over union; to be found are those that the survey went into.

    Parameters
    ----------
    visited : (r,) bool

    Returns
    -------
    dict of str to float
        A room is found where its IoU is above one half; drawn rooms that overlap no true room so
        are false. The mean counts a room that is not found with what it has.
    """
    shapes = np.array(drawn, object)
    iou = np.zeros((len(true), len(drawn)))
    for row, room in zip(iou, true, strict=True):
        shared_m2 = shapely.area(overlays.intersect_areas(room, shapes))
        row[:] = shared_m2 / (room.area + shapely.area(shapes) - shared_m2)
    best = iou.max(axis=1, initial=0.0)[visited]
    of_drawn = iou.max(axis=0, initial=0.0)
    return {
        "n_rooms_true": int(visited.sum()),
        "n_rooms_found": int((best > 0.5).sum()),
        "n_rooms_false": int((of_drawn <= 0.5).sum()),
        "room_iou": float(best.mean()) if len(best) else np.nan,
        "least_room_iou": float(best.min()) if len(best) else np.nan,
    }


def plan_evaluation_columns(rows: Sequence[Mapping[str, Any]]) -> dict[str, list[Any]]:
    """Return rows, by frame, as the columns of `schemas.PLAN_EVALUATION`."""
    return {name: [row[name] for row in rows] for name in schemas.PLAN_EVALUATION.columns}


def summarise_plan_measures(row: Mapping[str, Any], *, has_heights: bool) -> str:
    """Return in a line what a plan is worth.

    Parameters
    ----------
    row : dict
        Columns of `schemas.PLAN_EVALUATION`.
    has_heights : bool
        Whether any were measured: without them windows are not told from glass or wall.
    """
    return (
        "faces right {correctness_010m:.3f}, of the visible found"
        " {visible_completeness_010m:.3f} (of what the {n_scans} scans see"
        " {seen_completeness_010m:.3f}); {walls}; {doors}; {windows}; rooms driven into found"
        " {n_rooms_found} of {n_rooms_true}, {n_rooms_false} false{overlap}"
    ).format(
        **row,
        overlap=f", IoU {row['room_iou']:.3f}" if row["n_rooms_true"] else "",
        walls=_summarise_walls(row),
        doors=_summarise_openings("door", row),
        windows=_summarise_openings("window", row, unless="" if has_heights else _NO_HEIGHTS),
    )


def _summarise_walls(row: Mapping[str, Any]) -> str:
    """Return how many walls there are for a true one, and how wrong their thicknesses are."""
    if not np.isfinite(row["plan_walls_per_true_wall"]):
        return "no wall is beside a true one"
    words = "{plan_walls_per_true_wall:.2f} walls a true wall, ".format_map(row)
    if not row["n_thickness"]:
        return words + "no thickness to compare"
    off = "{n_thickness} thicknesses off by {thickness_error_m:.3f} m (at worst {worst:.3f})"
    return words + off.format(**row, worst=row["worst_thickness_error_m"])


def _summarise_openings(kind: str, row: Mapping[str, Any], unless: str = "") -> str:
    """Return how many openings of a kind are found and right, or why none is drawn."""
    n_true, n_found = row[f"n_{kind}s_true"], row[f"n_{kind}s_found"]
    if not row[f"n_{kind}s_drawn"]:
        return f"{kind}s: none drawn of {n_true}{unless}"
    words = f"{kind}s found {n_found} of {n_true}, right {row[f'{kind}_precision']:.3f}"
    return f"{words}, width right {row[f'{kind}_width_right']:.3f}" if n_found else words
