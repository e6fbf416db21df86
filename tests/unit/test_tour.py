"""Tours whose shortest is known."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.geometry import tour


def distances(xy):
    xy = np.array(xy, float)
    return np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1))


def test_places_on_a_line_are_visited_from_end_to_end():
    metres = distances([(3, 0), (0, 0), (7, 0), (1, 0)])
    assert tour.shortest_tour(metres, closed=False) == [1, 3, 0, 2]


def test_a_square_is_walked_round():
    found = tour.shortest_tour(distances([(0, 0), (1, 1), (1, 0), (0, 1)]), closed=True)
    assert tour.tour_length(
        found, distances([(0, 0), (1, 1), (1, 0), (0, 1)]), closed=True
    ) == pytest.approx(4)


def test_it_starts_where_it_must():
    assert tour.shortest_tour(distances([(3, 0), (0, 0), (7, 0)]), closed=False, first=0)[0] == 0
    assert tour.shortest_tour([[0.0]], closed=True) == [0]


@given(
    st.lists(st.tuples(st.integers(0, 30), st.integers(0, 30)), min_size=2, max_size=6),
    st.booleans(),
)
def test_it_visits_all_once_and_is_close_to_the_best(xy, closed):
    metres = distances(xy)
    found = tour.shortest_tour(metres, closed=closed)
    assert sorted(found) == list(range(len(xy)))
    best = min(tour.tour_length(p, metres, closed=closed) for p in permutations(range(len(xy))))
    assert tour.tour_length(found, metres, closed=closed) <= 1.25 * best + 1e-6


class AskedDistances:
    """Distances of which a share is known before they are asked for."""

    def __init__(self, metres, share):
        self.metres, self.least_m, self.asked = metres, metres * share, set()

    def __getitem__(self, pair):
        self.asked.add(frozenset(pair))
        return self.metres[pair]


@given(
    st.lists(st.tuples(st.integers(0, 30), st.integers(0, 30)), min_size=1, max_size=20),
    st.booleans(),
    st.floats(0, 1),
)
def test_distances_that_are_found_when_asked_for_make_the_same_tour(xy, closed, share):
    metres = distances(xy)
    asked = tour.shortest_tour(AskedDistances(metres, share), closed=closed, first=0)
    assert asked == tour.shortest_tour(metres, closed=closed, first=0)


def test_few_distances_are_asked_for():
    metres = distances(np.random.default_rng(1).uniform(0, 100, (100, 2)))
    asked = AskedDistances(metres, 0.8)
    tour.shortest_tour(asked, closed=False, first=0)
    assert len(asked.asked) < 600  # of 4,950


def test_places_that_cannot_be_reached_are_a_wrong_call():
    with pytest.raises(ValueError, match="finite"):
        tour.shortest_tour([[0, np.inf], [np.inf, 0]], closed=False)
