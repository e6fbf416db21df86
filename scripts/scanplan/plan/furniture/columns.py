"""Columns, piers and casings: what stands in rooms like furniture, but goes on to the ceiling."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely
from scipy.sparse.csgraph import connected_components
from shapely import affinity
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.arcs import Circles, fit_circles
from scanplan.geometry.lines import Line
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.plan import wall_ground
from scanplan.plan.furniture.pieces import Piece
from scanplan.plan.model import priors
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import END_M, ENOUGH_RAYS, FACE_M, LOW_PERCENT, NOISE_M
from scanplan.rays.face_raster import CELL_M
from scanplan.rays.face_rays import cast_at_face
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import FEW, SKIRTING_M, STRETCH_M
from scanplan.store.schemas import COLUMN
from scanplan.types import FloatArray, IntArray

_AMID = 0.7  # of a diagonal: at corners rays go by
_FEW_POINTS = 2000  # tell how a column is turned
_QUARTER = 8  # sides of a quarter of a circle: within 2 mm of it where columns are 0.6 m wide


def tell_columns(
    pieces: Sequence[Piece],
    rays: RaySet,
    walls: Sequence[Polygon],
    *,
    furniture_height_m: float,
    max_width_m: float,
) -> list[Piece]:
    """Return pieces of furniture, those that are columns as such.

    A column is seen from near the floor up to where no furniture is, without a pause, by several
    scans, it stops rays, and it is no wider than a wall is thick. It is drawn as the circle or the
    rectangle that its returns lie on, this up to the wall that it stands against.

    Parameters
    ----------
    pieces : sequence of pieces.Piece
    rays : ray_set.RaySet
    walls : sequence of shapely.Polygon
        The ground that walls and their openings stand on.
    furniture_height_m : float
        What is seen higher above the floor is no furniture.
    max_width_m : float
        Of either side of a column.

    Returns
    -------
    list of pieces.Piece
        In the order given.
    """
    solid = overlays.unite_areas(list(walls))
    return [_tell(piece, rays, solid, furniture_height_m, max_width_m) for piece in pieces]


def find_column_faces(
    walls: Sequence[PlanWall],
    panes: Sequence[PlanWall],
    rays: RaySet,
    *,
    furniture_height_m: float,
    max_width_m: float,
    unpaired_m: float,
) -> list[bool]:
    """Return which walls are visible sides of columns.

    Such are walls as short as a column is wide where none of those that hang together ends at a
    longer wall or a pane, and what stands around one is told to be a column.

    Parameters
    ----------
    walls, panes : sequence of plan_wall.PlanWall
    rays, furniture_height_m, max_width_m
        As in `tell_columns`.
    unpaired_m : float
        How thick a wall is taken for of which one side is known.
    """
    strips = np.array(wall_ground.wall_strips([*walls, *panes], unpaired_m), object)
    is_short = np.array(
        [not wall.openings and wall.length_m <= max_width_m for wall in walls]
        + [False] * len(panes),
        bool,
    )
    others = overlays.unite_areas([*strips[~is_short]])
    taken = overlays.buffer_shapes(others, FACE_M)

    def is_side(wall: PlanWall) -> bool:
        around = overlays.subtract_areas(_ground_around(wall, max_width_m), taken)
        if around.is_empty:
            return False
        outline = max(shapely.get_parts(around), key=lambda part: part.area)
        piece = Piece(outline, np.nan, np.nan, 0, 0)
        return _tell(piece, rays, others, furniture_height_m, max_width_m).kind == COLUMN

    # few walls are as short: only of these is looked at what is around them
    rows = np.flatnonzero(is_short)
    touching = shapely.distance(strips[rows][:, None], strips[rows]) <= END_M
    _, group = connected_components(touching, directed=False)
    meets = shapely.distance(strips[rows], others) <= END_M
    is_free = ~np.isin(group, group[meets])
    sides = [row for row in rows[is_free].tolist() if is_side(walls[row])]
    columns = set(rows[np.isin(group, group[np.isin(rows, sides)])].tolist())
    return [row in columns for row in range(len(walls))]


def _ground_around(wall: PlanWall, depth_m: float) -> Polygon:
    """Return the ground that a column stands on of which a wall is one side."""
    ends_m = wall.line.at(np.array([wall.low_m - END_M, wall.high_m + END_M]))
    before_m, behind_m = (off_m * wall.line.normal for off_m in (END_M, -depth_m))
    return Polygon([*(ends_m + before_m), *(ends_m[::-1] + behind_m)])


def _tell(
    piece: Piece, rays: RaySet, solid: BaseGeometry, furniture_height_m: float, max_width_m: float
) -> Piece:
    xyz_m, scan = _returns_above(piece.outline, rays)
    is_high = xyz_m[:, 2] >= furniture_height_m
    if is_high.sum() < ENOUGH_RAYS or len(np.unique(scan[is_high])) < FEW:
        return piece
    # a lamp over a table is none, nor what hangs over a shelf
    levels_m = np.concatenate([[0.0], np.sort(xyz_m[~is_high, 2]), [furniture_height_m]])
    if np.diff(levels_m).max() > STRETCH_M:
        return piece
    drawn = _fit_outline(xyz_m[:, :2], max_width_m, solid)
    if drawn is None or _weigh_rays(drawn, rays) < 0:
        return piece
    return replace(
        piece,
        outline=drawn,
        z_max_m=float(np.percentile(xyz_m[is_high, 2], 100 - LOW_PERCENT)),
        n_points=len(xyz_m),
        n_scans=len(np.unique(scan)),
        kind=COLUMN,
    )


def _returns_above(outline: Polygon, rays: RaySet) -> tuple[FloatArray, IntArray]:
    """Return the returns (n, 3) over an outline, heights above the floor, and their scans (n,)."""
    # no return on an edge is to be missed by rounding
    low_m, high_m = shapely.bounds(outline).reshape(2, 2) + np.array([[-SHORTEST_M], [SHORTEST_M]])
    xyz_m, scan = rays.gather_towards(low_m, high_m)
    xyz_m = xyz_m - (0.0, 0.0, rays.ground_z_m)
    is_over = shapely.contains_xy(outline, xyz_m[:, :2]) & (xyz_m[:, 2] > SKIRTING_M)
    return xyz_m[is_over], scan[is_over]


def _weigh_rays(drawn: Polygon, rays: RaySet) -> float:
    """Return the log odds that what stands on an outline stops the rays that meet it.

    What a mirror or a pane shows stands where other rays go through. Asked in both diagonals of the
    rectangle around it, as each ray meets one of them.
    """
    corners_m = shapely.get_coordinates(shapely.minimum_rotated_rectangle(drawn))[:4]
    n_stopped, n_passed = 0, 0
    for ends_m in (corners_m[::2], corners_m[1::2]):
        way_m = ends_m[1] - ends_m[0]
        length_m = float(np.hypot(*way_m))
        line = Line(ends_m.mean(axis=0), np.array([-way_m[1], way_m[0]]) / length_m)
        met = cast_at_face(
            rays, line, -_AMID * length_m / 2, _AMID * length_m / 2, at_m=length_m / 2
        )
        is_above = met.height_m > SKIRTING_M
        is_passing = met.is_free(length_m / 2 + FACE_M)
        n_passed += int((is_above & is_passing).sum())
        n_stopped += int((is_above & ~is_passing & ~met.is_occluded).sum())
    return priors.weigh_stops(n_stopped, n_passed)


def _fit_outline(xy_m: FloatArray, max_width_m: float, solid: BaseGeometry) -> Polygon | None:
    """Return the rectangle or the circle that points (n, 2) lie nearer to; None of none so wide.

    A rectangle goes on to the wall that it stands against.
    """
    rectangle, circle = _fit_rectangle(xy_m), _fit_circle(xy_m)
    off_m = np.asarray(shapely.distance(shapely.points(xy_m), rectangle.exterior))
    if circle is not None and _mean_square(circle.residual_m) < _mean_square(off_m):
        radius_m = float(circle.radii_m[0])
        is_column = END_M <= 2 * radius_m <= max_width_m
        drawn = overlays.buffer_shapes(shapely.Point(circle.centre_m), radius_m, quad_segs=_QUARTER)
        return drawn if is_column else None
    corners_m = shapely.get_coordinates(rectangle)
    sides_m = np.hypot(*(corners_m[1:3] - corners_m[:2]).T)
    is_column = sides_m.max() <= max_width_m and sides_m.min() >= END_M
    return _extend_to(rectangle, solid) if is_column else None


def _mean_square(off_m: FloatArray) -> float:
    """Return the mean of squares of distances (n,): strays count as three times noise."""
    return float(np.mean(np.minimum(np.abs(off_m), 3 * NOISE_M) ** 2))


def _fit_circle(xy_m: FloatArray) -> Circles | None:
    """Return the circle that most of points (n, 2) lie on; residuals are those of all."""
    first = _fit_all(xy_m)
    if first is None:
        return None
    far_m = np.abs(first.residual_m)
    circle = _fit_all(xy_m[far_m <= np.percentile(far_m, 100 - 2 * LOW_PERCENT)])
    if circle is None:
        return None
    off_m = np.hypot(*(xy_m - circle.centre_m).T) - circle.radii_m[0]
    return replace(circle, residual_m=off_m)


def _fit_all(xy_m: FloatArray) -> Circles | None:
    one = np.zeros(len(xy_m), np.int64)
    return fit_circles(xy_m, np.ones(len(xy_m)), one, xy_m.mean(axis=0))


def _fit_rectangle(xy_m: FloatArray) -> Polygon:
    """Return the rectangle that points (n, 2) lie nearest to, its sides amid those at each.

    Of those that they lie as near to, the least. Angles are tried in steps of a degree: over the
    width of a column, less than noise. Of a column that two sides are seen of, the rectangle along
    its diagonal is no larger.
    """
    some_m = xy_m[:: max(len(xy_m) // _FEW_POINTS, 1)]
    turns_rad = np.radians(np.arange(90))
    share = (LOW_PERCENT, 100 - LOW_PERCENT)
    own = [_turned(some_m, turn_rad) for turn_rad in turns_rad]
    boxes_m = [np.percentile(own_m, share, axis=0) for own_m in own]
    off_m2 = np.array([_mean_square(_far_from_box(*of)) for of in zip(own, boxes_m, strict=True)])
    area_m2 = [np.prod(np.ptp(box_m, axis=0)) for box_m in boxes_m]
    is_near = off_m2 <= off_m2.min() + (NOISE_M / 10) ** 2
    turn_rad = float(turns_rad[np.argmin(np.where(is_near, area_m2, np.inf))])
    own_m = _turned(xy_m, turn_rad)
    low_m, high_m = np.percentile(own_m, share, axis=0)
    low_x_m, low_y_m, high_x_m, high_y_m = (
        _side_m(own_m[:, axis], end_m[axis]) for end_m in (low_m, high_m) for axis in (0, 1)
    )
    box = shapely.box(low_x_m, low_y_m, high_x_m, high_y_m)
    return affinity.rotate(box, turn_rad, origin=(0, 0), use_radians=True)


def _far_from_box(own_m: FloatArray, box_m: FloatArray) -> FloatArray:
    """Return how far points (n, 2) lie from an upright rectangle: its low and its high corner."""
    low_m, high_m = box_m
    beyond_m = np.maximum(low_m - own_m, own_m - high_m)
    outside_m = np.hypot(*np.maximum(beyond_m, 0).T)
    return np.where((beyond_m <= 0).all(axis=1), -beyond_m.max(axis=1), outside_m)


def _side_m(along_m: FloatArray, end_m: float) -> float:
    """Return the middle of the places (n,) at an end; the end itself where it lies between two."""
    near_m = along_m[np.abs(along_m - end_m) <= NOISE_M]
    return float(np.median(near_m)) if len(near_m) else float(end_m)


def _turned(xy_m: FloatArray, turn_rad: float) -> FloatArray:
    """Return points (n, 2) in axes that are turned by an angle."""
    cos, sin = np.cos(turn_rad), np.sin(turn_rad)
    return xy_m @ np.array([[cos, -sin], [sin, cos]])


def _extend_to(drawn: Polygon, solid: BaseGeometry) -> Polygon:
    """Return a rectangle up to the wall that a side of it stands against, if there is one.

    Returns as near to a wall as its own scatter are the wall's, so that none is of the column.
    """
    corners_m = shapely.get_coordinates(shapely.orient_polygons(drawn))[:4]
    for side in range(4):
        start_m, end_m = corners_m[side], corners_m[(side + 1) % 4]
        along = (end_m - start_m) / np.hypot(*(end_m - start_m))
        away_m = (FACE_M + 2 * CELL_M) * np.array([along[1], -along[0]])
        beyond = Polygon([start_m, start_m + away_m, end_m + away_m, end_m])
        met = overlays.intersect_areas(beyond, solid)
        if met.area > 0:
            gap_m = shapely.LineString([start_m, end_m]).distance(solid)
            step_m = gap_m * away_m / np.hypot(*away_m)
            corners_m[side] = start_m + step_m
            corners_m[(side + 1) % 4] = end_m + step_m
    return Polygon(corners_m)
