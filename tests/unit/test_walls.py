"""Openings of walls made of stretches whose points and rays are known on paper."""

import functools

import numpy as np
import pytest

from helpers import house_making
from helpers.observation_making import line_through, observation
from scanplan.plan import planning
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.furniture.pillars import cut_off_pillars
from scanplan.plan.openings import classify_gap
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.walls import assemble_walls

SETTINGS = planning.make_plan_settings(house_making.PLAN)


def stretches(x0, y0, x1, y1, solid, crossed=(), lintel=()):
    """Stretches of a line, seen from the left of its way.

    Points, rays through it, and points above a door.
    """
    hits = [(x, 1.0) for span in solid for x in np.arange(*span, 0.02)]
    hits += [(x, 2.3) for span in lintel for x in np.arange(*span, 0.02)]
    passes = [(x, 1.0) for span in crossed for x in np.arange(*span, 0.01)]
    seen = observation(line_through(x0, y0, x1, y1), hits, passes)
    return [FaceInterval(seen, float(low), float(high)) for low, high in solid]


def openings(*found):
    walls = assemble_walls(
        *(
            [s for of_line in found for s in of_line],
            SETTINGS.pairs,
            SETTINGS.openings,
        ),
        corner_m=0.25,
    )
    return [
        np.sort(w.line.at(np.array([g.low_m, g.high_m]))[:, 0]) for w in walls for g in w.openings
    ]


def test_an_opening_begins_beside_the_wall_that_ends_there():
    south = stretches(0, 0, 6, 0, [(0, 2), (3, 6)], [(2.2, 3)])
    crossing = stretches(2.2, 4, 2.2, 0.05, [(0, 3.95)]) + stretches(2.0, 0.05, 2.0, 4, [(0, 3.95)])
    np.testing.assert_allclose(openings(south, crossing), [(2.2, 3)], atol=0.02)


@pytest.mark.parametrize(
    ("across_m", "expected"),
    [(3.95, [(2.6, 3.5)]), (0.9, [(2, 3.5)])],
    ids=["a wall", "as long as a leaf"],
)
def test_an_opening_does_not_go_on_across_a_wall(across_m, expected):
    """What is south of the opening's first part is hidden by the wall that ends amid it."""
    south = stretches(0, 0, 6, 0, [(0, 2), (3.5, 6)], [(2.6, 3.5)])
    crossing = stretches(2.6, 0.05 + across_m, 2.6, 0.05, [(0, across_m)])
    crossing += stretches(2.4, 0.05, 2.4, 0.05 + across_m, [(0, across_m)])
    np.testing.assert_allclose(openings(south, crossing), expected, atol=0.02)


def test_the_jambs_of_both_sides_are_averaged():
    one = stretches(0, 0, 6, 0, [(0, 2), (3, 6)], [(2, 3)])
    other = stretches(6, -0.2, 0, -0.2, [(0, 2.96), (3.96, 6)], [(2.96, 3.96)])
    np.testing.assert_allclose(openings(one, other), [(2.02, 3.02)], atol=0.005)


@pytest.mark.parametrize(("lintel", "count"), [([], 0), ([(0.4, 1.6)], 1)])
def test_between_two_things_there_is_no_door_but_below_a_lintel(lintel, count):
    assert len(openings(stretches(0, 0, 2, 0, [(0, 0.4), (1.6, 2)], [(0.4, 1.6)], lintel))) == count


PILLAR = [(0, 3), (3.8, 4)]
"""Of a line: a wall, and a pillar of 0.2 m behind a gap."""


def parts_at_pillars(solid, crossed, lintel=(), others=(), glass=()):
    """Spans along x, and openings, of a wall's parts."""
    made = assemble_walls(
        stretches(0, 0, 6, 0, solid, crossed, lintel) + [s for of_line in others for s in of_line],
        *(SETTINGS.pairs, SETTINGS.openings),
        corner_m=0.25,
    )
    classify = functools.partial(classify_gap, settings=SETTINGS.openings)
    found = cut_off_pillars(made, glass, classify, min_width_m=0.6, max_thickness_m=0.6)
    of_wall = next(
        parts for parts in found if any(abs(part.line.normal[1]) > 0.9 for part in parts)
    )
    spans = sorted(np.sort(part.ends[:, 0]).round(1).tolist() for part in of_wall)
    return spans, sum(len(part.openings) for part in of_wall)


def test_beside_a_pillar_there_is_no_door():
    crossed = [(3, 3.8), (4, 6)]
    assert parts_at_pillars(PILLAR, crossed) == ([[0.0, 3.0], [3.8, 4.0]], 0)


@pytest.mark.parametrize(
    ("solid", "crossed", "more"),
    [
        (PILLAR, [(3, 3.8)], {}),
        (PILLAR, [(3, 3.8), (4, 6)], {"lintel": [(2.6, 4)]}),
        ([(0, 3), (3.8, 4.6)], [(3, 3.8), (4.6, 6)], {}),
        (PILLAR, [(3, 3.8), (4, 6)], {"others": [stretches(4, 3, 4, 0.05, [(0, 2.95)])]}),
        (
            PILLAR,
            [(3, 3.8), (4, 6)],
            {"glass": [PlanWall(line_through(5, 0, 6, 0), -1, 1, np.nan, [], [])]},
        ),
    ],
    ids=["end not seen", "below a lintel", "longer", "where a wall begins", "where glass begins"],
)
def test_a_short_end_that_is_no_pillar_is_the_jamb_of_a_door(solid, crossed, more):
    spans, n_openings = parts_at_pillars(solid, crossed, **more)
    assert n_openings == 1 and len(spans) == 1


def ends(*found):
    walls = assemble_walls(
        *(
            [s for of_line in found for s in of_line],
            SETTINGS.pairs,
            SETTINGS.openings,
        ),
        corner_m=0.25,
    )
    return [np.sort(w.ends[:, 0]) for w in walls if abs(w.line.normal[1]) > 0.9]


@pytest.mark.parametrize(
    ("solid", "crossed", "end_m"),
    [
        (
            (0, 3),
            [],
            4.0,
        ),  # neither points nor rays between its end and the next wall: hidden, not open
        ((0, 3), [(3.1, 3.9)], 3.0),  # rays went through
        ((0, 1), [], 1.0),  # too far away
        ((2.6, 3.0), [], 3.0),  # farther than it is long
    ],
)
def test_a_wall_goes_on_to_the_next_through_what_is_hidden(solid, crossed, end_m):
    south = stretches(0, 0, 6, 0, [solid], crossed)
    across = stretches(4, 4, 4, -4, [(0, 8)])
    ((_, high_m),) = ends(south, across)
    assert high_m == pytest.approx(end_m, abs=0.03)


@pytest.mark.parametrize(
    ("to_y", "lintel", "count", "spans"),
    [
        (-4, [], 0, [(0, 2), (3.8, 6)]),
        (-4, [(2.0, 3.8)], 1, [(0, 6)]),
        (0, [], 1, [(0, 6)]),
    ],
    ids=["corridor", "below a lintel", "end of a corridor"],
)
def test_where_a_corridor_crosses_a_wall_is_no_opening_of_it(to_y, lintel, count, spans):
    south = stretches(0, 0, 6, 0, [(0, 2), (3.8, 6)], [(2, 3.8)], lintel)
    west = stretches(2, to_y, 2, 4, [(0, 4 - to_y)])
    east = stretches(3.8, 4, 3.8, to_y, [(0, 4 - to_y)])
    assert len(openings(south, west, east)) == count
    np.testing.assert_allclose(sorted(map(tuple, ends(south, west, east))), spans, atol=0.05)
