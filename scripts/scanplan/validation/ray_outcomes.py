"""Outcomes of rays in a plan: predicted against measured ends."""

from dataclasses import dataclass

import numpy as np

from scanplan.plan.tolerances import END_M
from scanplan.rays.ray_set import RaySet
from scanplan.types import BoolArray, FloatArray, IntArray
from scanplan.validation.drawn_surfaces import DrawnSurfaces

OUTCOMES = ("explained", "stopped", "passed", "beyond", "outside")
"""What becomes of a ray, see `RayOutcomes`."""
EXPLAINED, STOPPED, PASSED, BEYOND, OUTSIDE = range(len(OUTCOMES))


@dataclass(frozen=True, eq=False)
class RayOutcomes:
    """What became of rays, and what elements of the plan they speak for or against.

    Attributes
    ----------
    outcome : (n,) int8
        Index of `OUTCOMES`: explained, ended at a drawn surface, or pane, that it had a way to;
        stopped before the next (furniture, people, or what is not drawn); passed through one;
        beyond, ended where nothing is drawn; outside, the same after it left through a pane or
        another opening, of which the plan predicts nothing.
    row, element : (m,) int64
        Rays, and the elements that they speak of.
    verdict : (m,) int8
        Explained, where a ray ended at the surface or went through the way as drawn; else passed
        (through the surface) or stopped (in the way).
    """

    outcome: IntArray
    row: IntArray
    element: IntArray
    verdict: IntArray


@dataclass(frozen=True, eq=False)
class _Lines:
    """The lines of surfaces: (k, 2) begins, directions and normals, (k,) lengths."""

    begin_m: FloatArray
    along: FloatArray
    normal: FloatArray
    length_m: FloatArray
    wide_ends_m: FloatArray  # (2, k, 2), as far out as the ends may lie


@dataclass(frozen=True, eq=False)
class _Meetings:
    """Rays and the surfaces that they cross, or would if they went on; (p,) each.

    Attributes
    ----------
    row, surface : int64
    beyond_m : float64
        How far the return lies behind the surface, square to it; negative before it.
    share : float64
        Of the way to the return, where the ray crosses the surface.
    is_sure : bool
        Whether the crossing is within the surface, whatever its ends and heights err by.
    may_be : bool
        Whether it is if they err.
    is_at : bool
        Whether the return is, if they err.
    crossed_span, end_span : int64
        The surface's spans that the crossing and the return are in.
    """

    row: IntArray
    surface: IntArray
    beyond_m: FloatArray
    share: FloatArray
    is_sure: BoolArray
    may_be: BoolArray
    is_at: BoolArray
    crossed_span: IntArray
    end_span: IntArray


def cast_rays(rays: RaySet, surfaces: DrawnSurfaces, tolerance_m: float) -> RayOutcomes:
    """Compare where rays end with where a plan says that they do.

    Ranges are compared square to the surface, as errors of poses and of the surface's place work:
    along a ray that meets it at a small angle, the same error is many times longer. A ray that
    crosses a surface within `END_M` of its end may as well pass beside it: it is explained
    whichever way it went.

    Parameters
    ----------
    tolerance_m : float, > 0
        How far a return at a surface may lie from it.
    """
    lines = _measure_lines(surfaces)
    parts = [
        _judge(_meet(rays, scan, lines, surfaces), surfaces, tolerance_m, rays.rows[scan])
        for scan in range(len(rays.scan_ids))
    ]
    kinds = (np.int8, np.int64, np.int64, np.int8)
    columns = zip(*parts, strict=True) if parts else ([], [], [], [])
    joined = [
        np.concatenate([np.empty(0, kind), *column])
        for kind, column in zip(kinds, columns, strict=True)
    ]
    return RayOutcomes(*joined)


def _measure_lines(surfaces: DrawnSurfaces) -> _Lines:
    begin_m, end_m = surfaces.ends_m[:, 0], surfaces.ends_m[:, 1]
    length_m = np.hypot(*(end_m - begin_m).T)
    along = (end_m - begin_m) / length_m[:, None]
    normal = np.column_stack([-along[:, 1], along[:, 0]])
    wide_ends_m = np.stack([begin_m - END_M * along, end_m + END_M * along])
    return _Lines(begin_m, along, normal, length_m, wide_ends_m)


def _meet(rays: RaySet, scan: int, lines: _Lines, surfaces: DrawnSurfaces) -> _Meetings:
    """Find which surfaces the rays of a scan cross, or would if they went on."""
    n_surfaces = len(lines.length_m)
    most = (len(rays.xyz_m) + 1) * (n_surfaces + 1)  # all of them
    row, surface = rays.sample_rows_between(
        lines.wide_ends_m, np.full(n_surfaces, scan, np.int64), most
    )
    sensor_m = rays.sensors_m[scan]
    way_m = rays.xyz_m[row] - sensor_m
    apart_m = np.einsum("ij,ij->i", lines.begin_m - sensor_m[:2], lines.normal)
    toward_m = np.einsum("ij,ij->i", way_m[:, :2], lines.normal[surface])
    toward_m *= np.sign(apart_m)[surface]
    # a ray that does not come nearer is of a sensor on the line
    kept = toward_m > 0
    row, surface, way_m, toward_m = row[kept], surface[kept], way_m[kept], toward_m[kept]
    distance_m = np.abs(apart_m)[surface]
    share = distance_m / toward_m
    start_m = np.einsum("ij,ij->i", sensor_m[:2] - lines.begin_m, lines.along)[surface]
    gone_m = np.einsum("ij,ij->i", way_m[:, :2], lines.along[surface])
    length_m, z_m = lines.length_m[surface], surfaces.z_m[surface]

    def is_within(of_way: FloatArray | float, wider_m: float) -> BoolArray:
        """Return which places along the ways are within their surfaces, wider by a length."""
        along_m, height_m = start_m + of_way * gone_m, sensor_m[2] + of_way * way_m[:, 2]
        within = (along_m >= -wider_m) & (along_m <= length_m + wider_m)
        return within & (height_m >= z_m[:, 0] - wider_m) & (height_m <= z_m[:, 1] + wider_m)

    return _Meetings(
        row,
        surface,
        toward_m - distance_m,
        share,
        is_within(share, -END_M),
        is_within(share, END_M),
        is_within(1.0, END_M),
        _find_spans((start_m + share * gone_m) / length_m, surfaces.n_spans[surface]),
        _find_spans((start_m + gone_m) / length_m, surfaces.n_spans[surface]),
    )


def _find_spans(place: FloatArray, n_spans: IntArray) -> IntArray:
    """Return the spans (p,) that places along lines are in, shares of the length."""
    return np.clip(np.floor(place * n_spans), 0, n_spans - 1).astype(np.int64)


def _judge(
    met: _Meetings, surfaces: DrawnSurfaces, tolerance_m: float, rows: slice
) -> tuple[IntArray, IntArray, IntArray, IntArray]:
    """Return the outcomes of a scan's rays, and the fields of `RayOutcomes` that follow."""
    n = rows.stop - rows.start
    ray = met.row - rows.start
    is_way, is_cap = surfaces.is_way[met.surface], surfaces.is_cap[met.surface]
    is_pane = surfaces.is_pane[met.surface]
    may_end = ~is_way | is_pane
    is_behind = met.beyond_m > tolerance_m + surfaces.half_m[met.surface]
    is_before = met.beyond_m < -tolerance_m - surfaces.half_m[met.surface]
    passes = ~is_way & ~is_cap & is_behind & met.is_sure
    first_passed = np.full(n, np.inf)
    np.minimum.at(first_passed, ray[passes], met.share[passes])
    is_free = met.share < first_passed[ray]
    ends = may_end & ~is_behind & ~is_before & met.is_at & np.isinf(first_passed)[ray]
    leaves = is_way & is_behind & met.is_sure & is_free
    outcome = np.full(n, BEYOND, np.int8)
    outcome[ray[leaves & (is_pane | (surfaces.half_m[met.surface] > 0))]] = OUTSIDE
    outcome[ray[may_end & is_before & met.may_be]] = STOPPED
    outcome[ray[ends]] = EXPLAINED
    outcome[ray[passes]] = PASSED
    blocked = ~may_end & ~is_behind & ~is_before & met.is_sure & (outcome > EXPLAINED)[ray]
    blocked &= is_free
    stops = _nearest_of_rays(ray, np.abs(met.beyond_m), ends)
    through = passes & (met.share == first_passed[ray])
    speaks = (stops | leaves | through | blocked) & ~is_cap
    verdict = np.select([through, blocked], [PASSED, STOPPED], EXPLAINED).astype(np.int8)
    span = np.where(stops | blocked, met.end_span, met.crossed_span)
    element = surfaces.element[met.surface] + span
    return outcome, met.row[speaks], element[speaks], verdict[speaks]


def _nearest_of_rays(ray: IntArray, apart_m: FloatArray, chosen: BoolArray) -> BoolArray:
    """Return which of the chosen meetings is the one of its ray that is least apart."""
    rows = np.flatnonzero(chosen)
    rows = rows[np.lexsort((apart_m[rows], ray[rows]))]
    nearest = np.zeros(len(ray), bool)
    nearest[rows[np.unique(ray[rows], return_index=True)[1]]] = True
    return nearest
