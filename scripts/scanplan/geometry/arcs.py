"""Arcs of circles: lines along them, and concentric circles fitted to places."""

import math
from dataclasses import dataclass

import numpy as np

from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import FloatArray, IntArray

SAGITTA_M = 0.002
"""From an arc to the middle of a chord that is drawn for it: below what a range errs by."""
NO_CIRCLES = np.empty((0, 3))
_MOST_STEPS = 50  # of Gauss and Newton: from a circle of two chords they take fewer than ten
_MOST_TURN_RAD = math.radians(170)  # of an arc drawn as one: of half a circle two ends say little
_FARTHEST_M = 1e4  # a centre that is farther is that of a straight line


@dataclass(frozen=True, eq=False)
class Circles:
    """Concentric circles as fitted to places.

    Attributes
    ----------
    centre_m : (2,) float64
    radii_m, sigmas_m : (c,) float64
        Radius of each, and its standard deviation.
    residual_m : (n,) float64
        How far each place lies outside its circle.
    """

    centre_m: FloatArray
    radii_m: FloatArray
    sigmas_m: FloatArray
    residual_m: FloatArray


def trace_arc(
    ends_m: FloatArray, centre_m: FloatArray, *, away_m: float = 0.0, beyond_m: float = 0.0
) -> FloatArray:
    """Return places (n, 2) along the shorter arc between two ends, both with it.

    Chords between them are within `SAGITTA_M` of it.

    Parameters
    ----------
    ends_m : (2, 2) float
        On a circle around the centre.
    centre_m : (2,) float
    away_m : float
        Of a parallel arc: how much greater its radius is.
    beyond_m : float, >= 0
        How far it goes on beyond each end, along the circle through the ends; no more than around.

    >>> trace_arc(np.array([[1.0, 0.0], [0.0, 1.0]]), np.zeros(2))[[0, -1]].round(6).tolist()
    [[1.0, 0.0], [0.0, 1.0]]
    """
    radius_m, start_rad, turned_rad = _measure(ends_m, centre_m)
    on_rad = min(beyond_m / radius_m, np.pi - abs(turned_rad) / 2)
    start_rad -= math.copysign(on_rad, turned_rad)
    turned_rad += math.copysign(2 * on_rad, turned_rad)
    drawn_m = max(radius_m + away_m, 0.0)
    step_rad = 2 * np.arccos(1 - min(SAGITTA_M / max(drawn_m, SAGITTA_M), 1.0))
    n_chords = max(int(np.ceil(abs(turned_rad) / step_rad - ROUNDING)), 1)
    at_rad = start_rad + turned_rad * np.linspace(0, 1, n_chords + 1)
    return centre_m + drawn_m * np.column_stack([np.cos(at_rad), np.sin(at_rad)])


def arc_length_m(ends_m: FloatArray, centre_m: FloatArray) -> float:
    """Return the length of the shorter arc between two ends (2, 2) around a centre (2,)."""
    radius_m, _, turned_rad = _measure(ends_m, centre_m)
    return radius_m * abs(turned_rad)


def bend_path(corners_m: FloatArray, circles_m: FloatArray, off_m: float) -> FloatArray:
    """Return a path with arcs in place of the short chords along known circles.

    Parameters
    ----------
    corners_m : (n, 2) float
    circles_m : (k, 3) float
        x and y of centre, radius.
    off_m : float, > 0
        How far corners may lie beside a circle, and it beside the middles of chords.

    Returns
    -------
    (m, 3) float64
        Its corners and the bulge of the stretch that follows: the tangent of a quarter of the angle
        that its arc turns by, 0 of straight ones.
    """
    owner = np.full(len(corners_m) - 1, -1)
    turned = np.zeros(len(owner))
    middles_m = (corners_m[1:] + corners_m[:-1]) / 2
    for number, (*centre_m, radius_m) in enumerate(circles_m.tolist()):
        is_on = np.abs(np.hypot(*(corners_m - centre_m).T) - radius_m) <= off_m
        is_near = np.abs(np.hypot(*(middles_m - centre_m).T) - radius_m) <= 2 * off_m
        is_chord = is_on[1:] & is_on[:-1] & is_near & (owner < 0)
        owner[is_chord] = number
        outward = (corners_m - centre_m) @ np.array([1, 1j])
        turned[is_chord] = np.angle(outward[1:] * outward[:-1].conjugate())[is_chord]
    path: list[tuple[float, float, float]] = []
    first = 0
    while first < len(owner):
        last = first + 1
        while (
            last < len(owner)
            and owner[last] == owner[first] >= 0
            and abs(turned[first : last + 1].sum()) <= _MOST_TURN_RAD
        ):
            last += 1
        bulge = math.tan(turned[first:last].sum() / 4) if last - first > 1 else 0.0
        path.append((*corners_m[first].tolist(), bulge))
        first = last
    path.append((*corners_m[-1].tolist(), 0.0))
    return np.array(path)


def middle_of_bulge(path: FloatArray) -> FloatArray:
    """Return the middle (2,) of the arc from the first to the second row of a path (2, 3).

    >>> middle_of_bulge(np.array([[1.0, 0.0, 1.0], [-1.0, 0.0, 0.0]])).tolist()
    [0.0, 1.0]
    """
    chord_m = path[1, :2] - path[0, :2]
    aside_m = np.array([chord_m[1], -chord_m[0]]) * path[0, 2] / 2
    return (path[0, :2] + path[1, :2]) / 2 + aside_m


def turn_rad(from_centre_m: FloatArray, first_m: FloatArray) -> FloatArray:
    """Return how far directions (..., 2) turn counter-clockwise from a first one (2,).

    Between -pi and pi.
    """
    first = complex(*first_m)
    turned = np.asarray(from_centre_m) @ np.array([1, 1j]) * first.conjugate()
    return np.angle(turned)


def fit_circles(
    xy_m: FloatArray, variance: FloatArray, circle: IntArray, centre_m: FloatArray
) -> Circles | None:
    """Fit concentric circles to places by weighted least squares of their distances.

    Parameters
    ----------
    xy_m : (n, 2) float
    variance : (n,) float, > 0
        Of each place across, square metres.
    circle : (n,) int
        Which circle it is on, each of 0 to c - 1 at least once.
    centre_m : (2,) float
        Where the centre is about.

    Returns
    -------
    Circles or None
        None where the places are on straight lines.
    """
    weight = variance**-0.5
    own = circle[:, None] == np.arange(circle.max() + 1)
    change = own.astype(float)
    for _ in range(_MOST_STEPS):
        from_centre_m = xy_m - centre_m
        distance_m = np.hypot(*from_centre_m.T)
        if distance_m.min() == 0:
            return None
        change = np.column_stack([from_centre_m / distance_m[:, None], own]) * weight[:, None]
        solved, _, rank, _ = np.linalg.lstsq(change, distance_m * weight, rcond=None)
        if rank < change.shape[1] or np.hypot(*solved[:2]) > _FARTHEST_M:
            return None
        centre_m = centre_m + solved[:2]
        if np.hypot(*solved[:2]) < ROUNDING:
            break
    distance_m = np.hypot(*(xy_m - centre_m).T)
    radii_m = own.T @ (distance_m / variance) / (own.T @ (1 / variance))
    residual_m = distance_m - radii_m[circle]
    covariance = np.diag(np.linalg.pinv(change.T @ change, hermitian=True))
    # places may err more than is said: what they scatter by about their circles says so as well
    scale = np.sum(residual_m**2 / variance) / max(len(xy_m) - change.shape[1], 1)
    sigmas_m = np.sqrt(np.maximum(covariance[2:], 0.0) * max(scale, 1.0))
    return Circles(centre_m, radii_m, sigmas_m, residual_m)


def _measure(ends_m: FloatArray, centre_m: FloatArray) -> tuple[float, float, float]:
    """Return the radius, the first end's direction, and how far it turns to the second."""
    from_centre_m = np.asarray(ends_m) - centre_m
    radius_m = float(np.hypot(*from_centre_m.T).mean())
    start_rad = math.atan2(from_centre_m[0, 1], from_centre_m[0, 0])
    return radius_m, start_rad, float(turn_rad(from_centre_m[1], from_centre_m[0]))
