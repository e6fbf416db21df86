"""Ways between stops, held against searches over the whole grid."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from scanplan.geometry import roadmap
from scanplan.geometry.stop_ways import StopWays

# two rooms of 3 m by 3 m and a door of 0.8 m between them
ROOMS = shapely.union_all(
    [shapely.box(0, 0, 3, 3), shapely.box(3.2, 0, 6.2, 3), shapely.box(2.9, 2.1, 3.3, 2.9)]
)
GRID = roadmap.connected_grid(roadmap.make_grid(ROOMS, 0.1, 0.1))
CELLS = st.integers(0, len(GRID.xy_m) - 1)


@given(st.lists(CELLS, min_size=2, max_size=5), st.data())
def test_ways_and_their_costs_are_those_of_the_whole_grid(cells, data):
    ways = StopWays(GRID, np.array(cells))
    stops = st.integers(0, len(cells) - 1)
    for one, other in data.draw(st.lists(st.tuples(stops, stops), min_size=1, max_size=6)):
        costs, _ = roadmap.cheapest_ways(GRID, cells[one])
        cost = costs[cells[other]]
        assert ways[one, other] == pytest.approx(cost, abs=1e-9)
        assert ways.least_m[one, other] <= cost
        cells_between = ways.trace(one, other)
        assert cells_between.tolist()[:: len(cells_between) - 1 or 1] in (
            [cells[one], cells[other]],
            [cells[one]],
        )
        steps = GRID.steps + GRID.steps.T
        made = sum(steps[a, b] for a, b in pairwise(cells_between.tolist()))
        assert made == pytest.approx(cost, abs=1e-9)


def test_near_stops_are_found_without_looking_far():
    corridor = roadmap.make_grid(shapely.box(0, 0, 60, 1), 0.1, 0.1)
    cells = [roadmap.nearest_cell(corridor, (x_m, 0.5)) for x_m in (30.0, 31.0, 59.0)]
    ways = StopWays(corridor, np.array(cells))
    searched = []
    whole = ways._search
    ways._search = lambda *of_stop: searched.append(whole(*of_stop)) or searched[-1]
    assert 1 <= ways[0, 1] < 4
    assert sum(len(near) for near, _, _ in searched) < len(corridor.xy_m) / 5


def test_stops_that_no_way_joins_are_a_wrong_call():
    apart = roadmap.make_grid(
        shapely.MultiPolygon([shapely.box(0, 0, 1, 1), shapely.box(5, 0, 6, 1)]), 0.1, 0.1
    )
    cells = [roadmap.nearest_cell(apart, (x_m, 0.5)) for x_m in (0.5, 5.5)]
    with pytest.raises(ValueError, match="no way"):
        _ = StopWays(apart, np.array(cells))[0, 1]
