"""The table of the oracle's shares: of one survey, and of several seeds of it."""

import numpy as np

from helpers import claim_making as made
from thesis.comparison import oracle_figure


def with_shares(factor, **changes):
    table = made.evaluation(**changes)
    return table.assign(oracle_share=factor * table["visible_completeness_010m"])


def texts(*tables):
    return [
        [text.get_text() for text in axes.texts]
        for axes in oracle_figure.draw_oracle_figure(*tables).axes
    ]


def test_one_survey_tells_share_and_completeness():
    shown = texts(with_shares(0.5))
    # two extractors, five methods at 40 and 80 scans, the oracle first
    assert [len(of_it) for of_it in shown] == [10, 10]
    assert shown[0][:4] == ["0.48  (0.97)", "0.50  (1.00)", "0.45  (0.90)", "0.49  (0.98)"]


def test_several_seeds_tell_mean_and_range_where_all_have_so_many_scans():
    few = with_shares(1.0)
    few = few[few["k"] != 80]
    (ours, _) = texts(with_shares(0.5), few)
    assert len(ours) == 5 and ours[0] == "0.73  (0.48 to 0.97)"


def test_methods_come_by_their_mean_over_the_seeds():
    # the order by one seed alone is another
    first = with_shares(1.0, random=np.zeros(7))
    second = with_shares(1.0, hull=np.zeros(7), random=np.ones(7))
    figure = oracle_figure.draw_oracle_figure(first, second)
    names = [label.get_text() for label in figure.axes[0].get_yticklabels()]
    alone = [
        label.get_text()
        for label in oracle_figure.draw_oracle_figure(first).axes[0].get_yticklabels()
    ]
    assert names != alone and sorted(names) == sorted(alone)
