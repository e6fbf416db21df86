"""Curved walls of two surveys that are one, wherever it stands: each is one wall with an arc."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.changes.frame_fit import FrameFit
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import CHANGES, MOVED, REACH_M, SAME, SIGMAS, Change
from scanplan.geometry import overlays
from scanplan.geometry.lines import left_normals
from scanplan.types import BoolArray, FloatArray

_STEP_M = 0.1  # between places along an arc: what moved is some metres long
_LEAST_SHARE = 0.6  # of the shorter arc that has the other beside it
_ROUNDS = 3  # a shift along normals of where an arc was is off by how much it turned since
_LIKE_M = 0.03  # what one arc, moved, may lie off the other, beside what both err by


@dataclass(frozen=True, eq=False)
class CurveShift:
    """A curved wall of both surveys.

    Attributes
    ----------
    number_a, number_b : int
        Of the wall in either plan.
    moved_m : (2,) float64
        Where to, in the common frame.
    sigma_m : float
        Standard deviation of that.
    axis : shapely geometry
        Of a, in the common frame.
    """

    number_a: int
    number_b: int
    moved_m: FloatArray
    sigma_m: float
    axis: BaseGeometry

    @property
    def is_moved(self) -> bool:
        """Whether it has moved by more than both err."""
        return math.hypot(*self.moved_m.tolist()) > SIGMAS * self.sigma_m


@dataclass(frozen=True, eq=False)
class _Curve:
    number: int
    axis: BaseGeometry
    sigma_m: float
    is_thick: bool


def measure_curves(a: Survey, b: Survey, fit: FrameFit) -> Sequence[CurveShift]:
    """Return the curved walls of a that b has, too, and by how much they stand elsewhere there.

    Parameters
    ----------
    a, b : Survey
        In one frame.
    fit : FrameFit
        The motion between them.
    """
    others = list(_list_curves(b))
    # the line of one that was seen from one side is that of its face
    found = [
        _measure(one, other, fit)
        for one in _list_curves(a)
        for other in others
        if one.is_thick == other.is_thick
    ]
    return [shift for shift in found if shift is not None]


def join_curves(changes: Sequence[Change], curves: Sequence[CurveShift]) -> list[Change]:
    """Return what became of walls, with each curved wall that has moved as one, others measured.

    Parameters
    ----------
    changes : sequence of Change
        Of walls, the pieces of curved ones each for itself.
    """
    joined = list(changes)
    for curve in curves:
        join = _join_pieces if curve.is_moved else _measure_pieces
        joined = join(joined, curve)
    return joined


def _join_pieces(changes: list[Change], curve: CurveShift) -> list[Change]:
    """Return changes with the pieces of a curved wall as one that has moved, if rays say so.

    They do where they go through a piece of it, as it was or as it is.
    """
    pieces = [
        change
        for change in changes
        if change.number_a == curve.number_a
        or (change.number_a < 0 and change.number_b == curve.number_b)
    ]
    p = max((piece.p for piece in pieces if piece.verdict in CHANGES), default=0.0)
    if not p:
        return changes
    x_m, y_m = curve.moved_m.tolist()
    moved = Change(
        "wall",
        curve.number_a,
        curve.number_b,
        MOVED,
        p,
        curve.axis,
        moved_m=(x_m, y_m),
        shift_m=math.hypot(x_m, y_m),
        sigma_m=curve.sigma_m,
    )
    return [moved, *(change for change in changes if change not in pieces)]


def _measure_pieces(changes: list[Change], curve: CurveShift) -> list[Change]:
    """Return changes with what each piece of a curved wall that stands is off by, across it."""
    measured = []
    for change in changes:
        is_piece = change.number_a == curve.number_a and change.verdict == SAME
        if is_piece and math.isnan(change.shift_m):
            normal = left_normals(shapely.get_coordinates(change.shape)[None])[0]
            shift_m = float(curve.moved_m @ normal)
            change = replace(
                change, number_b=curve.number_b, shift_m=shift_m, sigma_m=curve.sigma_m
            )
        measured.append(change)
    return measured


def _list_curves(survey: Survey) -> Iterator[_Curve]:
    plan = survey.plan
    for row in np.flatnonzero(plan.wall_shapes.is_bent).tolist():
        axis = survey.place(plan.axes[row])
        sigma_m = float(plan.walls["sigma_offset_m"][row])
        yield _Curve(int(plan.walls["wall"][row]), axis, sigma_m, bool(plan.thick[row]))


def _measure(one: _Curve, other: _Curve, fit: FrameFit) -> CurveShift | None:
    """Return by which shift one arc comes to lie on another, None where none does.

    What lies across of it is known along an arc alone: a shift is what makes up for that
    everywhere.
    """
    least_m = _LEAST_SHARE * min(one.axis.length, other.axis.length)
    at_m, normals = _place_feelers(one.axis)
    moved_m = np.zeros(2)
    rest_m = np.inf
    for _ in range(_ROUNDS):
        met, off_m = _feel(at_m + moved_m, normals, other.axis)
        if met.sum() * _STEP_M < least_m:
            return None
        step_m = np.linalg.lstsq(normals[met], off_m, rcond=None)[0]
        rest_m = _scatter_m(normals[met] @ step_m - off_m)
        moved_m = moved_m + step_m
    of_frame_m = float(np.median(fit.sigmas_m(at_m, normals)))
    errors_m = np.nan_to_num([one.sigma_m, other.sigma_m, of_frame_m, fit.scatter_m])
    sigma_m = float(np.sqrt(np.sum(errors_m**2)))
    if rest_m > SIGMAS * sigma_m + _LIKE_M:
        return None
    return CurveShift(one.number, other.number, moved_m, sigma_m, one.axis)


def _place_feelers(axis: BaseGeometry) -> tuple[FloatArray, FloatArray]:
    """Return places along a line (n, 2), and the normals there (n, 2)."""
    at_m = np.arange(_STEP_M / 2, axis.length, _STEP_M)
    begin_m, end_m, middle_m = (
        shapely.get_coordinates(shapely.line_interpolate_point([axis], at_m + step_m))
        for step_m in (-_STEP_M / 2, _STEP_M / 2, 0.0)
    )
    return middle_m, left_normals(np.stack([begin_m, end_m], axis=1))


def _feel(
    at_m: FloatArray, normals: FloatArray, axis: BaseGeometry
) -> tuple[BoolArray, FloatArray]:
    """Return from which places (n,) a line lies across, and how far, of those (k,)."""
    ends_m = np.stack([at_m - REACH_M * normals, at_m + REACH_M * normals], axis=1)
    meets = overlays.cross_lines(shapely.linestrings(ends_m), axis)
    met = (shapely.get_type_id(meets) == shapely.GeometryType.POINT) & ~shapely.is_empty(meets)
    way_m = shapely.get_coordinates(np.asarray(meets)[met]) - at_m[met]
    return met, np.einsum("nj,nj->n", way_m, normals[met])


def _scatter_m(off_m: FloatArray) -> float:
    return float(np.sqrt(np.mean(off_m**2)))
