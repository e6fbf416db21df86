"""Sets of scans' polygons for tests of selection."""

from itertools import combinations

import numpy as np
import shapely
from hypothesis import strategies as st
from hypothesis.strategies import composite
from shapely import box


@composite
def hull_sets(draw, max_size=9):
    """Sets of polygons of every awkward kind.

    Boxes on a grid, convex, several parts, again, nested, empty.
    """
    chosen = []
    for kind in draw(st.lists(st.sampled_from("bbbcccmrns0"), min_size=1, max_size=max_size)):
        if kind == "b":
            x, y, w, h = draw(st.tuples(*[st.integers(0, 6)] * 2, *[st.integers(1, 4)] * 2))
            chosen.append(box(x, y, x + w, y + h))
        elif kind == "c":
            corners = draw(
                st.lists(st.tuples(*[st.floats(0, 8, width=32)] * 2), min_size=3, max_size=8)
            )
            chosen.append(shapely.MultiPoint(corners).convex_hull)
        elif kind == "m":
            x = draw(st.integers(0, 5))
            chosen.append(box(x, 0, x + 1, 3) | box(x + 2, 1, x + 3, 5))
        elif kind == "s":
            chosen.append(
                shapely.Point(draw(st.floats(0, 8, width=32)), 3).buffer(1.5, quad_segs=4)
            )
        elif kind == "0" or not chosen:
            chosen.append(shapely.Polygon())
        else:
            earlier = draw(st.sampled_from(chosen))
            chosen.append(earlier if kind == "r" else shapely.affinity.scale(earlier, 0.5, 0.5))
    return chosen


def scattered(n, seed=0):
    """Long thin hulls along a 60 m walk, three to a scan."""
    rng = np.random.default_rng(seed)
    centre = np.column_stack([np.linspace(0, 60, n), rng.normal(0, 0.5, n)])
    return [
        shapely.union_all(
            [shapely.MultiPoint(rng.normal(c, (2, 0.8), (12, 2))).convex_hull for _ in range(3)]
        )
        for c in centre
    ]


def best_by_trying_all(polygons):
    """Largest area that 1, 2, ... of a few polygons cover."""
    n = len(polygons)
    return [
        max(
            shapely.union_all([polygons[i] for i in subset]).area
            for subset in combinations(range(n), k)
        )
        for k in range(1, n + 1)
    ]
