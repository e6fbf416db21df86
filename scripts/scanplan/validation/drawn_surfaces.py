"""Surfaces and openings of a plan, as rays meet them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.intervals import find_gaps
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.plan.floorplan import FloorPlan, centrelines_m, line_columns, line_shapes
from scanplan.plan.tolerances import END_M
from scanplan.types import Array, BoolArray, Columns, FloatArray, IntArray

FACE, OPENING, OUTLINE = "face", "opening", "outline"
"""Kinds of elements: spans of faces, openings, and spans of rooms' outlines without either."""
_EVERYWHERE_M = (-np.inf, np.inf)


@dataclass(frozen=True, eq=False)
class DrawnSurfaces:
    """The surfaces and ways of a plan, upright rectangles; heights in the map frame.

    Attributes
    ----------
    ends_m : (k, 2, 2) float64
    z_m : (k, 2) float64
        From which height to which; infinite where the plan states none.
    half_m : (k,) float64
        Of ways: half of the thickness of the wall that they lead through; 0 of surfaces.
    is_way : (k,) bool
        Rays are to go through, and not to end there.
    is_pane : (k,) bool
        Of ways, those of glass: rays may end at them as well.
    is_cap : (k,) bool
        The end of a wall, or the reveal of an opening: returns are explained by it, but none
        contradicts it, as what it adjoins is seldom drawn to its thickness.
    element, n_spans : (k,) int64
        Row of `elements` of the first of its equal spans, -1 of caps, and how many there are.
    elements : dict of str to (e,) array
        `kind`, `number` (of the face, opening or room), `span`, `x0_m`, `y0_m`, `x1_m`, `y1_m`.
    """

    ends_m: FloatArray
    z_m: FloatArray
    half_m: FloatArray
    is_way: BoolArray
    is_pane: BoolArray
    is_cap: BoolArray
    element: IntArray
    n_spans: IntArray
    elements: Columns


@dataclass(frozen=True, eq=False)
class _Surface:
    """One surface: its ends, what `DrawnSurfaces` says of it, and its first element's identity."""

    ends_m: FloatArray
    z_m: tuple[float, float]
    half_m: float = 0.0
    is_way: bool = False
    is_pane: bool = False
    element: tuple[str, int, int] | None = None
    n_spans: int = 1

    def spans(self) -> Iterator[tuple[tuple[str, int, int], FloatArray]]:
        """Yield the identity and the ends (2, 2) of each span; nothing of a cap."""
        if self.element is None:
            return
        kind, number, first = self.element
        places_m = np.linspace(self.ends_m[0], self.ends_m[1], self.n_spans + 1)
        for i in range(self.n_spans):
            yield (kind, number, first + i), places_m[i : i + 2]


def list_surfaces(plan: FloorPlan, span_m: float, *, planar: bool) -> DrawnSurfaces:
    """List what the rays of a sensor meet in a plan.

    Faces are solid from the floor to their wall's top, less openings; openings are ways from sill
    to lintel and solid below and above, in both sides of their wall; where neither is drawn of a
    room's outline, it is a way.

    Parameters
    ----------
    span_m : float, > 0
        Faces and outlines are cut into equal spans of at most this length, each an element.
    planar : bool
        Whether the sensor's height is not known: everything is as high as the storey, and sills
        and lintels are not asked for.
    """
    surfaces = [*_face_surfaces(plan, span_m, planar=planar)]
    surfaces += _opening_surfaces(plan, planar=planar)
    surfaces += _wall_ends(plan)
    lines_m = np.array([surface.ends_m for surface in surfaces], float).reshape(-1, 2, 2)
    drawn = overlays.unite_areas(
        overlays.buffer_shapes([*line_shapes(lines_m), *plan.gaps], END_M, quad_segs=8)
    )
    return _gather([*surfaces, *_outline_ways(plan, drawn, span_m)])


def _gather(surfaces: Sequence[_Surface]) -> DrawnSurfaces:
    # an opening's way comes before what is below and above it, and states its ends
    ends_of: dict[tuple[str, int, int], FloatArray] = {}
    for surface in surfaces:
        for element, ends_m in surface.spans():
            ends_of.setdefault(element, ends_m)
    elements = sorted(ends_of)
    row_of = {element: row for row, element in enumerate(elements)}
    ends_m = np.array([ends_of[element] for element in elements])
    columns: dict[str, Array] = {
        "kind": np.array([kind for kind, _, _ in elements], object),
        "number": np.array([number for _, number, _ in elements], np.int32),
        "span": np.array([span for _, _, span in elements], np.int32),
    }
    columns |= line_columns(ends_m)
    return DrawnSurfaces(
        np.array([s.ends_m for s in surfaces], float).reshape(-1, 2, 2),
        np.array([s.z_m for s in surfaces], float).reshape(-1, 2),
        np.array([s.half_m for s in surfaces], float),
        np.array([s.is_way for s in surfaces], bool),
        np.array([s.is_pane for s in surfaces], bool),
        np.array([s.element is None for s in surfaces], bool),
        np.array([-1 if s.element is None else row_of[s.element] for s in surfaces], np.int64),
        np.array([s.n_spans for s in surfaces], np.int64),
        columns,
    )


def _face_surfaces(plan: FloorPlan, span_m: float, *, planar: bool) -> Iterator[_Surface]:
    """Yield the spans of faces, openings of their walls left out."""
    floor_m, _ = plan.storey_m
    tops_m = dict(zip(plan.walls["wall"].tolist(), floor_m + plan.heights_m, strict=True))
    is_low = dict(zip(plan.walls["wall"].tolist(), plan.low.tolist(), strict=True))
    openings_m = centrelines_m(plan.openings)
    lines_m = centrelines_m(plan.faces)
    numbers = (plan.faces[name].tolist() for name in ("face", "wall"))
    for face, wall, ends_m, is_reveal in zip(*numbers, lines_m, plan.reveals, strict=True):
        ends_low = is_low.get(wall, False) and not planar
        z_m = (-np.inf, tops_m[wall]) if ends_low else _EVERYWHERE_M
        span = 0
        # openings in no wall (-1) are none of every face in no wall
        is_own = (plan.openings["wall"] == wall) & (wall >= 0) & ~is_reveal
        for part_m in _cut_out(ends_m, openings_m[is_own]):
            n_spans = _count_spans(part_m, span_m)
            yield _Surface(part_m, z_m, element=(FACE, face, span), n_spans=n_spans)
            span += n_spans


def _opening_surfaces(plan: FloorPlan, *, planar: bool) -> Iterator[_Surface]:
    """Yield the openings: the way, what is below and above it on both sides, and its reveals."""
    floor_m, _ = plan.storey_m
    known = (plan.openings[name] for name in ("opening", "type", "sill_m", "lintel_m"))
    rows = zip(*known, plan.hosts, centrelines_m(plan.openings), strict=True)
    for opening, kind, sill_m, lintel_m, host, ends_m in rows:
        left_m, right_m = (float(side[host]) if host >= 0 else 0.0 for side in plan.sides_m)
        element = (OPENING, int(opening), 0)
        normal = _normal(ends_m)
        sides_m = [ends_m + left_m * normal, ends_m - right_m * normal]
        low_m = floor_m + sill_m if sill_m > 0 and not planar else -np.inf
        high_m = floor_m + lintel_m if np.isfinite(lintel_m) and not planar else np.inf
        half_m = max(left_m, right_m)
        yield _Surface(
            ends_m,
            (low_m, high_m),
            half_m,
            is_way=True,
            is_pane=kind == "glass",
            element=element,
        )
        for side_m in sides_m:
            if np.isfinite(low_m):
                yield _Surface(side_m, (-np.inf, low_m), element=element)
            if np.isfinite(high_m):
                yield _Surface(side_m, (high_m, np.inf), element=element)
        yield from _caps(*sides_m)


def _outline_ways(plan: FloorPlan, drawn: BaseGeometry, span_m: float) -> Iterator[_Surface]:
    """Yield what is not near anything drawn of the rooms' outlines, but for corners' rests."""
    for room, area in zip(plan.rooms["room"].tolist(), plan.areas, strict=True):
        blank = overlays.merge_lines(overlays.subtract_lines(shapely.boundary(area), drawn))
        span = 0
        for line in shapely.get_parts(blank):
            corners_m = shapely.get_coordinates(line)
            for ends_m in np.stack([corners_m[:-1], corners_m[1:]], axis=1):
                if np.hypot(*(ends_m[1] - ends_m[0])) <= 2 * END_M:
                    continue
                n, element = _count_spans(ends_m, span_m), (OUTLINE, room, span)
                yield _Surface(ends_m, _EVERYWHERE_M, is_way=True, element=element, n_spans=n)
                span += n


def _wall_ends(plan: FloorPlan) -> Iterator[_Surface]:
    """Yield the caps of walls of known thickness."""
    left_m, right_m = plan.sides_m
    for row in np.flatnonzero(plan.thick).tolist():
        sides_m = [plan.wall_shapes.trace(row, off_m) for off_m in (left_m[row], -right_m[row])]
        yield from _caps(*(side_m[[0, -1]] for side_m in sides_m))


def _caps(left_m: FloatArray, right_m: FloatArray) -> Iterator[_Surface]:
    for end in (0, 1):
        across_m = np.stack([left_m[end], right_m[end]])
        if np.hypot(*(across_m[1] - across_m[0])) > SHORTEST_M:
            yield _Surface(across_m, _EVERYWHERE_M)


def _cut_out(ends_m: FloatArray, openings_m: FloatArray) -> list[FloatArray]:
    """Return the parts (2, 2) of a line that openings (n, 2, 2) leave."""
    length_m = np.hypot(*(ends_m[1] - ends_m[0]))
    along = (ends_m[1] - ends_m[0]) / length_m
    taken_m = np.sort((openings_m - ends_m[0]) @ along, axis=1)
    taken_m = taken_m[(taken_m[:, 1] > 0) & (taken_m[:, 0] < length_m)]
    # the ends stand for openings of no width, so that there is always one
    taken_m = np.concatenate([[[0.0, 0.0]], taken_m])
    gaps_m = find_gaps(taken_m, 0.0, length_m)
    # an opening that ends where the line does may leave a part without a length
    gaps_m = gaps_m[np.diff(gaps_m)[:, 0] > SHORTEST_M]
    return [ends_m[0] + gap_m[:, None] * along for gap_m in gaps_m]


def _count_spans(ends_m: FloatArray, span_m: float) -> int:
    """Return into how many equal spans of at most a length a line (2, 2) is cut."""
    return max(int(np.ceil(np.hypot(*(ends_m[1] - ends_m[0])) / span_m)), 1)


def _normal(ends_m: FloatArray) -> FloatArray:
    """Return the unit normal (2,) to the left of a line."""
    x, y = (ends_m[1] - ends_m[0]) / np.hypot(*(ends_m[1] - ends_m[0]))
    return np.array([-y, x])
