"""Pieces of face lines: cut at pauses, met at corners, never two over each other."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import shapely

from scanplan.geometry import intervals, lines
from scanplan.geometry.lines import Line, ObservedSegments, Span

_LEAST_CORNER_RAD = np.radians(30)
_BEFORE_M = 0.08  # as far as points of a face lie from the line of another all the same
_LEVEL = 1e-12  # sine of an angle below which lines are parallel: rounding
_SHORT_M = 0.15  # of what noise, a skirting or a frame may hide of a face before a corner


@dataclass(frozen=True, eq=False)
class FaceCandidate(Span):
    """A stretch of a face's line: from `low_m` to `high_m` along it, and the segments (k,) that show its line."""

    segments: ObservedSegments
    line: Line
    low_m: float
    high_m: float
    members: np.ndarray

    @cached_property
    def points(self):
        """How many points of each member lie on the stretch, (k,) float64."""
        low, high = lines.extents_along_m(self.line, self.segments, self.members)
        inside = np.clip(np.minimum(high, self.high_m) - np.maximum(low, self.low_m), 0, None)
        return self.segments.n_points[self.members] * inside / (high - low)

    @cached_property
    def n_points(self):
        """How many points lie on the stretch, float."""
        return float(self.points.sum())

    @cached_property
    def n_scans(self):
        """How many scans show the stretch."""
        return len(np.unique(self.segments.scan_id[self.members[self.points > 0]]))


def cut_candidates(segments, members, *, max_gap_m):
    """Cut a group's line where none of its members shows the face for more than `max_gap_m`.

    Returns
    -------
    list of Piece
        All on the group's common line, in order along it.
    """
    line = lines.fit_segments_line(segments, members)
    low, high = lines.extents_along_m(line, segments, members)
    order = np.argsort(low, kind="stable")
    breaks = intervals.find_run_starts(low[order], high[order], max_gap_m)
    low, high = low[order], np.maximum.accumulate(high[order])
    first, last = np.r_[0, breaks], np.r_[breaks, len(low)] - 1
    shares = np.split(np.asarray(members)[order], breaks)
    return [
        FaceCandidate(segments, line, float(low[a]), float(high[b]), np.sort(share))
        for a, b, share in zip(first, last, shares, strict=True)
    ]


def meet_at_corners(pieces, *, corner_m):
    """Move the ends of pieces to where their lines cross, if that is no further than `corner_m`.

    A face ends at the corner of a room in front of the other face, at the edge of a pillar behind it; a face that
    butts against the middle of another ends on it. Lines keep their place, only extents change.

    Parameters
    ----------
    pieces : list of Piece
    corner_m : float
        0 moves nothing.

    Returns
    -------
    list of Piece, in the order given
    """
    moves = [{} for _ in pieces]
    for piece, end, along_m in _crossings(pieces, corner_m):
        moves[piece].setdefault(end, []).append(along_m)
    return [_moved(piece, move) for piece, move in zip(pieces, moves, strict=True)]


def _crossings(pieces, corner_m):
    """Return (piece, name of the end, where along it) for every end that may move to another piece's line."""
    one, other = _near(pieces, 2 * corner_m)
    centre, normal, along, low, high = _stacked(pieces)
    turn = _dot(along[one], normal[other])
    steep = np.abs(turn) >= np.sin(_LEAST_CORNER_RAD)
    one, other, turn = one[steep], other[steep], turn[steep]
    place = -_dot(centre[one] - centre[other], normal[other]) / turn
    there = _dot(centre[one] + place[:, None] * along[one] - centre[other], along[other])
    at_low = np.abs(place - low[one]) <= np.abs(place - high[one])
    moves_m = np.abs(place - np.where(at_low, low[one], high[one]))
    beyond_m = np.maximum(np.maximum(low[other] - there, there - high[other]), 0)
    in_front = np.where(at_low, turn, -turn) > 0
    # an edge seen from outside: the other face, too, ends here and lies behind this one
    other_at_low = np.abs(there - low[other]) <= np.abs(there - high[other])
    other_ends = np.abs(there - np.where(other_at_low, low[other], high[other])) <= corner_m
    other_behind = np.where(other_at_low, 1, -1) * _dot(along[other], normal[one]) < 0
    # a face that is seen well before another one ends there only if that one is seen to begin there: one would look at
    # the other's front from where the first is
    before_m = np.where(at_low, place - low[one], high[one] - place)
    other_before_m = np.where(other_at_low, there - low[other], high[other] - there)
    meets = (np.maximum(before_m, other_before_m) <= _BEFORE_M) | (
        np.minimum(before_m, other_before_m) >= -_SHORT_M
    )
    is_edge = other_ends & other_behind & meets
    taken = (moves_m <= corner_m) & (beyond_m <= corner_m) & (in_front | is_edge)
    names = np.where(at_low, "low_m", "high_m")
    return list(zip(one[taken].tolist(), names[taken].tolist(), place[taken].tolist(), strict=True))


def _moved(piece, move):
    if not move:
        return piece
    nearest = {
        end: min(places, key=lambda p: (abs(p - getattr(piece, end)), p))
        for end, places in move.items()
    }
    moved = replace(piece, **nearest)
    return moved if moved.length_m >= piece.length_m / 2 else piece


def remove_doubles(pieces, *, max_angle_rad, distance_m, ghost_distance_m, ghost_share):
    """Take away from every piece what a stronger one of the same side already draws.

    That is what runs closer than `distance_m` beside it, and, further off, up to `ghost_distance_m`, what shows less
    than `ghost_share` of its points per metre: the same wall once more from a scan that was placed badly.

    Parameters
    ----------
    pieces : list of Piece
    max_angle_rad : float
        Faces that turn further from each other are different faces, however close.
    distance_m : float
    ghost_distance_m : float
    ghost_share : float, 0 to 1
        0 leaves ghosts standing.

    Returns
    -------
    list of Piece
        The strongest (longest seen by most points) first; a piece may have become several or none.
    """
    points, length = (
        np.array([getattr(piece, name) for piece in pieces]) for name in ("n_points", "length_m")
    )
    widest_m = max(distance_m, ghost_distance_m)
    one, other = _near(pieces, widest_m)
    normal = _stacked(pieces)[1]
    same_side = _dot(normal[one], normal[other]) >= np.cos(max_angle_rad)
    one, other = one[same_side], other[same_side]
    ghost = points[one] * length[other] < ghost_share * points[other] * length[one]
    beside = [[] for _ in pieces]
    for weaker, stronger, width_m in zip(
        one, other, np.where(ghost, widest_m, distance_m), strict=True
    ):
        beside[weaker].append((stronger, width_m))
    order = np.argsort(-points * length, kind="stable")
    kept = {}
    for number in order:
        remains = [pieces[number]]
        for stronger, width_m in (
            (p, width) for other, width in beside[number] for p in kept.get(other, ())
        ):
            remains = [rest for piece in remains for rest in _less(piece, stronger, width_m)]
        kept[number] = remains
    return [piece for number in order for piece in kept[number]]


def _less(piece, stronger, distance_m):
    low, high = doubled_interval_m(piece, stronger, distance_m)
    if high <= low:
        return [piece]
    rests = replace(piece, high_m=low), replace(piece, low_m=high)
    return [rest for rest in rests if rest.length_m > 0]


def doubled_interval_m(piece, other, distance_m):
    """Return from where to where along `piece` it runs closer than `distance_m` beside `other`; empty: high <= low."""
    low, high = piece.low_m, piece.high_m
    bands = (
        (
            other.line.along_m(piece.line.centre),
            piece.line.direction @ other.line.direction,
            other.low_m,
            other.high_m,
        ),
        (
            other.line.offset_m(piece.line.centre),
            piece.line.direction @ other.line.normal,
            -distance_m,
            distance_m,
        ),
    )
    for value, slope, least, most in bands:
        inside = intervals.solve_range(value, slope if abs(slope) >= _LEVEL else 0.0, least, most)
        low, high = max(low, float(inside[0])), min(high, float(inside[1]))
    return low, max(low, high)


def _near(pieces, distance_m):
    """Return the ordered pairs of different pieces within `distance_m` of each other: (k,), (k,), sorted."""
    strings = shapely.linestrings(np.array([piece.ends for piece in pieces]).reshape(-1, 2, 2))
    one, other = shapely.STRtree(strings).query(strings, predicate="dwithin", distance=distance_m)
    order = np.lexsort((other, one))
    order = order[one[order] != other[order]]
    return one[order], other[order]


def _stacked(pieces):
    """Return centres, normals, directions (n, 2), and where the pieces begin and end, (n,), as arrays."""
    centre = np.array([piece.line.centre for piece in pieces]).reshape(-1, 2)
    normal = np.array([piece.line.normal for piece in pieces]).reshape(-1, 2)
    low, high = (
        np.array([getattr(piece, name) for piece in pieces]) for name in ("low_m", "high_m")
    )
    return centre, normal, np.column_stack([normal[:, 1], -normal[:, 0]]), low, high


def _dot(one, other):
    return np.einsum("ij,ij->i", one, other)
