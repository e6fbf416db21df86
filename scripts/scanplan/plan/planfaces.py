"""The faces of the plan: lines that segments agree on, cut to what the points and rays of the chosen scans show."""

import math
from dataclasses import dataclass

from scanplan.plan import crossings, facepieces, fronts, overshoots, rightangles, stretches

_STUB_M = 0.1
_FOREIGN_M = 0.08
_REACHES_M = 0.15


@dataclass(frozen=True, eq=False)
class Traced:
    """Faces found, and how much was dropped.

    Attributes
    ----------
    stretches : list of stretches.Stretch
    n_lines : int
    n_dropped : int
        Lines of which nothing is left: too little seen, furniture, or drawn by a stronger one.
    panes : list of (faceline.Line, float, float)
        From where to where along a line there is glass.
    """

    stretches: list
    n_lines: int
    n_dropped: int
    panes: list


def trace(pieces, rays, merging, reading, square, furniture):
    """Find the faces along the lines of pieces.

    Parameters
    ----------
    pieces : list of facepieces.Piece
        Those of one group share their line.
    rays : rays.Rays
    merging : faces.MergeSettings
    reading : profiles.Reading
    square : rightangles.Prior
    furniture : fronts.Limits

    Returns
    -------
    Traced
        Its stretches meet at corners, none beside a stronger one.
    """
    lines = {}
    for piece in pieces:
        lines.setdefault(id(piece.line), []).append(piece)
    seen = rightangles.turned([_seen(group, rays, reading) for group in lines.values()], square)
    found = _once([stretches.find(s, reading, planar=rays.planar) for s in seen], merging)
    found = fronts.without(found, furniture, planar=rays.planar)
    stacked = crossings.stack(found)
    foreign = [_crossed_m(s, found, stacked) for s in seen]
    runs = (stretches.find(s, reading, planar=rays.planar, foreign_m=m) for s, m in zip(seen, foreign, strict=True))
    found = fronts.without(_once(list(runs), merging), furniture, planar=rays.planar)
    found = overshoots.without_tails(overshoots.without(found), share=merging.ghost_share)
    found = [f for f in found if f.length_m >= _STUB_M]
    met = facepieces.meet_at_corners(found, corner_m=merging.corner_m)
    # some faces reach the line that they end at only now
    met = overshoots.without_tails(met, share=merging.ghost_share)
    met = [f for f in _without_doubles(met, merging) if f.length_m >= _STUB_M]
    lost = [(s.line, *span_m) for s in seen for span_m in s.framed_m.tolist()]
    return Traced(met, len(seen), len(seen) - len({id(f.seen) for f in met}), lost)


def _seen(group, rays, reading):
    low_m, high_m = min(piece.low_m for piece in group), max(piece.high_m for piece in group)
    return stretches.look_along(rays, group[0].line, low_m, high_m, reading)


def _once(found, merging):
    """Return the stretches (those of a line in one list) that are supported, none beside a stronger one."""
    return _without_doubles([s for of_line in found for s in _supported(of_line, merging)], merging)


def _without_doubles(found, merging):
    return facepieces.without_doubles(
        found,
        max_angle_rad=math.radians(merging.max_angle_deg),
        distance_m=merging.merge_distance_m,
        ghost_distance_m=merging.ghost_distance_m,
        ghost_share=merging.ghost_share,
    )


def _supported(of_line, merging):
    """Return the stretches of one line that enough points show; where one is believed, short ones beside it are too."""
    dense = [s for s in of_line if s.n_points >= max(2, merging.min_points_per_m * s.length_m)]
    sure = [s for s in dense if s.length_m >= merging.min_length_m and _is_shown(s, merging)]
    return [s for s in dense if s.length_m >= _STUB_M] if sure else []


def _is_shown(stretch, merging):
    # its ends may have been left to faces that cross it there
    return stretch.length_m + 2 * _FOREIGN_M >= merging.lone_length_m or stretch.n_scans >= merging.min_scans


def _crossed_m(seen, found, stacked):
    """Return from where to where along a line stretches of other lines cross it: list of (low, high)."""
    crossed = crossings.find(seen.line, stacked, reach_m=_REACHES_M)
    spans = zip(crossed.which.tolist(), crossed.place_m, _FOREIGN_M / crossed.sine, strict=True)
    return [(place_m - half_m, place_m + half_m) for i, place_m, half_m in spans if found[i].seen is not seen]
