"""The weights of what parts rooms, fitted on a floor whose rooms are known."""

import random
import sys
from pathlib import Path

import numpy as np
from shapely import box

from scanplan.geometry.ground_cells import part_ground
from scanplan.lab.evaluation.scores.scene_file import object_array
from scanplan.plan.model import parting_odds

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))

import fit_partings

N_TERMS = len(parting_odds.WEIGHTS)
LINES = np.array([[(x, 0.0), (x, 4.0)] for x in (3, 6, 9)])
CELLS = part_ground(box(0, 0, 12, 4), LINES, 0.05)
ROOMS = object_array([box(0, 0, 6, 4), box(6, 0, 12, 4)])  # the middle line parts them
TERMS = np.zeros((3, N_TERMS))
TERMS[:, 0] = 1
TERMS[1, 1] = 1


def test_cells_are_of_the_room_that_most_of_them_lies_in():
    found = fit_partings.find_true_rooms(CELLS.cells, ROOMS)
    assert [(cell.centroid.x > 6) for cell in CELLS.cells] == found.astype(bool).tolist()
    half = fit_partings.find_true_rooms(CELLS.cells, ROOMS[:1])
    assert sorted(half.tolist()) == [-1, -1, 0, 0]


def test_pairs_of_one_room_are_told_from_pairs_of_two_and_the_weights_tell_them():
    visited = np.ones(4, bool)
    terms, is_apart = fit_partings.note_floor([TERMS], [(CELLS, visited)], ROOMS, random.Random(0))
    assert terms.shape[1] == N_TERMS + 2
    np.testing.assert_array_equal(is_apart, terms[:, 1] > 0.5)
    weights = fit_partings.fit(terms, is_apart)
    assert weights[1] > 0 > weights[0]
    assert len(weights) == N_TERMS + 2
