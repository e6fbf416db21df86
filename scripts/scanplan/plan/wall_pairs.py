"""Faces paired into walls: which stretches are sides of one wall, and where its middle and its thickness are."""

import math
from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.geometry.lines import Line, least_scatter_normal, rows_scatter
from scanplan.rays import face_profile

_LEAST_OVERLAP_M = 0.2
_LEAST_OPEN_M = 0.3
_OPEN_SHARE = 0.3
CORNER_M = 0.3
_SHORTEST_M = 1e-9
_SAME_LINE, _OPPOSITE, _ONWARD = range(3)


@dataclass(frozen=True)
class PairSettings:
    """When faces are sides of one wall.

    Attributes
    ----------
    max_angle_deg : float, above 0, below 45
    min_thickness_m, max_thickness_m : float, > 0
    offset_m : float, > 0
        All faces of one side of a wall lie this near to one line.
    max_gap_m : float, >= 0
        Faces of one side that pause for longer are different walls, unless the other side goes on.
    """

    max_angle_deg: float
    min_thickness_m: float
    max_thickness_m: float
    offset_m: float
    max_gap_m: float


class Sides:
    """What has a `left` and a `right` side, lists, and a `thickness_m`, NaN where only one side is known."""

    @property
    def members(self):
        """All of both sides."""
        return self.left + self.right

    @property
    def half_m(self):
        """From the middle to either face; 0 where the line is that of the face."""
        return 0.0 if math.isnan(self.thickness_m) else self.thickness_m / 2


@dataclass(frozen=True, eq=False)
class FacePair(Sides):
    """A straight wall of one or two sides.

    Attributes
    ----------
    line : lines.Line
        Its middle, or its face where it has one side; the normal is on the left of the way along it.
    left, right : list of int
        Stretches whose normals are the line's, and opposite to it; the right side is empty where only one is known.
    thickness_m : float
        NaN where only one side is known.
    """

    line: Line
    left: list
    right: list
    thickness_m: float


def pair_faces(stretches, settings, reading, *, planar):
    """Sort stretches into walls.

    Stretches of one line are joined first, then those opposite to each other, the longest overlap before others, then
    those that go on from each other; never so that a side would not be straight within `offset_m`, nor where rays went
    through what would be one side while the other was seen.

    Parameters
    ----------
    stretches : list of face_intervals.FaceInterval
    settings : PairSettings
    reading : face_profile.RaySettings
    planar : bool

    Returns
    -------
    list of Wall
        Every stretch is in exactly one.
    """
    group = list(range(len(stretches)))
    members = {i: [i] for i in group}
    for one, other in _offers(stretches, settings, reading, planar):
        a, b = group[one], group[other]
        if a == b or _joined(stretches, members[a] + members[b], settings) is None:
            continue
        members[a] = sorted(members[a] + members.pop(b))
        for i in members[a]:
            group[i] = a
    return [_joined(stretches, of_wall, settings) for _, of_wall in sorted(members.items())]


def _offers(stretches, settings, reading, planar):
    """Return pairs that may be of one wall, the surest first."""
    ends = np.array([s.ends for s in stretches]).reshape(-1, 2, 2)
    lines = shapely.linestrings(ends)
    reach_m = max(settings.max_gap_m, settings.max_thickness_m)
    pairs = np.stack(
        shapely.STRtree(lines).query(lines, predicate="dwithin", distance=reach_m), axis=1
    )
    pairs = pairs[pairs[:, 0] < pairs[:, 1]]
    normal = np.array([s.line.normal for s in stretches]).reshape(-1, 2)
    alike = np.einsum("ij,ij->i", normal[pairs[:, 0]], normal[pairs[:, 1]])
    steep = math.cos(math.radians(settings.max_angle_deg))
    offers = []
    for i, j in pairs[np.abs(alike) >= steep].tolist():
        overlap_m, behind_m = _beside(stretches[i], stretches[j])
        if stretches[i].line.normal @ stretches[j].line.normal < 0:
            is_thick = settings.min_thickness_m <= behind_m <= settings.max_thickness_m
            if (
                overlap_m >= _LEAST_OVERLAP_M
                and is_thick
                and not _contradict(stretches[i], stretches[j], reading, planar)
            ):
                offers.append((_OPPOSITE, -overlap_m, i, j))
        elif -overlap_m <= settings.max_gap_m and abs(behind_m) <= settings.offset_m:
            kind = _SAME_LINE if stretches[i].seen is stretches[j].seen else _ONWARD
            offers.append((kind, abs(behind_m), i, j))
    return [offer[2:] for offer in sorted(offers)]


def _beside(one, other):
    """Return how far two stretches overlap (negative: how far they are apart), and how far the other lies behind."""
    longer, shorter = (one, other) if one.length_m >= other.length_m else (other, one)
    along = np.sort(longer.line.along_m(shorter.ends))
    overlap_m = min(along[1], longer.high_m) - max(along[0], longer.low_m)
    return float(overlap_m), -float(longer.line.offset_m(shorter.ends).mean())


def _contradict(one, other, reading, planar):
    """Tell whether rays went through the line of one side where the other side was seen and it was not."""
    for seen, unseen in ((one, other), (other, one)):
        span = np.sort(unseen.line.along_m(seen.ends))
        open_m = solid_m = 0.0
        for low_m, high_m in (
            (span[0], min(span[1], unseen.low_m)),
            (max(span[0], unseen.high_m), span[1]),
        ):
            if high_m > low_m:
                columns = unseen.seen.columns(reading, planar=planar)
                open_m += (
                    face_profile.COLUMN_M * columns.opened[columns.between(low_m, high_m)].sum()
                )
                solid_m += high_m - low_m
        if open_m > max(_LEAST_OPEN_M, _OPEN_SHARE * solid_m):
            return True
    return False


def _joined(stretches, members, settings):
    """Return the wall of some stretches; None where they are not straight sides of a wall of possible thickness."""
    first = max(members, key=lambda i: stretches[i].length_m)
    normal = stretches[first].line.normal
    sides = [
        [i for i in members if (stretches[i].line.normal @ normal > 0) == left]
        for left in (True, False)
    ]
    line, offsets_m = _fit([[stretches[i].ends for i in side] for side in sides], normal)
    for side, offset_m in zip(sides, offsets_m, strict=True):
        if any(
            np.abs(line.offset_m(stretches[i].ends) - offset_m).max() > settings.offset_m
            for i in side
        ):
            return None
    if not sides[1]:
        return FacePair(
            Line(line.centre + offsets_m[0] * line.normal, line.normal), *sides, math.nan
        )
    thickness_m = offsets_m[0] - offsets_m[1]
    if not settings.min_thickness_m <= thickness_m <= settings.max_thickness_m:
        return None
    return FacePair(
        Line(line.centre + sum(offsets_m) / 2 * line.normal, line.normal),
        *sides,
        float(thickness_m),
    )


def _fit(sides, normal):
    """Fit parallel lines to the two sides, a list of ends (2, 2) each: a common line, and each side's offset from it.

    A stretch counts as a uniform row of points, by its length.
    """
    scatter = np.zeros(3)
    centres = []
    for ends in sides:
        if not ends:
            centres.append(None)
            continue
        ends = np.array(ends)
        middle, half = ends.mean(axis=1), (ends[:, 1] - ends[:, 0]) / 2
        weight = np.hypot(*half.T)
        weight = weight / max(weight.sum(), _SHORTEST_M)
        centre, of_side = rows_scatter(middle, half, weight)
        scatter += np.hypot(*half.T).sum() * of_side
        centres.append(centre)
    fitted = least_scatter_normal(*scatter, arctan2=math.atan2)
    fitted = fitted if fitted @ normal >= 0 else -fitted
    line = Line(next(c for c in centres if c is not None), fitted)
    return line, [0.0 if c is None else float(line.offset_m(c)) for c in centres]
