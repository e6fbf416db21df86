"""Reference points: those that one rigid motion lays onto one another pass, others are told."""

import cmath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.errors import StageError
from scanplan.project.reference_points import check_points

PLACES = [(0, 0), (12, 1), (3, 9), (11, 8)]


def check(places, world_of):
    entries = [f"a.yaml: entry {number}" for number in range(1, len(places) + 1)]
    world = [world_of(complex(*place)) for place in places]
    check_points(entries, places, [(place.real, place.imag) for place in world])


@given(
    st.floats(-3.2, 3.2),
    st.complex_numbers(max_magnitude=6e6),
    st.lists(st.complex_numbers(max_magnitude=0.4), min_size=4, max_size=4),
)
def test_points_of_one_motion_pass_with_errors_of_hand_and_projection(turn, shift, errors):
    grid = 0.9996
    noise = iter(errors)
    check(PLACES, lambda z: grid * z * cmath.exp(1j * turn) + shift + next(noise))


@pytest.mark.parametrize(
    ("world_of", "said"),
    [
        (lambda z: 1000 * z, r"entry 1: lies 13\.6015 m from entry 4 by `at`, 13601\.5 m by"),
        (lambda z: z / 1000, r"by `at`, 0\.0136015 m by `world`; they may differ by 1\.3 m"),
        (lambda z: z / 0.3048, "they may differ by"),
        (lambda z: 5e5 + 0 * z, "by `at`, 0 m by `world`"),
        (lambda z: z + (5e4 if z == 12 + 1j else 0), "50012 m by `world`"),
        (lambda z: z.conjugate(), r"entry 2: lies to the left .*; give `world` as \[east, north\]"),
        (lambda z: complex(z.imag, z.real), r"give `world` as \[east, north\]"),
    ],
)
def test_points_that_disagree_are_told(world_of, said):
    with pytest.raises(StageError, match=said):
        check(PLACES, world_of)


@pytest.mark.parametrize("places", [[(0, 0), (0, 0)], [(0, 0), (0, 1.9)], [(5, 5)] * 4])
def test_points_at_one_place_are_told(places):
    with pytest.raises(
        StageError, match=r"give no direction; give two that are at least 2 m apart"
    ):
        check(places, lambda z: z)


def test_points_on_one_line_pass():
    check([(0, 0), (5, 0), (10, 0)], lambda z: 1j * z)
