import numpy as np

from scanplan.extraction import runs
from scanplan.rays.face_raster import rasterise_rays

NOTHING = (np.empty(0), np.empty(0))
RASTER = rasterise_rays(NOTHING, NOTHING, NOTHING, span_m=(0.0, 4.95), column_m=0.1)
FOUND = np.array([(0.5, 1.0), (2.5, 3.0)])


def grown(found, where_m, *, opened=()):
    is_open = np.isin(np.arange(len(RASTER)), opened)
    return runs.grow_runs(found, np.array(where_m), 0.5, RASTER, is_open).tolist()


def test_runs_end_where_positions_pause():
    where = np.array([3.0, 0.0, 0.4, 0.2, 3.1, 9.0])
    assert runs.find_runs(where, 0.5, 2).tolist() == [[0.0, 0.4], [3.0, 3.1]]
    assert runs.find_runs(where, 0.5, 3).tolist() == [[0.0, 0.4]]
    assert runs.find_runs(np.empty(0), 0.5, 1).shape == (0, 2)


def test_runs_grow_through_further_positions_and_meet():
    assert grown(FOUND, [0.1, 1.4]) == [[0.1, 1.4], [2.5, 3.0]]
    assert grown(FOUND, [1.4, 1.8, 2.2]) == [[0.5, 3.0]]
    assert grown(np.empty((0, 2)), [1.0]) == []


def test_an_open_column_ends_a_run():
    assert grown(FOUND, [1.4, 1.8, 2.2], opened=[16]) == [[0.5, 1.4], [1.8, 3.0]]


def test_a_run_is_prolonged_within_its_reach_and_no_farther():
    """2 m off, 0.05 rad reach 0.1 m at the foot and 0.112 m at 1 m along; pauses, half of it."""
    where = np.array([-0.06, 0.0, 1.0, 1.04, 1.08, 1.12])
    assert runs.extend_run_ends(0.0, 1.0, where, 0.05, 2.0) == [0.0, 1.08]
    assert runs.extend_run_ends(0.0, 1.0, where[1:3], 0.05, 2.0) == [0.0, 1.0]
