"""A floor plan as one thing: its tables, and the shapes that drawings and models make of them."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.arcs import trace_arc
from scanplan.plan.curves.bent_footprints import WallShapes
from scanplan.plan.plan_wall import Nearly
from scanplan.plan.survey_scale import SurveyScale
from scanplan.plan.tolerances import END_M
from scanplan.plan.wall_ground import UNSEEN
from scanplan.rays import free_space, levels
from scanplan.store import schemas
from scanplan.store.doubts import NO_DOUBT, Doubts
from scanplan.types import Array, BoolArray, Columns, FloatArray, IntArray

STATES = ("observed", "inferred")
"""Of faces and walls."""
HEIGHTS = {"ceiling": "ceiling", "walls": "highest seen of all walls", "assumed": "assumed"}
"""What the height of a storey follows from, and its wording."""
OPENINGS = {
    "door": "door",
    "window": "window",
    "passage": "passage",
    "glass": "glass pane",
    "gap": "unknown gap",
}
"""Types of openings, and their wording."""
WAYS = ("door", "passage")
"""Those that one may go through."""
NUMBERS = {"walls": "wall", "faces": "face", "openings": "opening", "rooms": "room"}
"""Tables of elements to the columns that number their rows."""
_ENDS = ("x0_m", "y0_m", "x1_m", "y1_m")
_ACROSS = 0.5  # cosine of 60 degrees: reveals are built square, and are short
_CLEARANCE_M = 0.02  # an opening is cut this much deeper than its wall, so that no skin is left
_GRID_M = 1e-4  # of corners: a tenth of a millimetre, what drawings are rounded to


def centrelines_m(columns: Columns) -> FloatArray:
    """Return the lines (n, 2, 2) float64 of a table with the columns x0_m, y0_m, x1_m, y1_m."""
    ends = np.column_stack([columns[name] for name in _ENDS])
    return ends.astype(float).reshape(-1, 2, 2)


def find_hosts(walls: Columns, elements: Columns) -> IntArray:
    """Return the rows of the walls that elements (n,) are of, or in; -1 of none."""
    row_of = {wall: row for row, wall in enumerate(walls["wall"].tolist())}
    return np.array([row_of.get(wall, -1) for wall in elements["wall"].tolist()], np.int64)


def are_across(lines_m: FloatArray, directions: FloatArray) -> BoolArray:
    """Return which lines (n, 2, 2) turn by over 60 degrees from directions (n, 2) or (2,)."""
    own_m = lines_m[:, 1] - lines_m[:, 0]
    along_m = np.abs(np.sum(own_m * directions, axis=-1))
    return along_m < _ACROSS * np.hypot(*own_m.T) * np.hypot(*np.transpose(directions))


def find_reveals(walls: Columns, faces: Columns) -> BoolArray:
    """Return which faces (n,) are across the straight wall that they are of."""
    lines_m = np.append(centrelines_m(walls), np.full((1, 2, 2), np.nan), axis=0)
    lines_m[:-1][np.isfinite(walls["arc_radius_m"].astype(float))] = np.nan
    hosts = find_hosts(walls, faces)
    return are_across(centrelines_m(faces), (lines_m[:, 1] - lines_m[:, 0])[hosts])


def find_stated(elements: Columns) -> BoolArray:
    """Return which rows (n,) a person drew or sized: these are as wide or thick as was said."""
    said = [word.startswith(schemas.DRAWN) for word in elements["corrected"].tolist()]
    return np.array(said, bool)


def line_columns(lines_m: FloatArray) -> Columns:
    """Return the columns of which `centrelines_m` makes lines (n, 2, 2)."""
    return dict(zip(_ENDS, lines_m.reshape(-1, 4).T.copy(), strict=True))


def draw_axis(row: Mapping[str, Any]) -> shapely.LineString:
    """Return the line of a row with such columns: of a curved wall its arc, in short chords."""
    ends_m = np.array([row[name] for name in _ENDS], float).reshape(2, 2)
    if not np.isfinite(row.get("arc_radius_m", np.nan)):
        return shapely.LineString(ends_m)
    return shapely.LineString(trace_arc(ends_m, np.array([row["arc_x_m"], row["arc_y_m"]])))


def shape_walls(walls: Columns, left_m: FloatArray, right_m: FloatArray) -> WallShapes:
    """Return the lines of walls, straight and curved, and how far their surfaces lie off."""
    centres_m = np.column_stack([walls[name] for name in schemas.ARC[:2]]).astype(float)
    return WallShapes(centrelines_m(walls), left_m, right_m, centres_m.reshape(-1, 2))


def _no_openings() -> Columns:
    return {name: np.empty(0) for name in schemas.OPENINGS.columns}


def _no_furniture() -> Columns:
    return {name: np.empty(0) for name in schemas.FURNITURE.columns}


@dataclass(frozen=True)
class GeoReference:
    """The rigid motion from the map frame to a system of the Earth.

    Attributes
    ----------
    crs : str
        Its name, such as EPSG:25832.
    east_m, north_m : float
        The map frame's origin in it.
    rotation_rad : float
        The direction of the map's x axis in it, counter-clockwise from east.
    residual_m : float
        Root of the mean square distance of the reference points after it.
    control_off_m, check_off_m : sequence of (str, float)
        Name and distance of each of them, and of each point that was not used for it.
    fits_mirrored : bool
        Whether a mirror image of the map would agree with all of them as well: then no residual
        shows exchanged axes.
    faults : sequence of str
        A line on each point that is off by more than chance.
    """

    crs: str
    east_m: float
    north_m: float
    rotation_rad: float
    residual_m: float
    control_off_m: Sequence[tuple[str, float]] = ()
    check_off_m: Sequence[tuple[str, float]] = ()
    fits_mirrored: bool = False
    faults: Sequence[str] = ()

    @property
    def check_rms_m(self) -> float:
        """Root of the mean square distance of the check points; NaN of none."""
        if not self.check_off_m:
            return float("nan")
        return float(np.sqrt(np.mean([off_m**2 for _, off_m in self.check_off_m])))


@dataclass(frozen=True)
class FloorPlan:
    """The tables of a plan, and what follows from them.

    Attributes
    ----------
    name : str
        The dataset's name.
    faces, walls, openings, rooms, free : dict of str to (n,) array
        The columns of `schemas.FACES`, `PLAN_WALLS`, `OPENINGS`, `ROOMS` and `FREE`; all but
        `faces` may have no rows, and openings that were not seen are in `unseen`.
    unseen : dict of str to (u,) array
        The rows of `schemas.OPENINGS` that are spans of rooms' outlines of which nothing is known.
    furniture : dict of str to (f,) array
        The columns of `schemas.FURNITURE`.
    assumed_thickness_m : float, > 0
        ASSUME of a wall that was seen from one side only, behind its face.
    assumed_height_m : float, > 0
        ASSUME of the storey, where neither its ceiling nor walls were seen in their height.
    floor_z_m, ceiling_z_m : float
        Heights in the map frame, NaN where not seen.
    georeference : GeoReference or None
        Where the plan lies on Earth, where a person said so.
    n_corrections : int
        How many corrections by hand are carried out in it, removals with them.
    unmatched_corrections : sequence of str
        Of each that is not, why.
    opened_by_hand : sequence of int
        Numbers of rooms that are open by corrections, and were closed before.
    corrected_by : str
        Who said so, and the day of the last; empty where that is not known.
    taped_m : sequence of (float, float, float)
        Of each taped length what is drawn, metres of the map, what was taped, and the standard
        deviation of both.
    scale : survey_scale.SurveyScale or None
        What these, and reference points, say of the survey's lengths.
    doubted : doubts.Doubts
        What speaks against all of the plan.
    nearly : sequence of plan_wall.Nearly
        What was nearly drawn.
    room_word : str
        What stands before the number of a room that nobody has named, in the receiver's language.
    """

    name: str
    faces: Columns = field(repr=False)
    walls: Columns = field(repr=False)
    openings: Columns = field(repr=False)
    rooms: Columns = field(repr=False)
    free: Columns = field(repr=False)
    unseen: Columns = field(repr=False, default_factory=_no_openings)
    furniture: Columns = field(repr=False, default_factory=_no_furniture)
    assumed_thickness_m: float = 0.1
    assumed_height_m: float = 2.5
    floor_z_m: float = np.nan
    ceiling_z_m: float = np.nan
    georeference: GeoReference | None = None
    n_corrections: int = 0
    unmatched_corrections: Sequence[str] = ()
    opened_by_hand: Sequence[int] = ()
    corrected_by: str = ""
    taped_m: Sequence[Sequence[float]] = ()
    scale: SurveyScale | None = None
    doubted: Doubts = NO_DOUBT
    nearly: Sequence[Nearly] = ()
    room_word: str = "Room"

    @property
    def mark(self) -> str:
        """What every sheet of it says of a recording that is damaged, or without rays."""
        damaged = "from a damaged recording" if self.doubted.damage else ""
        rayless = "made without rays" if self.doubted.rayless else ""
        return ", ".join(filter(None, [damaged, rayless]))

    @cached_property
    def thick(self) -> BoolArray:
        """Which walls (n,) have a known thickness."""
        return np.isfinite(self.walls["thickness_m"])

    @cached_property
    def is_seen_from_left(self) -> BoolArray:
        """Of which walls (n,) the left side is known, or neither is."""
        return np.asarray((self.walls["face_left"] >= 0) | (self.walls["face_right"] < 0), bool)

    @cached_property
    def sides_m(self) -> tuple[FloatArray, FloatArray]:
        """How far the surfaces of each wall lie from its line, (left (n,), right (n,)), metres.

        What is assumed behind a single face lies on the side that it was not seen from.
        """
        half_m = self.walls["thickness_m"] / 2
        behind_m = self.assumed_thickness_m
        left_m = np.where(self.is_seen_from_left, 0.0, behind_m)
        right_m = np.where(self.is_seen_from_left, behind_m, 0.0)
        return np.where(self.thick, half_m, left_m), np.where(self.thick, half_m, right_m)

    @cached_property
    def wall_shapes(self) -> WallShapes:
        """The lines of its walls, straight and curved, and how far their surfaces lie off."""
        return shape_walls(self.walls, *self.sides_m)

    @cached_property
    def axes(self) -> Array:
        """The line of each wall, (n,) LineStrings: of a curved one as `arcs.trace_arc` draws it."""
        return self.wall_shapes.draw_axes()

    @cached_property
    def lengths_m(self) -> FloatArray:
        """How long each wall is along its line, (n,)."""
        return self.wall_shapes.measure_lengths_m()

    @cached_property
    def circles_m(self) -> FloatArray:
        """The circles (k, 3) of curved walls' lines and sides: x and y of centre, radius."""
        left_m, right_m = self.sides_m
        radius_m = self.walls["arc_radius_m"].astype(float)
        radii_m = [radius_m + m for m in (0.0, left_m, -left_m, right_m, -right_m)]
        circles = [np.column_stack([self.wall_shapes.centres_m, of_m]) for of_m in radii_m]
        known = np.concatenate(circles)
        return np.unique(known[np.isfinite(known).all(axis=1)], axis=0)

    @cached_property
    def bodies(self) -> Array:
        """The footprint of each wall, (n,) Polygons, openings not cut out.

        Of a regular plan, what may be furniture cuts no corner off a wall.
        """
        bodies = self.wall_shapes.draw_footprints()
        sure = ~np.asarray(self.walls.get("perhaps", np.zeros(len(bodies))), bool)
        if not sure.all():
            bodies[sure] = self.wall_shapes.take(sure).draw_footprints()
        return bodies

    @cached_property
    def _surfaces(self) -> Array:
        """The side of each wall that was seen, (n,), less what runs on beyond its corners."""
        left, right = self.wall_shapes.cut_sides()
        return np.where(self.walls["face_left"] >= 0, left, right)

    @cached_property
    def known_bodies(self) -> Array:
        """Likewise of the walls of known thickness, none of them mitred with an assumed one."""
        return self.wall_shapes.take(self.thick).draw_footprints()

    @cached_property
    def reveals(self) -> BoolArray:
        """Which faces (k,) are across the straight wall that they are of."""
        return find_reveals(self.walls, self.faces)

    @cached_property
    def revealed(self) -> BoolArray:
        """Which walls (n,) of one side are as thick as reveals are deep: nobody said another."""
        is_single = (self.walls["face_left"] >= 0) != (self.walls["face_right"] >= 0)
        of_reveals = np.isin(self.walls["wall"], self.faces["wall"][self.reveals])
        return self.thick & is_single & of_reveals & ~find_stated(self.walls)

    @cached_property
    def face_hosts(self) -> IntArray:
        """The row of the wall that each face is of, (k,); -1 if it is of none."""
        return find_hosts(self.walls, self.faces)

    @cached_property
    def hosts(self) -> IntArray:
        """The row of the wall that each opening is in, (m,); -1 if it is in none."""
        return find_hosts(self.walls, self.openings)

    @cached_property
    def partings(self) -> BoolArray:
        """Which openings (m,) are passages between two rooms in no wall: nothing stands there."""
        is_bare = np.asarray(self.openings["type"] == "passage", bool)
        return is_bare & (self.hosts < 0) & (self.openings["room_b"] >= 0)

    @cached_property
    def gaps(self) -> Array:
        """What each opening cuts out of the walls, (m,) Polygons a little deeper than its wall."""
        thickness_m = np.nan_to_num(self.openings["thickness_m"], nan=self.assumed_thickness_m)
        # one more for the openings that are in no wall
        walls_m = np.append(np.maximum(*self.sides_m), 0.0)
        half_m = np.maximum(thickness_m / 2, walls_m[self.hosts]) + _CLEARANCE_M
        # a curved wall bows beside the line from jamb to jamb
        radius_m = np.append(self.walls["arc_radius_m"].astype(float), np.nan)[self.hosts]
        chord_m = np.hypot(*np.diff(centrelines_m(self.openings), axis=1)[:, 0].T)
        bow_m = radius_m - np.sqrt(np.maximum(radius_m**2 - (chord_m / 2) ** 2, 0.0))
        half_m = half_m + np.nan_to_num(bow_m)
        return buffer_lines(centrelines_m(self.openings), half_m)

    @cached_property
    def all_gaps(self) -> BaseGeometry:
        """What all of them cut out together."""
        return overlays.unite_areas(self.gaps)

    def solid(self, state: str) -> BaseGeometry:
        """Return the footprint of the walls of one state and known thickness, less openings."""
        bodies = self.known_bodies[self.walls["state"][self.thick] == state]
        merged = overlays.unite_areas(bodies, grid=_GRID_M)
        return overlays.subtract_areas(merged, self.all_gaps, grid=_GRID_M)

    def single(self, state: str) -> Array:
        """Return the surfaces of one state with nothing known behind them, less openings.

        Returns
        -------
        (k,) object
            LineStrings.
        """
        # a face that is a side of a wall is drawn with it
        is_loose = (self.faces["wall"] < 0) & (self.faces["state"] == state)
        is_one_sided = ~self.thick & (self.walls["state"] == state)
        faces = line_shapes(centrelines_m(self.faces)[is_loose])
        lines = np.concatenate([self._surfaces[is_one_sided], faces])
        parts = shapely.get_parts(overlays.subtract_lines(lines, self._hides_lines))
        return parts[shapely.length(parts) > 0]

    @cached_property
    def _hides_lines(self) -> BaseGeometry:
        # lines end at the surfaces of the walls that they meet
        return overlays.unite_areas(
            [*self.gaps, *overlays.buffer_shapes(self.known_bodies, _GRID_M, quad_segs=8)]
        )

    @cached_property
    def assumed(self) -> BaseGeometry:
        """The footprint of what is assumed behind walls seen from one side, less openings.

        Rooms and the walls of known thickness are left out of it, but for what these have in
        corners with assumed ones.
        """
        if self.thick.all():
            return shapely.Polygon()
        bodies = overlays.unite_areas(self.bodies, grid=_GRID_M)
        others = overlays.unite_areas([*self.gaps, *self.known_bodies, *self.areas])
        return overlays.subtract_areas(bodies, others, grid=_GRID_M)

    @cached_property
    def main_direction_deg(self) -> float:
        """Direction of the wall that most length of walls is nearest to along or across.

        In the map frame, at most 45 degrees from its x axis.
        """
        columns = self.walls if len(self.walls["wall"]) else self.faces
        directions = np.diff(centrelines_m(columns), axis=1)[:, 0] @ np.array([1, 1j])
        angles = np.angle(directions)
        off = np.abs(np.sin(2 * (angles[:, None] - angles)))
        best = float(np.degrees(angles[np.argmin(off @ np.abs(directions))]))
        return best - 90 * round(best / 90)

    @cached_property
    def storey_m(self) -> tuple[float, float]:
        """Height of the floor in the map frame and of the ceiling above it, metres.

        Where the floor was not seen, the lowest that was seen of the walls stands for it; a ceiling
        that was not seen is where it is assumed, or higher if walls were seen higher: they do not
        end above it.
        """
        floor_m, highest_m = self._walls_z_m
        heights_m = {
            "ceiling": self.ceiling_z_m - floor_m,
            "walls": highest_m,
            "assumed": self.assumed_height_m,
        }
        return floor_m, float(heights_m[self.height_from])

    @cached_property
    def height_from(self) -> str:
        """What the height of the storey follows from: a key of `HEIGHTS`."""
        floor_m, highest_m = self._walls_z_m
        if self.ceiling_z_m - floor_m > levels.SEARCH_M:
            return "ceiling"
        return "walls" if highest_m > self.assumed_height_m else "assumed"

    @cached_property
    def least_height_m(self) -> float:
        """How high above the floor its ceiling or else its walls were seen; NaN of planar scans."""
        _, highest_m = self._walls_z_m
        seen_m = self.storey_m[1] if self.height_from == "ceiling" else highest_m
        return seen_m if seen_m > levels.SEARCH_M else np.nan

    @cached_property
    def _walls_z_m(self) -> tuple[float, float]:
        """Height of the floor in the map frame, and how high above it walls were seen."""
        is_seen = np.isfinite(self.floor_z_m)
        floor_m = self.floor_z_m if is_seen else _extreme(self.walls["z_min_m"], np.fmin)
        return floor_m, _extreme(self.walls["z_max_m"], np.fmax) - floor_m

    @cached_property
    def low(self) -> BoolArray:
        """Which walls (n,) were seen to end below the ceiling."""
        floor_m, height_m = self.storey_m
        top_m = self.walls["top_m"] - floor_m
        return (top_m > 0) & (top_m < height_m)

    @cached_property
    def heights_m(self) -> FloatArray:
        """How high each wall is above the floor (n,): to the ceiling, or to its top below it."""
        floor_m, height_m = self.storey_m
        return np.where(self.low, self.walls["top_m"] - floor_m, height_m)

    @cached_property
    def bounds_m(self) -> tuple[FloatArray, FloatArray]:
        """The least and the greatest x and y of all shapes, rooms with them, ((2,), (2,))."""
        faces = line_shapes(centrelines_m(self.faces))
        return _bounds(np.concatenate([faces, self.known_bodies, self.areas]))

    @cached_property
    def extent_m(self) -> tuple[FloatArray, FloatArray]:
        """Likewise of walls and openings as drawn: what a dimension line measures."""
        shapes: list[BaseGeometry] = [*line_shapes(centrelines_m(self.openings))]
        for state in STATES:
            shapes += [self.solid(state), *self.single(state)]
        is_anything_drawn = any(not shape.is_empty for shape in shapes)
        return _bounds(shapes) if is_anything_drawn else self.bounds_m

    @cached_property
    def areas(self) -> Array:
        """The rooms' polygons, (r,)."""
        return shapely.from_wkb(np.asarray(self.rooms["geometry"], object))

    @cached_property
    def net_areas_m2(self) -> FloatArray:
        """How much floor each room has, (r,): between walls, less what columns stand on."""
        areas_m2 = np.asarray(self.rooms["area_m2"], float)
        pieces = shapely.from_wkb(np.asarray(self.furniture["geometry"], object))
        is_column = np.asarray(self.furniture["kind"]) == schemas.COLUMN
        if not is_column.any() or not len(areas_m2):
            return areas_m2
        columns = overlays.unite_areas(pieces[is_column])
        return areas_m2 - shapely.area(overlays.intersect_areas(self.areas, columns))

    @cached_property
    def hidden_floor(self) -> Array:
        """Floor of rooms that no chosen scan saw, nor furniture on it, (k,) Polygons.

        What is narrow, as shadows of legs and feet of walls are, is left out; nothing where no
        floor is known to be seen.
        """
        return self._leave_unseen(self.areas)

    @cached_property
    def enclosed_ground(self) -> Array:
        """Ground of no room, likewise unseen, (k,).

        What rooms and walls enclose on all sides, and narrow ground beside rooms: before a wall,
        between two of them, in a notch of one.
        """
        built = overlays.unite_areas([*self.areas, *self.bodies], grid=_GRID_M)
        closed = close_gaps(built)
        holes = [shapely.Polygon(r) for part in shapely.get_parts(closed) for r in part.interiors]
        enclosed = overlays.subtract_areas(np.array(holes, object), built, grid=_GRID_M)
        gaps = shapely.get_parts(overlays.subtract_areas(closed, built, grid=_GRID_M))
        rooms = overlays.unite_areas(self.areas)
        beside = gaps[shapely.dwithin(gaps, rooms, _GRID_M)]
        return self._leave_unseen(np.concatenate([enclosed, beside]))

    def _leave_unseen(self, grounds: Array) -> Array:
        """Return what no chosen scan saw of grounds, nor furniture on it, (k,) Polygons."""
        shown, pieces = (
            shapely.from_wkb(np.asarray(columns["geometry"], object))
            for columns in (self.free, self.furniture)
        )
        if len(shown) == 0:
            return np.empty(0, object)
        known = overlays.unite_areas([*shown, *pieces], grid=_GRID_M)
        hidden = overlays.subtract_areas(grounds, known, grid=_GRID_M)
        parts = [part for ground in hidden for part in free_space.open_polygons(ground, END_M)]
        return np.array(parts, object)

    @cached_property
    def room_numbers(self) -> list[str]:
        """What number each room has, (r,): the one given by hand, or that of its row's key."""
        own = self.rooms["room"].tolist()
        given = self.rooms.get("number", np.full(len(own), "", object))
        return [str(number or n) for number, n in zip(given, own, strict=True)]

    @cached_property
    def room_names(self) -> list[str]:
        """What each room is called, (r,): the name given by hand, or its number."""
        given = self.rooms.get("name", np.full(len(self.room_numbers), "", object))
        named = zip(given, self.room_numbers, strict=True)
        return [name or f"{self.room_word} {number}" for name, number in named]

    @cached_property
    def room_labels(self) -> list[str]:
        """What each room is told by, (r,): its name, behind the number that somebody gave it."""
        given = self.rooms.get("number", np.full(len(self.room_names), "", object))
        named = zip(given, self.rooms.get("name", given), self.room_names, strict=True)
        return [f"{number} {name}" if number and own else name for number, own, name in named]

    @cached_property
    def label_widths_m(self) -> FloatArray:
        """How wide each room's label may be, (r,): across the circle that has room around it."""
        places = shapely.points(self.rooms["x_m"], self.rooms["y_m"])
        return 2 * shapely.distance(places, shapely.boundary(self.areas))


def make_floorplan(
    parts: Mapping[str, Columns],
    floor_z_m: float,
    ceiling_z_m: float,
    name: str = "",
    **known: Any,
) -> FloorPlan:
    """Return a plan of its tables, columns by name; what was not seen is no opening of it.

    `known` are further attributes of `FloorPlan`.
    """
    openings = parts["openings"]
    is_unseen = openings["type"] == UNSEEN
    return FloorPlan(
        name=name,
        faces=parts["faces"],
        walls=parts["walls"],
        openings={column: values[~is_unseen] for column, values in openings.items()},
        unseen={column: values[is_unseen] for column, values in openings.items()},
        rooms=parts["rooms"],
        free=parts["free"],
        floor_z_m=floor_z_m,
        ceiling_z_m=ceiling_z_m,
        **known,
    )


def summarise_floorplan(plan: FloorPlan, drawn: Sequence[str] | None = None) -> str:
    """Return how many walls, openings of each type and rooms a plan has, in words.

    Without walls it is how many faces of such. Partings are no openings. Types of openings may be
    given as they are drawn.
    """
    types = plan.openings["type"][~plan.partings].tolist() if drawn is None else drawn
    counts = {"wall": len(plan.walls["wall"])}
    counts["wall face"] = 0 if counts["wall"] else len(plan.faces["face"])
    for kind, noun in OPENINGS.items():
        counts[noun] = types.count(kind)
    counts["room"] = len(plan.rooms["room"])
    return ", ".join(say_count(n, noun) for noun, n in counts.items() if n)


def say_count(n: int, noun: str) -> str:
    """Return how many there are of what a noun names: `1 wall`, `2 walls`."""
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"


def line_shapes(lines_m: FloatArray) -> Array:
    """Return LineStrings (n,) of lines (n, 2, 2)."""
    return np.asarray(shapely.linestrings(lines_m), object)


def buffer_lines(lines: FloatArray, half_m: FloatArray) -> Array:
    """Return rectangles (n,) along lines (n, 2, 2), `half_m` (n,) to each side."""
    if len(lines) == 0:
        return np.array([], object)
    return overlays.buffer_shapes(line_shapes(lines), half_m, cap_style="flat")


def close_gaps(built: BaseGeometry) -> BaseGeometry:
    """Return what is built with gaps closed that ends of walls leave, which err on both sides."""
    grown = overlays.buffer_shapes(built, 2 * END_M, join_style="mitre")
    closed = overlays.buffer_shapes(grown, -2 * END_M, join_style="mitre")
    # GEOS loses areas now and then that it shrinks by mitred edges
    return closed if closed.area >= built.area else built


def _bounds(shapes: Iterable[BaseGeometry]) -> tuple[FloatArray, FloatArray]:
    x0, y0, x1, y1 = shapely.total_bounds(np.array(list(shapes), object))
    return np.array([x0, y0]), np.array([x1, y1])


def _extreme(values: FloatArray, choose: np.ufunc) -> float:
    """Return the least or greatest of values, NaN left out; 0 of none."""
    extreme = choose.reduce(values, initial=np.nan)
    return float(extreme) if np.isfinite(extreme) else 0.0
