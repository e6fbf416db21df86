"""A floor plan as one thing: its tables, and the shapes that drawings and models make of them."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import shapely

from scanplan.plan import wall_footprints

STATES = ("observed", "inferred")
HEIGHTS = {"ceiling": "ceiling", "walls": "highest seen of all walls", "assumed": "assumed"}
OPENINGS = ("door", "window", "passage")
_ENDS = ("x0_m", "y0_m", "x1_m", "y1_m")
_CLEARANCE_M = 0.02
_GRID_M = 1e-4
_FLAT_M = 0.5


def centrelines_m(columns):
    """Return the lines (n, 2, 2) float64 of a table with the columns x0_m, y0_m, x1_m, y1_m."""
    return np.column_stack([columns[c] for c in _ENDS]).astype(float).reshape(-1, 2, 2)


@dataclass(frozen=True)
class FloorPlan:
    """The tables of a plan, and what follows from them.

    Attributes
    ----------
    name : str
        The dataset's name.
    faces, walls, openings, rooms, free : dict of str to (n,) array
        The columns of `schemas.FACES`, `PLAN_WALLS`, `OPENINGS`, `ROOMS` and `FREE`; all but `faces` may have no rows.
    assumed_thickness_m : float, > 0
        ASSUME of a wall that was seen from one side only, behind its face.
    assumed_height_m : float, > 0
        ASSUME of the storey, where neither its ceiling nor walls were seen in their height.
    floor_z_m, ceiling_z_m : float
        Heights in the map frame, NaN where not seen.
    """

    name: str
    faces: dict = field(repr=False)
    walls: dict = field(repr=False)
    openings: dict = field(repr=False)
    rooms: dict = field(repr=False)
    free: dict = field(repr=False)
    assumed_thickness_m: float = 0.1
    assumed_height_m: float = 2.5
    floor_z_m: float = np.nan
    ceiling_z_m: float = np.nan

    @cached_property
    def thick(self):
        """Which walls (n,) have a known thickness."""
        return np.isfinite(self.walls["thickness_m"])

    @cached_property
    def sides_m(self):
        """How far the surfaces of each wall lie from its line, (left (n,), right (n,)), metres.

        What is assumed behind a single face lies on the side that it was not seen from.
        """
        half_m = self.walls["thickness_m"] / 2
        seen_from_left = np.where(self.walls["face_left"] >= 0, True, self.walls["face_right"] < 0)
        behind_m = self.assumed_thickness_m
        left_m = np.where(self.thick, half_m, np.where(seen_from_left, 0.0, behind_m))
        return left_m, np.where(self.thick, half_m, np.where(seen_from_left, behind_m, 0.0))

    @cached_property
    def bodies(self):
        """The ground that each wall stands on, (n,) Polygons, openings not cut out."""
        return wall_footprints.draw_footprints(centrelines_m(self.walls), *self.sides_m)

    @cached_property
    def known(self):
        """Likewise of the walls of known thickness, none of them mitred with an assumed one."""
        return wall_footprints.draw_footprints(
            centrelines_m(self.walls)[self.thick], *(side[self.thick] for side in self.sides_m)
        )

    @cached_property
    def hosts(self):
        """The row of the wall that each opening is in, (m,); -1 if it is in none."""
        row = {wall: i for i, wall in enumerate(self.walls["wall"].tolist())}
        return np.array([row.get(wall, -1) for wall in self.openings["wall"].tolist()], np.int64)

    @cached_property
    def gaps(self):
        """What each opening cuts out of the walls, (m,) Polygons a little deeper than its wall."""
        deep_m = np.nan_to_num(self.openings["thickness_m"], nan=self.assumed_thickness_m) / 2
        # one more for the openings that are in no wall
        walls_m = np.append(np.maximum(*self.sides_m), 0.0)
        return buffer_lines(
            centrelines_m(self.openings), np.maximum(deep_m, walls_m[self.hosts]) + _CLEARANCE_M
        )

    def solid(self, state):
        """Return the ground of the walls of one state whose thickness is known, merged, openings cut out."""
        chosen = self.known[self.walls["state"][self.thick] == state]
        merged = shapely.union_all(chosen, grid_size=_GRID_M)
        return shapely.difference(merged, shapely.union_all(self.gaps), grid_size=_GRID_M)

    def single(self, state):
        """Return the surfaces of one state with nothing known behind them, (k,) lines, openings cut out."""
        # a face that is a side of a wall is drawn with it
        loose = (self.faces["wall"] < 0) & (self.faces["state"] == state)
        one_sided = ~self.thick & (self.walls["state"] == state)
        lines = shapely.linestrings(
            np.concatenate([centrelines_m(self.walls)[one_sided], centrelines_m(self.faces)[loose]])
        )
        # they end at the surfaces of the walls that they meet
        hidden = shapely.union_all([*self.gaps, *shapely.buffer(self.known, _GRID_M)])
        parts = shapely.get_parts(shapely.difference(lines, hidden))
        return parts[shapely.length(parts) > 0]

    @cached_property
    def storey_m(self):
        """Height of the floor in the map frame and of the ceiling above it, metres.

        Where the floor was not seen, the lowest that was seen of the walls stands for it; a ceiling that was not seen
        is where it is assumed, or higher if walls were seen higher: they do not end above it.
        """
        floor_m, seen_m = self._walls_z_m
        heights_m = {
            "ceiling": self.ceiling_z_m - floor_m,
            "walls": seen_m,
            "assumed": self.assumed_height_m,
        }
        return floor_m, float(heights_m[self.height_from])

    @cached_property
    def height_from(self):
        """What tells the height of the storey: its `ceiling`, its highest `walls`, or neither: `assumed`."""
        floor_m, seen_m = self._walls_z_m
        if self.ceiling_z_m - floor_m > _FLAT_M:
            return "ceiling"
        return "walls" if seen_m > self.assumed_height_m else "assumed"

    @cached_property
    def _walls_z_m(self):
        """Height of the floor in the map frame, and how high above it walls were seen."""
        floor_m = (
            self.floor_z_m
            if np.isfinite(self.floor_z_m)
            else _extreme(self.walls["z_min_m"], np.fmin)
        )
        return floor_m, _extreme(self.walls["z_max_m"], np.fmax) - floor_m

    @cached_property
    def low(self):
        """Which walls (n,) were seen to end below the ceiling."""
        floor_m, height_m = self.storey_m
        top_m = self.walls["top_m"] - floor_m
        return (top_m > 0) & (top_m < height_m)

    @cached_property
    def heights_m(self):
        """How high each wall is above the floor (n,): up to the ceiling, or to where it was seen to end below it."""
        floor_m, height_m = self.storey_m
        return np.where(self.low, self.walls["top_m"] - floor_m, height_m)

    @cached_property
    def bounds_m(self):
        """The least and the greatest x and y of all that is known, rooms with it, ((2,), (2,))."""
        return _bounds([*shapely.linestrings(centrelines_m(self.faces)), *self.known, *self.areas])

    @cached_property
    def extent_m(self):
        """Likewise of what is drawn of walls and openings: what a dimension line measures."""
        walls = [part for state in STATES for part in (self.solid(state), *self.single(state))]
        drawn = [*walls, *shapely.linestrings(centrelines_m(self.openings))]
        return _bounds(drawn) if any(not part.is_empty for part in drawn) else self.bounds_m

    @cached_property
    def areas(self):
        """The rooms' polygons, (r,)."""
        return shapely.from_wkb(np.asarray(self.rooms["geometry"], object))

    @cached_property
    def label_widths_m(self):
        """How wide a label may be where each room's label goes, (r,): across the circle that has room there."""
        places = shapely.points(self.rooms["x_m"], self.rooms["y_m"])
        return 2 * shapely.distance(places, shapely.boundary(self.areas))


def summarise_floorplan(plan):
    """Return what a plan holds, in words."""
    counts = [(len(plan.walls["wall"]), "wall"), (len(plan.faces["face"]), "wall face")]
    counts += [(int((plan.openings["type"] == kind).sum()), kind) for kind in OPENINGS]
    counts += [(len(plan.rooms["room"]), "room")]
    return ", ".join(f"{n} {what}{'s' if n != 1 else ''}" for n, what in counts if n)


def buffer_lines(lines, half_m):
    """Return rectangles (n,) along lines (n, 2, 2), `half_m` (n,) to each side."""
    return (
        shapely.buffer(shapely.linestrings(lines), half_m, cap_style="flat")
        if len(lines)
        else np.array([], object)
    )


def _bounds(shapes):
    x0, y0, x1, y1 = shapely.total_bounds(np.array(shapes, object))
    return np.array([x0, y0]), np.array([x1, y1])


def _extreme(values, choose):
    """Return the least or greatest of values, NaN left out; 0 of none."""
    found = choose.reduce(values, initial=np.nan)
    return float(found) if np.isfinite(found) else 0.0
