"""Plans made regular: what is straightened, what is not, and what goes along."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from helpers import floorplan_making
from scanplan.exports.drafting.directions import find_main_directions
from scanplan.exports.drafting.moved_rooms import move_outline
from scanplan.exports.drafting.moved_walls import MovedWalls
from scanplan.exports.drafting.nominal_sizes import choose_sizes
from scanplan.exports.drafting.regular_plan import (
    ASSUMED,
    MEASURED,
    REVEALS,
    DraftSettings,
    draft_plan,
)
from scanplan.exports.drafting.wall_lines import WallLines
from scanplan.plan.floorplan import centrelines_m

SETTINGS = DraftSettings(
    tolerance_m=0.05, walls_m=(0.1, 0.2), doors_m=(0.9, 1.0), windows_m=(1.2,), facade_m=0.3
)
SIGMA_M = 0.004
END_COLUMNS = ("x0_m", "y0_m", "x1_m", "y1_m")


def turned(line, degrees):
    """Return a line (x0, y0, x1, y1) turned about its middle."""
    ends = np.array(line, float).reshape(2, 2)
    middle, angle = ends.mean(axis=0), np.radians(degrees)
    matrix = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return tuple(((ends - middle) @ matrix.T + middle).ravel())


def plan_of(rows, sigma_m: object = SIGMA_M):
    """Return a plan of walls (line, thickness): no faces are looked at."""
    walls = floorplan_making.walls([(line, thick, 0, 1, "observed") for line, thick in rows])
    sigmas_m = np.broadcast_to(np.asarray(sigma_m, float), len(rows)).copy()
    return floorplan_making.plan(
        walls=walls | {"sigma_offset_m": sigmas_m},
        rooms=floorplan_making.rooms([]),
        openings=floorplan_making.openings([]),
    )


def angle_deg(plan, wall):
    x, y = np.diff(centrelines_m(plan.walls)[wall], axis=0)[0]
    return float(np.degrees(np.arctan2(y, x)))


# two long walls at right angles, which say what is square; what is tried stands apart from them
FRAME = [((0, 0, 20, 0), 0.2), ((0, 0, 0, 20), 0.2)]
TRIED = (8, 10, 12, 10)


@pytest.mark.parametrize(
    ("off_deg", "sigma_m", "is_square"),
    [
        # 4 m long: an end is off by 17 mm, which is as walls are built
        (0.5, SIGMA_M, True),
        (12.0, SIGMA_M, False),
        # 44 mm: more than three times its uncertainty, and then less
        (1.25, SIGMA_M, False),
        (1.25, 0.016, True),
        # 105 mm: as uncertain, but beyond the tolerance
        (3.0, 0.1, False),
    ],
)
def test_a_wall_is_straightened_where_what_is_known_of_it_allows(off_deg, sigma_m, is_square):
    walls = [*FRAME, (turned(TRIED, off_deg), 0.1)]
    regular, drafted = draft_plan(plan_of(walls, [SIGMA_M, SIGMA_M, sigma_m]), SETTINGS)
    assert angle_deg(regular, 2) == pytest.approx(0 if is_square else off_deg, abs=1e-6)
    assert drafted.n_square == 2 + is_square
    assert regular.walls["turned_deg"][2] == pytest.approx(-off_deg * is_square, abs=1e-6)
    # about its middle: half of its length times the sine
    moved_m = 2 * np.sin(np.radians(off_deg)) if is_square else 0
    assert regular.walls["moved_m"][2] == pytest.approx(moved_m, abs=1e-6)


def test_halfway_between_two_directions_is_one_too():
    walls = [*FRAME, (turned(TRIED, 45.3), 0.1)]
    assert angle_deg(draft_plan(plan_of(walls), SETTINGS)[0], 2) == pytest.approx(45, abs=1e-6)


def test_a_building_out_of_square_is_left_so():
    # 4 m long, off by 0.3 degrees: 10 mm, less than walls are built off by, but 2.6 times sigma
    crooked = [(turned((8, y, 12, y), 0.3), 0.1) for y in (10, 12, 14, 16)]
    # of less than its sigma nobody knows
    maybe = (turned((8, 18, 12, 18), 0.1), 0.1)
    regular, drafted = draft_plan(plan_of([*FRAME, *crooked, maybe]), SETTINGS)
    turned_deg = [angle_deg(regular, wall) for wall in range(7)]
    assert turned_deg == pytest.approx([0, 90, *[0.3] * 4, 0], abs=1e-6)
    assert drafted.n_square == 3


def test_two_pieces_of_a_wall_lie_in_one_line_the_surer_one_moving_less():
    pieces = [((2, 10.0, 6, 10.0), 0.1), ((7, 10.03, 11, 10.03), 0.1)]
    sigmas_m = [SIGMA_M, SIGMA_M, 0.005, 0.01]
    regular, drafted = draft_plan(plan_of([*FRAME, *pieces], sigmas_m), SETTINGS)
    # the mean, weighed by 1 / 0.005^2 and 1 / 0.01^2: a fifth of the way
    y_m = centrelines_m(regular.walls)[2:, :, 1]
    np.testing.assert_allclose(y_m, 10.006, atol=1e-6)
    np.testing.assert_allclose(regular.walls["moved_m"][2:], [0.006, 0.024], atol=1e-6)
    assert drafted.n_through == 2 and drafted.moved_m == pytest.approx(0.024, abs=1e-6)


def test_pieces_of_another_thickness_are_flush():
    # left sides at 10.05 and 10.06 m; right ones 9.95 and 9.86 m
    pieces = [((2, 10.0, 6, 10.0), 0.1), ((7, 9.96, 11, 9.96), 0.2)]
    regular, _ = draft_plan(plan_of([*FRAME, *pieces]), SETTINGS)
    y_m = centrelines_m(regular.walls)[2:, 0, 1]
    half_m = regular.walls["thickness_m"][2:] / 2
    assert (y_m + half_m) == pytest.approx([10.055, 10.055], abs=1e-6)


def test_a_step_that_is_known_stays():
    pieces = [((2, 10.0, 6, 10.0), 0.1), ((7, 10.04, 11, 10.04), 0.1)]
    regular, drafted = draft_plan(plan_of([*FRAME, *pieces]), SETTINGS)
    assert centrelines_m(regular.walls)[2:, 0, 1] == pytest.approx([10.0, 10.04])
    assert drafted.n_through == 0


def test_thickness_is_nominal_where_it_is_near():
    walls = [*FRAME, (TRIED, 0.112), ((8, 15, 12, 15), 0.15)]
    regular, drafted = draft_plan(plan_of(walls), SETTINGS)
    assert regular.walls["thickness_m"] == pytest.approx([0.2, 0.2, 0.1, 0.15])
    assert regular.walls["thickness_changed_m"][2] == pytest.approx(-0.012)
    # each side by half of it
    assert regular.walls["moved_m"][2] == pytest.approx(0.006)
    assert (drafted.n_nominal, drafted.thickness_m) == (3, pytest.approx(0.012))


def test_a_size_at_the_very_limit_is_taken_and_one_beyond_is_not():
    sizes_m, sigma_m = (0.1,), np.full(2, 0.005)
    measured_m, allowed_m = np.array([0.12, 0.121]), np.full(2, 0.02)
    chosen_m = choose_sizes(measured_m, sigma_m, allowed_m, sizes_m, np.ones(2))
    np.testing.assert_array_equal(chosen_m, [0.1, np.nan])


def test_of_two_sizes_that_may_be_that_is_taken_which_the_building_has():
    measured_m = np.array([0.1, 0.1, 0.1, 0.1075])
    near_m = np.full(4, 0.02)
    chosen_m = choose_sizes(measured_m, near_m / 4, near_m, (0.1, 0.115), np.ones(4))
    assert chosen_m.tolist() == [0.1, 0.1, 0.1, 0.1]
    assert np.isnan(choose_sizes(measured_m, near_m / 4, near_m, (), np.ones(4))).all()


def test_the_main_direction_is_that_of_most_walls():
    angles_rad = np.radians([10.0, 100.2, 190.0, 55.0, 12.0])
    assert np.degrees(find_main_directions(angles_rad, np.array([4, 4, 4, 1, 1.0]))) == (
        pytest.approx([10.0])
    )
    # a wing with a third of the weight has its own
    wings_rad = np.radians([0.0, 90.0, 30.0, 120.0])
    mains_deg = np.degrees(find_main_directions(wings_rad, np.array([2.0, 2, 1, 1])))
    assert mains_deg == pytest.approx([0.0, 30.0])


def test_no_wall_no_change():
    regular, drafted = draft_plan(plan_of([]), SETTINGS)
    assert len(regular.walls["wall"]) == drafted.n_walls == 0 and drafted.moved_m == 0


def test_what_is_regular_stays_but_for_what_is_assumed():
    drawn = floorplan_making.plan()
    regular, drafted = draft_plan(drawn, SETTINGS)
    assert (drafted.moved_m, drafted.turned_deg) == pytest.approx((0, 0), abs=1e-8)
    assert drafted.width_m == pytest.approx(0, abs=1e-8)
    assert shapely.equals_exact(regular.areas, drawn.areas, 1e-8).all()
    # the east wall was seen from inside: 7.1 m is its face
    assert regular.walls["thickness_from"].tolist() == [MEASURED, ASSUMED, *[MEASURED] * 4]
    assert centrelines_m(regular.walls)[1, :, 0] == pytest.approx([7.25, 7.25])
    assert regular.walls["thickness_m"][1] == 0.3
    # with its corners: from the lower edge of the south wall to the upper one of the north wall
    assert shapely.union_all(regular.bodies).bounds == pytest.approx((-0.2, -0.2, 7.4, 3.2))
    assert not {"verify", "p_true", "doubt"} & set(regular.walls)


def revealed(deep_m, **others):
    """The east wall, whose face is at 7.1 m, as thick as the reveals of its window are deep."""
    east = ((7.1 + deep_m / 2, -0.1, 7.1 + deep_m / 2, 3.1), deep_m, 1, -1, "observed")
    rows = [others.get(f"wall_{n}", of) for n, of in enumerate(floorplan_making.WALLS)]
    rows[1] = east
    reveals = [(7.1 + deep_m, 1.0, 7.1, 1.0, 1), (7.1, 2.0, 7.1 + deep_m, 2.0, 1)]
    return floorplan_making.plan(
        walls=floorplan_making.walls(rows),
        faces=floorplan_making.faces([*floorplan_making.FACES, *reveals]),
    )


@pytest.mark.parametrize(
    ("deep_m", "thick_m"),
    [(0.45, 0.45), (0.39, 0.4)],  # between the catalogue's, and near to one
)
def test_a_facade_is_as_thick_as_its_reveals_are_deep(deep_m, thick_m):
    regular, drafted = draft_plan(revealed(deep_m), replace(SETTINGS, walls_m=(0.1, 0.2, 0.4)))
    (east,) = np.flatnonzero(regular.walls["wall"] == 1)
    assert regular.walls["thickness_m"][east] == pytest.approx(thick_m)
    assert regular.walls["thickness_from"][east] == REVEALS
    assert drafted.n_revealed == 1
    reveals_m = centrelines_m(regular.faces)[regular.reveals]
    assert np.ptp(reveals_m[:, :, 0], axis=1) == pytest.approx([thick_m, thick_m], abs=1e-6)
    # the side that was seen stays
    assert regular.bodies[east].bounds[0] == pytest.approx(7.1)


def test_a_facade_without_reveals_is_as_thick_as_those_with():
    """The north wall of the small room, of which its face alone is known."""
    north = ((7.1, 3.0, 4.05, 3.0), np.nan, 2, -1, "observed")
    regular, _ = draft_plan(revealed(0.45, wall_2=north), SETTINGS)
    assert regular.walls["thickness_m"][2] == pytest.approx(0.45)
    assert regular.walls["thickness_from"][2] == ASSUMED


def test_rooms_follow_walls_and_leave_neither_gap_nor_overlap():
    # the wall between the rooms is 20 mm to the east, 20 mm thicker, and turned by half a degree
    line = turned((4.07, -0.1, 4.07, 3.1), 0.5)
    walls = [*floorplan_making.WALLS]
    walls[5] = (line, 0.11, *walls[5][2:])
    left = shapely.LineString(np.array(line).reshape(2, 2)).parallel_offset(0.055, "left")
    right = shapely.LineString(np.array(line).reshape(2, 2)).parallel_offset(0.055, "right")
    cut = [shapely.get_x(shapely.intersection(side, shapely.LineString([(0, y), (9, y)])))
           for side in (left, right) for y in (0, 3)]  # fmt: skip
    west = shapely.Polygon([(0, 0), (cut[0], 0), (cut[1], 3), (0, 3)])
    east = shapely.Polygon([(cut[2], 0), (7.1, 0), (7.1, 3), (cut[3], 3)])
    drawn = floorplan_making.plan(
        walls=floorplan_making.walls(walls), rooms=floorplan_making.rooms([west, east])
    )
    regular, _ = draft_plan(drawn, SETTINGS)
    x_m = float(centrelines_m(regular.walls)[5, 0, 0])
    assert centrelines_m(regular.walls)[5, :, 0] == pytest.approx([x_m, x_m])
    expected = [shapely.box(0, 0, x_m - 0.05, 3), shapely.box(x_m + 0.05, 0, 7.1, 3)]
    assert shapely.hausdorff_distance(regular.areas, expected) == pytest.approx([0, 0], abs=1e-6)
    assert regular.rooms["area_m2"] == pytest.approx([shape.area for shape in expected])


def test_an_outline_turns_at_corners_alone_wherever_it_begins():
    wavering = [(1.5, 0), (2, 0.002), (4, 0), (4, 1), (4.001, 2), (4, 3), (0, 3), (0, 0), (1, 0)]
    rooms = floorplan_making.rooms([shapely.Polygon(wavering), floorplan_making.ROOMS[1]])
    regular, _ = draft_plan(floorplan_making.plan(rooms=rooms), SETTINGS)
    assert shapely.get_num_coordinates(regular.areas).tolist() == [5, 5]
    assert regular.areas[0].symmetric_difference(floorplan_making.ROOMS[0]).area < 1e-6
    assert regular.rooms["perimeter_m"][0] == pytest.approx(14)


def test_an_opening_is_in_its_wall_and_of_a_size_of_the_catalogue():
    rows = [(0, 1.0, 0, 1.88), (-0.1, 1.0, -0.1, 2.05)]
    openings = floorplan_making.openings(
        [(rows[0], 5, "door", 0.0, 2.0, 0, 1), (rows[1], 4, "door", 0.0, 2.0, 0, -1)]
    )
    regular, drafted = draft_plan(floorplan_making.plan(openings=openings), SETTINGS)
    # in the middle of its wall, and by 10 mm wider on both sides; 1.08 m, as which the other was
    # seen too narrow, is near to nothing, and drawn evenly
    assert centrelines_m(regular.openings)[0] == pytest.approx(
        np.array([[4.05, 0.99], [4.05, 1.89]])
    )
    assert regular.openings["width_m"] == pytest.approx([0.9, 1.1])
    assert drafted.width_m == pytest.approx(0.05)
    # no lintel was seen: in a plane doors are less too narrow, and widths are finer
    openings["lintel_m"][:] = np.nan
    flat, _ = draft_plan(floorplan_making.plan(openings=openings), SETTINGS)
    assert flat.openings["width_m"] == pytest.approx([0.9, 1.06])
    # what an even width would change by more than the tolerance has the next narrower one
    openings["lintel_m"][:], openings["y1_m"][1], openings["width_m"][1] = 2.0, 2.296, 1.296
    other, _ = draft_plan(floorplan_making.plan(openings=openings), SETTINGS)
    assert other.openings["width_m"] == pytest.approx([0.9, 1.3])


def test_faces_and_rooms_lie_on_sides_of_walls():
    # 6 mm before and behind the sides; corners cut off, a step where nothing is
    faces = [(0, 0.006, 7.1, 0.006, 0), (4.006, 0, 4.006, 3, 5), (4.1, 0, 4.1, 3, 5)]
    west = [(0.02, 0), (2, 0), (2.01, 0.008), (3.98, 0.007), (4, 0.03), (4, 3), (0, 3), (0, 0.02)]
    east = [(4.106, 0), (7.1, 0), (7.1, 3), (4.106, 3)]
    drawn = floorplan_making.plan(
        faces=floorplan_making.faces(faces),
        rooms=floorplan_making.rooms([shapely.Polygon(west), shapely.Polygon(east)]),
    )
    regular, _ = draft_plan(drawn, SETTINGS)
    sides_m = centrelines_m(regular.faces)
    assert [*sides_m[0, :, 1], *sides_m[1:, 0, 0]] == pytest.approx([0, 0, 4, 4.1], abs=1e-9)
    assert regular.areas[0].normalize().equals_exact(floorplan_making.ROOMS[0].normalize(), 1e-9)
    assert regular.areas[1].normalize().equals_exact(floorplan_making.ROOMS[1].normalize(), 1e-9)


def test_an_outline_that_goes_on_beyond_its_wall_in_line_follows_the_wall_alone():
    line_m = np.array([[[0.0, -0.1], [3.0, -0.1]]])
    one = np.ones(1)
    before = WallLines(line_m, 0.2 * one, 0.01 * one, one > 0, one < 0, one < 0, 0.05)
    lowered = MovedWalls(before, line_m - [0, 0.02], 0 * one)
    room = shapely.Polygon([(0, 0), (3, 0), (8, 0), (8, 4), (0, 4)])
    moved = move_outline(room, lowered)
    wall_side, bare = shapely.points([(1.5, -0.02), (8, 0)])
    assert shapely.distance(moved.boundary, [wall_side, bare]) == pytest.approx([0, 0], abs=1e-9)
    # beyond its end no farther than it has moved
    assert moved.area == pytest.approx(32 + 3 * 0.02 + 5 * 0.02 / 2)


def test_a_face_before_its_wall_stays_as_far_from_it():
    faces = floorplan_making.faces([(0, 0.05, 7.1, 0.05, 0)])
    regular, _ = draft_plan(floorplan_making.plan(faces=faces), SETTINGS)
    assert centrelines_m(regular.faces)[0, :, 1] == pytest.approx([0.05, 0.05])


def test_an_opening_beside_a_joint_of_a_wall_is_of_a_size_of_the_catalogue():
    # its pieces meet at 4.05
    walls = [(*row[:4], "observed") for row in floorplan_making.WALLS]
    window = ((4.06, 3.1, 5.25, 3.1), 2, "window", 0.9, 2.1, 1, -1)
    drawn = floorplan_making.plan(
        walls=floorplan_making.walls(walls), openings=floorplan_making.openings([window])
    )
    regular, _ = draft_plan(drawn, SETTINGS)
    assert regular.openings["width_m"] == pytest.approx([1.2])
    assert regular.walls["joined"][regular.hosts[0]] == "2"


def test_short_pieces_of_wall_at_no_room_are_left_out_and_counted():
    stub = ((8.0, 1.0, 8.0, 1.4), np.nan, 0, -1, "observed")
    drawn = floorplan_making.plan(walls=floorplan_making.walls([*floorplan_making.WALLS, stub]))
    regular, drafted = draft_plan(drawn, SETTINGS)
    assert 6 not in regular.walls["wall"] and drafted.n_left_out == 1
    slit = ((1.0, -0.1, 1.05, -0.1), 0, "window", 0.9, 2.1, 0, -1)
    openings = floorplan_making.openings([*floorplan_making.OPENINGS, slit])
    without, counted = draft_plan(floorplan_making.plan(openings=openings), SETTINGS)
    assert without.openings["opening"].tolist() == [0, 1, 2] and counted.n_left_out == 1
    # one that a person drew stays
    corrected = drawn.walls["corrected"].copy()
    corrected[6] = "added"
    by_hand = replace(drawn, walls={**drawn.walls, "corrected": corrected})
    assert draft_plan(by_hand, SETTINGS)[1].n_left_out == 0


jitters = st.lists(st.floats(-0.012, 0.012), min_size=24, max_size=24)


def jittered(offsets_m, sigma_m=SIGMA_M):
    walls = floorplan_making.walls()
    for row in range(6):
        for number, column in enumerate(END_COLUMNS):
            walls[column][row] += offsets_m[4 * row + number]
    return floorplan_making.plan(walls=walls | {"sigma_offset_m": np.full(6, sigma_m)})


@given(jitters, st.floats(0.0, 0.05), st.floats(0.001, 0.1))
@settings(max_examples=40, deadline=None)
def test_nothing_is_moved_farther_than_it_may(offsets_m, tolerance_m, sigma_m):
    drawn = jittered(offsets_m, sigma_m)
    regular, drafted = draft_plan(drawn, replace(SETTINGS, tolerance_m=tolerance_m))
    limit_m = min(tolerance_m, max(0.03, 3 * sigma_m)) + 1e-5
    assert drafted.moved_m <= limit_m
    for wall, thick_m in ((0, 0.2), (5, 0.1)):
        before, after = (centrelines_m(p.walls)[wall] for p in (drawn, regular))
        grown_m = abs(regular.walls["thickness_m"][wall] - thick_m) / 2
        lines = shapely.LineString(before), shapely.LineString(after)
        middle = lines[1].interpolate(0.5, normalized=True)
        assert lines[0].distance(middle) + grown_m <= limit_m
    assert abs(regular.openings["width_changed_m"]).max() <= tolerance_m + 1e-9


@given(jitters)
@settings(max_examples=25, deadline=None)
def test_what_has_been_made_regular_is_regular(offsets_m):
    once, first = draft_plan(jittered(offsets_m), SETTINGS)
    # taken for out of square, it is crooked in part, and may be told otherwise by what was turned
    assume(first.n_square == first.n_walls)
    again, drafted = draft_plan(once, SETTINGS)
    assert drafted.moved_m < 1e-6 and drafted.width_m < 1e-6
    assert shapely.equals_exact(once.areas, again.areas, 1e-6).all()


def test_the_same_plan_gives_the_same_bytes():
    drawn = jittered(np.random.default_rng(1).uniform(-0.01, 0.01, 24))
    one, other = (draft_plan(drawn, SETTINGS)[0] for _ in range(2))
    for table in ("walls", "openings", "rooms", "faces"):
        for column, values in getattr(one, table).items():
            np.testing.assert_array_equal(values, getattr(other, table)[column])


@pytest.mark.parametrize(
    ("said", "is_kept"),
    [
        ("drawn by hand, A. Bee", True),
        ("added by hand", True),
        ("changed by hand", False),
        ("kept by hand", False),
        ("", False),
    ],
)
def test_a_size_that_a_person_stated_stays(said, is_kept):
    walls, openings = floorplan_making.walls(), floorplan_making.openings()
    walls["thickness_m"][5], walls["corrected"][5] = 0.112, said
    openings["y1_m"][1], openings["width_m"][1], openings["corrected"][1] = 1.87, 0.87, said
    regular, _ = draft_plan(floorplan_making.plan(walls=walls, openings=openings), SETTINGS)
    assert regular.walls["thickness_m"][5] == pytest.approx(0.112 if is_kept else 0.1)
    assert regular.openings["width_m"][1] == pytest.approx(0.87 if is_kept else 0.9)


def test_openings_of_one_width_that_no_catalogue_has_are_drawn_alike():
    doors = [(x, x + width_m) for x, width_m in ((1, 0.741), (2, 0.74), (3, 0.739), (5, 1.342))]
    rows = [((x0, -0.1, x1, -0.1), 0, "door", 0.0, 2.0, 0, -1) for x0, x1 in doors]
    plan = floorplan_making.plan(openings=floorplan_making.openings(rows))
    widths_m = draft_plan(plan, SETTINGS)[0].openings["width_m"]
    # one of a size that none has is even, what doors are seen too narrow by counted
    assert widths_m == pytest.approx([0.77, 0.77, 0.77, 1.35])
    # two may be alike by chance
    two = floorplan_making.plan(openings=floorplan_making.openings(rows[1:]))
    assert draft_plan(two, SETTINGS)[0].openings["width_m"] == pytest.approx([0.75, 0.75, 1.35])
    none = replace(SETTINGS, doors_m=())
    assert draft_plan(plan, none)[1].width_m == pytest.approx(0)


@pytest.mark.parametrize(("gap_m", "is_joined"), [(0.25, True), (0.4, False)])
def test_a_wall_that_ends_before_another_is_drawn_on_to_it(gap_m, is_joined):
    # of a wall of 20 cm: 30 cm, and half of its own 10 cm, are near
    walls = [*FRAME, ((5, 0.1 + gap_m, 5, 6), 0.1)]
    drawn = centrelines_m(draft_plan(plan_of(walls), SETTINGS)[0].walls)[2, 0]
    assert drawn == pytest.approx([5, 0 if is_joined else 0.1 + gap_m], abs=1e-6)


def test_what_a_person_said_of_a_door_holds_on_both_drawings():
    """A swing that is stated is drawn though a wall is in its way."""
    drawn = floorplan_making.plan()
    stated = np.array(["changed", *drawn.openings["corrected"][1:]])
    by_hand = replace(drawn, openings={**drawn.openings, "corrected": stated})
    regular, _ = draft_plan(by_hand, SETTINGS)
    np.testing.assert_array_equal(regular.openings["corrected"], stated)
