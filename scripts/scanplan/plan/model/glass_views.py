"""How much of a surface was seen through windows and panes: what is outside, or mirrored."""

from collections.abc import Sequence

import numpy as np
import shapely

from scanplan.plan.plan_wall import PlanWall
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import STRETCH_M
from scanplan.types import Array, FloatArray, IntArray

_MOST_RAYS = 300  # of a surface: a share is known to some percent by so many


def find_glass_shares(walls: Sequence[PlanWall], rays: RaySet) -> FloatArray:
    """Return the share (n,) of the rays to each wall that go through a window or pane of another.

    Rays that a pane mirrors end at what they show behind it.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
        With the kinds of their openings.
    rays : ray_set.RaySet
    """
    panes = [(number, pane) for number, wall in enumerate(walls) for pane in draw_panes(wall)]
    tree = shapely.STRtree([pane for _, pane in panes])
    owner = np.array([number for number, _ in panes], np.int64)
    shares = np.zeros(len(walls))
    for number, wall in enumerate(walls):
        sights = _draw_sights(wall, rays)
        if len(sights):
            sight, pane = tree.query(sights, predicate="intersects")
            shares[number] = len(np.unique(sight[owner[pane] != number])) / len(sights)
    return shares


def draw_panes(wall: PlanWall) -> list[shapely.LineString]:
    """Return the windows and panes of a wall."""
    through = [opening for opening in wall.openings if opening.kind in ("window", "glass")]
    return [
        shapely.LineString(wall.line.at(np.array([opening.low_m, opening.high_m])))
        for opening in through
    ]


def _draw_sights(wall: PlanWall, rays: RaySet) -> Array:
    """Return the ways (n,) of some rays, from the sensor to close before a wall's faces."""
    ends_m: list[FloatArray] = [np.empty((0, 2))]
    scans: list[IntArray] = [np.empty(0, np.int64)]
    for face in wall.members:
        ends_m.append(face.line.at(face.observation.occupied_m[face.points]))
        scans.append(face.observation.occupied_scan[face.points])
    end_m, scan = np.concatenate(ends_m), np.concatenate(scans)
    some = np.unique(np.linspace(0, len(end_m) - 1, min(_MOST_RAYS, len(end_m))).astype(np.int64))
    start_m = rays.sensors_m[scan[some], :2]
    way_m = end_m[some] - start_m
    length_m = np.hypot(*way_m.T)
    is_long = length_m > STRETCH_M
    # what stands close before a surface is a part of it
    before_m = start_m + way_m * (1 - STRETCH_M / np.maximum(length_m, STRETCH_M))[:, None]
    return np.asarray(shapely.linestrings(np.stack([start_m, before_m], axis=1)[is_long]))
