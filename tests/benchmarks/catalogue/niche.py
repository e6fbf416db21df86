"""Niches: stretches where a wall is thinner and set back."""

import numpy as np
from shapely import LineString, Point

from .facade import opening_line, openings
from .plan import Plan, Wall, Xy

_OUT = {"n": (0.0, 1.0), "s": (0.0, -1.0), "e": (1.0, 0.0), "w": (-1.0, 0.0)}
_LAP_M = 0.03


def cut_niche(plan: Plan, a: Xy, b: Xy, *, side: str, depth_m: float = 0.25) -> bool:
    """Cut a niche into one side of a wall that is drawn, between two places on its centreline.

    The wall becomes up to three: before, in the niche, and behind. Openings must not be there.

    Parameters
    ----------
    plan : Plan
    a, b : (x, y)
        The lesser first.
    side : {"s", "n", "w", "e"}
        Which side the niche opens to.
    depth_m : float
        What is left of the wall is at least 5 cm.

    Returns
    -------
    bool
        False where no straight wall of one thickness is there, or it is too thin.
    """
    span = LineString([a, b])
    for feature in plan.features:
        values = feature["properties"]
        if values["kind"] != "wall" or len(feature["geometry"]["coordinates"]) != 2:
            continue
        line = LineString(feature["geometry"]["coordinates"])
        is_on = line.distance(Point(a)) < 1e-3 and line.distance(Point(b)) < 1e-3
        is_even = "end_thickness_m" not in values and "material" not in values
        if not (is_on and is_even and values["thickness_m"] >= depth_m + 0.05):
            continue
        if any(span.distance(opening_line(o)) < 0.05 for o in openings(plan)):
            return False
        plan.features.remove(feature)
        plan.walls.remove(Wall(line, values["thickness_m"]))
        thickness_m = values["thickness_m"]
        ends = [(float(x), float(y)) for x, y in line.coords]
        for p, q in ((ends[0], a), (b, ends[1])):
            if Point(p).distance(Point(q)) > 1e-3:
                plan.wall(p, q, thickness_m)
        back = -depth_m / 2 * np.array(_OUT[side])
        # into what it stands between, so that no rounding opens a crack
        lap = _LAP_M * np.subtract(b, a) / span.length
        p, q = np.add(a, back) - lap, np.add(b, back) + lap
        ends_m = (float(p[0]), float(p[1])), (float(q[0]), float(q[1]))
        plan.wall(*ends_m, round(thickness_m - depth_m, 3))
        return True
    return False
