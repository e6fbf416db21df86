"""Walls seen in single scans, merged into the faces of the plan, each standing once."""

import math
from dataclasses import dataclass, fields

import numpy as np

from scanplan import facegroups, faceline, facepieces

_MOST_ROUNDS = 10


@dataclass(frozen=True)
class MergeSettings:
    """When segments are one face, and when a face is believed.

    Attributes
    ----------
    max_angle_deg : float, above 0, below 90
        Segments whose normals turn further from the face's are not of it.
    tolerance_m : float, > 0
        Both ends of every segment of a face lie this close to it: what registration may be wrong by.
    merge_distance_m : float, >= tolerance_m
        Of two faces of one side that run closer than this, the stronger is drawn.
    ghost_distance_m : float, >= 0
        Likewise up to this distance, if the weaker shows
    ghost_share : float, 0 to 1
        less than this share of the stronger one's points per metre.
    max_gap_m : float, >= 0
        A longer pause along a face stays open.
    align_gap_m : float, >= 0
        Faces on either side of a pause up to this length share one line where their segments allow (a door in a
        wall). Up to `max_gap_m` it has no effect.
    registration_sigma_m : float, > 0
        Standard deviation of a registered scan's place, for the weights of the fit.
    corner_m : float, >= 0
        Ends this close to where two faces cross are moved there.
    min_length_m : float, >= 0
        Shorter faces are dropped,
    min_points_per_m : float, >= 0
        thinner ones too,
    min_scans : int, >= 1
        and those that fewer scans show,
    lone_length_m : float, >= 0
        unless they are this long.
    """

    max_angle_deg: float
    tolerance_m: float
    merge_distance_m: float
    ghost_distance_m: float
    ghost_share: float
    max_gap_m: float
    align_gap_m: float
    registration_sigma_m: float
    corner_m: float
    min_length_m: float
    min_points_per_m: float
    min_scans: int
    lone_length_m: float

    def __post_init__(self):
        wrong = [f.name for f in fields(self) if not 0 <= getattr(self, f.name) < math.inf]
        wrong += [name for name in ("max_angle_deg", "tolerance_m", "registration_sigma_m") if not getattr(self, name)]
        wrong += ["max_angle_deg"] * (self.max_angle_deg >= 90)
        wrong += ["ghost_share"] * (self.ghost_share > 1)
        wrong += ["merge_distance_m"] * (self.merge_distance_m < self.tolerance_m)
        if wrong:
            raise ValueError(f"merge settings out of range: {', '.join(dict.fromkeys(wrong))}")


def merge(walls, settings):
    """Merge the wall segments of many scans into faces.

    Segments are grouped around common lines (`facegroups`); each group's line is cut at pauses, what too little
    supports is dropped, what weaker faces draw over stronger ones is taken away, and ends meet at corners
    (`facepieces`). The two sides of a wall are different faces. Neither the order of the rows nor the place and turn
    of the map frame matters.

    Parameters
    ----------
    walls : dict of str to (n,) array
        The columns of `schemas.WALLS`.
    settings : MergeSettings

    Returns
    -------
    dict of str to (m,) array
        The columns of `schemas.FACES`, the longest face first; m may be 0.

    Raises
    ------
    ValueError
        If a number of the walls is not finite.
    """
    return _columns([_row(piece) for piece in pieces(walls, settings)])


def pieces(walls, settings):
    """Do as `merge`, but return the faces with the segments that show them, those of one group on one line.

    Parameters
    ----------
    walls : dict of str to (n,) array
        The columns of `schemas.WALLS`.
    settings : MergeSettings

    Returns
    -------
    list of facepieces.Piece
    """
    segments = faceline.from_columns(walls, registration_sigma_m=settings.registration_sigma_m)
    if len(segments.start) == 0:
        return []
    groups = facegroups.group(
        segments,
        max_angle_rad=math.radians(settings.max_angle_deg),
        tolerance_m=settings.tolerance_m,
        reach_m=max(settings.max_gap_m, settings.align_gap_m),
    )
    cut = [p for members in groups for p in facepieces.cut(segments, members, max_gap_m=settings.max_gap_m)]
    return _met(_once(cut, settings), settings)


def summary(faces):
    """Say in a few words how many faces there are and how long all of them are."""
    length_m = np.hypot(faces["x1_m"] - faces["x0_m"], faces["y1_m"] - faces["y0_m"]).sum()
    return f"{len(faces['face'])} faces, {length_m:,.1f} m in all"


def _met(pieces, settings):
    """Let ends meet at corners until nothing changes: what a corner takes in may lie beside a third face."""
    for _ in range(_MOST_ROUNDS):
        before = [(piece.low_m, piece.high_m) for piece in pieces]
        pieces = _once(facepieces.meet_at_corners(pieces, corner_m=settings.corner_m), settings)
        if before == [(piece.low_m, piece.high_m) for piece in pieces]:
            break
    return pieces


def _once(pieces, settings):
    """Return the pieces that are supported, none beside a stronger one."""
    pieces = facepieces.without_doubles(
        [piece for piece in pieces if _is_supported(piece, settings)],
        max_angle_rad=math.radians(settings.max_angle_deg),
        distance_m=settings.merge_distance_m,
        ghost_distance_m=settings.ghost_distance_m,
        ghost_share=settings.ghost_share,
    )
    return [piece for piece in pieces if _is_supported(piece, settings)]


def _is_supported(piece, settings):
    return (
        piece.length_m >= settings.min_length_m
        and piece.n_points >= max(1, settings.min_points_per_m * piece.length_m)
        and (piece.length_m >= settings.lone_length_m or piece.n_scans >= settings.min_scans)
    )


def _row(piece):
    """Return a piece's row of the table of faces, without its number."""
    shown = piece.members[piece.points > 0]
    (x0_m, y0_m), (x1_m, y1_m) = piece.ends
    nx, ny = piece.line.normal
    return {
        "x0_m": x0_m,
        "y0_m": y0_m,
        "x1_m": x1_m,
        "y1_m": y1_m,
        "nx": nx,
        "ny": ny,
        "n_points": round(piece.n_points),
        "n_scans": piece.n_scans,
        "rmse_m": _rmse_m(piece),
        "z_min_m": piece.segments.z_min_m[shown].min(initial=math.inf),
        "z_max_m": piece.segments.z_max_m[shown].max(initial=-math.inf),
    }


def _rmse_m(piece):
    """Root mean square distance of the points from the face: a segment off by a to b adds (aa + ab + bb) / 3."""
    start = piece.line.offset_m(piece.segments.start[piece.members])
    end = piece.line.offset_m(piece.segments.end[piece.members])
    squared = piece.segments.rmse_m[piece.members] ** 2 + (start**2 + start * end + end**2) / 3
    return float(np.sqrt(piece.points @ squared / piece.n_points))


def _columns(rows):
    """Return the rows as columns, numbered from 0: the longest first, equals by place."""
    rows = sorted(rows, key=_rank)
    names = ("x0_m", "y0_m", "x1_m", "y1_m", "nx", "ny", "n_points", "n_scans", "rmse_m", "z_min_m", "z_max_m")
    dtypes = {"n_points": np.int64, "n_scans": np.int32}
    columns = {name: np.array([row[name] for row in rows], dtypes.get(name, np.float64)) for name in names}
    return {
        "face": np.arange(len(rows), dtype=np.int32),
        **columns,
        "state": np.full(len(rows), "observed", object),
        "wall": np.full(len(rows), -1, np.int32),
    }


def _rank(row):
    length_m = math.hypot(row["x1_m"] - row["x0_m"], row["y1_m"] - row["y0_m"])
    return -length_m, row["x0_m"], row["y0_m"], row["nx"], row["ny"]
