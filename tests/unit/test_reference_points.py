"""Reference points: those that one rigid motion lays onto one another pass, others are told."""

import cmath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.project.reference_points import check_points, check_zone, fits_mirrored

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
        (lambda z: 1000 * z, "`world` seems to be in millimetres: give both in metres"),
        (lambda z: z / 1000 + 7, "`at` seems to be in millimetres: give both in metres"),
        (lambda z: 1j * z / 0.3048, "`world` seems to be in feet"),
        (lambda z: 1.7 * z, r"distances by `world` are 1\.7 times"),
        (lambda z: 5e5 + 0 * z, "measure them again"),
        (lambda z: z + (5e4 if z == 12 + 1j else 0), "agree without entry 2: measure that again"),
        (lambda z: z + (9 if z == 0 else 0), "agree without entry 1: .* or leave it out"),
        (lambda z: z.conjugate(), r"exchanged: give `world` as \[east, north\]"),
        (lambda z: complex(z.imag, z.real), r"give `world` as \[east, north\]"),
        (
            lambda z: 100 * complex(z.imag, z.real),
            r"\[east, north\]; besides `world` seems to be in centimetres",
        ),
    ],
)
def test_points_that_disagree_are_told(world_of, said):
    with pytest.raises(StageError, match=said):
        check(PLACES, world_of)


@pytest.mark.parametrize("places", [[(0, 0), (0, 0)], [(0, 0), (0, 1.9)], [(5, 5)] * 4])
def test_points_at_one_place_are_told(places):
    with refused(value="2 m"):
        check(places, lambda z: z)


@given(st.integers(0, 3), st.floats(4, 1e4), st.floats(-3.2, 3.2))
def test_the_one_point_that_is_off_is_named_and_without_it_they_pass(which, off_m, turn):
    """The remedy of the message, carried out."""
    off = [off_m * cmath.exp(1j * turn) if i == which else 0 for i in range(4)]
    errors = iter(off)
    with refused(value=f"without entry {which + 1}"):
        check(PLACES, lambda z: z + next(errors))
    check([place for i, place in enumerate(PLACES) if i != which], lambda z: z)


def test_the_residual_of_each_point_is_told():
    with pytest.raises(StageError, match=r"1: 2\.431 m, 2: 4\.924 m, 3: 1\.324 m, 4: 1\.403 m"):
        check(PLACES, lambda z: z + (7 if z == 12 + 1j else 0))


@pytest.mark.parametrize(
    ("places", "is_open"),
    # the last: 0.3 m off a line of 20 m, less than places may be off
    [([(0, 0), (12, 1)], True), (PLACES, False), ([(0, 0), (10, 0.3), (20, 0)], True)],
)
def test_exchanged_axes_show_by_a_point_off_the_line_alone(places, is_open):
    world = [(5e5 + x, 5.4e6 + y) for x, y in places]
    assert fits_mirrored(places, world) is is_open
    # what passes exchanged, too, is told by nothing
    if is_open:
        check(places, lambda z: complex(z.imag, z.real))


@pytest.mark.parametrize(
    ("crs", "world", "remedy"),
    [
        ("EPSG:25832", (5_400_020.1, 500_010.2), "[east, north]"),
        ("EPSG:32717", (5e7, 2e7), "metres"),
        ("EPSG:25832", (500_010.2, 5_400_020.1), ""),
        # Gauss-Krüger has its zone before the easting
        ("EPSG:31467", (3_500_010.2, 5_400_020.1), ""),
    ],
)
def test_a_place_beyond_a_zone_of_utm_is_told_though_two_points_agree(crs, world, remedy):
    if remedy:
        with refused(value=("entry 2", f"{world[0]:,.0f}", crs), remedy=remedy):
            check_zone("a.yaml: entry 2", crs, world)
    else:
        check_zone("a.yaml: entry 2", crs, world)


def test_points_on_one_line_pass():
    check([(0, 0), (5, 0), (10, 0)], lambda z: 1j * z)
