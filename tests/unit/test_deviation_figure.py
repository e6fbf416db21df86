"""Points against drawn faces: distances, and cells without a point."""

import numpy as np
import pytest

from helpers.floorplan_making import bare
from scanplan.report import deviation_figure

# a face of 1 m along x
FACES = bare(((0, 0, 1, 0, -1),)).faces


def test_points_have_their_distance_and_far_ones_none():
    xy_m = np.array([[0.5, 0.0], [0.5, -0.012], [0.55, 0.14], [0.5, 0.16], [1.1, 0.0]])
    found = deviation_figure.measure_deviations(xy_m, FACES)
    assert found.off_m == pytest.approx([0, 0.012, 0.14, np.nan, 0.1], nan_ok=True)


def test_the_length_that_points_show_is_counted_in_cells_of_a_decimetre():
    # three in two cells, one too far off to show a third
    xy_m = np.array([[0.01, 0.0], [0.09, 0.02], [1.0, 0.04], [0.5, 0.06]])
    found = deviation_figure.measure_deviations(xy_m, FACES)
    assert np.flatnonzero(found.is_shown).tolist() == [0, 9]
    assert found.cells_m[[0, 9]] == pytest.approx(
        np.array([[[0, 0], [0.1, 0]], [[0.9, 0], [1, 0]]])
    )


@pytest.mark.wording
def test_the_figure_states_shares_of_classes_and_coverage():
    xy_m = np.array([[0.05, 0.0], [0.15, 0.01], [0.25, 0.03], [0.35, 0.1], [0.5, 0.9]])
    figure = deviation_figure.draw_deviation_figure(xy_m, FACES)
    (legend,) = figure.legends
    said = [text.get_text() for text in legend.get_texts()]
    assert said[:4] == [f"up to {mm} mm: 25.0%" for mm in (5, 15, 50, 150)]
    assert said[4].endswith("20.0% of all points")
    assert figure.get_suptitle().startswith("points show 30.0% of the length")


@pytest.mark.wording
def test_of_no_point_at_all_nothing_is_shown():
    figure = deviation_figure.draw_deviation_figure(np.zeros((0, 2)), FACES)
    assert figure.get_suptitle().startswith("points show 0.0% of the length")


def test_what_is_of_floor_or_ceiling_is_left_out_as_far_as_they_are_known():
    xyz_m = np.array([[0, 0, z] for z in (0.0, 1.0, 2.0)])
    taken = deviation_figure.take_upright
    assert taken(xyz_m, 0.0, 2.0)[:, 2].tolist() == [1.0]
    assert taken(xyz_m, np.nan, 2.0)[:, 2].tolist() == [0.0, 1.0]
    assert len(taken(xyz_m, np.nan, np.nan)) == 3
