"""The faces of the plan's walls: what was observed of them, and what follows from it."""

from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon

from scanplan.geometry.intervals import find_gaps
from scanplan.geometry.lines import Line, Span
from scanplan.plan.face_intervals import FaceInterval

OBSERVED, INFERRED = "observed", "inferred"
_INSIDE_M = 0.01
_BUTT_M = 0.05
_SHORTEST_M = 0.1


@dataclass(frozen=True, eq=False)
class WallFace(Span):
    """A face of a wall: a stretch of its line, and the points that show it (none where it is inferred).

    Attributes
    ----------
    line : lines.Line
    low_m, high_m : float
    shown : Stretch or None
    wall : int
    left : bool
        Whether it is the wall's left side.
    """

    line: Line
    low_m: float
    high_m: float
    shown: FaceInterval | None
    wall: int
    left: bool

    @property
    def state(self):
        """`OBSERVED` or `INFERRED`."""
        return INFERRED if self.shown is None else OBSERVED


def cut_wall_faces(walls, *, max_beyond_m):
    """Return the faces of walls, cut where other walls butt against them.

    Where one side of a wall was seen and the other was not, the other is inferred between pieces of it that were seen,
    and a little beyond; so is what lies in a pause that no ray went through; never an opening.

    Parameters
    ----------
    walls : list of walls.PlanWall
    max_beyond_m : float
        How far a side may go on to the wall's end beyond where it was seen.

    Returns
    -------
    list of Face
        By wall.
    """
    blocks = [_block(wall) for wall in walls]
    tree = shapely.STRtree(blocks)
    faces = []
    for number, wall in enumerate(walls):
        shown = [
            (s, is_left) for side, is_left in ((wall.left, True), (wall.right, False)) for s in side
        ]
        for stretch, is_left in shown:
            for low_m, high_m in _outside(
                stretch.line, stretch.low_m, stretch.high_m, number, blocks, tree
            ):
                part = replace(stretch, low_m=low_m, high_m=high_m)
                if part.n_points:
                    faces.append(WallFace(part.line, low_m, high_m, part, number, is_left))
        for line, low_m, high_m, is_left in _missing(wall, max_beyond_m):
            for begin_m, end_m in _outside(line, low_m, high_m, number, blocks, tree):
                if end_m - begin_m >= _SHORTEST_M:
                    faces.append(WallFace(line, begin_m, end_m, None, number, is_left))
    return faces


def _missing(wall, max_beyond_m):
    """Return (line, from, to, left) of what was not seen of the sides of a wall and is there all the same."""
    for is_left, side in ((True, wall.left), (False, wall.right)):
        if not side:
            continue
        sign = 1 if is_left else -1
        line = Line(
            wall.line.centre + sign * wall.half_m * wall.line.normal, sign * wall.line.normal
        )
        known = [line.along_m(s.ends) for s in side]
        if wall.right:
            ways = [g for g in wall.openings if not g.is_above_wall]
            known += [line.along_m(wall.line.at(np.array([g.low_m, g.high_m]))) for g in ways]
            span = np.sort(line.along_m(wall.ends))
            seen = np.sort(known[: len(side)], axis=1)
            inner = span[0] if seen.min() - span[0] <= max_beyond_m else seen.min()
            outer = span[1] if span[1] - seen.max() <= max_beyond_m else seen.max()
            yield from (
                (line, low, high, is_left)
                for low, high in find_gaps(np.sort(known, axis=1), inner, outer).tolist()
            )
        else:
            for gap in wall.closed:
                span = np.sort(line.along_m(wall.line.at(np.array([gap.low_m, gap.high_m]))))
                yield (line, *map(float, span), is_left)


def _block(wall):
    """Return the ground of a wall of known thickness, a little longer than it and slimmer; else nothing."""
    if np.isnan(wall.thickness_m) or wall.half_m <= _INSIDE_M:
        return Polygon()
    ends = wall.line.at(np.array([wall.low_m - _BUTT_M, wall.high_m + _BUTT_M]))
    across = (wall.half_m - _INSIDE_M) * wall.line.normal
    return Polygon([ends[0] - across, ends[1] - across, ends[1] + across, ends[0] + across])


def _outside(line, low_m, high_m, own, blocks, tree):
    """Return the spans (low, high) of a stretch that lie in no other wall."""
    ends = line.at(np.array([low_m, high_m]))
    stretch = LineString(ends)
    others = [
        blocks[i] for i in sorted(tree.query(stretch, predicate="intersects").tolist()) if i != own
    ]
    if not others:
        return [(float(low_m), float(high_m))]
    rest = shapely.get_parts(shapely.difference(stretch, shapely.union_all(others)))
    spans = [
        np.sort(line.along_m(shapely.get_coordinates(part))) for part in rest if part.length > 0
    ]
    return sorted((float(span[0]), float(span[-1])) for span in spans)
