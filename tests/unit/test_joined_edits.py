"""What becomes of the pieces of a wall that was edited as one: three of 4, 2 and 4 m in a line."""

import numpy as np
import pytest

from scanplan.edited.elements import Element
from scanplan.edited.entries import move_pieces

WALL = Element("wall", "3", np.array([[0.0, 0.0], [10.0, 0.0]]))
# as measured, the first begins later than it is drawn; the second runs the other way
PIECES = np.array([[[0.15, 0], [4, 0]], [[6, 0], [4, 0]], [[6, 0], [10, 0]]], float)


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ([(-1, 0), (10, 0)], [(-0.85, 4), (6, 4), (6, 10)]),
        ([(0, 0), (7, 0)], [(0.15, 4), (6, 4), (6, 7)]),
        # the last is gone, and the end lies in the one before it
        ([(0, 0), (5, 0)], [(0.15, 4), (5, 4), None]),
        ([(0.2, 0), (10.2, 0)], [(0.35, 4), (6, 4), (6, 10.2)]),
        # drawn the other way
        ([(7, 0), (0, 0)], [(0.15, 4), (6, 4), (6, 7)]),
    ],
    ids=["longer", "shorter", "by two pieces", "along itself", "turned round"],
)
def test_ends_go_along_the_wall_and_the_rest_stays(line, expected):
    moved = move_pieces(WALL, np.array(line, float), PIECES)
    found = [None if of is None else tuple(of[:, 0].round(6).tolist()) for of in moved]
    assert found == expected
    assert all(of is None or not of[:, 1].any() for of in moved)


def test_all_pieces_go_across_with_their_wall():
    moved = move_pieces(WALL, np.array([[0, 0.1], [10, 0.2]]), PIECES)
    np.testing.assert_allclose(moved[1], [[6, 0.16], [4, 0.14]])
