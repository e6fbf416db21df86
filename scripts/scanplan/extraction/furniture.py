"""Which faces are walls, and which are furniture, stairs or glass.

One classifier, for one scan or all together.

A wall goes on upward as far as rays reach, lets none through, and has nothing like it close behind.
Where no ray could show that it ends, a low face is judged by its corners: walls meet in the inner
corners of a room, furniture shows its outer ones. The thesis's own extractors go without it: they
know no furniture.
"""

import math
from dataclasses import dataclass

import numpy as np

from scanplan.extraction import face_evidence
from scanplan.extraction.face_arrangement import (
    Faces,
    find_backs_m,
    find_collinear_faces,
    find_corner_faces,
    stand_before,
    stand_in_front,
)
from scanplan.extraction.segment_limits import Row
from scanplan.geometry.lines import Line
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import BEHIND_M, ON_M
from scanplan.types import BoolArray, FloatArray


@dataclass(frozen=True, kw_only=True)
class FurnitureLimits:
    """What distinguishes a wall from furniture.

    Attributes
    ----------
    max_rmse_m : float
        Points of a wall scatter less about its line: clutter that fills the band of inliers
        scatters more. In space asked of what may be furniture.
    wall_height_m : float
        A face seen up to here above the floor, and not seen to end, is a wall; a lower one where
        its corners decide.
    furniture_height_m : float
        A face seen higher is no furniture.
    hang_height_m : float
        A face that begins higher than this and ends below `furniture_height_m` hangs on a wall.
    over_share : float
        A face ends at a height if rays pass over this share, by length, of what they cross above
        it.
    through_share : float
        Rays through a face per ray that meets it: above this it is a railing, stairs or the legs of
        a table.
    missing_share : float
        Usual returns that a face does not give: above this share it is glass.
    furniture_depth_m : float
        Furniture stands at most this far before the wall, which is seen at most this far beside it;
        its sides are no longer.
    furniture_length_m : float
        Longer faces are not taken for furniture because of a wall behind.
    stub_length_m : float
        Shorter faces are walls only where they go on beyond a door or end in inner corners on both
        sides.
    door_width_m : float
        Walls on one line no farther apart than this are parts of one, if what is between leads on.
    corner_m : float
        Ends no farther apart than this meet, and what prolongs a face pauses for no longer.
    by_scan : bool
        Whether single scans leave out what they take for furniture; otherwise all of them together
        decide (`plan.model`).
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
    by_scan: bool = True


def find_furniture_fronts(
    faces: Faces, limits: FurnitureLimits, is_wall: BoolArray | None = None
) -> BoolArray:
    """Return which faces (n,) are fronts of furniture: before a wall seen beside them.

    The wall is what is longer of the two lines: of a niche and the walls beside it these stay, as
    does the wall of a room beside one that is deeper. A pilaster of which no more is seen than of a
    cabinet goes with those. What has its other side before the wall's line is a wall that steps
    forward: of the niche on its other side.

    Parameters
    ----------
    faces : face_arrangement.Faces
    limits : FurnitureLimits
    is_wall : (n,) bool, optional
        Which may be the wall behind; all by default.
    """
    is_small = (faces.top_m < limits.furniture_height_m) & (
        faces.length_m <= limits.furniture_length_m
    )
    may_be_behind = faces.top_m >= limits.wall_height_m
    if is_wall is not None:
        may_be_behind &= is_wall
    before = stand_before(
        faces, is_small, depth_m=limits.furniture_depth_m, door_m=limits.door_width_m
    )
    before &= may_be_behind
    before &= find_backs_m(faces)[:, None] > faces.forward_m - ON_M
    fronts = is_small & before.any(axis=1)
    # a shelf before a cabinet is furniture because of the wall behind both
    return fronts & (before & ~fronts).any(axis=1)


def keep_walls(rows: list[Row], scan: RaySet | None, limits: FurnitureLimits) -> list[Row]:
    """Return the segments of one scan that are walls.

    Parameters
    ----------
    rows : list of tuple
        As `segments.cut_line` returns them, relative to the sensor.
    scan : ray_set.RaySet, optional
        Of all points of the scan. Without it, in the plane, only the scatter decides: no ray
        passes over anything.
    limits : FurnitureLimits
    """
    if not rows:
        return rows
    values = np.array(rows, float)
    if scan is None or not limits.by_scan:
        is_wall = values[:, 7] <= limits.max_rmse_m
    else:
        is_wall = _upright_walls(values, scan, limits)
    return [row for row, is_kept in zip(rows, is_wall.tolist(), strict=True) if is_kept]


def _upright_walls(values: FloatArray, scan: RaySet, limits: FurnitureLimits) -> BoolArray:
    """Return which rows (n, 10) are walls, by what the rays of a 3-D scan show."""
    ends_m = values[:, 0:4].reshape(-1, 2, 2)
    normal = values[:, 4:6]
    heights_m = values[:, 8:10] - scan.floor_z_m
    evidence = face_evidence.weigh_faces(scan, ends_m, normal, heights_m)
    faces = Faces(ends_m=ends_m, normal=normal, top_m=evidence.top_m, line=np.arange(len(values)))
    is_low = faces.top_m < limits.furniture_height_m
    sound = _are_sound(values, evidence, is_low, scan.floor_z_m, limits)
    is_small = is_low & (faces.length_m <= limits.furniture_length_m)
    sound &= ~(is_small & (stand_in_front(faces, limits.furniture_depth_m) & sound).any(axis=1))
    inner, outer = find_corner_faces(faces, limits.corner_m)
    wall = _are_walls_by_corners(faces, sound, inner, outer, limits)
    plain = sound & ~outer.any(axis=(1, 2))
    return wall | _go_on_beyond_doors(values, faces, wall, sound, plain, scan, limits)


def _are_walls_by_corners(
    faces: Faces, sound: BoolArray, inner: BoolArray, outer: BoolArray, limits: FurnitureLimits
) -> BoolArray:
    """Return which sound faces (n,) are tall, or walls by their inner corners.

    Without the sides of furniture and low stubs.
    """
    is_low = faces.top_m < limits.furniture_height_m
    closed = np.all((inner & sound).any(axis=2), axis=1)
    plain = sound & ~outer.any(axis=(1, 2))
    wall = sound & ((faces.top_m >= limits.wall_height_m) | closed)
    # what meets a wall in an inner corner is one, too, and so on
    while (joined := plain & ~wall & (inner & wall).any(axis=(1, 2))).any():
        wall |= joined
    # what is seen higher than a piece of furniture is no side of it
    as_high = faces.top_m[None, :] > faces.top_m[:, None] - BEHIND_M
    beside_furniture = (outer & (~sound & as_high)[:, None]).any(axis=(1, 2))
    wall &= ~(beside_furniture & (faces.length_m <= limits.furniture_depth_m) & is_low)
    is_stub = faces.length_m < limits.stub_length_m
    return wall & ~(is_stub & is_low & ~closed)


def _go_on_beyond_doors(
    values: FloatArray,
    faces: Faces,
    wall: BoolArray,
    sound: BoolArray,
    plain: BoolArray,
    scan: RaySet,
    limits: FurnitureLimits,
) -> BoolArray:
    """Return which faces (n,) go on from a wall beyond a door, however short they are.

    Of a low one, what is between must be a door.
    """
    tall = faces.top_m >= limits.wall_height_m
    is_stub = faces.length_m < limits.stub_length_m
    beyond = find_collinear_faces(faces, limits.door_width_m) & (wall & ~is_stub)
    goes_on = sound & tall & beyond.any(axis=1)
    unsure = plain & ~tall & ~wall
    for one, other in np.argwhere(beyond & unsure[:, None]):
        goes_on[one] |= _is_door_between(values[one], values[other], scan, limits)
    return goes_on


def _are_sound(
    values: FloatArray,
    evidence: face_evidence.FaceEvidence,
    is_low: BoolArray,
    floor_z_m: float,
    limits: FurnitureLimits,
) -> BoolArray:
    """Return which faces (n,) may be walls: no clutter, railing or glass, none that ends low."""
    is_pierced = evidence.through > limits.through_share
    is_glass = evidence.missing > limits.missing_share
    is_overlooked = evidence.over > limits.over_share
    is_clutter = values[:, 7] > limits.max_rmse_m
    hangs = values[:, 8] - floor_z_m > limits.hang_height_m
    return ~(is_pierced | is_glass | (is_low & (is_clutter | hangs | is_overlooked)))


def _is_door_between(
    one: FloatArray, other: FloatArray, scan: RaySet, limits: FurnitureLimits
) -> bool:
    """Return whether what is between two rows on one line is a door, or nothing."""
    is_after = (other[2:4] - one[0:2]) @ (one[2:4] - one[0:2]) > 0
    first, second = (one, other) if is_after else (other, one)
    start_m = first[2:4]
    end_m = second[0:2]
    if math.hypot(*(end_m - start_m)) <= limits.corner_m:
        return True
    if (end_m - start_m) @ (second[2:4] - second[0:2]) < 0:
        # side by side: one stands before the other
        return False
    line = Line(start_m, second[4:6])
    low_m, high_m = np.sort(line.along_m(np.array([start_m, end_m])))
    return face_evidence.gap_leads_on(scan, line, (low_m, high_m), limits.furniture_depth_m)
