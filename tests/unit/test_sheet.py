"""Sheets are usual ones, to scale, and no word on them lies on another."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers import floorplan_making
from helpers.floorplan_making import bare, plan
from scanplan.exports.sheet import accuracy, composition, content, lettering, paper, symbols
from scanplan.exports.sheet.facts import SheetFacts, summarise_survey
from scanplan.exports.sheet.labels import Candidate, LabelSpace
from scanplan.exports.sheet.marks import Word, flatten
from scanplan.exports.sheet.openings import list_symbols
from scanplan.exports.sheet.paper import Slot
from scanplan.exports.sheet.shown import show_measured
from scanplan.exports.sheet.styles import LAYERS, STYLES, Letters, Paper, doubt_layer
from scanplan.plan.floorplan import summarise_floorplan
from scanplan.store import schemas
from scanplan.store.doubts import Doubts, Finding
from scanplan.validation.doubts import find_doubtful_faces, list_doubts

pytestmark = pytest.mark.wording


def turned(drawn, angle_deg):
    """A plan turned in the map."""
    turn = lettering.rotation(angle_deg)

    def turn_ends(columns):
        ends = np.stack([columns[f"{c}{i}_m"] for i in "01" for c in "xy"], axis=1)
        x0, y0, x1, y1 = (ends.reshape(-1, 2) @ turn.T).reshape(-1, 4).T
        return columns | {"x0_m": x0, "y0_m": y0, "x1_m": x1, "y1_m": y1}

    areas = [shapely.transform(area, lambda xy: xy @ turn.T) for area in drawn.areas]
    rooms = floorplan_making.rooms(areas) | {"name": drawn.rooms.get("name", None)}
    if rooms["name"] is None:
        del rooms["name"]
    return replace(
        drawn,
        faces=turn_ends(drawn.faces),
        walls=turn_ends(drawn.walls),
        openings=turn_ends(drawn.openings),
        rooms=rooms,
    )


def crowded(n=9):
    """Rooms of 1.2 m side by side: words have hardly any room."""
    rooms = [
        shapely.box(1.3 * i, 1.3 * j, 1.3 * i + 1.2, 1.3 * j + 1.2)
        for i in range(n)
        for j in range(n)
    ]
    side = 1.3 * n
    lines = [
        ((1.3 * i - 0.05, -0.1, 1.3 * i - 0.05, side), 0.1, 0, 1, "observed") for i in range(n + 1)
    ]
    lines += [
        ((-0.1, 1.3 * j - 0.05, side, 1.3 * j - 0.05), 0.1, 2, 3, "observed") for j in range(n + 1)
    ]
    doors = [
        ((1.3 * i + 0.2, 1.3 * j - 0.05, 1.3 * i + 0.9, 1.3 * j - 0.05), 0, "door", 0.0, 2.0, 0, 1)
        for i in range(n)
        for j in range(n)
    ]
    walls = floorplan_making.walls(lines) | {"verify": np.ones(len(lines), bool)}
    openings = floorplan_making.openings(doors) | {"verify": np.ones(len(doors), bool)}
    return plan(rooms=floorplan_making.rooms(rooms), walls=walls, openings=openings)


PLANS = {
    "house": plan(),
    "turned house": turned(plan(), 27),
    "crowded": crowded(),
    "crowded and turned": turned(crowded(5), -12),
    "bare": bare(),
    "tiny": bare([(0, 0, 0.3, 0, -1)]),
    "huge": bare([(0, 0, 900, 400, -1)]),
    "long name": replace(plan(), name="W" * 300),
}


@pytest.fixture(params=PLANS, scope="module")
def sheet(request):
    return composition.compose_sheet(PLANS[request.param])


def test_no_word_lies_on_another(sheet):
    words = [*composition.paper_words(sheet)]
    boxes = [lettering.word_box(word) for word in words]
    pairs = itertools.combinations(range(len(words)), 2)
    over = [(words[i].text, words[j].text) for i, j in pairs if boxes[i].intersects(boxes[j])]
    assert len(words) > 20 and over == []


def test_a_room_too_narrow_for_its_name_has_its_number_and_area():
    # 0.7 m wide between two walls, 14 mm on paper
    walls = [*floorplan_making.WALLS, ((4.85, 0, 4.85, 3), 0.1, 9, 10, "observed")]
    rooms = floorplan_making.rooms([floorplan_making.ROOMS[0], shapely.box(4.1, 0, 4.8, 3)])
    rooms["name"][1] = "Room of the servers"
    drawn = plan(rooms=rooms, walls=floorplan_making.walls(walls))
    _, narrow = composition.compose_sheet(drawn).stamps
    assert [word.text for word in narrow.words] == ["1", "2.1 m²"]


def test_the_name_of_a_room_keeps_off_furniture_in_its_middle():
    piece = shapely.box(1.9, 1.4, 2.1, 1.6)
    sheet = composition.compose_sheet(plan(furniture=floorplan_making.furniture([piece])))
    outline = sheet.page.place_shape(piece.exterior)
    words = [*composition.paper_words(sheet)]
    named = [word for word in words if word.element == "room-0"]
    assert len(named) == 2
    assert not any(lettering.word_box(word).intersects(outline) for word in named)


def test_every_word_lies_in_the_frame(sheet):
    frame = shapely.box(*sheet.page.inner_mm)
    words = [*composition.paper_words(sheet)]
    assert [word.text for word in words if not lettering.word_box(word).within(frame)] == []


def test_words_have_three_sizes_none_below_the_least_of_the_standard(sheet):
    sizes = {word.size_mm for word in composition.paper_words(sheet)}
    assert sizes <= {Letters.SMALL, Letters.MEDIUM, Letters.LARGE} and min(sizes) >= 1.8


def test_the_plan_lies_above_the_title_block(sheet):
    area = shapely.box(*sheet.page.drawing_mm)
    drawn = [sheet.page.to_paper(path[:, :2]) for mark in sheet.marks for path in mark.paths]
    assert shapely.multipoints(np.concatenate(drawn)).within(area)


def test_paper_and_plan_are_each_other_s_inverse(sheet):
    places_m = np.array([[0.0, 0.0], [3.0, -2.0]])
    np.testing.assert_allclose(sheet.page.to_plan(sheet.page.to_paper(places_m)), places_m)
    (first, other) = sheet.page.to_paper(places_m)
    assert np.hypot(*(other - first)) == pytest.approx(1000 * np.hypot(3, 2) / sheet.page.scale)


@pytest.mark.parametrize(
    ("extent_m", "name", "upright", "scale"),
    [
        # A4 upright: 180 x 277 in the frame, less 66 of tables and 36 around: 144 x 175;
        # A3 has tables beside the title block, 38 high: 390 x 277 less these leave 354 x 203
        ((7.1, 8.7), "A4", True, 50),
        ((17.7, 10.1), "A3", False, 50),
        # too long for that; A3 at 1:75 would be 47 % full, A4 lying is 73 %
        ((17.8, 9.5), "A4", False, 100),
        # upright, A3 has 231 x 326
        ((31, 31), "A3", True, 150),
        # 45 % of A3, but A4 holds it at 1:250 only
        ((54, 20), "A3", False, 200),
        # A2: 528 x 326, and upright 354 x 500
        ((80, 50), "A2", False, 200),
        # A1: 775 x 500, and upright 528 x 747; A0: 1123 x 747
        ((156, 100), "A0", False, 150),
        ((900, 400), "A0", False, 1000),
    ],
)
def test_the_sheet_is_small_and_well_filled_at_a_scale_to_read(extent_m, name, upright, scale):
    page = paper.choose_page(np.zeros(2), np.array(extent_m), 0.0, [6])
    assert (page.name, page.scale) == (name, scale)
    assert (page.size_mm[0] < page.size_mm[1]) == upright


def test_tables_go_beside_a_plan_that_is_drawn_larger_so():
    # 277 mm x 181 at 1:75: on A3 above 15 rows of tables 179 mm are left, above 9 of them 203
    low_m, high_m, blocks = np.zeros(2), np.array([20.8, 13.6]), [6, 8, 8, 15]
    page = paper.choose_page(low_m, high_m, 0.0, blocks)
    assert (page.name, page.scale, page.rows, page.n_beside) == ("A3", 75, 9, 1)
    _, y0, right, y1 = page.drawing_mm
    assert page.inner_mm[2] - right == pytest.approx(62)
    *below, beside = page.slots()
    assert all(slot.y_mm < y0 for slot in below) and right < beside.x_mm
    assert y0 <= beside.y_mm - beside.rows * Paper.ROW and beside.y_mm <= y1 - Paper.ROW
    # what is beside it is whole, and stands there alone
    places = page.place_tables(blocks)
    assert [[(slot.x_mm > right, slot.rows) for slot in parts] for parts in places] == [
        [(False, 6)],
        [(False, 8)],
        [(True, 8)],
        [(True, 15)],
    ]
    # a lower one is as large above them
    lower = paper.choose_page(low_m, np.array([20.8, 12.0]), 0.0, blocks)
    assert (lower.name, lower.scale, lower.n_beside) == ("A3", 75, 0)


@pytest.mark.parametrize(("side_m", "scale"), [(29.0, 250), (35.0, 300)])
def test_two_columns_beside_a_square_plan_draw_it_larger_on_a4(side_m, scale):
    # lying, less two columns and 10 mm around: 125 x 130; upright, less 37 rows: 160 x 106
    blocks = [6, 7, 9, 31]
    page = paper.choose_page(
        np.zeros(2),
        np.full(2, side_m),
        0.0,
        blocks,
        names=("A4",),
        scales=paper.ROUND_SCALES,
        around_mm=Paper.BARE,
    )
    assert (page.scale, page.n_beside, page.rows) == (scale, 2, paper.TITLE_ROWS)
    *_, (notes,), (rooms,) = page.place_tables(blocks)
    assert rooms.x_mm - notes.x_mm == pytest.approx(Paper.COLUMN)
    assert rooms.x_mm + Paper.COLUMN == pytest.approx(page.inner_mm[2])


def test_no_column_stays_empty():
    # as wide as high: beside a column it fills an A3 better
    page = paper.choose_page(np.zeros(2), np.array([36.0, 35.0]), 0.0, [6, 8, 0, 0])
    assert page.n_beside == 0
    page = paper.choose_page(np.zeros(2), np.array([36.0, 35.0]), 0.0, [6, 8, 0, 2])
    assert page.n_beside == 1
    *_, (rooms,) = page.place_tables([6, 8, 0, 2])
    assert rooms.x_mm > page.drawing_mm[2] and rooms.rows == 2


def test_a_plan_beyond_all_usual_scales_fills_the_largest_sheet():
    page = paper.choose_page(np.zeros(2), np.array([900_000, 1]), 0.0, [6])
    assert page.name == "A0" and page.scale == pytest.approx(900_000_000 / (1159 - 36), abs=1)


def test_tables_break_only_where_no_slot_holds_them():
    slots = [Slot(0, 100, 10), Slot(60, 100, 10), Slot(120, 100, 10)]
    # six rows and a head leave two rows: the next block goes to a slot of its own, and on
    first, second = paper.fill_slots(iter(slots), [6, 12])
    assert [(s.x_mm, s.rows) for s in first] == [(0, 6)]
    assert [(s.x_mm, s.rows) for s in second] == [(60, 9), (120, 3)]
    assert paper.fill_slots(iter(slots[:1]), [10]) is None


@pytest.mark.parametrize("n_rooms", range(1, 40))
def test_no_row_of_a_table_stands_alone_unless_the_scale_would_be_smaller(n_rooms):
    blocks = [6, 7, n_rooms]

    def chosen(height_m):
        return paper.choose_page(np.zeros(2), np.array([18.0, height_m]), 0.0, blocks)

    page = chosen(11.0)
    (parts,) = page.place_tables(blocks)[2:]
    assert sum(part.rows for part in parts) == n_rooms
    assert len(parts) == 1 or min(part.rows for part in parts) >= 3
    # as high a plan as the sheet holds with tables as low as can be
    rows = next(
        rows
        for rows in range(paper.TITLE_ROWS, 60)
        if paper.fill_slots(paper.find_slots(page.inner_mm, rows), blocks) is not None
    )
    _, y0, _, y1 = replace(page, rows=rows).drawing_mm
    full_m = (y1 - y0 - Paper.AROUND[1] - Paper.AROUND[3]) / page.mm_per_m
    assert chosen(full_m - 0.01).name == page.name


@given(st.floats(-180, 180))
@settings(max_examples=25, deadline=None)
def test_the_main_direction_follows_the_building(angle_deg):
    found = turned(plan(), angle_deg).main_direction_deg
    assert -45 <= found <= 45
    off = (found - angle_deg) % 90
    assert min(off, 90 - off) == pytest.approx(0, abs=1e-6)


def test_a_plan_is_turned_unless_it_is_not_to_be():
    drawn = turned(plan(), 27)
    assert composition.compose_sheet(drawn).page.turn_deg == pytest.approx(-27)
    straight = composition.compose_sheet(drawn, turn_deg=0.0)
    assert straight.page.turn_deg == 0
    said = [word.text for word in straight.paper_words]
    assert any("not turned" in text for text in said)


@pytest.mark.parametrize(
    ("size_m", "turn_deg", "scale"),
    [
        # at 1:75 it is 270 mm by 209 mm: A3 has about 350 by 200 for it lying, 230 by 320 upright
        ((20.0, 15.5), 90, 75),
        ((15.5, 20.0), 0, 75),
        # either way at one scale
        ((10.0, 9.0), 0, 50),
    ],
)
def test_a_plan_is_turned_by_a_quarter_where_it_is_drawn_larger(size_m, turn_deg, scale):
    width_m, depth_m = size_m
    corners = [(0, 0), (width_m, 0), (width_m, depth_m), (0, depth_m), (0, 0)]
    sides = [(*one, *other) for one, other in itertools.pairwise(corners)]
    walls = floorplan_making.walls([(side, 0.2, 2, 3, "observed") for side in sides])
    page = composition.compose_sheet(replace(bare(), walls=walls)).page
    assert (round(page.turn_deg) % 180, page.scale, page.name) == (turn_deg, scale, "A3")


def test_chains_and_rooms_measure_the_house():
    sheet = composition.compose_sheet(plan())
    measured = sorted({float(d.word.text.removeprefix("~")) for d in sheet.dimensions})
    east_m = max(ends[0] for dimension in sheet.dimensions for ends in dimension.ends_m)
    for dimension in sheet.dimensions:
        line, ends = dimension.line_m, dimension.ends_m
        along = (line[1] - line[0]) / np.hypot(*(line[1] - line[0]))
        stated_m = float(dimension.word.text.removeprefix("~"))
        assert (ends[1] - ends[0]) @ along == pytest.approx(stated_m, abs=0.006)
        # of the wall in the east one side was seen, the thickness of the others is known; that in
        # the north of the small room is to be verified
        is_along_x = abs(along[0]) > abs(along[1])
        ends_in_east = is_along_x and ends[:, 0].max() == pytest.approx(east_m, abs=0.01)
        ends_in_north = ends[:, 1].max() == pytest.approx(3) and ends[0, 0] > 4.1
        assert dimension.word.text.startswith("~") == (ends_in_east or ends_in_north)
    # outside: 7.4 x 3.4 m; the window, 1.2 m wide, begins 1.2 m from the west; the entrance is 1 m
    assert {7.4, 3.4, 1.2, 1.0} <= set(measured)
    # inside: rooms of 4 x 3 and 3 x 3 m
    assert {4.0, 3.0} <= set(measured)


def test_an_oblique_facade_in_pieces_is_one_length():
    # the west side leans by 60 mm a metre, and is traced in three pieces
    corners = [(0, 0), (5, 0), (5, 4), (-0.24, 4), (-0.18, 3), (-0.03, 0.5)]
    drawn = plan(
        walls=floorplan_making.walls([]),
        openings=floorplan_making.openings([]),
        rooms=floorplan_making.rooms([shapely.Polygon(corners)]),
    )
    sheet = composition.compose_sheet(drawn, turn_deg=0.0)
    measured = [d.word.text for d in sheet.dimensions if d.line_m[:, 0].max() < -0.3]
    # no wall stands there
    assert measured == ["~4.00"]


def test_what_lies_behind_an_oblique_facade_is_not_measured_from_there():
    # a recess in the south, whose west side faces the corner that is cut off in the east
    corners = [(0, 0), (4, 0), (4, 0.8), (5, 0.8), (5, 0), (9, 0), (10, 1), (10, 5), (0, 5)]
    drawn = plan(
        walls=floorplan_making.walls([]),
        openings=floorplan_making.openings([]),
        rooms=floorplan_making.rooms([shapely.Polygon(corners)]),
    )
    sheet = composition.compose_sheet(drawn, turn_deg=0.0)
    east = [d.ends_m for d in sheet.dimensions if d.line_m[:, 0].min() > 10.01]
    assert len(east) == 2 and np.array(east)[..., 0].min() == pytest.approx(10.0)


def test_what_lies_before_an_oblique_facade_is_measured():
    # the side rises to the east, and a hut of 3 m stands before its higher end
    outlines = [shapely.Polygon([(0, 0), (12, 12), (0, 12)]), shapely.box(9, 6.5, 12, 8)]
    drawn = plan(
        walls=floorplan_making.walls([]),
        openings=floorplan_making.openings([]),
        rooms=floorplan_making.rooms(outlines),
    )
    sheet = composition.compose_sheet(drawn, turn_deg=0.0)
    lengths = [
        d.word.text.removeprefix("~") for d in sheet.dimensions if d.line_m[:, 1].max() < -0.01
    ]
    south = [float(length) for length in lengths]
    assert 3.0 in south


def test_chains_end_at_faces_where_corners_stray_from_them():
    """The west's upper corner is 12 mm off its face, the lower one of the step 9 mm."""
    corners = [(0, 0), (4.009, 0), (4, 0.01), (4, 3), (0, 3), (-0.012, 2.998), (0, 2.99)]
    west, east = shapely.Polygon(corners), shapely.box(4, 1, 7, 3)
    drawn = plan(
        walls=floorplan_making.walls([]),
        openings=floorplan_making.openings([]),
        rooms=floorplan_making.rooms([west, east]),
    )
    sheet = composition.compose_sheet(drawn)
    south = [d.ends_m[:, 0] for d in sheet.dimensions if d.line_m[:, 1].max() < -0.2]
    expected_m = [[0, 4], [0, 7], [4, 7]]
    np.testing.assert_allclose(sorted(x.tolist() for x in south), expected_m, atol=0.001)


def test_a_length_to_an_outline_that_was_not_seen_is_about_so_long():
    """The small room's north side was not seen, nor its east side north of 1.5 m."""
    north = ((4.1, 3, 7.1, 3), -1, "unseen", np.nan, np.nan, 1, -1)
    east = ((7.1, 1.5, 7.1, 3), -1, "unseen", np.nan, np.nan, 1, -1)

    def said(unseen, verify=()):
        walls = floorplan_making.walls()
        walls["verify"] = np.isin(walls["wall"], verify)
        drawn = plan(unseen=floorplan_making.openings(unseen), walls=walls)
        sheet = composition.compose_sheet(drawn)
        room = floorplan_making.ROOMS[1].buffer(0.01)
        inside = [d for d in sheet.dimensions if room.covers(shapely.LineString(d.line_m))]
        return sorted(dimension.word.text for dimension in inside)

    assert said([]) == ["3.00", "3.00"]
    # likewise the wall in its north is to be verified, or that in its east
    assert said([], [2]) == said([], [1]) == ["3.00", "~3.00"]
    # its width is measured where it is known
    assert said([north, east]) == ["3.00", "~3.00"]
    whole = ((7.1, 0, 7.1, 3), *east[1:])
    assert said([north, whole]) == ["~3.00", "~3.00"]


def test_a_chain_that_ends_at_an_outline_that_was_not_seen_is_about_so_long():
    """The west side of 3.4 m was not seen, or from 0.6 or 2 m above its corner on."""
    west, above_corner, upper_half = (
        ((-0.2, y, -0.2, 3.2), -1, "unseen", np.nan, np.nan, 0, -1) for y in (-0.2, 0.4, 1.8)
    )
    below = ((-0.2, -0.2, 7.2, -0.2), *west[1:])

    def count(unseen):
        sheet = composition.compose_sheet(plan(unseen=floorplan_making.openings(unseen)))
        south = [d for d in sheet.dimensions if np.ptp(d.line_m[:, 1]) < 0.01]
        first = [d for d in south if d.ends_m[:, 0].min() == pytest.approx(-0.2, abs=0.01)]
        return {d.word.text for d in first if d.line_m[0, 1] < -0.2}

    assert count([]) == count([below]) == count([upper_half]) == {"1.20", "~7.40"}
    assert count([west]) == count([above_corner]) == {"~1.20", "~7.40"}


def test_a_step_of_a_facade_that_was_not_seen_is_about_where_it_is():
    """The second room is a metre shallower; of the first only the side beside it was not seen."""
    rooms = [shapely.box(0, 0, 4, 3), shapely.box(4, 1, 7, 3)]
    step = ((4, 0, 4, 1), -1, "unseen", np.nan, np.nan, 0, -1)
    corners = [(0, 0), (4, 0), (4, 1), (7, 1), (7, 3), (0, 3), (0, 0)]
    sides = [(*one, *other, -1) for one, other in itertools.pairwise(corners)]

    def south(unseen, faces=sides):
        sheet = composition.compose_sheet(
            plan(
                faces=floorplan_making.faces(faces),
                walls=floorplan_making.walls([]),
                openings=floorplan_making.openings([]),
                unseen=floorplan_making.openings(unseen),
                rooms=floorplan_making.rooms(rooms),
            )
        )
        return sorted(d.word.text for d in sheet.dimensions if d.line_m[:, 1].max() < -0.2)

    assert south([]) == ["3.00", "4.00", "7.00"]
    assert south([step]) == ["7.00", "~3.00", "~4.00"]
    # nothing was found at the side in the east, or at that and the others that are upright
    assert south([], [*sides[:3], *sides[4:]]) == ["4.00", "~3.00", "~7.00"]
    assert south([], sides[::2]) == ["~3.00", "~4.00", "~7.00"]


def test_a_chain_that_ends_at_a_tip_that_was_not_seen_is_about_so_long():
    """A room open to the east, where two outlines that were not seen run to a tip."""
    corners = [(0, 0), (4, 0), (7, 1.5), (4, 3), (0, 3), (0, 0)]
    sides = [(*one, *other) for one, other in itertools.pairwise(corners)]
    seen = [(*side, -1) for side in sides]

    def south(n_unseen):
        unseen = [(side, -1, "unseen", np.nan, np.nan, 0, -1) for side in sides[1 : 1 + n_unseen]]
        drawn = plan(
            faces=floorplan_making.faces(seen),
            walls=floorplan_making.walls([]),
            openings=floorplan_making.openings([]),
            unseen=floorplan_making.openings(unseen),
            rooms=floorplan_making.rooms([shapely.Polygon(corners)]),
        )
        sheet = composition.compose_sheet(drawn, turn_deg=0.0)
        return {d.word.text for d in sheet.dimensions if d.line_m[:, 1].max() < -0.2}

    assert "7.00" in south(0) and "~7.00" in south(2)


@pytest.mark.parametrize("depth_m", [0.3, 0.8, 1.2])
def test_rooms_may_be_shallow(depth_m):
    closet = shapely.box(4.1, 0, 7.1, depth_m)
    drawn = plan(rooms=floorplan_making.rooms([floorplan_making.ROOMS[0], closet]))
    assert len(composition.compose_sheet(drawn).stamps) == 2


def test_a_small_doubtful_room_is_doubtful_on_the_sheet():
    drawn = crowded()
    rooms = drawn.rooms | {"closed": np.zeros(len(drawn.areas), bool)}
    stamps = composition.compose_sheet(replace(drawn, rooms=rooms)).stamps
    labels = [stamp.words[0].text for stamp in stamps if stamp.words]
    assert any(len(label) <= 4 for label in labels)
    assert all(label.endswith(" ?") for label in labels)


def test_walls_that_stand_apart_from_all_rooms_are_not_measured_with_the_building():
    stub = ((9.0, -2.0, 9.0, -1.0), 0.2, -1, -1, "observed")
    walls = floorplan_making.walls([*floorplan_making.WALLS, stub])
    house, with_stub = (composition.compose_sheet(p) for p in (plan(), plan(walls=walls)))

    def texts(sheet):
        return sorted(dimension.word.text for dimension in sheet.dimensions)

    assert texts(with_stub) == texts(house)
    # chains keep off it all the same
    lines = [shapely.LineString(d.line_m) for d in with_stub.dimensions]
    assert min(line.distance(shapely.box(8.9, -2, 9.1, -1)) for line in lines) > 0.1


def test_without_rooms_all_walls_are_measured():
    stub = ((9.0, -2.0, 9.0, -1.0), 0.2, -1, -1, "observed")
    walls = floorplan_making.walls([*floorplan_making.WALLS, stub])
    drawn = plan(walls=walls, rooms=floorplan_making.rooms([]))
    texts = {dimension.word.text for dimension in composition.compose_sheet(drawn).dimensions}
    assert "9.30" in texts


def test_what_a_chain_states_is_not_written_again():
    sheet = composition.compose_sheet(plan())
    widths = [word.text for word in sheet.words if word.kind == "width"]
    assert widths == ["0.90"]


def test_an_opening_in_an_assumed_wall_lies_in_its_middle():
    east = ((7.1, 1.0, 7.1, 2.0), 1, "window", 0.9, 2.1, 1, -1)
    drawn = plan(openings=floorplan_making.openings([east]))
    (window,) = list_symbols(drawn)
    # seen from the west, the wall is assumed 0.1 m thick behind x = 7.1
    np.testing.assert_allclose(window.ends_m[:, 0], 7.15)
    assert window.thickness_m == pytest.approx(0.1)
    assert drawn.assumed.bounds[0] == pytest.approx(7.1, abs=1e-3)


def test_doors_swing_as_their_leaves_stand_in_walls_of_any_drawing():
    # door 0 is 0.9 m wide in the middle of a wall of 0.1 m
    (x, y0), (_, y1) = list_symbols(plan())[0].ends_m
    stands = shapely.box(x, y0 - 0.02, x + y1 - y0, y0 + 0.02)
    leaf = floorplan_making.furniture([stands], "leaf")
    assert [symbol.kind for symbol in list_symbols(plan())[:2]] == ["door", "door"]
    swung, other = list_symbols(plan(furniture=leaf))[:2]
    assert (swung.kind, other.kind) == ("swing", "door")
    drawn = np.concatenate([flatten(path) for path in symbols.symbol_paths(swung)])
    assert drawn[:, 0].max() == pytest.approx(x + swung.thickness_m / 2 + y1 - y0)


def test_doubt_is_marked_told_and_on_layers_of_its_own():
    openings = floorplan_making.openings() | {
        "verify": np.array([True, False, False]),
        "doubt": np.array(["few rays", "", ""], object),
    }
    sheet = composition.compose_sheet(plan(openings=openings))
    doors = [symbol for symbol in sheet.symbols if symbol.verify]
    assert [door.facts["doubt"] for door in doors] == ["few rays"]
    doubted = [mark.element for mark in composition.paper_marks(sheet) if mark.kind == "verify"]
    assert {"verify-door-0", "verify-wall-2"} <= set(doubted)
    said = [word.text for word in composition.paper_words(sheet)]
    assert sum(text.endswith("?") for text in said) >= 2
    assert any("doubtful" in text for text in said)
    assert {doubt_layer(STYLES[kind].layer) for kind in ("wall", "door", "window", "room")} == {
        "A-WALL-VRFY", "A-DOOR-VRFY", "A-GLAZ-VRFY", "A-AREA-VRFY"
    }  # fmt: skip


def test_a_doubtful_face_is_drawn_and_counted_unless_its_wall_is():
    faces = floorplan_making.faces()
    # the loose one, and a side of wall 2, which is doubtful itself
    faces["verify"] = np.isin(faces["face"], [2, 8])
    doubted = plan(faces=faces)
    sheet = composition.compose_sheet(doubted)
    drawn = [mark.element for mark in composition.paper_marks(sheet) if mark.kind == "verify"]
    assert [name for name in drawn if "face" in name] == ["verify-face-8"]
    said = [word.text for word in composition.paper_words(sheet)]
    assert said[said.index("To verify on site") + 1] == str(len(list_doubts(doubted)))


def test_who_corrected_on_site_stands_in_the_title_block():
    by = [word.text for word in composition.paper_words(composition.compose_sheet(plan()))]
    assert "Corrected on site by" not in by
    sheet = composition.compose_sheet(plan(corrected_by="A. Bee, 2026-03-01"))
    said = [word.text for word in composition.paper_words(sheet)]
    assert said[said.index("Corrected on site by") + 1] == "A. Bee, 2026-03-01"


def test_the_sides_of_a_wall_that_a_person_kept_are_in_no_doubt():
    faces = floorplan_making.faces()
    faces["verify"] = faces["wall"] == 5
    walls = floorplan_making.walls()
    assert len(find_doubtful_faces(plan(faces=faces, walls=walls))) == 2
    walls["corrected"] = np.where(walls["wall"] == 5, "kept", "").astype(object)
    is_judged = walls["verify"].copy()
    assert len(find_doubtful_faces(plan(faces=faces, walls=walls))) == 0
    np.testing.assert_array_equal(walls["verify"], is_judged)


def test_a_passage_in_no_wall_is_drawn_as_what_is_inferred():
    through = ((4.05, 1, 4.05, 2), -1, "passage", np.nan, np.nan, 0, 1)
    in_wall = (*through[:1], 4, *through[2:])
    leads_out = (*through[:-1], -1)
    for opening, kind in ((through, "parting"), (in_wall, "passage"), (leads_out, "passage")):
        drawn = plan(openings=floorplan_making.openings([opening]))
        sheet = composition.compose_sheet(drawn)
        (symbol,) = sheet.symbols
        assert (symbol.kind, symbol.element) == (kind, "passage-0")
        for said in (show_measured(drawn).contents, summarise_floorplan(drawn)):
            assert ("passage" in said) == (kind == "passage")
        assert any(mark.element == f"legend-{kind}" for mark in sheet.paper_marks)


def test_what_was_not_seen_of_a_room_is_dotted():
    unseen = floorplan_making.openings([((10, 0, 10, 2), -1, "unseen", np.nan, np.nan, 1, -1)])
    (blank,) = content.draw_unseen(plan(unseen=unseen))
    assert shapely.LineString(blank.paths[0][:, :2]).length == 2


def test_floor_of_a_room_that_was_not_seen_is_shown_but_for_what_stands_there():
    """Of the second room the last metre of three; a cupboard takes 2 m of it, a sliver is left."""
    sheet = composition.compose_sheet(plan())
    (hidden,) = [mark for mark in sheet.marks if mark.kind == "hidden"]
    assert shapely.Polygon(hidden.paths[0][:, :2]).equals(shapely.box(4.1, 2, 7.1, 3))
    assert hidden.title == "not seen, 3.0 m²"
    assert any("ground not seen by the scans used" in word.text for word in sheet.paper_words)
    row = floorplan_making.furniture([shapely.box(4.1, 2, 6.1, 3), shapely.box(6.1, 2, 7.1, 2.85)])
    assert len(plan(furniture=row).hidden_floor) == 0
    (left,) = plan(furniture={name: values[:1] for name, values in row.items()}).hidden_floor
    assert left.area == pytest.approx(1)


def test_unseen_ground_that_the_building_encloses_is_shown_as_what_is_around_it_is_not():
    """A corridor around 4 m x 4 m, into which rays went for 1 m."""
    corridor = shapely.box(0, 0, 8, 8) - shapely.box(2, 2, 6, 6)
    drawn = plan(
        walls=floorplan_making.walls([]),
        openings=floorplan_making.openings([]),
        rooms=floorplan_making.rooms([corridor]),
        free=floorplan_making.free([corridor, shapely.box(2, 2, 3, 6)]),
    )
    (hidden,) = [mark for mark in composition.compose_sheet(drawn).marks if mark.kind == "hidden"]
    assert shapely.Polygon(hidden.paths[0][:, :2]).equals(shapely.box(3, 2, 6, 6))


def test_furniture_is_a_thin_outline_on_a_layer_of_its_own_with_its_evidence():
    sheet = composition.compose_sheet(plan(furniture=floorplan_making.furniture()))
    (piece,) = [mark for mark in sheet.marks if mark.kind == "furniture"]
    assert STYLES[piece.kind].layer == "A-FURN" and piece.element == "furniture-0"
    assert shapely.Polygon(piece.paths[0][:, :2]).area == pytest.approx(0.5)
    assert (piece.facts["z_max_m"], piece.facts["n_scans"]) == (0.9, 2)
    assert any("furniture" in word.text for word in sheet.paper_words)


def test_a_column_is_cut_like_a_wall_on_a_layer_of_its_own():
    columns = floorplan_making.furniture(kind="column")
    sheet = composition.compose_sheet(plan(furniture=columns))
    (column,) = [mark for mark in sheet.marks if mark.kind == "column"]
    assert STYLES["column"].layer == "A-COLS" and column.element == "column-0"
    assert STYLES["column"].fill == STYLES["wall"].fill
    assert "column" in legend_kinds(sheet)


@pytest.mark.parametrize("kind", [schemas.PIECE, schemas.COLUMN, schemas.LEAF])
def test_whatever_stands_in_a_room_is_drawn_and_in_the_legend(kind):
    sheet = composition.compose_sheet(plan(furniture=floorplan_making.furniture(kind=kind)))
    assert kind in {mark.kind for mark in composition.paper_marks(sheet)}
    assert kind in legend_kinds(sheet)


def test_the_title_block_states_the_survey():
    facts = SheetFacts("Town hall", "First floor", "2024-05-06", 12, "scanplan 1")
    rooms = floorplan_making.rooms() | {"name": np.array(["Foyer", ""], object)}
    said = [word.text for word in composition.compose_sheet(plan(rooms=rooms), facts).paper_words]
    assert {"Town hall", "First floor", "2024-05-06", "12 scans", "scanplan 1"} <= set(said)
    # 2 mm of offset are 3.9 mm of 95 %
    assert "LOA40: walls ± 3.9 mm (95 %), of which the sensor ± 0.0 mm" in said
    assert any(word.startswith("a plan: 2 of 2 rooms are closed") for word in said)
    assert {"Foyer", "Room 1", "12.0", "9.0", "14.00"} <= set(said)


def test_people_stand_in_a_row_of_the_title_block_and_no_words_on_others():
    facts = SheetFacts("Town hall", author="A. Bee", organisation="Bee & Partners")
    drawn = plan(corrected_by="C. Dee, 2026-03-01")
    page_words = composition.compose_sheet(drawn, facts).paper_words
    words = [word for word in page_words if word.element.startswith("title:")]
    said = {word.element.removeprefix("title:"): word.text for word in words}
    assert (said["AUTHOR"], said["ORGANISATION"]) == ("A. Bee", "Bee & Partners")
    assert said["CORRECTED_ON_SITE_BY"] == "C. Dee, 2026-03-01"
    levels = sorted({round(float(word.place[1]), 3) for word in words})
    assert np.diff(levels).min() >= Letters.SMALL


def test_a_long_value_of_the_title_block_is_written_on_two_lines():
    version = "scanplan, code 0123456789ab"
    doubted = Doubts(damage=("cut off",))
    sheet = composition.compose_sheet(plan(doubted=doubted), SheetFacts(version=version))
    values = {word.element: word for word in sheet.paper_words if word.element.startswith("title:")}
    software = values["title:SOFTWARE"], values["title:SOFTWARE_2"]
    assert " ".join(word.text for word in software) == version
    assert software[0].place[1] > software[1].place[1]
    assert not any(word.text.endswith("…") for word in values.values())


@pytest.mark.parametrize("author", ["", "A. Bee"])
def test_two_lines_of_the_title_block_keep_off_its_rules(author):
    version, surveyed = "scanplan, code 0123456789ab", "2026-02-17 to 2026-02-18, in two visits"
    drawn = plan(doubted=Doubts(damage=("cut off",)))
    facts = SheetFacts(version=version, surveyed=surveyed, author=author)
    sheet = composition.compose_sheet(drawn, facts)
    values = [word for word in sheet.paper_words if word.element.startswith("title:")]
    assert {"title:SOFTWARE_2", "title:DATE_OF_SURVEY_2"} <= {word.element for word in values}
    rules = [mark.paths[0][:, :2] for mark in sheet.paper_marks if mark.kind == "dimension"]
    levels = np.array([rule[0, 1] for rule in rules if np.ptp(rule[:, 0]) == pytest.approx(180)])
    y0 = sheet.page.inner_mm[1]
    levels = np.append(levels, y0 + STYLES["frame"].width_mm / 2)
    for word in values:
        if word.size_mm == Letters.SMALL:
            # the tails of letters hang a quarter of their height below the line
            top, low = word.place[1] + 0.9, word.place[1] - 0.9 - 0.45
            assert np.abs(levels - top).min() > 0.25 and np.abs(levels - low).min() > 0.25
            assert not ((low < levels) & (levels < top)).any()


@pytest.mark.parametrize(
    ("sigma_m", "name"), [(0.0005, "LOA50"), (0.003, "LOA30"), (0.02, "LOA20"), (0.1, "LOA10")]
)
def test_accuracy_is_the_class_that_holds_95_percent(sigma_m, name):
    walls = floorplan_making.walls() | {"sigma_offset_m": np.full(6, sigma_m)}
    assert accuracy.state_accuracy(plan(walls=walls)).startswith(name)


def test_what_the_sensor_is_off_by_is_in_the_accuracy():
    """1 mm of a wall, 3 mm of all ranges, and 4 mm of scale over half of 8 m: 10 mm of 95 %."""
    walls = floorplan_making.walls()
    reach_m = np.ptp(np.concatenate([walls["x0_m"], walls["x1_m"]])) / 2
    walls |= {"sigma_offset_m": np.full(6, 0.001)}
    sensor = accuracy.SensorErrors(0.003, 0.004 / reach_m)
    said = accuracy.state_accuracy(plan(walls=walls), sensor)
    assert said == "LOA30: walls ± 10.0 mm (95 %), of which the sensor ± 9.8 mm"


def test_no_accuracy_is_stated_of_what_is_mostly_in_doubt():
    walls = floorplan_making.walls() | {"verify": np.ones(6, bool)}
    assert "most of the walls are to be verified" in accuracy.state_accuracy(plan(walls=walls))
    jump = Finding("map jump", 2.0, "it jumps", "carried", "cut")
    folded = plan(doubted=Doubts(findings=(jump,)))
    assert accuracy.state_accuracy(folded) == "none stated of what is no plan"
    opened = floorplan_making.rooms() | {"closed": np.zeros(2, bool)}
    assert accuracy.state_accuracy(plan(rooms=opened)) == "none stated of a sketch"


@pytest.mark.parametrize("remedy", ["cut it", "cut it " * 60])
def test_the_verdict_on_a_sheet_is_whole_and_has_its_remedy_if_there_is_room(remedy):
    jump = Finding("map jump", 2.0, "it jumps", "the robot was carried", remedy)
    sheet = composition.compose_sheet(plan(doubted=Doubts(findings=(jump,))))
    words = [w.text for w in sheet.paper_words if w.element.startswith("title:VERDICT")]
    said = " ".join(words)
    assert said.startswith("not a plan: the map jumps") and "…" not in said
    assert said.endswith("cut it" if len(remedy) < 20 else "see summary.txt")


def test_what_else_was_found_is_counted_on_the_sheet():
    jump = Finding("map jump", 2.0, "it jumps", "carried", "cut")
    apart = Finding("days apart", 2.0, "days apart", "two states", "part them")

    def said(*findings):
        sheet = composition.compose_sheet(plan(doubted=Doubts(findings=findings)))
        words = [w.text for w in sheet.paper_words if w.element.startswith("title:VERDICT")]
        return " ".join(words)

    assert said(jump, apart).endswith("cut (1 more in summary.txt)")
    assert said(apart).endswith("100% of the floor (1 more in summary.txt)")
    assert said().endswith("100% of the floor")


def test_accuracy_without_sigmas_is_not_known():
    walls = floorplan_making.walls() | {"sigma_offset_m": np.full(6, np.nan)}
    assert accuracy.state_accuracy(plan(walls=walls)) == "not known"


def test_texts_are_one_line_and_cut_where_they_are_too_long():
    assert lettering.clean_text(" a\nb\t\x00c\u2028d ") == "a b c d"
    cut = lettering.shorten_text("W" * 50, 1.8, 20.0)
    assert cut.endswith("…") and lettering.measure_width_mm(cut, 1.8) <= 20
    assert lettering.shorten_text("short", 1.8, 20.0) == "short"


def test_a_text_is_broken_between_words_once():
    assert lettering.wrap_text("as short\nas this", 1.8, 40.0) == ["as short as this"]
    wide_mm = lettering.measure_width_mm("one two", 1.8)
    assert lettering.wrap_text("one two three", 1.8, wide_mm) == ["one two", "three"]
    first, second = lettering.wrap_text("one two " * 5, 1.8, wide_mm)
    assert first == "one two" and second.endswith("…")
    named_mm = lettering.measure_width_mm("first_floor_nor", 1.8)
    assert lettering.wrap_text("first_floor_north", 1.8, named_mm) == ["first_floor_", "north"]
    (cut,) = lettering.wrap_text("W" * 50, 1.8, 20.0)
    assert cut.endswith("…")


@given(st.text(st.sampled_from("AVTW.,i '’\n+"), max_size=40), st.floats(0.1, 30))
def test_no_letter_more_would_have_fitted(text, width_mm):
    def is_short(words):
        return lettering.measure_width_mm(words, 1.8) <= width_mm

    text = lettering.clean_text(text)
    words = text.split()
    fitting = [n for n in range(1, len(words) + 1) if is_short(" ".join(words[:n]))]
    first = " ".join(words[: max(fitting, default=0)])
    rest = text.removeprefix(first).strip()
    kept = [n for n in range(len(rest) + 1) if is_short(f"{rest[:n]}…")]
    cut = rest if is_short(rest) else f"{rest[: max(kept, default=0)].rstrip()}…"
    assert lettering.wrap_text(text, 1.8, width_mm) == ([first] if first else []) + (
        [cut] if rest or not first else []
    )


@pytest.mark.parametrize("text", ["W" * 100_000, "a word " * 20_000])
def test_of_an_endless_text_only_what_fits_is_measured(monkeypatch, text):
    measured = []
    monkeypatch.setattr(
        lettering, "measure_width_mm", lambda text, _: measured.append(text) or len(text)
    )
    assert all(len(line) <= 40 for line in lettering.wrap_text(text, 1.8, 40.0))
    assert sum(map(len, measured)) < 2_000


def test_every_style_has_a_layer_and_walls_are_drawn_over_rooms():
    assert {style.layer for style in STYLES.values()} <= set(LAYERS)
    order = list(STYLES)
    assert order.index("room") < order.index("assumed") < order.index("wall")


def test_without_a_ceiling_the_table_of_rooms_states_how_high_walls_were_seen():
    def stated(drawn):
        sheet = composition.compose_sheet(drawn)
        heights = [stamp.facts["HEIGHT"] for stamp in sheet.stamps]
        return heights, {word.text for word in sheet.paper_words}

    facts, words = stated(plan(floor_z_m=0.0))
    assert facts == ["at least 2.50 m"] * 2 and "min. 2.50" in words
    facts, words = stated(plan(floor_z_m=0.0, ceiling_z_m=2.6))
    assert facts == ["2.60 m"] * 2 and "2.60" in words
    # of a planar scanner no height is known, and no column is empty
    flat = floorplan_making.walls() | {"z_max_m": np.full(len(floorplan_making.WALLS), 0.2)}
    facts, words = stated(plan(floor_z_m=0.0, walls=flat))
    assert facts == ["not seen"] * 2 and words.isdisjoint({"-", "Height m"}) and "Perim. m" in words


def test_no_date_is_stated_of_a_clock_that_nobody_set():
    evidence = floorplan_making.evidence()
    surveyed = summarise_survey(evidence | {"t_ns": evidence["t_ns"] + 1_554_107_481 * 10**9})
    assert surveyed.surveyed == "2019-04-01"
    unset = summarise_survey(evidence | {"t_ns": evidence["t_ns"] + 10**18})
    assert unset.surveyed == "not known, clock not set"
    words = {word.text for word in composition.compose_sheet(plan(), unset).paper_words}
    assert "not known, clock not set" in words


def test_furniture_smaller_than_a_letter_is_not_drawn():
    piece, speck = shapely.box(1, 1, 1.5, 1.5), shapely.box(2, 2, 2.02, 2.02)
    sheet = composition.compose_sheet(plan(furniture=floorplan_making.furniture([piece, speck])))
    assert 0.02 * sheet.page.mm_per_m < Letters.SMALL < 0.5 * sheet.page.mm_per_m
    drawn = [mark.element for mark in sheet.marks if mark.kind == "furniture"]
    assert drawn == ["furniture-0"]
    assert "furniture" in legend_kinds(sheet)
    only_speck = composition.compose_sheet(plan(furniture=floorplan_making.furniture([speck])))
    assert "furniture" not in legend_kinds(only_speck)


def legend_kinds(sheet):
    return {mark.kind for mark in sheet.paper_marks if mark.element.startswith("legend-")}


def test_a_dimension_goes_where_it_crosses_no_door_though_its_words_lie_on_a_line():
    door = shapely.LineString([(20, 0), (20, 30)])
    other = shapely.LineString([(0, 80), (60, 80)])
    space = LabelSpace((0, 0, 100, 100), [], [door, other])

    def measured(y_mm):
        line = np.array([[10.0, y_mm], [50.0, y_mm]])
        word = Word("dimension", "4.00", np.array([35.0, y_mm + 1.5]), Letters.SMALL)
        return Candidate([word], 0.0, (line,))

    chosen = space.place([measured(10.0), measured(79.0)])
    assert chosen.words[0].place[1] == 80.5


def test_a_word_lies_on_a_dimension_line_only_where_there_is_no_other_place():
    space = LabelSpace((0, 0, 100, 100), [], [])
    space.add_lines([np.array([[50.0, 0.0], [50.0, 100.0]])])
    on, off = (Word("dimension", "1.20", np.array([x, 40.0]), 1.8) for x in (50.0, 60.0))
    chosen = space.place([Candidate([on]), Candidate([off], 4.0)])
    assert chosen is not None and chosen.words == [off]
    again = space.place([Candidate([on]), Candidate([off], 4.0)])
    assert again is not None and again.words == [on]
