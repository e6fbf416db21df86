"""Which of the faces that a scan shows are walls, and which are furniture, stairs or glass.

A wall goes on upward as far as rays reach, lets none through, and has nothing like it close behind. Where no ray could
show that it ends, a low face is judged by its corners: walls meet in the inner corners of a room, furniture shows its
outer ones.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.rays.expected_returns import count_sent_rays
from scanplan.rays.face_raster import SCAN_COLUMN_M, rasterise_rays
from scanplan.rays.face_rays import ON_M, SKIRTING_M, cast_at_face
from scanplan.rays.ray_set import RaySet

_PARALLEL = np.cos(np.deg2rad(10))
BEHIND_M = 0.15  # a return farther behind a face is not its own
_EDGE_ON_M = 1e-3  # a face through the sensor is seen edge on
_GOOD_SHARE = 0.15  # of rays: fewer may be stray
_LEVEL_M = 0.15  # tops that differ less are one
_ACROSS = np.cos(np.deg2rad(45))


@dataclass(frozen=True, kw_only=True)
class FurnitureLimits:
    """What tells a wall from furniture.

    Attributes
    ----------
    max_rmse_m : float
        Points of a wall scatter less about its line: clutter that fills the band of inliers scatters more. In space
        asked of what may be furniture.
    wall_height_m : float
        A face seen up to here above the floor, and not seen to end, is a wall; a lower one where its corners tell.
    furniture_height_m : float
        A face seen higher is no furniture.
    hang_height_m : float
        A face that begins higher than this and ends below `furniture_height_m` hangs on a wall.
    over_share : float
        A face ends at a height if rays pass over this share, by length, of what they cross above it.
    through_share : float
        Rays through a face per ray that meets it: above this it is a railing, stairs or the legs of a table.
    missing_share : float
        Usual returns that a face does not give: above this share it is glass.
    furniture_depth_m : float
        Furniture stands at most this far before the wall, which is seen at most this far beside it; its sides are no
        longer.
    furniture_length_m : float
        Longer faces are not taken for furniture because of a wall behind.
    stub_length_m : float
        Shorter faces are walls only where they go on beyond a door or end in inner corners on both sides.
    door_width_m : float
        Walls on one line no farther apart than this are pieces of one, if what is between leads on.
    corner_m : float
        Ends no farther apart than this meet, and what prolongs a face pauses for no longer.
    """

    max_rmse_m: float
    wall_height_m: float
    furniture_height_m: float
    hang_height_m: float
    over_share: float
    through_share: float
    missing_share: float
    furniture_depth_m: float
    furniture_length_m: float
    stub_length_m: float
    door_width_m: float
    corner_m: float


def keep_walls(rows, scan, limits):
    """Keep the rows that are walls.

    Parameters
    ----------
    rows : list of tuple
        As `segments.cut_line` gives them, relative to the sensor.
    scan : ray_set.RaySet, optional
        Of all points of the scan. Without it, in the plane, only the scatter is judged: no ray passes over anything.
    limits : Limits

    Returns
    -------
    list of tuple
    """
    if not rows:
        return rows
    values = np.array(rows, float)
    sound = (
        values[:, 7] <= limits.max_rmse_m if scan is None else _upright_walls(values, scan, limits)
    )
    return [row for row, good in zip(rows, sound.tolist(), strict=True) if good]


@dataclass(frozen=True)
class FaceEvidence:
    """What rays say of a face.

    Attributes
    ----------
    top_m : float
        Height above the floor up to which it is seen over a good stretch.
    over : float
        How surely it ends at some height, see `face_raster.FaceRaster.over_share`.
    through : float
        Rays through it below its top, per ray that ends at it.
    missing : float
        Share of the returns expected within its outline that are nowhere.
    """

    top_m: float
    over: float
    through: float
    missing: float


def weigh_face(
    rays: RaySet, line: Line, span_m: tuple[float, float], heights_m: tuple[float, float]
) -> FaceEvidence:
    """Return what one scan's rays say of a face.

    Parameters
    ----------
    rays : ray_set.RaySet
    line : lines.Line
    span_m : (float, float)
        The face along the line.
    heights_m : (float, float)
        Of its returns, above the floor.
    """
    face = cast_at_face(rays, line, *span_m, at_m=ON_M, least_side_m=_EDGE_ON_M)
    is_on, is_beyond = face.is_occupied, face.is_free(BEHIND_M)
    is_raised = face.height_m > SKIRTING_M
    raster = rasterise_rays(
        (face.along_m[is_on], face.height_m[is_on]),
        (face.along_m[is_beyond], face.height_m[is_beyond]),
        (np.empty(0), np.empty(0)),
        span_m=span_m,
        column_m=SCAN_COLUMN_M,
    )
    top_m = raster.seen_top_m()
    n_through = (is_beyond & is_raised & (face.height_m < top_m)).sum()
    sent = count_sent_rays(rays, face, span_m[0], len(raster), raster.column_m, heights_m)
    through = n_through / max((is_on & is_raised).sum(), 1)
    return FaceEvidence(top_m, raster.over_share(), through, sent.missing_share)


def _upright_walls(values, scan, limits):
    """Return which rows (n, 10) are walls, by what the rays of a 3-D scan tell."""
    start_m, end_m, normal = values[:, 0:2], values[:, 2:4], values[:, 4:6]
    evidence = [_weigh_row(scan, row) for row in values]
    top_m, over, through, missing = np.array(
        [(e.top_m, e.over, e.through, e.missing) for e in evidence]
    ).T
    length_m, lowish = np.hypot(*(end_m - start_m).T), top_m < limits.furniture_height_m
    sound = (values[:, 7] <= limits.max_rmse_m) | ~lowish
    sound &= (through <= limits.through_share) & (missing <= limits.missing_share)
    hangs = values[:, 8] - scan.floor_z_m > limits.hang_height_m
    sound &= ~(lowish & (hangs | (over > limits.over_share)))
    small = lowish & (length_m <= limits.furniture_length_m)
    sound &= ~(
        small
        & (find_faces_in_front(start_m, end_m, normal, limits.furniture_depth_m) & sound).any(
            axis=1
        )
    )
    inner, outer = find_corner_faces(start_m, end_m, normal, limits.corner_m)
    closed = (inner & sound).any(axis=2).all(axis=1)
    tall = top_m >= limits.wall_height_m
    plain = sound & ~outer.any(axis=(1, 2))
    wall = sound & (tall | closed)
    # what meets a wall in an inner corner is one, too, and so on
    while (joined := plain & ~wall & (inner & wall).any(axis=(1, 2))).any():
        wall |= joined
    # what is seen higher than a piece of furniture is no side of it
    as_high = top_m[None, :] > top_m[:, None] - _LEVEL_M
    side_of_furniture = (outer & (~sound & as_high)[:, None]).any(axis=(1, 2)) & (
        length_m <= limits.furniture_depth_m
    )
    wall &= ~(side_of_furniture & lowish)
    stub = length_m < limits.stub_length_m
    wall &= ~(stub & lowish & ~closed)
    # beyond a door a wall goes on, however short what is seen of it there; if it is low, what is between must be a door
    beyond = find_collinear_faces(start_m, end_m, normal, limits) & (wall & ~stub)
    low = plain & ~tall & ~wall
    wall |= sound & tall & beyond.any(axis=1)
    for one, other in np.argwhere(beyond & low[:, None]):
        wall[one] |= _door_between(values[one], values[other], scan, limits)
    return wall


def _weigh_row(scan, row):
    """Return the evidence of a row of `segments.cut_line`."""
    line = Line((row[0:2] + row[2:4]) / 2, row[4:6])
    span_m = np.sort(line.along_m(row[0:4].reshape(2, 2)))
    return weigh_face(scan, line, tuple(span_m), tuple(row[8:10] - scan.floor_z_m))


def gap_leads_on(rays: RaySet, line: Line, span_m: tuple[float, float], depth_m: float) -> bool:
    """Return whether a gap in a wall leads on, as a door does, and not into a niche or between two cabinets.

    Parameters
    ----------
    rays : ray_set.RaySet
    line : lines.Line
    span_m : (float, float)
        The gap along the line.
    depth_m : float
        A niche is no deeper.

    Returns
    -------
    bool
        Whether a good part of the rays through it get deeper; true if there are none.
    """
    face = cast_at_face(rays, line, *span_m, at_m=ON_M, least_side_m=_EDGE_ON_M)
    behind_m = face.behind_m[face.is_free(BEHIND_M) & (face.height_m > SKIRTING_M)]
    return not len(behind_m) or bool(np.mean(behind_m > depth_m) > _GOOD_SHARE)


def _door_between(one, other, scan, limits):
    """Tell whether what is between two faces on one line is a door, or nothing."""
    if (other[2:4] - one[0:2]) @ (one[2:4] - one[0:2]) > 0:
        one, other = other, one
    start_m, end_m = other[2:4], one[0:2]
    if np.hypot(*(end_m - start_m)) <= limits.corner_m:
        return True
    if (end_m - start_m) @ (one[2:4] - one[0:2]) < 0:
        # side by side: one stands before the other
        return False
    line = Line(start_m, one[4:6])
    span_m = np.sort(line.along_m(np.array([start_m, end_m])))
    return gap_leads_on(scan, line, tuple(span_m), limits.furniture_depth_m)


def find_corner_faces(start_m, end_m, normal, reach_m):
    """Tell which faces meet at the ends of others, across them.

    Parameters
    ----------
    start_m, end_m, normal : (n, 2) float
        Of the faces; the normals towards the sensor.
    reach_m : float
        Largest distance of two ends that meet.

    Returns
    -------
    inner, outer : (n, 2, n) bool
        Whether at the start and the end of a face each other one makes an inner corner with it, in which either stands
        before the other, or an outer one, at which both turn away.
    """
    ends_m = np.stack([start_m, end_m], axis=1)
    inner = np.zeros((len(ends_m), 2, len(ends_m)), bool)
    outer = inner.copy()
    across = np.abs(normal @ normal.T) < _ACROSS
    for own in (0, 1):
        for other in (0, 1):
            apart_m = ends_m[None, :, other] - ends_m[:, None, own]
            meet = across & (np.hypot(apart_m[..., 0], apart_m[..., 1]) <= reach_m)
            its_far_end = ends_m[None, :, 1 - other] - ends_m[:, None, own]
            my_far_end = ends_m[:, None, 1 - own] - ends_m[None, :, other]
            it_is_before = np.einsum("ijk,ik->ij", its_far_end, normal) > 0
            i_am_before = np.einsum("ijk,jk->ij", my_far_end, normal) > 0
            inner[:, own] |= meet & it_is_before & i_am_before
            outer[:, own] |= meet & ~it_is_before & ~i_am_before
    return inner, outer


def find_faces_in_front(start_m, end_m, normal, depth_m):
    """Tell which faces stand before others: parallel, up to `depth_m` before and beside them; (n, n) bool."""
    forward_m, gap_m = _placed(start_m, end_m, normal)
    facing = normal @ normal.T > _PARALLEL
    return facing & (forward_m > BEHIND_M) & (forward_m <= depth_m) & (gap_m <= depth_m)


def find_collinear_faces(start_m, end_m, normal, limits):
    """Tell which faces are on one line with others, no farther than a door's width apart; (n, n) bool."""
    forward_m, gap_m = _placed(start_m, end_m, normal)
    same = (normal @ normal.T > _PARALLEL) & (np.abs(forward_m) <= ON_M)
    return same & (gap_m <= limits.door_width_m) & ~np.eye(len(normal), dtype=bool)


def _placed(start_m, end_m, normal):
    """Return how far each face's middle is before each other's line, and how far apart they are along that."""
    middle_m, along = (start_m + end_m) / 2, np.column_stack([normal[:, 1], -normal[:, 0]])
    forward_m = middle_m @ normal.T - (middle_m * normal).sum(axis=1)
    starts_m, ends_m = start_m @ along.T, end_m @ along.T
    own_start_m, own_end_m = np.diag(starts_m), np.diag(ends_m)
    gap_m = np.maximum(
        own_start_m - np.maximum(starts_m, ends_m), np.minimum(starts_m, ends_m) - own_end_m
    )
    return forward_m, gap_m
