"""What is told about a plan, and when there is none."""

import numpy as np

from scanplan.errors import StageError


def check_segments(path, segments, used, n_scans):
    """Raise StageError if the table of walls at `path` has no wall of the used rows (n,) bool, or wrong numbers."""
    if not used.any():
        raise StageError(
            f"{path}: no wall in the first {n_scans} scans ({len(used)} in all scans), at least 1 needed;"
            " take more scans (selection.stop) or loosen the wall extractor (walls)"
        )
    wrong = sum(int((~np.isfinite(values[used])).sum()) for values in segments.values())
    if wrong:
        raise StageError(f"{path}: {wrong} numbers are not finite, 0 allowed; delete it and run again")


def check_plan(path, plan, n_segments, n_scans):
    """Raise StageError if a plan has no wall."""
    if len(plan.walls["wall"]) == 0:
        raise StageError(
            f"{path}: none of {n_segments} wall segments of {n_scans} scans is supported enough to be drawn;"
            " lower plan.merge min_length_m, min_points_per_m, min_scans or lone_length_m"
        )


def text(plan):
    """Say in a few words what a plan holds, and what was left out."""
    walls, faces, rooms = plan.walls, plan.faces, plan.rooms
    length_m = np.hypot(walls["x1_m"] - walls["x0_m"], walls["y1_m"] - walls["y0_m"]).sum()
    paired = int(np.isfinite(walls["thickness_m"]).sum())
    inferred = int((faces["state"] == "inferred").sum())
    closed, doubtful = int(rooms["closed"].sum()), int(walls["verify"].sum())
    return (
        f"{len(walls['wall'])} walls ({paired} with thickness, {doubtful} to verify), {length_m:,.1f} m;"
        f" {len(faces['face'])} faces, {inferred} of them inferred; {len(plan.openings['opening'])} openings;"
        f" {len(rooms['room'])} rooms, {closed} closed, {rooms['area_m2'].sum():,.1f} m2;"
        f" {plan.n_dropped} of {plan.n_lines} lines of faces dropped; {_errors(plan.range_errors_m)}"
    )


def _errors(range_errors_m):
    known_mm = 1000 * range_errors_m[range_errors_m != 0]
    if len(known_mm) == 0:
        return "ranges taken as they are"
    return f"ranges too long by {known_mm.min():.1f} to {known_mm.max():.1f} mm, corrected"
