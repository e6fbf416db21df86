"""Rays of an earlier survey that a later one has overtaken: they met, or crossed, what changed."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely
import shapely.affinity
from shapely.geometry.base import BaseGeometry

from scanplan.changes.comparison import Comparison
from scanplan.changes.ray_cells import AT_M
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import MOVED, Change
from scanplan.geometry import overlays
from scanplan.types import BoolArray, FloatArray

_THICK_M = 0.1  # half of a wall's thickness, where only one of its sides was seen


@dataclass(frozen=True, eq=False)
class StalePlaces:
    """Where a floor has changed, in the frame of the earlier survey.

    Attributes
    ----------
    built : shapely geometry
        Around walls, openings and columns, as high as the storey.
    stood : shapely geometry
        Around furniture.
    top_m : float
        Above the floor, the top of the highest of it: rays higher up have passed over it.
    """

    built: BaseGeometry
    stood: BaseGeometry
    top_m: float

    def find_rays(self, sensor_m: FloatArray, ends_m: FloatArray, *, planar: bool) -> BoolArray:
        """Return which rays (n,) meet or cross what changed.

        Parameters
        ----------
        sensor_m : (3,) float
            Height above the floor.
        ends_m : (n, 3) float
            Likewise.
        planar : bool
            Whether heights mean nothing.
        """
        found = _cross(self.built, sensor_m, ends_m)
        is_low = np.full(len(ends_m), planar)
        is_low |= np.minimum(ends_m[:, 2], sensor_m[2]) <= self.top_m
        low = np.flatnonzero(is_low & ~found)
        found[low] = _cross(self.stood, sensor_m, ends_m[low])
        return found


def find_stale_places(compared: Comparison) -> StalePlaces:
    """Return where the likely changes of a comparison were, and are; doors that swung are none."""
    likely = [change for change in compared.changes if change.is_change and change.table != "room"]
    built = [
        overlays.buffer_shapes(shape, AT_M + _half_m(change, compared))
        for change in likely
        for shape in _list_places(change)
        if change.table != "furniture"
    ]
    stood = [
        overlays.buffer_shapes(shape, AT_M)
        for change in likely
        for shape in _list_places(change)
        if change.table == "furniture"
    ]
    tops_m = [_top_m(survey) for survey in (compared.a, compared.b)]
    return StalePlaces(overlays.unite_areas(built), overlays.unite_areas(stood), max(tops_m))


def _list_places(change: Change) -> Iterator[BaseGeometry]:
    yield change.shape
    if change.verdict == MOVED:
        yield shapely.affinity.translate(change.shape, *change.moved_m)


def _half_m(change: Change, compared: Comparison) -> float:
    """Return half of the thickness of the wall that a change is of, or in."""
    is_of_a = change.number_a >= 0
    plan = compared.a.plan if is_of_a else compared.b.plan
    number = change.number_a if is_of_a else change.number_b
    if change.table == "opening":
        number = int(plan.openings["wall"][plan.openings["opening"] == number][0])
    rows = np.flatnonzero(plan.walls["wall"] == number)
    if change.table == "column" or not len(rows):
        return 0.0
    thickness_m = float(plan.walls["thickness_m"][rows[0]])
    return thickness_m / 2 if np.isfinite(thickness_m) else _THICK_M


def _top_m(survey: Survey) -> float:
    """Return the top of the highest piece of furniture, above the floor; infinite of unknown ones.

    A plan without furniture has none.
    """
    tops_m = np.asarray(survey.plan.furniture["z_max_m"], float)
    if not len(tops_m):
        return 0.0
    floor_m = survey.plan.floor_z_m if np.isfinite(survey.plan.floor_z_m) else 0.0
    return float(np.nan_to_num(tops_m - floor_m, nan=np.inf).max())


def _cross(places: BaseGeometry, sensor_m: FloatArray, ends_m: FloatArray) -> BoolArray:
    """Return which straight ways (n,) from a sensor to where rays end touch places."""
    found = np.zeros(len(ends_m), bool)
    if places.is_empty:
        return found
    low, high = (pick(ends_m[:, :2], sensor_m[:2]) for pick in (np.minimum, np.maximum))
    x0, y0, x1, y1 = places.bounds
    near = np.flatnonzero(
        (low[:, 0] <= x1) & (high[:, 0] >= x0) & (low[:, 1] <= y1) & (high[:, 1] >= y0)
    )
    begins = np.broadcast_to(sensor_m[:2], (len(near), 2))
    sights = shapely.linestrings(np.stack([begins, ends_m[near, :2]], axis=1))
    shapely.prepare(places)
    found[near] = shapely.intersects(places, sights)
    return found
