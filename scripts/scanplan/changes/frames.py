"""The frames of two surveys tied by the walls that both show; refused where they do not fit."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.changes.agreement import NEAR_M, Agreement, measure_agreement, place_points
from scanplan.changes.frame_fit import FrameFit, fit_frame
from scanplan.changes.frame_votes import list_motions
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.seen_faces import SeenFaces
from scanplan.changes.seen_floors import SeenFloor
from scanplan.errors import StageError
from scanplan.geometry import overlays

_LEAST_SHARE = 0.35  # of the smaller survey's faces: below half of what surveys of one floor have
_LEAST_MATCHED_M = 4.0  # of faces: of a single room
_MOST_SIGMA_M = 0.05  # of the motion, at its centre: with more no wall can be told to have moved
_MOST_SIGMA_RAD = np.radians(0.5)  # likewise: 9 cm at the end of a wing of 10 m
_LEAST_P = 0.5  # that both are of one building
_NEARLY = 0.9  # of the score of the best: as different as two surveys of one floor are
_SAME_M = 0.5  # motions that are nearer are one
_SAME_RAD = np.radians(5)
_INSIDE_M = 0.3  # farther inside of free floor no face of it lies


@dataclass(frozen=True, eq=False)
class FrameTie:
    """How the frame of survey b lies in that of survey a.

    Attributes
    ----------
    fit : frame_fit.FrameFit
    share : float
        Of the faces of the survey that shows less, the part that agrees with the other's.
    others : list of (PlaneMotion, float)
        Motions that fit nearly as well, as of a symmetric building, with the part that agrees.
    """

    fit: FrameFit
    share: float
    others: Sequence[tuple[PlaneMotion, float]]


def tie_frames(floors: tuple[SeenFloor, SeenFloor], names: tuple[str, str]) -> FrameTie:
    """Tie the frames of two surveys.

    Of motions that fit nearly as well, that is taken which leaves the frames as they are, if one
    does: maps of one localiser have one frame.

    Parameters
    ----------
    floors : (SeenFloor, SeenFloor)
        Of a and b, each in its own frame.
    names : (str, str)
        Of the surveys, for messages.

    Raises
    ------
    StageError
        If no motion lays enough of the walls of one on those of the other, or walls leave one
        direction free, or of what both could see so much differs that they are likelier of two.
    """
    a, b = (floor.faces for floor in floors)
    pair = " and ".join(names)
    least_m = min(float(a.length_m.sum()), float(b.length_m.sum()))
    if least_m < _LEAST_MATCHED_M:
        fault = f"one shows {least_m:.1f} m of walls, {_LEAST_MATCHED_M:g} m are needed"
        raise StageError(f"{pair}: cannot be compared, {fault}; survey more of the floor")
    starts = [PlaneMotion(), *list_motions(a, b)]
    fits = [fit_frame(a, b, start) for start in starts]
    contradicted = [_contradiction_m(*floors, fit.motion) for fit in fits]
    scores = [
        (_favour_m(fit) - against_m) / least_m
        for fit, against_m in zip(fits, contradicted, strict=True)
    ]
    order = sorted(range(len(fits)), key=lambda i: (-scores[i], i))
    best = order[0]
    nearly = [i for i in order if scores[i] >= _NEARLY * scores[best]]
    best = next((i for i in nearly if _is_one(fits[i].motion, PlaneMotion(), a)), best)
    fit = fits[best]
    share = fit.matched_m / least_m
    _check_fit(pair, fit, share)
    moved = floors[1].moved(fit.motion)
    _check_agreement(pair, measure_agreement(floors[0], moved))
    others: list[int] = []
    for i in nearly:
        if not any(_is_one(fits[i].motion, fits[j].motion, a) for j in [best, *others]):
            others.append(i)
    alike = [(fits[i].motion, fits[i].matched_m / least_m) for i in others]
    return FrameTie(fit, min(share, 1.0), alike)


def _favour_m(fit: FrameFit) -> float:
    """Return the length of faces that speaks for a motion: of what has moved a little, half."""
    return (fit.matched_m + fit.near_m) / 2


def _check_fit(pair: str, fit: FrameFit, share: float) -> None:
    remedy = "give two surveys of one floor, of which both show the same walls"
    if share < _LEAST_SHARE or fit.matched_m < _LEAST_MATCHED_M:
        fault = f"at best {share:.0%} of the walls agree ({fit.matched_m:.1f} m)"
        limit = f"{_LEAST_SHARE:.0%} and {_LEAST_MATCHED_M:g} m are needed"
        raise StageError(f"{pair}: do not fit each other, {fault}, {limit}; {remedy}")
    sigma_m = float(np.sqrt(np.diag(fit.covariance)[:2].max()))
    sigma_rad = float(np.sqrt(fit.covariance[2, 2]))
    if not np.isfinite(sigma_m):
        fault = "walls along one direction alone agree, which leave a shift along them free"
        raise StageError(f"{pair}: do not fit each other, {fault}; {remedy}")
    if sigma_m > _MOST_SIGMA_M or sigma_rad > _MOST_SIGMA_RAD:
        fault = f"the motion is known to {sigma_m:.3f} m and {np.degrees(sigma_rad):.2f}° alone"
        limit = f"{_MOST_SIGMA_M:g} m and {np.degrees(_MOST_SIGMA_RAD):g}° are needed"
        raise StageError(f"{pair}: do not fit each other, {fault}, {limit}; {remedy}")


def _check_agreement(pair: str, found: Agreement) -> None:
    if found.p_one >= _LEAST_P:
        return
    met, walled = found.n_ways
    fault = (
        f"of what both could see {found.share:.0%} of the walls agree within {NEAR_M:g} m, and"
        f" {met} of {met + walled} doors: of one building with {found.p_one:.2f}"
    )
    limit = f"{_LEAST_P:g} is needed"
    remedy = "give two surveys of one floor; of one, mend the map that is bent (close loops)"
    raise StageError(f"{pair}: do not fit each other, {fault}, {limit}; {remedy}")


def _is_one(motion: PlaneMotion, other: PlaneMotion, a: SeenFaces) -> bool:
    """Return whether two motions are one for the floor that a survey shows."""
    middle_m = a.ends_m.mean(axis=(0, 1))
    apart_m = other.move(motion.inverse().move(middle_m)) - middle_m
    apart_rad = np.remainder(motion.yaw_rad - other.yaw_rad + np.pi, 2 * np.pi) - np.pi
    return bool(np.hypot(*apart_m) <= _SAME_M and abs(apart_rad) <= _SAME_RAD)


def _contradiction_m(a: SeenFloor, b: SeenFloor, motion: PlaneMotion) -> float:
    """Return what length of the faces of each survey lies well inside of the other's free floor."""
    back = motion.inverse()
    return _inside_m(b.faces.moved(motion), a) + _inside_m(a.faces.moved(back), b)


def _inside_m(faces: SeenFaces, floor: SeenFloor) -> float:
    inner = overlays.buffer_shapes(floor.free, -_INSIDE_M)
    shapely.prepare(inner)
    _, points_m, length_m = place_points(faces)
    return float(length_m[shapely.contains_xy(inner, *points_m.T)].sum())
