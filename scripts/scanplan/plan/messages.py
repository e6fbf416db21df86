"""What is told about a plan, and when there is none."""

import numpy as np

from scanplan.errors import StageError
from scanplan.rays import free_space

_FAR_SHARE = (
    0.5  # of the points: fewer of them too far away still leave most doors met by two columns
)


def check_segments(path, segments, used, n_scans):
    """Raise StageError if the table of walls at `path` has no wall of the used rows (n,) bool, or wrong numbers."""
    if not used.any():
        raise StageError(
            f"{path}: no wall in the first {n_scans} scans ({len(used)} in all scans), at least 1 needed;"
            " take more scans (selection.stop) or loosen the wall extractor (walls)"
        )
    wrong = sum(int((~np.isfinite(values[used])).sum()) for values in segments.values())
    if wrong:
        raise StageError(
            f"{path}: {wrong} numbers are not finite, 0 allowed; delete it and run again"
        )


def check_plan(path, plan, n_segments, n_scans):
    """Raise StageError if a plan has no wall."""
    if len(plan.walls["wall"]) == 0:
        raise StageError(
            f"{path}: none of {n_segments} wall segments of {n_scans} scans is supported enough to be drawn;"
            " lower plan.merge min_length_m, min_points_per_m, min_scans or lone_length_m"
        )


def sparse_rays_warning(rays, min_opening_m):
    """Say that rays lie too far apart for the narrowest opening; nothing where they do not.

    An opening is told by rays through it. At a distance r it is met by ``width / (r * spacing)`` columns of rays; two
    are needed, as one alone may pass beside it.

    Parameters
    ----------
    rays : ray_set.RaySet
    min_opening_m : float

    Returns
    -------
    str
        Empty where most points are near enough.
    """
    spacing_rad = float(
        np.median(
            [
                free_space.column_spacing_rad(azimuth_rad)
                for azimuth_rad in (rays.azimuth_rad[rows] for rows in rays.rows)
            ]
        )
    )
    range_m = [
        np.hypot(*(rays.xyz_m[rows, :2] - s[:2]).T)
        for rows, s in zip(rays.rows, rays.sensors_m, strict=True)
    ]
    enough_m = min_opening_m / (2 * spacing_rad) if spacing_rad > 0 else np.inf
    far = float(np.mean(np.concatenate(range_m) > enough_m))
    if far <= _FAR_SHARE:
        return ""
    return (
        f"columns of rays lie {np.degrees(spacing_rad):.1f} deg apart: two meet an opening of {min_opening_m:g} m"
        f" (plan.openings.min_opening_m) up to {enough_m:.1f} m away only, and {far:.0%} of the points are farther;"
        " doors may be missed and rooms not be parted; record more directions a turn (simulate.sensor.n_azimuth)"
    )


def summarise_plan(plan):
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
