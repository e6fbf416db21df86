"""How good the openings of a plan are: doors, passages and windows against the true ones."""

import numpy as np
import shapely

from scanplan.lab.evaluation import length_metrics

PARALLEL = np.cos(np.radians(10))
WALL_M = 0.35  # a wall and what its place may be wrong by: both of its faces are nearer than this
_NEAR_M = 0.35  # likewise, and less than half of a door's width: never the next door
_WIDTH_M = 0.10  # as for faces
_BESIDE_M = 0.5  # a jamb's worth of wall has to be seen for a window to be told
_VISIBLE_SHARE = 0.5


def measure_doors(drawn_m, true_m, rooms, visited):
    """Measure doors and passages; to be found are those of rooms that the survey went into.

    Parameters
    ----------
    drawn_m, true_m : (n, 2, 2), (m, 2, 2) float
    rooms : list of shapely geometry
    visited : (r,) bool

    Returns
    -------
    dict of str to float
        Precision counts all true doors. Without doors to find or drawn, recall or precision is 1.
    """
    entered = shapely.union_all([room for room, was in zip(rooms, visited, strict=True) if was])
    wanted = shapely.distance(shapely.linestrings(true_m), entered) <= _NEAR_M
    return _measured("door", drawn_m, true_m, wanted)


def measure_windows(drawn_m, true_m, cells, visible):
    """Measure windows; to be found are those whose wall the survey could see.

    Parameters
    ----------
    drawn_m, true_m : (n, 2, 2), (m, 2, 2) float
    cells : visible_faces.FaceCells
        Of the true faces.
    visible : (c,) bool
        Whether the survey could see a cell.

    Returns
    -------
    dict of str to float
        As `measure_doors` has them.
    """
    wanted = np.array([_is_visible(line_m, cells, visible) for line_m in true_m], bool)
    return _measured("window", drawn_m, true_m, wanted)


def _is_visible(line_m, cells, visible):
    """Tell whether half of the wall below a window and half a metre beside it could be seen from one of its sides.

    Where the opening reaches down to the height of the sensor there is no face below it, only beside it.
    """
    middle_m, way = line_m.mean(axis=0), unit_directions(line_m[None])[0]
    across, off_m = np.array([-way[1], way[0]]), cells.middle_m - middle_m
    reach_m = length_metrics.line_lengths_m(line_m[None])[0] / 2 + _BESIDE_M
    alike = np.abs(unit_directions(cells.faces_m) @ way) >= PARALLEL
    beside = (
        (np.abs(off_m @ way) <= reach_m) & (np.abs(off_m @ across) <= WALL_M) & alike[cells.face]
    )
    sides = [
        beside & (unit_directions(cells.faces_m)[cells.face] @ way * sign > 0) for sign in (1, -1)
    ]
    return any(
        cells.length_m[side & visible].sum() >= _VISIBLE_SHARE * cells.length_m[side].sum()
        for side in sides
        if side.any()
    )


def _measured(kind, drawn_m, true_m, wanted):
    """Return the measures of a kind of openings, of which those wanted (m,) bool are to be found."""
    pairs = _nearest_pairs(drawn_m, true_m)
    found = [(d, t) for d, t in pairs if wanted[t]]
    width_m = [length_metrics.line_lengths_m(m) for m in (drawn_m, true_m)]
    error_m = np.array([abs(width_m[0][d] - width_m[1][t]) for d, t in found])
    return {
        f"n_{kind}s_true": int(wanted.sum()),
        f"n_{kind}s_found": len(found),
        f"n_{kind}s_drawn": len(drawn_m),
        f"{kind}_recall": length_metrics.safe_share(len(found), wanted.sum()),
        f"{kind}_precision": length_metrics.safe_share(len(pairs), len(drawn_m)),
        f"{kind}_width_error_m": float(np.median(error_m)) if found else np.nan,
        f"{kind}_width_right": float(np.mean(error_m <= _WIDTH_M)) if found else np.nan,
    }


def _nearest_pairs(drawn_m, true_m):
    """Return pairs (drawn, true), each once, the nearest first: middles within 0.35 m, much the same way."""
    apart_m = np.hypot(
        *np.moveaxis(drawn_m.mean(axis=1)[:, None] - true_m.mean(axis=1)[None], -1, 0)
    )
    alike = np.abs(unit_directions(drawn_m) @ unit_directions(true_m).T) >= PARALLEL
    i, j = np.nonzero((apart_m <= _NEAR_M) & alike)
    pairs, used = [], (set(), set())
    for k in np.lexsort((j, i, apart_m[i, j])):
        if i[k] not in used[0] and j[k] not in used[1]:
            pairs.append((int(i[k]), int(j[k])))
            used[0].add(i[k]), used[1].add(j[k])
    return pairs


def unit_directions(lines_m):
    """Return the unit directions (n, 2) of lines (n, 2, 2); those of no length have none."""
    way = lines_m[:, 1] - lines_m[:, 0]
    return way / np.maximum(np.hypot(*way.T), 1e-9)[:, None]
