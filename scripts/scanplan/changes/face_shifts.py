"""How far the faces of one survey lie from those of another, held against returns of both."""

from dataclasses import dataclass

import numpy as np

from scanplan.changes import ray_cells
from scanplan.changes.frame_fit import FrameFit
from scanplan.changes.scan_plane import are_one_plane
from scanplan.changes.seen_faces import FacePairs, SeenFaces, keep_nearest, pair_faces
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import REACH_M, SIGMAS
from scanplan.geometry.lines import Line
from scanplan.types import BoolArray, FloatArray, IntArray

_TURN_RAD = np.radians(4)  # faces of one wall, of which one is short
_LEAST_M = 0.3  # side by side: less may be a jamb
_LIKE_M = 0.03  # faces and returns agree within that: they are of other parts of the wall
_BESIDE = 0.5  # of a stretch: what another pair shows there holds for it


@dataclass(frozen=True, eq=False)
class FaceShifts:
    """Pairs of faces, as seen from those of one survey.

    Attributes
    ----------
    faces, others : SeenFaces
        Of the one survey and the other, in one frame.
    pairs : FacePairs
        `a` are rows of `faces`, `b` of `others`.
    sigma_m : (k,) float64
        Standard deviation of the shifts.
    is_confirmed : (k,) bool
        Whether returns of both surveys say so, too.
    """

    faces: SeenFaces
    others: SeenFaces
    pairs: FacePairs
    sigma_m: FloatArray
    is_confirmed: BoolArray

    def turned(self) -> "FaceShifts":
        """Return them as seen from the faces of the other survey."""
        pairs = self.pairs
        along, middle_m = self.others.along[pairs.b], self.others.ends_m[pairs.b].mean(axis=1)
        along_m = np.einsum("kj,kj->k", pairs.middle_m - middle_m, along)
        half_m = pairs.length_m / 2
        on_a_m = pairs.middle_m - pairs.shift_m[:, None] * self.faces.normal[pairs.a]
        back = FacePairs(
            pairs.b, pairs.a, along_m - half_m, along_m + half_m, on_a_m, -pairs.shift_m
        )
        return FaceShifts(self.others, self.faces, back, self.sigma_m, self.is_confirmed)


def measure_shifts(a: Survey, b: Survey, fit: FrameFit) -> FaceShifts:
    """Pair the faces of two surveys that may be of one wall, wherever it stands now.

    A shift is held against the returns of both surveys at the same heights; where these deny it,
    the faces are of different things, such as a wall and the cupboard before it, and no pair. So
    are those of a wall whose other side is where that of another wall was.

    Parameters
    ----------
    a, b : Survey
        In one frame.
    fit : FrameFit
        The motion between them.
    """
    near = pair_faces(a.faces, b.faces, reach_m=REACH_M, turn_rad=_TURN_RAD, least_m=_LEAST_M)
    pairs = keep_nearest(near, len(a.faces.wall), len(b.faces.wall))
    own_m2 = a.faces.sigma_m[pairs.a] ** 2 + b.faces.sigma_m[pairs.b] ** 2
    of_motion_m = fit.sigmas_m(pairs.middle_m, a.faces.normal[pairs.a])
    sigma_m = np.sqrt(own_m2 + of_motion_m**2 + fit.scatter_m**2)
    is_shifted = np.abs(pairs.shift_m) > SIGMAS * sigma_m
    by_returns_m = np.full(len(sigma_m), np.nan)
    is_compared = is_shifted & are_one_plane(a.sight.plane, b.sight.plane)
    for row in np.flatnonzero(is_compared).tolist():
        span_m = (float(pairs.low_m[row]), float(pairs.high_m[row]))
        line = _face_line(a.faces, pairs.a[row])
        reach_m = REACH_M + ray_cells.CELL_M
        places = [s.sight.place_returns(line, span_m, reach_m) for s in (a, b)]
        by_returns_m[row] = ray_cells.measure_shift(*places)
    off_m = np.abs(by_returns_m - pairs.shift_m)
    agrees = off_m <= np.maximum(SIGMAS * sigma_m, _LIKE_M)
    kept = ~is_shifted | agrees | np.isnan(by_returns_m)
    kept &= ~_are_of_others(a.faces, b.faces, pairs, is_shifted)
    return FaceShifts(a.faces, b.faces, pairs.select(kept), sigma_m[kept], agrees[kept])


def _are_of_others(
    faces: SeenFaces, others: SeenFaces, pairs: FacePairs, is_shifted: BoolArray
) -> BoolArray:
    """Return which shifted pairs (k,) are of two things.

    Those that have a wall that stands, by a side of it, as another, or that are likelier a wall and
    no wall than of one kind: neither has moved to where the other is.
    """
    wall, other = faces.wall[pairs.a], others.wall[pairs.b]
    along = faces.along[pairs.a]
    p_wall, p_other = faces.p_wall[pairs.a], others.p_wall[pairs.b]
    found = is_shifted & (p_wall * p_other + (1 - p_wall) * (1 - p_other) < 1 / 2)
    for row in np.flatnonzero(is_shifted).tolist():
        off_m = (pairs.middle_m - pairs.middle_m[row]) @ along[row]
        half_m, own_half_m = pairs.length_m / 2, pairs.length_m[row] / 2
        shared_m = np.minimum(off_m + half_m, own_half_m) - np.maximum(off_m - half_m, -own_half_m)
        is_beside = ~is_shifted & (shared_m >= _BESIDE * pairs.length_m[row])
        is_beside &= np.abs(along @ along[row]) >= np.cos(_TURN_RAD)
        is_of_wall = (wall == wall[row]) & (wall >= 0)
        is_of_other = (other == other[row]) & (other >= 0)
        found[row] |= np.any(is_beside & (is_of_wall != is_of_other))
    return found


def _face_line(faces: SeenFaces, row: int | IntArray) -> Line:
    return Line(faces.ends_m[row].mean(axis=0), faces.normal[row])
