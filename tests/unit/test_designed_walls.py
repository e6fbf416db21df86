"""A design as a prior of labels: what it tells where rays do not, and what they tell against it."""

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.changing_floor import DOOR, INNER, survey
from helpers.drawn_floor_making import storey
from helpers.refusals import refused
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.design.design_prior import lay_design
from scanplan.geometry.lines import Line
from scanplan.plan.model import priors, things
from scanplan.plan.model.designed_walls import DesignedWalls
from scanplan.plan.model.line_labels import label_line
from scanplan.plan.model.surface_counts import BEYOND, COLUMN_M, FACE, N_ENDS, SurfaceCounts
from scanplan.plan.model.surface_features import Features
from scanplan.rays.ray_set import ROWS_M

N_ROWS = len(ROWS_M) - 1
LINE = Line(np.zeros(2), np.array([0.0, 1.0]))
LENGTH_M = 4.0
N_COLUMNS = round(LENGTH_M / COLUMN_M)
DRAWN = DesignedWalls(
    lines_m=np.array([[(0.0, 0.0), (LENGTH_M, 0.0)]]),
    half_m=np.array([0.1]),
    openings_m=np.array([[(1.5, 0.0), (2.4, 0.0)]]),
    walls=np.array([0]),
    kinds=np.array(["door"], object),
)


def label(ends, designed=DRAWN):
    counts = SurfaceCounts(0.0, ends)
    known = designed and designed.weigh_labels(LINE, counts.middles_m)
    return label_line(counts, line=priors.INNER, known=known)


def unseen(n_rows=N_ROWS):
    return np.zeros((N_COLUMNS, n_rows, 2, N_ENDS))


def test_what_no_ray_tells_of_is_as_it_was_drawn():
    found = [(s.kind, round(s.low_m, 6), round(s.high_m, 6)) for s in label(unseen())]
    assert found[0][0] == found[-1][0] == "solid"
    (way,) = [of for of in found if of[0] != "solid"]
    assert way[0] in ("door", "shut") and way[1:] == pytest.approx((1.5, 2.4), abs=0.06)


@given(
    begin=st.integers(4, 50),
    columns=st.integers(16, 25),
    n_rows=st.sampled_from([1, N_ROWS]),
)
def test_rays_of_one_place_through_what_was_drawn_outweigh_it(begin, columns, n_rows):
    ends = unseen(n_rows)
    ends[:, :, 1, FACE] = 1.0
    ends[begin : begin + columns, :, 1, FACE] = 0.0
    ends[begin : begin + columns, :, 1, BEYOND] = 1.0
    found = label(ends)
    middle_m = (begin + columns / 2) * COLUMN_M
    (there,) = [s for s in found if s.low_m <= middle_m < s.high_m]
    assert there.kind in ("open", "door")


@pytest.mark.parametrize("n_rows", [1, N_ROWS])
def test_rays_that_end_at_a_wall_where_a_door_was_drawn_outweigh_it(n_rows):
    ends = unseen(n_rows)
    ends[:, :, 1, FACE] = 1.0
    assert [s.kind for s in label(ends)] == ["solid"]


def test_a_design_tells_of_its_own_lines_alone():
    middles_m = np.array([-1.0, 0.5, 2.0, 5.0])
    weights = DRAWN.weigh_labels(LINE, middles_m)
    assert [np.flatnonzero(row).tolist() for row in weights] == [
        [],
        [priors.SOLID],
        [priors.DOOR, priors.SHUT],
        [],
    ]
    # of a wall that is seen from one side the line is that of its face
    beside, elsewhere = (Line(np.array([0.0, off_m]), LINE.normal) for off_m in (0.1, 0.4))
    turned = Line(np.zeros(2), np.array([np.sin(0.2), np.cos(0.2)]))
    assert (DRAWN.weigh_labels(beside, middles_m) == weights).all()
    assert not DRAWN.weigh_labels(elsewhere, middles_m).any()
    assert not DRAWN.weigh_labels(turned, middles_m).any()


def test_a_doubtful_surface_on_a_drawn_wall_is_likelier_a_wall_and_no_other_is():
    half, none = (DRAWN.weigh_wall(LINE, np.array(at)) for at in ([0.5, 5.0], [5.0]))
    whole = DRAWN.weigh_wall(LINE, np.array([0.5, 2.0]))
    assert whole == pytest.approx(np.log(19)) and half == pytest.approx(whole / 2) and none == 0
    # of a surface of which nothing is known but that it is one
    plain = Features(*[np.nan] * len(fields(Features)))
    odds = []
    for known in (0.0, whole):
        p = things.weigh_things([plain] * 2, np.array([known, 0.0]))[0, things.WALL]
        odds.append(p / (1 - p))
    assert 15 < odds[1] / odds[0] < 23
    assert things.weigh_things([], np.empty(0)).shape == (0, len(things.KINDS))


@pytest.mark.parametrize("motion", [PlaneMotion(), PlaneMotion(0.6, -2.0, 4.0)])
def test_a_design_is_laid_on_a_plan_in_the_frame_of_the_plan(motion):
    laid, told = lay_design([storey()], "design.ifc", survey(motion=motion).plan)
    inner_m = motion.inverse().move(np.reshape(INNER, (2, 2)).astype(float))
    door_m = motion.inverse().move(np.reshape(DOOR, (2, 2)))
    assert len(told) == 1 and "design.ifc, Ground" in told[0]
    assert laid.lines_m[-1] == pytest.approx(inner_m, abs=0.01)
    assert laid.openings_m[0] == pytest.approx(door_m, abs=0.01)
    assert laid.walls.tolist() == [4] and laid.half_m[-1] == pytest.approx(0.1)


def test_a_design_of_another_floor_is_refused_in_one_line():
    star = [(0, 0, 3, 1), (3, 1, 9, 0.2), (9, 0.2, 5, 7), (5, 7, 1.2, 4), (1.2, 4, 0, 0)]
    with refused(file="design.ifc", remedy="the design") as fault:
        lay_design([storey()], "design.ifc", survey([], [], outer=star).plan)
    assert "\n" not in str(fault.value)
