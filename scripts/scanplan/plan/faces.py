"""The faces of the plan: lines that segments agree on, cut to what the points and rays of the chosen scans show."""

import math
from dataclasses import dataclass

import numpy as np

from scanplan.geometry import intersections
from scanplan.plan import (
    face_candidates,
    face_intervals,
    face_trimming,
    furniture_fronts,
)

_STUB_M = 0.1
_FOREIGN_M = 0.08
_REACHES_M = 0.15


@dataclass(frozen=True, eq=False)
class TracedFaces:
    """Faces found, and how much was dropped.

    Attributes
    ----------
    stretches : list of face_intervals.FaceInterval
    n_lines : int
    n_dropped : int
        Lines of which nothing is left: too little seen, furniture, or drawn by a stronger one.
    panes : list of (lines.Line, float, float)
        From where to where along a line there is glass.
    """

    stretches: list
    n_lines: int
    n_dropped: int
    panes: list


def trace_faces(pieces, rays, merging, reading, furniture):
    """Find the faces along the lines of pieces.

    Parameters
    ----------
    pieces : list of face_candidates.FaceCandidate
        Those of one group share their line.
    rays : ray_set.RaySet
    merging : segment_merging.MergeSettings
    reading : face_profile.RaySettings
    furniture : furniture_fronts.FrontLimits

    Returns
    -------
    Traced
        Its stretches meet at corners, none beside a stronger one.
    """
    lines = {}
    for piece in pieces:
        lines.setdefault(id(piece.line), []).append(piece)
    seen = [_seen(group, rays, reading) for group in lines.values()]
    found = _once(
        [face_intervals.find_face_intervals(s, reading, planar=rays.planar) for s in seen], merging
    )
    found = furniture_fronts.remove_furniture_fronts(found, furniture, planar=rays.planar)
    claimed = zip(seen, owned_intervals(seen, found), strict=True)
    runs = (
        face_intervals.find_face_intervals(s, reading, planar=rays.planar, foreign_m=spans_m)
        for s, spans_m in claimed
    )
    found = furniture_fronts.remove_furniture_fronts(
        _once(list(runs), merging), furniture, planar=rays.planar
    )
    found = face_trimming.trim_tails(
        face_trimming.trim_overshoots(found), share=merging.ghost_share
    )
    found = [f for f in found if f.length_m >= _STUB_M]
    met = face_candidates.meet_at_corners(found, corner_m=merging.corner_m)
    # some faces reach the line that they end at only now
    met = face_trimming.trim_tails(met, share=merging.ghost_share)
    met = [f for f in _without_doubles(met, merging) if f.length_m >= _STUB_M]
    lost = [(s.line, *span_m) for s in seen for span_m in s.framed_m.tolist()]
    return TracedFaces(met, len(seen), len(seen) - len({id(f.seen) for f in met}), lost)


def _seen(group, rays, reading):
    low_m, high_m = min(piece.low_m for piece in group), max(piece.high_m for piece in group)
    return face_intervals.observe_along(rays, group[0].line, low_m, high_m, reading)


def _once(found, merging):
    """Return the stretches (those of a line in one list) that are supported, none beside a stronger one."""
    return _without_doubles([s for of_line in found for s in _supported(of_line, merging)], merging)


def _without_doubles(found, merging):
    return face_candidates.remove_doubles(
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
    return (
        stretch.length_m + 2 * _FOREIGN_M >= merging.lone_length_m
        or stretch.n_scans >= merging.min_scans
    )


def owned_intervals(lines, found):
    """Return from where to where along lines others cross them: points there are theirs.

    What others claim whole is the end of a wall that another line happens to lead through, as a shelf's beside a door's
    jamb: it is no wall that crosses, and claims nothing.

    Parameters
    ----------
    lines : list of face_profile.FaceObservation
    found : list of face_intervals.FaceInterval

    Returns
    -------
    list of list of (float, float)
        Per line.
    """
    stacked = intersections.stack_spans(found)
    standing = [f for f in found if _left_m(f, _crossed_m(f.seen, found, stacked)) >= _STUB_M]
    stacked = intersections.stack_spans(standing)
    return [_crossed_m(seen, standing, stacked) for seen in lines]


def _left_m(stretch, claimed_m):
    """Return how much of a stretch is in none of some spans along its line."""
    spans = np.clip(np.array(claimed_m).reshape(-1, 2), stretch.low_m, stretch.high_m)
    reached_m, left_m = stretch.low_m, 0.0
    for low_m, high_m in sorted(spans.tolist()):
        left_m += max(low_m - reached_m, 0.0)
        reached_m = max(reached_m, high_m)
    return left_m + stretch.high_m - reached_m


def _crossed_m(seen, found, stacked):
    """Return from where to where along a line stretches of other lines cross it: list of (low, high)."""
    crossed = intersections.find_crossings(seen.line, stacked, reach_m=_REACHES_M)
    spans = zip(crossed.which.tolist(), crossed.place_m, _FOREIGN_M / crossed.sine, strict=True)
    return [
        (place_m - half_m, place_m + half_m)
        for i, place_m, half_m in spans
        if found[i].seen is not seen
    ]
