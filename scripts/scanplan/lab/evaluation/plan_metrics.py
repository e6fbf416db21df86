"""How good a plan is: its faces, walls, openings and rooms against the true ones."""

import numpy as np
import shapely

from scanplan.lab.evaluation import length_metrics, opening_metrics, visible_faces
from scanplan.store import schemas, tables

WITHIN_M = 0.10
_MISPLACED_M = 0.30
_SAME_ROOM_IOU = 0.5
_DOORS = ("door", "passage")
_TABLES = {
    "faces": schemas.FACES,
    "walls": schemas.PLAN_WALLS,
    "openings": schemas.OPENINGS,
    "rooms": schemas.ROOMS,
}


def read_plan_tables(plan):
    """Read the tables of a plan that are measured, columns by name, from paths by name."""
    return {
        name: tables.read_table(plan[name], schema, allow_empty=True)
        for name, schema in _TABLES.items()
    }


def evidence_scan_ids(evidence):
    """Return the scan_ids (n,) that a table of evidence at a path names, increasing."""
    return np.unique(tables.read_table(evidence, schemas.EVIDENCE, ["wall", "scan_id"])["scan_id"])


def measure_plan(drawn, motion, true, floor):
    """Measure a plan.

    Parameters
    ----------
    drawn : dict of str to dict
        As `read_plan_tables` returns it.
    motion : (4, 4) float
        Level rigid motion that the plan is moved by first.
    true : true_plan.TruePlan
    floor : wall_findings.VisibleTruth
        The true faces, and what of them the survey and the chosen scans could see.

    Returns
    -------
    dict of str to float
        Columns of `schemas.PLAN_EVALUATION`.
    """
    walls_m, openings_m = (_moved(_lines_m(drawn[name]), motion) for name in ("walls", "openings"))
    drawn_m, seen = moved_faces_m(drawn, motion), floor.seen.any(axis=0)
    kinds = drawn["openings"]["type"]
    outlines = shapely.transform(
        shapely.from_wkb(drawn["rooms"]["geometry"]), lambda xy_m: _moved(xy_m, motion)
    )
    return {
        "length_m": float(length_metrics.line_lengths_m(drawn_m).sum()),
        **measure_faces(
            drawn_m, drawn["faces"]["state"] == "observed", floor.cells, floor.visible, seen
        ),
        **measure_walls(walls_m, drawn["walls"]["thickness_m"], true.walls_m, true.thickness_m),
        **opening_metrics.measure_doors(
            openings_m[np.isin(kinds, _DOORS)], true.doors_m, true.rooms, true.visited
        ),
        **opening_metrics.measure_windows(
            openings_m[kinds == "window"], true.windows_m, floor.cells, floor.visible
        ),
        **measure_rooms(list(outlines), true.rooms, true.visited),
    }


def moved_faces_m(drawn, motion):
    """Return the faces (n, 2, 2) of a plan after a rigid motion (4, 4)."""
    return _moved(_lines_m(drawn["faces"]), motion)


def _lines_m(columns):
    return np.column_stack([columns[c] for c in ("x0_m", "y0_m", "x1_m", "y1_m")]).reshape(-1, 2, 2)


def _moved(xy_m, motion):
    return xy_m @ motion[:2, :2].T + motion[:2, 3]


def measure_faces(drawn_m, observed, cells, visible, seen):
    """Measure faces.

    Parameters
    ----------
    drawn_m : (n, 2, 2) float
    observed : (n,) bool
        Whether a face was observed, not inferred.
    cells : visible_faces.FaceCells
        Of the true faces.
    visible, seen : (c,) bool
        Whether the survey, and the chosen scans, could see a cell.

    Returns
    -------
    dict of str to float
        Shares of length at 0.10 m. What is missed of the visible is parted into what the chosen scans could not see,
        what is drawn within 0.30 m, and the rest.
    """
    length_m, true_m = cells.length_m, cells.faces_m
    found, nearly = (_found(cells, drawn_m, m) for m in (WITHIN_M, _MISPLACED_M))
    found_observed = _found(cells, drawn_m[observed], WITHIN_M)
    missed = visible & ~found
    whole_m = length_m[visible].sum()
    return {
        "seen_completeness_010m": length_metrics.safe_share(
            length_m[seen & found].sum(), length_m[seen].sum()
        ),
        "observed_correctness_010m": length_metrics.compare_lines(
            drawn_m[observed], true_m, WITHIN_M
        ).correctness,
        "observed_visible_completeness_010m": length_metrics.safe_share(
            length_m[visible & found_observed].sum(), whole_m
        ),
        "missed_not_seen": _part(length_m, missed & ~seen, whole_m),
        "missed_misplaced": _part(length_m, missed & seen & nearly, whole_m),
        "missed_misextracted": _part(length_m, missed & seen & ~nearly, whole_m),
    }


def _part(length_m, chosen, whole_m):
    return float(length_m[chosen].sum() / whole_m) if whole_m > 0 else 0.0


def _found(cells, drawn_m, within_m):
    found = np.zeros(len(cells.face), bool)
    near = length_metrics.find_near_intervals(cells.faces_m, drawn_m, within_m)
    begin, end = visible_faces.cells_in_intervals(cells, near.line, near.low_m, near.high_m)
    for b, e in zip(begin.tolist(), end.tolist(), strict=True):
        found[b:e] = True
    return found


def measure_walls(drawn_m, thickness_m, true_m, true_thickness_m):
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
    near = length_metrics.find_near_intervals(drawn_m, true_m, opening_metrics.WALL_M)
    alike = (
        np.abs(
            np.einsum(
                "ij,ij->i",
                opening_metrics.unit_directions(drawn_m)[near.line],
                opening_metrics.unit_directions(true_m)[near.other],
            )
        )
        >= opening_metrics.PARALLEL
    )
    line, other, length_m = near.line[alike], near.other[alike], (near.high_m - near.low_m)[alike]
    order = np.lexsort((-other, length_m, line))
    belongs = np.full(len(drawn_m), -1)
    belongs[line[order]] = other[order]
    matched = belongs >= 0
    known = matched & np.isfinite(thickness_m)
    error_m = np.abs(thickness_m[known] - true_thickness_m[belongs[known]])
    return {
        "n_plan_walls": len(drawn_m),
        "plan_walls_per_true_wall": matched.sum() / len(np.unique(belongs[matched]))
        if matched.any()
        else np.nan,
        "n_thickness": int(known.sum()),
        "thickness_error_m": float(np.median(error_m)) if known.any() else np.nan,
    }


def measure_rooms(drawn, true, visited):
    """Measure rooms by intersection over union; to be found are those that the survey went into.

    Parameters
    ----------
    drawn, true : list of shapely geometry
    visited : (r,) bool

    Returns
    -------
    dict of str to float
        A room is found where its IoU is above one half; drawn rooms that overlap no true room so are false. The mean
        counts a room that is not found with what it has.
    """
    iou = np.zeros((len(true), len(drawn)))
    for i, room in enumerate(true):
        area_m2 = shapely.area(shapely.intersection(room, np.array(drawn, object)))
        iou[i] = area_m2 / (room.area + shapely.area(np.array(drawn, object)) - area_m2)
    best = iou.max(axis=1, initial=0.0)[visited]
    return {
        "n_rooms_true": int(visited.sum()),
        "n_rooms_found": int((best > _SAME_ROOM_IOU).sum()),
        "n_rooms_false": int((iou.max(axis=0, initial=0.0) <= _SAME_ROOM_IOU).sum()),
        "room_iou": float(best.mean()) if len(best) else np.nan,
        "least_room_iou": float(best.min()) if len(best) else np.nan,
    }


def plan_evaluation_columns(rows):
    """Return rows, by frame, as the columns of `schemas.PLAN_EVALUATION`."""
    return {name: [row[name] for row in rows] for name in schemas.PLAN_EVALUATION.columns}


def summarise_plan_measures(row):
    """Say in a line what a plan is worth."""
    per_wall = row["plan_walls_per_true_wall"]
    told = {
        name: value if isinstance(value, str) else f"{value:.3f}" for name, value in row.items()
    }
    return (
        f"faces right {told['correctness_010m']}, of the visible found {told['visible_completeness_010m']} (of what the"
        f" {row['n_scans']} scans see {told['seen_completeness_010m']}); {per_wall:.2f} walls a true wall,"
        f" {row['n_thickness']} thicknesses off by {told['thickness_error_m']} m; doors found {row['n_doors_found']}"
        f" of {row['n_doors_true']}, right {told['door_precision']}, width right {told['door_width_right']}; windows"
        f" found {row['n_windows_found']} of {row['n_windows_true']}, right {told['window_precision']}; rooms"
        f" {row['n_rooms_found']} of {row['n_rooms_true']}, {row['n_rooms_false']} false, IoU {told['room_iou']}"
    )
