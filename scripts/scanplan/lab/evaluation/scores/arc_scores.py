"""Curved walls: how many are drawn as arcs, how many arcs are of curved walls, and how true."""

from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.lab.evaluation.opening_metrics import unit_directions
from scanplan.lab.evaluation.scores.drawn_plan import DrawnPlan
from scanplan.lab.evaluation.scores.scene import Scene, line_shapes_of
from scanplan.lab.evaluation.scores.score import Score, element_columns, share_or_nan
from scanplan.lab.evaluation.scores.sight import Sight
from scanplan.types import FloatArray, IntArray

_NEAR_M = 0.20  # of a surface, as the farthest that walls are looked for
_SAME_M = 0.05  # of centres of one circle: vertices of truths are given to 0.1 mm
_BESIDE_M = 1.5  # around faces of one curve: half of what an opening in it is wide at most
_LEAST_SEEN_M = 1.0  # of a curve: less shows no circle
_LEAST_FACES = 3  # of a curve: the lines of two always meet
_ROUNDS = 5  # of centres without jambs: two settle it


@dataclass(frozen=True, eq=False)
class _TrueCurve:
    """The curved faces (k,) about one centre, and the radius that each is at."""

    centre_m: FloatArray
    faces: IntArray
    radii_m: FloatArray


def score_arcs(plan: DrawnPlan, scene: Scene, sight: Sight) -> Score:
    """Score curved walls that are drawn as arcs.

    A true arc is all curved wall about one centre. It is found where arcs are drawn along half of
    what could be seen of it; a drawn arc is right where true curved faces are along half of it.

    Returns
    -------
    Score
        `arcs_true` of which a metre could be seen, `arcs_found`, `arc_recall`, `arcs_drawn`,
        `arc_precision`; `arc_radius_error_m` and `arc_centre_error_m`, the means over those found,
        by the drawn wall that is longest there: of its sides' radii, and where it turns around.
    """
    drawn = np.unique(plan.wall[np.isfinite(plan.centres_m[:, 0])])
    axes = {number: overlays.unite_lines(_chords(plan, number)) for number in drawn.tolist()}
    strips = {of: overlays.buffer_shapes(axis, _NEAR_M) for of, axis in axes.items()}
    faces = line_shapes_of(scene.inner_m)
    radius_off_m, centre_off_m, n_true = [], [], 0
    for curve in _find_true_curves(scene):
        is_own = sight.visible & np.isin(sight.cells.face, curve.faces)
        seen_m = np.bincount(
            sight.cells.face[is_own], sight.cells.length_m[is_own], minlength=len(faces)
        )
        if seen_m.sum() < _LEAST_SEEN_M:
            continue
        n_true += 1
        seen_faces = overlays.unite_lines(faces[seen_m > 0])
        along_m = {of: overlays.intersect_lines(seen_faces, strips[of]).length for of in axes}
        if along_m and 2 * sum(along_m.values()) >= seen_faces.length:
            best = max(along_m, key=lambda of: along_m[of])
            row = int(np.flatnonzero(plan.wall == best)[0])
            half_m = np.nan_to_num(plan.thickness_m[row]) / 2
            sides_m = np.unique(plan.radii_m[row] + np.array([-half_m, half_m]))
            off_m = np.abs(sides_m[:, None] - curve.radii_m).min(axis=1)
            radius_off_m.append(float(off_m.mean()))
            centre_off_m.append(float(np.hypot(*(plan.centres_m[row] - curve.centre_m))))
    curved = overlays.buffer_shapes(overlays.unite_lines(faces[scene.curved]), _NEAR_M)
    n_right = sum(
        2 * overlays.intersect_lines(axis, curved).length >= axis.length for axis in axes.values()
    )
    measures: dict[str, float] = {
        "arcs_true": n_true,
        "arcs_found": len(radius_off_m),
        "arc_recall": share_or_nan(len(radius_off_m), n_true),
        "arcs_drawn": len(axes),
        "arc_precision": share_or_nan(int(n_right), len(axes)),
        "arc_radius_error_m": float(np.mean(radius_off_m)) if radius_off_m else np.nan,
        "arc_centre_error_m": float(np.mean(centre_off_m)) if centre_off_m else np.nan,
    }
    return Score(measures, element_columns([]))


def _chords(plan: DrawnPlan, number: int) -> np.ndarray:
    return line_shapes_of(plan.walls_m[plan.wall == number])


def _find_true_curves(scene: Scene) -> list[_TrueCurve]:
    """Return the curves of a scene: curved faces near to each other, those of one centre as one."""
    rows = np.flatnonzero(scene.curved)
    lines = line_shapes_of(scene.inner_m[rows])
    near = overlays.unite_areas(overlays.buffer_shapes(lines, _BESIDE_M))
    found: list[_TrueCurve] = []
    for part in shapely.get_parts(near):
        own = rows[shapely.intersects(lines, part)]
        curve = _fit_curve(scene.inner_m, own)
        if curve is None:
            continue
        alike = [of for of in found if np.hypot(*(of.centre_m - curve.centre_m)) <= _SAME_M]
        found = [of for of in found if of not in alike]
        parts = [*alike, curve]
        faces = np.concatenate([of.faces for of in parts])
        radii_m = np.concatenate([of.radii_m for of in parts])
        found.append(_TrueCurve(parts[0].centre_m, faces, radii_m))
    return found


def _fit_curve(faces_m: FloatArray, rows: IntArray) -> _TrueCurve | None:
    """Return the curve of faces: where the lines square to them, in their middles, meet.

    Jambs and reveals, which point at the centre, are left out.
    """
    middle_m = faces_m[rows].mean(axis=1)
    direction = unit_directions(faces_m[rows])
    centre_m = _guess_centre(middle_m)
    is_chord = np.ones(len(rows), bool)
    for _ in range(_ROUNDS):
        outward_m = middle_m - centre_m
        is_chord = 2 * np.abs(np.sum(direction * outward_m, axis=1)) < np.hypot(*outward_m.T)
        if is_chord.sum() < _LEAST_FACES:
            return None
        along_m = np.sum(direction * middle_m, axis=1)
        centre_m = np.linalg.lstsq(direction[is_chord], along_m[is_chord], rcond=None)[0]
    radii_m = np.hypot(*(middle_m - centre_m).T)
    return _TrueCurve(centre_m, rows[is_chord], radii_m[is_chord])


def _guess_centre(places_m: FloatArray) -> FloatArray:
    """Return the centre (2,) of the circle through places (n, 2), by linear least squares."""
    middle_m = places_m.mean(axis=0)
    off_m = places_m - middle_m
    known = np.column_stack([2 * off_m, np.ones(len(off_m))])
    return middle_m + np.linalg.lstsq(known, np.sum(off_m**2, axis=1), rcond=None)[0][:2]
