"""Labels of lines whose every witness is given, and of random ones against all ways to part them.

Columns are 5 cm wide; the edges of rows are at 0.1, 0.3 ... 4.1 m.
"""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reference import labels as literal
from scanplan.plan.model import line_labels, priors
from scanplan.plan.model.line_labels import label_line
from scanplan.plan.model.surface_counts import (
    BEYOND,
    DEEP,
    FACE,
    LOST,
    N_ENDS,
    SHALLOW,
    SurfaceCounts,
)
from scanplan.rays.ray_set import ROWS_M

N_ROWS = len(ROWS_M) - 1
SQUARE, OBLIQUE = 0, 1
CEILING_M = 2.5
KINDS = range(len(priors.KINDS))
LINES = (priors.INNER, priors.OUTER, priors.FRONT, priors.ROW)


def wall(length_m, top_m=CEILING_M, n=3.0):
    """Return the ends of rays at a wall: so many witnesses of its face in each cell, oblique."""
    ends = np.zeros((round(length_m / 0.05), N_ROWS, 2, N_ENDS))
    put(ends, (0, length_m), (0, top_m), {(OBLIQUE, FACE): n})
    return ends


def put(ends, along_m, heights_m, witnesses):
    """Let cells between places and heights show only these witnesses, by incidence and end."""
    columns = slice(*np.round(np.array(along_m) / 0.05).astype(int))
    rows = slice(*np.searchsorted(ROWS_M, np.array(heights_m) - 1e-9).tolist())
    ends[columns, rows] = 0
    for (incidence, end), n in witnesses.items():
        ends[columns, rows, incidence, end] = n


def label(ends, *, line=priors.INNER, **more):
    return label_line(SurfaceCounts(0.0, ends), line=line, **more)


def spans(stretches):
    return [(s.kind, round(s.low_m, 6), round(s.high_m, 6)) for s in stretches]


def test_stretches_are_scored_alike_in_any_steps(monkeypatch):
    ends = wall(4)
    put(ends, (1, 1.9), (0, 2.1), {(SQUARE, BEYOND): 3.0})
    at_once = label(ends)
    monkeypatch.setattr(line_labels, "_PAIRS_AT_ONCE", 1)
    one_by_one = label(ends)
    assert spans(one_by_one) == spans(at_once) and len(at_once) > 1
    assert [s.p for s in one_by_one] == [s.p for s in at_once]


class TestByHand:
    def test_a_wall_with_a_hole_under_a_lintel_has_a_door(self):
        ends = wall(4)
        put(ends, (1.5, 2.4), (0, 2.1), {(OBLIQUE, BEYOND): 3})
        found = label(ends)
        assert spans(found) == [("solid", 0, 1.5), ("door", 1.5, 2.4), ("solid", 2.4, 4)]
        assert (found[1].sill_m, found[1].lintel_m) == pytest.approx((0, 2.1))
        assert min(s.p for s in found) > 0.95

    def test_a_pane_that_answers_square_rays_alone_is_a_window(self):
        ends = wall(4)
        pane = {(SQUARE, FACE): 1, (OBLIQUE, BEYOND): 1.5, (OBLIQUE, LOST): 0.5}
        put(ends, (1.0, 2.2), (0.9, 2.1), pane)
        found = label(ends, line=priors.OUTER)
        assert spans(found) == [("solid", 0, 1), ("window", 1, 2.2), ("solid", 2.2, 4)]
        assert (found[1].sill_m, found[1].lintel_m) == pytest.approx((0.9, 2.1))
        assert found[1].p > 0.95

    def test_what_returns_5_cm_behind_the_face_is_a_shut_leaf(self):
        ends = wall(4)
        put(ends, (1.5, 2.4), (0, 2.1), {(OBLIQUE, SHALLOW): 3})
        found = label(ends)
        assert spans(found) == [("solid", 0, 1.5), ("shut", 1.5, 2.4), ("solid", 2.4, 4)]
        assert found[1].lintel_m == pytest.approx(2.1)

    def test_a_wall_that_rays_pass_over_ends_low(self):
        ends = wall(2, top_m=1.1)
        put(ends, (0, 2), (1.1, CEILING_M), {(OBLIQUE, BEYOND): 3})
        (found,) = label(ends)
        assert found.kind == "low" and found.lintel_m == pytest.approx(1.1)
        assert found.p > 0.95

    def test_a_desk_before_a_window_is_low(self):
        """Over all of it rays leave the room; no lintel was seen."""
        ends = wall(2, top_m=0.9)
        put(ends, (0, 2), (0.9, 1.9), {(OBLIQUE, BEYOND): 2, (OBLIQUE, LOST): 1})
        (found,) = label(ends, line=priors.OUTER)
        assert found.kind == "low" and found.lintel_m == pytest.approx(0.9)

    def test_a_way_to_the_next_wall_is_a_door_only_under_a_lintel(self):
        """A wall of 3 m, and what rays show from there to the next one."""
        under, free = wall(3.9), wall(3.9)
        put(under, (3.0, 3.9), (0, 2.1), {(OBLIQUE, BEYOND): 3})
        put(free, (3.0, 3.9), (0, CEILING_M), {(OBLIQUE, BEYOND): 3})
        goes_on = (False, True)
        assert spans(label(under, goes_on=goes_on)) == [("solid", 0, 3), ("door", 3, 3.9)]
        assert spans(label(free, goes_on=goes_on)) == [("solid", 0, 3), ("open", 3, 3.9)]

    def test_from_one_wall_that_crosses_to_another_a_line_is_open_below_a_beam(self):
        """A corridor of 1.6 m, and a beam across it at 2.5 m; a door has a lintel at 2.1 m."""
        beam, door = wall(5, top_m=2.9), wall(5, top_m=2.9)
        put(beam, (1.5, 3.1), (0, 2.5), {(OBLIQUE, BEYOND): 3})
        put(door, (1.8, 2.7), (0, 2.1), {(OBLIQUE, BEYOND): 3})
        crossed_m = np.array([(1.2, 1.8), (2.8, 3.4)])
        kinds = [[s.kind for s in label(ends, crossed_m=crossed_m)] for ends in (beam, door)]
        assert kinds == [["solid", "open", "solid"], ["solid", "door", "solid"]]
        # elsewhere it is a way as wide under a high lintel
        assert [s.kind for s in label(beam)] == ["solid", "door", "solid"]

    def test_a_slot_under_a_lintel_is_no_door(self):
        ends = wall(4)
        put(ends, (1.5, 1.8), (0, 2.1), {(OBLIQUE, BEYOND): 3})
        assert [kind for kind, *_ in spans(label(ends))] == ["solid", "open", "solid"]

    def test_what_is_free_to_the_ceiling_and_wide_is_open(self):
        ends = wall(6)
        put(ends, (1.5, 4.5), (0, CEILING_M), {(OBLIQUE, BEYOND): 3})
        assert spans(label(ends)) == [("solid", 0, 1.5), ("open", 1.5, 4.5), ("solid", 4.5, 6)]

    def test_a_pane_to_the_floor_is_glass(self):
        ends = wall(6)
        pane = {(SQUARE, FACE): 1, (OBLIQUE, BEYOND): 1.5, (OBLIQUE, DEEP): 0.5}
        put(ends, (1.5, 4.5), (0, CEILING_M), pane)
        found = label(ends, line=priors.OUTER)
        assert spans(found) == [("solid", 0, 1.5), ("glass", 1.5, 4.5), ("solid", 4.5, 6)]

    def test_a_gap_of_90_cm_in_the_plane_is_a_door(self):
        ends = np.zeros((80, 1, 2, N_ENDS))
        ends[:, 0, OBLIQUE, FACE] = 6
        ends[30:48, 0, OBLIQUE] = np.eye(N_ENDS)[BEYOND] * 6
        found = label(ends)
        assert spans(found) == [("solid", 0, 1.5), ("door", 1.5, 2.4), ("solid", 2.4, 4)]
        assert all(np.isnan([s.sill_m, s.lintel_m]).all() for s in found)

    @pytest.mark.parametrize("n_rows", [1, N_ROWS])
    def test_where_nothing_was_seen_at_all_the_line_is_wall(self, n_rows):
        found = label(np.zeros((80, n_rows, 2, N_ENDS)))
        assert spans(found) == [("solid", 0, 4)]
        assert found[0].p < 1

    def test_what_nobody_saw_of_a_wall_is_wall(self):
        ends = wall(4)
        put(ends, (1.5, 2.4), (0, CEILING_M), {})
        assert spans(label(ends)) == [("solid", 0, 4)]

    def test_one_odd_cell_is_no_opening(self):
        ends = wall(4)
        put(ends, (1.5, 1.55), (0.9, 1.1), {(OBLIQUE, BEYOND): 9})
        assert spans(label(ends)) == [("solid", 0, 4)]

    def test_a_short_line_is_one_stretch(self):
        assert spans(label(wall(0.05))) == [("solid", 0, 0.05)]


@st.composite
def blocks(draw):
    """Draw the ends of rays of a line of up to three parts, all columns of each alike."""
    n_rows = draw(st.sampled_from([1, N_ROWS]))
    lengths = draw(st.lists(st.integers(1, 24), min_size=1, max_size=3))
    strength = draw(st.sampled_from([0.05, 0.3, 1.0]))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    parts = []
    for length in lengths:
        # mostly one kind of end in a row of heights, so that kinds compete
        favour = rng.integers(N_ENDS, size=rng.integers(1, 4))
        row_end = np.resize(np.repeat(favour, -(-n_rows // len(favour))), n_rows)
        cell = rng.random((n_rows, 2, N_ENDS)) * strength
        cell[np.arange(n_rows), 1, row_end] += 4 * strength
        parts.append(np.broadcast_to(cell, (length, *cell.shape)))
    return np.concatenate(parts)


def enumerate_ways(ends, *, line, goes_on):
    """Return all ways to part a line, and what they are made of."""
    labels = priors.list_labels(ends.shape[1], line=line)
    likely = line_labels.weigh_columns(SurfaceCounts(0.0, ends), labels).tolist()
    own = list(zip(labels.kind.tolist(), labels.log_prior.tolist(), strict=True))
    known = {
        "begins": priors.log_ends(line=line, goes_on=goes_on[0]).tolist(),
        "ends": priors.log_ends(line=line, goes_on=goes_on[1]).tolist(),
        "change": priors.log_change(line=line).tolist(),
        "length": priors.log_lengths(len(ends), line=line).tolist(),
    }
    ways = list(literal.list_ways(literal.find_cuts(likely), likely, own, known))
    return ways, likely, own, labels


GOES_ON = st.tuples(st.booleans(), st.booleans())


class TestAgainstAllWays:
    @settings(max_examples=60)
    @given(blocks(), st.sampled_from(LINES), GOES_ON)
    def test_the_best_way_and_its_heights_are_those_of_all_ways(self, ends, line, goes_on):
        ways, likely, own, labels = enumerate_ways(ends, line=line, goes_on=goes_on)
        best, _ = max(ways, key=lambda way: way[0])
        found = label(ends, line=line, goes_on=goes_on)
        columns = [(round(s.low_m / 0.05), round(s.high_m / 0.05), s) for s in found]
        stretches = [(begin, end, priors.KINDS.index(s.kind)) for begin, end, s in columns]
        # of two that weigh the same either is best
        weight = next((weight for weight, of_way in ways if of_way == stretches), -np.inf)
        assert weight == pytest.approx(best, rel=1e-9, abs=1e-9)
        for (begin, end, kind), stretch in zip(stretches, found, strict=True):
            number = literal.best_label(begin, end, kind, likely, own)
            heights_m = labels.sill_m[number], labels.lintel_m[number]
            assert (stretch.sill_m, stretch.lintel_m) == pytest.approx(heights_m, nan_ok=True)

    @settings(max_examples=60)
    @given(blocks(), st.sampled_from(LINES), GOES_ON)
    def test_probabilities_of_kinds_are_those_of_all_ways(self, ends, line, goes_on):
        ways, likely, _, labels = enumerate_ways(ends, line=line, goes_on=goes_on)
        shares = np.array(literal.kind_shares(ways, len(ends), len(KINDS)))
        chain = line_labels._Chain(labels, np.array(likely), line=line, goes_on=goes_on)
        assert chain.cuts.tolist() == literal.find_cuts(likely)
        between = chain.kind_shares()
        np.testing.assert_allclose(between.sum(axis=1), 1)
        np.testing.assert_allclose(between, shares[chain.cuts[:-1]], atol=1e-9)
        whole = literal.add([weight for weight, _ in ways])
        assert chain.evidence == pytest.approx(whole, rel=1e-9, abs=1e-9)
        for stretch in label(ends, line=line, goes_on=goes_on):
            begin, end = round(stretch.low_m / 0.05), round(stretch.high_m / 0.05)
            kind = priors.KINDS.index(stretch.kind)
            assert stretch.p == pytest.approx(shares[begin:end, kind].mean(), abs=1e-9)

    @given(blocks(), st.sampled_from(LINES))
    def test_stretches_follow_one_another_from_end_to_end(self, ends, line):
        found = label(ends, line=line)
        ends_m = [(s.low_m, s.high_m) for s in found]
        assert ends_m[0][0] == 0 and ends_m[-1][1] == pytest.approx(0.05 * len(ends))
        assert all(one[1] == two[0] for one, two in pairwise(ends_m))
        assert all(a.kind != b.kind for a, b in pairwise(found))


class TestPriors:
    @pytest.mark.parametrize("line", LINES)
    @pytest.mark.parametrize("n_rows", [1, N_ROWS])
    def test_of_each_kind_heights_are_likely_one_in_all(self, n_rows, line):
        labels = priors.list_labels(n_rows, line=line)
        for kind in np.unique(labels.kind):
            assert np.exp(labels.log_prior[labels.kind == kind]).sum() == pytest.approx(1)
        assert (labels.states.sum(axis=2) == 1).all()

    @pytest.mark.parametrize("line", LINES)
    def test_something_follows_each_kind_and_is_at_the_ends(self, line):
        np.testing.assert_allclose(np.exp(priors.log_change(line=line)).sum(axis=1), 1)
        for goes_on in (False, True):
            ends = priors.log_ends(line=line, goes_on=goes_on)
            assert np.exp(ends).sum() == pytest.approx(1)

    @pytest.mark.parametrize("line", LINES)
    def test_lengths_of_a_kind_are_likely_one_in_all(self, line):
        """Columns of 5 cm sum a density of the length to within some percent."""
        whole = np.exp(priors.log_lengths(2000, line=line)).sum(axis=1)
        np.testing.assert_allclose(whole, 1, atol=0.05)

    def test_a_cell_that_nothing_was_seen_of_speaks_for_no_state(self):
        weights = priors.weigh_states(np.zeros((1, 1, 2, N_ENDS)))
        assert np.ptp(weights) == pytest.approx(0)

    @pytest.mark.parametrize(
        ("end", "state"),
        [(FACE, 0), (SHALLOW, 2), (BEYOND, 4), (LOST, 1)],
        ids=["wall", "recess", "over a low thing", "free"],
    )
    def test_each_end_of_rays_speaks_for_its_state(self, end, state):
        ends = np.zeros((1, 1, 2, N_ENDS))
        ends[0, 0, OBLIQUE, end] = 3
        assert priors.weigh_states(ends)[0, 0].argmax() == state


def test_what_may_be_an_opening_is_as_long_as_it_is_likely_at_once():
    """Between places 0.3 m apart a window is likely at two, a door at one, which is too narrow."""
    shares = np.zeros((4, len(priors.KINDS)))
    shares[:, priors.SOLID] = 1.0
    shares[1:3, priors.WINDOW] = (0.3, 0.45)
    shares[3, priors.DOOR] = 0.4
    (found,) = line_labels.find_nearly(shares, 1 + 0.3 * np.arange(5))
    assert (found.kind, found.p) == ("window", 0.45)
    np.testing.assert_allclose((found.low_m, found.high_m), (1.3, 1.9))
