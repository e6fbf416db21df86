import numpy as np

from helpers import claim_making as made
from scanplan.selection.methods import METHODS
from thesis.figures import coverage_figures


def shorter(table, n):
    """The evaluation as a survey of fewer scans has it: its last size another one."""
    return table.assign(k=table["k"].replace(270, n))


def test_seeds_of_different_numbers_of_scans_are_drawn_together():
    table = made.evaluation()
    figure = coverage_figures.draw_shares_figure([table, shorter(table, 100)], "cluster_ransac")
    (line,) = [
        line
        for line in figure.axes[2].get_lines()
        if line.get_label() == METHODS["sequential"].label
    ]
    assert line.get_xdata().tolist() == [1, 15, 27, 40, 60, 80, 100]
    # of 100 scans one seed misses nothing, the other what is left between 80 and 270
    missed = (1 - 0.6) / 20 * (1 - 20 / 190)
    np.testing.assert_allclose(line.get_ydata()[[0, -1]], [0.045, missed / 2])
