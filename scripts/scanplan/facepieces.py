"""Pieces of face lines: cut at pauses, met at corners, never two over each other."""

from dataclasses import dataclass, replace

import numpy as np
import shapely

from scanplan import faceline
from scanplan.faceline import Line

_LEAST_CORNER_RAD = np.radians(30)


@dataclass(frozen=True)
class Piece:
    """A stretch of a face's line: from `low_m` to `high_m` along it, and the segments (k,) that show its line."""

    line: Line
    low_m: float
    high_m: float
    members: np.ndarray

    @property
    def length_m(self):
        """Length of the stretch."""
        return self.high_m - self.low_m

    @property
    def ends(self):
        """Start and end, (2, 2) metres."""
        return self.line.at(np.array([self.low_m, self.high_m]))


def cut(segments, members, *, max_gap_m):
    """Cut a group's line where none of its members shows the face for more than `max_gap_m`.

    Returns
    -------
    list of Piece
        All on the group's common line, in order along it.
    """
    line = faceline.fit(segments, members)
    low, high = faceline.extents_m(line, segments, members)
    order = np.argsort(low, kind="stable")
    low, high = low[order], np.maximum.accumulate(high[order])
    breaks = np.flatnonzero(low[1:] - high[:-1] > max_gap_m) + 1
    first, last = np.r_[0, breaks], np.r_[breaks, len(low)] - 1
    shares = np.split(np.asarray(members)[order], breaks)
    return [
        Piece(line, float(low[a]), float(high[b]), np.sort(share))
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
    for one, other in _near(pieces, 2 * corner_m):
        crossing = _crossing(pieces[one], pieces[other], corner_m)
        if crossing is not None:
            end, along_m = crossing
            moves[one].setdefault(end, []).append(along_m)
    return [_moved(piece, move) for piece, move in zip(pieces, moves, strict=True)]


def _crossing(piece, other, corner_m):
    """Return which end of `piece` the line of `other` meets and where along the piece, or None."""
    turn = piece.line.direction @ other.line.normal
    if abs(turn) < np.sin(_LEAST_CORNER_RAD):
        return None
    along = -(piece.line.centre - other.line.centre) @ other.line.normal / turn
    end = "low_m" if abs(along - piece.low_m) <= abs(along - piece.high_m) else "high_m"
    beyond_m = _beyond_m(other, other.line.along_m(piece.line.at(along)))
    if abs(along - getattr(piece, end)) > corner_m or beyond_m > corner_m:
        return None
    inward = turn if end == "low_m" else -turn
    if inward > 0 or (_at_an_end(other, piece, along, corner_m) and inward < 0):
        return end, float(along)
    return None


def _beyond_m(piece, along_m):
    return max(piece.low_m - along_m, along_m - piece.high_m, 0.0)


def _at_an_end(other, piece, along_m, corner_m):
    """Tell whether the other face, too, ends at the crossing and lies behind this one: an edge seen from outside."""
    place = other.line.along_m(piece.line.at(along_m))
    to_low, to_high = abs(place - other.low_m), abs(place - other.high_m)
    way = other.line.direction if to_low <= to_high else -other.line.direction
    return min(to_low, to_high) <= corner_m and way @ piece.line.normal < 0


def _moved(piece, move):
    nearest = {end: min(places, key=lambda p: (abs(p - getattr(piece, end)), p)) for end, places in move.items()}
    moved = replace(piece, **nearest)
    return moved if moved.length_m >= piece.length_m / 2 else piece


def without_doubles(segments, pieces, *, max_angle_rad, distance_m, ghost_distance_m, ghost_share):
    """Take away from every piece what a stronger one of the same side already draws.

    That is what runs closer than `distance_m` beside it, and, further off, up to `ghost_distance_m`, what shows less
    than `ghost_share` of its points per metre: the same wall once more from a scan that was placed badly.

    Parameters
    ----------
    segments : faceline.Segments
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
    points = [support(segments, piece)[0].sum() for piece in pieces]
    order = sorted(range(len(pieces)), key=lambda i: (-points[i] * pieces[i].length_m, i))
    beside = [[] for _ in pieces]
    for one, other in _near(pieces, max(distance_m, ghost_distance_m)):
        if pieces[one].line.normal @ pieces[other].line.normal >= np.cos(max_angle_rad):
            share = points[one] * pieces[other].length_m / max(points[other] * pieces[one].length_m, 1e-12)
            beside[one].append((other, max(distance_m, ghost_distance_m) if share < ghost_share else distance_m))
    kept = {}
    for number in order:
        remains = [pieces[number]]
        for stronger, width_m in ((p, width) for other, width in sorted(beside[number]) for p in kept.get(other, [])):
            remains = [rest for piece in remains for rest in _less(piece, stronger, width_m)]
        kept[number] = remains
    return [piece for number in order for piece in kept[number]]


def _less(piece, stronger, distance_m):
    low, high = doubled_m(piece, stronger, distance_m)
    if high <= low:
        return [piece]
    rests = replace(piece, high_m=low), replace(piece, low_m=high)
    return [rest for rest in rests if rest.length_m > 0]


def doubled_m(piece, other, distance_m):
    """Return from where to where along `piece` it runs closer than `distance_m` beside `other`; empty: high <= low."""
    low, high = piece.low_m, piece.high_m
    bands = (
        (other.line.along_m(piece.line.centre), piece.line.direction @ other.line.direction, other.low_m, other.high_m),
        (other.line.offset_m(piece.line.centre), piece.line.direction @ other.line.normal, -distance_m, distance_m),
    )
    for value, slope, least, most in bands:
        if abs(slope) < 1e-12:
            if not least <= value <= most:
                return low, low
            continue
        bounds = sorted(((least - value) / slope, (most - value) / slope))
        low, high = max(low, bounds[0]), min(high, bounds[1])
    return low, max(low, high)


def support(segments, piece):
    """Return how many points of each member lie on the piece, (k,) float64, and its members' shares of length, (k,)."""
    low, high = faceline.extents_m(piece.line, segments, piece.members)
    inside = np.clip(np.minimum(high, piece.high_m) - np.maximum(low, piece.low_m), 0, None)
    share = inside / (high - low)
    return segments.n_points[piece.members] * share, share


def _near(pieces, distance_m):
    """Return the ordered pairs of different pieces not further than `distance_m` from each other, sorted."""
    if not pieces:
        return []
    strings = shapely.linestrings(np.array([piece.ends for piece in pieces]))
    one, other = shapely.STRtree(strings).query(strings, predicate="dwithin", distance=distance_m)
    return sorted((a, b) for a, b in zip(one.tolist(), other.tolist(), strict=True) if a != b)
