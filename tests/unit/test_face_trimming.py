import numpy as np
import pytest

from helpers import observation_making
from scanplan.plan.faces import trimming


def stretch(x0, y0, x1, y1, places=None, offsets=None):
    """Seen from the left of its way; with points at places along it, every 2 cm by default."""
    places = np.arange(0, np.hypot(x1 - x0, y1 - y0), 0.02) if places is None else np.array(places)
    offsets = 0 * places if offsets is None else offsets(places)
    points = np.column_stack([places, 0 * places, offsets])
    return observation_making.stretch(x0, y0, x1, y1, points)


def spans(found):
    return [(pytest.approx(s.low_m, abs=0.01), pytest.approx(s.high_m, abs=0.01)) for s in found]


def test_chords_end_where_they_cross():
    # both go on for 0.5 m beyond their crossing at x = 2, ever further from the points
    off = {"offsets": lambda p: np.maximum(p - 2, 0) * 0.2}
    back = {"offsets": lambda p: np.maximum(0.5 - p, 0) * 0.2}
    one = stretch(0, 0, 2.5, 0, **off)
    other = stretch(
        2 - 0.5 * np.cos(0.2), -0.5 * np.sin(0.2), 2 + 2 * np.cos(0.2), 2 * np.sin(0.2), **back
    )
    assert spans(trimming.trim_overshoots([one, other])) == [(0, 2), (0.5, 2.5)]


def test_a_stretch_that_goes_on_further_than_the_other_stays():
    one = stretch(0, 0, 4, 0, offsets=lambda p: np.maximum(p - 2, 0) * 0.2)
    other = stretch(
        2 - 0.5 * np.cos(0.2), -0.5 * np.sin(0.2), 2 + 0.5 * np.cos(0.2), 0.5 * np.sin(0.2)
    )
    assert spans(trimming.trim_overshoots([one, other]))[0] == (0, 4)


def test_steep_crossings_are_left_to_corners():
    found = trimming.trim_overshoots([stretch(0, 0, 4, 0), stretch(2, -1, 2, 1)])
    assert spans(found) == [(0, 4), (0, 2)]


def test_stray_points_behind_a_corner_are_cut_off():
    wall = stretch(3, 2, 3, -2)
    strays = [*np.arange(0, 3, 0.02), 3.5]
    found = trimming.trim_tails([stretch(0, 0, 3.5, 0, strays), wall], share=0.2)
    assert spans(found) == [(0, 3), (0, 4)]


def test_a_wall_that_goes_on_behind_another_stays():
    wall = stretch(3, 2, 3, -2)
    found = trimming.trim_tails([stretch(0, 0, 3.5, 0), wall], share=0.2)
    assert spans(found) == [(0, 3.5), (0, 4)]


def test_a_pier_beside_a_door_stays():
    # the wall that crosses stands 0.9 m before the pier, not on it
    pier = stretch(0.9, 0, 1.04, 0)
    assert spans(trimming.trim_tails([pier, stretch(0, 2, 0, -2)], share=0.2)) == [
        (0, 0.14),
        (0, 4),
    ]


def test_nothing():
    assert trimming.trim_overshoots([]) == trimming.trim_tails([], share=0.2) == []
