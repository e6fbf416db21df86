"""Log lines about a plan, and errors where there is none."""

from collections.abc import Sequence

import numpy as np

from scanplan.errors import StageError
from scanplan.plan.faces.intervals import LEAST_OPEN_COLUMNS
from scanplan.plan.floorplan import say_count, shape_walls
from scanplan.plan.planning import Plan
from scanplan.plan.wall_ground import UNSEEN
from scanplan.rays.beam_spread import column_spacing_rad
from scanplan.rays.ray_set import RaySet
from scanplan.stage.witnesses import Measured, rank_findings, state_witness
from scanplan.store.doubts import Finding
from scanplan.store.schemas import COLUMN, LEAF
from scanplan.types import BoolArray, Columns, FilePath, FloatArray


def check_segments(
    path: FilePath,
    segments: Columns,
    used: BoolArray,
    n_scans: int,
    findings: Sequence[Finding] = (),
) -> None:
    """Raise StageError if a table of wall segments has none to use, or wrong numbers.

    Parameters
    ----------
    path : path-like
        The table's.
    segments : dict of str to (n,) array
        The columns of `schemas.WALLS`.
    used : (n,) bool
        Rows of the chosen scans.
    n_scans : int
        Number of the chosen scans.
    findings : sequence of doubts.Finding
        What speaks against the survey: the likeliest cause of it is why there is none.
    """
    if not used.any():
        remedy = "take more scans (selection.stop) or loosen the wall extractor (walls)"
        raise StageError(
            f"{path}: no wall in the first {n_scans} scans, at least 1 needed;"
            f" {_explain(findings) or remedy}"
        )
    n_wrong = sum(int((~np.isfinite(values[used])).sum()) for values in segments.values())
    if n_wrong:
        raise StageError(
            f"{path}: {n_wrong} numbers are not finite, 0 allowed; delete it and run again"
        )


def check_plan(
    path: FilePath,
    plan: Plan,
    n_segments: int,
    n_scans: int,
    findings: Sequence[Finding] = (),
) -> None:
    """Raise StageError if a plan has no wall, with the likeliest cause as in `check_segments`."""
    if len(plan.walls["wall"]) == 0:
        remedy = "lower plan.merge min_length_m, min_points_per_m, min_scans or lone_length_m"
        raise StageError(
            f"{path}: none of {n_segments} wall segments of {n_scans} scans is supported enough to"
            f" be drawn; {_explain(findings) or remedy}"
        )


def _explain(findings: Sequence[Finding]) -> str:
    """Return the likeliest cause of all that was found, and its remedy; empty without any."""
    return rank_findings(findings)[0].sentence if findings else ""


def measure_sparse_rays(rays: RaySet, min_opening_m: float) -> Measured:
    """Return which share of the points is so far off that rays may miss the narrowest opening.

    An opening is detected by rays through it. At a distance r it is met by ``width / (r *
    spacing)`` columns of rays; two are needed, as one alone may pass beside it.

    Parameters
    ----------
    rays : ray_set.RaySet
    min_opening_m : float
    """
    spacings_rad = [column_spacing_rad(*of_scan) for of_scan in rays.headings()]
    spacing_rad = float(np.median(spacings_rad))
    if spacing_rad <= 0:
        return state_witness("sparse rays", np.nan)
    enough_m = min_opening_m / (LEAST_OPEN_COLUMNS * spacing_rad)
    share = float((_ranges_m(rays) > enough_m).mean())
    sizes = {"spacing_deg": np.degrees(spacing_rad), "opening_m": min_opening_m}
    return state_witness("sparse rays", share, enough_m=enough_m, **sizes)


def summarise_plan(plan: Plan) -> str:
    """Return how much of each kind a plan has, and what was left out."""
    walls = plan.walls
    faces = plan.faces
    rooms = plan.rooms
    on_line_m = np.zeros(len(walls["wall"]))
    length_m = shape_walls(walls, on_line_m, on_line_m).measure_lengths_m().sum()
    n_curved = int(np.isfinite(walls["arc_radius_m"]).sum())
    curved = f" {n_curved} curved," if n_curved else ""
    n_paired = int(np.isfinite(walls["thickness_m"]).sum())
    n_doubtful = int(walls["verify"].sum())
    n_inferred = int((faces["state"] == "inferred").sum())
    n_closed = int(rooms["closed"].sum())
    n_pieces = len(plan.furniture["furniture"])
    n_columns, n_leaves = (
        int(np.count_nonzero(plan.furniture["kind"] == kind)) for kind in (COLUMN, LEAF)
    )
    n_unseen = int((plan.openings["type"] == UNSEEN).sum())
    parts = [
        f"{len(walls['wall'])} walls ({n_paired} with thickness,{curved} {n_doubtful} to verify),"
        f" {length_m:,.1f} m",
        f"{len(faces['face'])} faces, {n_inferred} of them inferred",
        say_count(len(plan.openings["opening"]) - n_unseen, "opening"),
        f"{say_count(len(rooms['room']), 'room')}, {n_closed} closed,"
        f" {rooms['area_m2'].sum():,.1f} m2",
        f"{n_pieces - n_columns - n_leaves} pieces of furniture, {n_columns} columns,"
        f" {n_leaves} open leaves",
        f"{plan.n_dropped} of {plan.n_lines} lines of faces dropped",
        summarise_range_bias(plan.range_errors_m),
    ]
    return "; ".join(parts)


def summarise_range_bias(range_errors_m: FloatArray) -> str:
    """Return in a phrase the bias of ranges, of the (181,) metres that they are too long by."""
    errors_mm = 1000 * range_errors_m[range_errors_m != 0]
    if len(errors_mm) == 0:
        return "no range bias removed"
    low, high = (f"{float(error):+.1f}" for error in (errors_mm.min(), errors_mm.max()))
    size = low if low == high else f"{low} to {high}"
    return f"per-beam range bias of {size} mm removed"


def _ranges_m(rays: RaySet) -> FloatArray:
    """Return the level distances of all points from their sensors."""
    way_m = rays.level_way_m
    return np.hypot(way_m[:, 0], way_m[:, 1])
