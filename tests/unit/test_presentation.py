"""The regular drawing on its sheet: what is drawn, dimensioned and said."""

import io
from collections import Counter
from dataclasses import replace

import ezdxf
import numpy as np
import pytest
import shapely

from helpers import floorplan_making, quarter_disc
from scanplan.exports import dxf
from scanplan.exports.drafting.facades import find_facades
from scanplan.exports.drafting.presentation import compose_overview, compose_presentation
from scanplan.exports.drafting.regular_plan import DraftSettings, draft_plan
from scanplan.exports.sheet.composition import compose_sheet, paper_words
from scanplan.exports.sheet.lettering import measure_width_mm
from scanplan.exports.sheet.locale import Locale
from scanplan.exports.sheet.marks import Word
from scanplan.exports.sheet.paper import Slot
from scanplan.exports.sheet.styles import STYLES, Letters
from scanplan.exports.sheet.title import draw_room_table
from scanplan.geometry.arcs import trace_arc
from scanplan.plan.floorplan import centrelines_m
from scanplan.store import schemas
from scanplan.validation import confidence

SETTINGS = DraftSettings(0.05, (0.1, 0.2), (0.9, 1.0), (1.2,), 0.3)


def composed(**tables):
    measured = floorplan_making.plan(**tables)
    regular, drafted = draft_plan(measured, SETTINGS)
    return compose_presentation(measured, regular, drafted)


def ground(sheet, kind):
    """The area of the marks of a kind, holes left out."""
    return shapely.union_all(
        [
            shapely.Polygon(mark.paths[0][:, :2], [path[:, :2] for path in mark.paths[1:]])
            for mark in sheet.marks
            if mark.kind == kind
        ]
    )


def test_walls_are_solid_with_openings_cut_out_and_rooms_left_free():
    # 7.6 x 3.4 m around, the east wall 0.3 m thick, less rooms; less two doors and a window
    expected_m2 = 7.6 * 3.4 - 12 - 9 - 0.2 * 1.0 - 0.1 * 0.9 - 0.2 * 1.2
    assert ground(composed(), "poche").area == pytest.approx(expected_m2, abs=1e-6)


@pytest.mark.parametrize(("wall", "is_outline"), [(5, True), (1, False)], ids=["within", "facade"])
def test_what_may_be_furniture_is_an_outline_but_the_facade(wall, is_outline):
    walls = floorplan_making.walls()
    walls["about"] = np.full(6, "", object)
    walls["verify"][wall], walls["about"][wall] = True, confidence.KIND
    sheet = composed(walls=walls)
    place = shapely.Point(4.05, 0.5) if wall == 5 else shapely.Point(7.2, 1.5)
    assert ground(sheet, "perhaps").intersects(place) == is_outline
    assert ground(sheet, "poche").intersects(place) != is_outline
    assert ground(sheet, "perhaps").area < 0.3 and ground(sheet, "poche").area > 4
    meaning = STYLES["perhaps"].meaning
    assert (meaning in [word.text for word in paper_words(sheet)]) == is_outline


@pytest.mark.wording
def test_contents_are_counted_of_what_a_drawing_draws():
    """A door in no wall, off all rooms, is on the measured sheet alone; a gap is a passage else."""
    door = ((1.0, 6.0, 1.9, 6.0), -1, "door", np.nan, np.nan, -1, -1)
    gap = ((5.0, 0.0, 5.8, 0.0), 0, "gap", np.nan, np.nan, 1, -1)
    openings = floorplan_making.openings([*floorplan_making.OPENINGS, door, gap])
    measured = floorplan_making.plan(openings=openings)
    regular, drafted = draft_plan(measured, SETTINGS)
    sheets = compose_sheet(measured), compose_presentation(measured, regular, drafted)
    counts = [{"door": 3, "window": 1, "gap": 1}, {"door": 2, "window": 1, "passage": 1}]
    for sheet, drawn in zip(sheets, counts, strict=True):
        assert Counter(symbol.kind for symbol in sheet.symbols) == drawn
        (said,) = (word.text for word in sheet.paper_words if word.element == "title:CONTENTS")
        stated = {
            part.split()[-1].removesuffix("s"): int(part.split()[0]) for part in said.split(",")
        }
        assert stated == {"wall": 6, "room": 2, **drawn}


def test_a_line_that_parts_rooms_at_one_edge_is_drawn():
    halves = [shapely.box(0, 0, 2, 3), shapely.box(2, 0, 4, 3), floorplan_making.ROOMS[1]]
    line = ((2.0, 0.0, 2.0, 3.0), -1, "passage", np.nan, np.nan, 0, 1)
    openings = floorplan_making.openings([*floorplan_making.OPENINGS, line])
    sheet = composed(rooms=floorplan_making.rooms(halves), openings=openings)
    drawn = [symbol.ends_m for symbol in sheet.symbols if symbol.kind == "parting"]
    assert len(drawn) == 1 and np.hypot(*(drawn[0][1] - drawn[0][0])) == pytest.approx(3.0)


def test_overall_lengths_reach_to_the_outer_side_of_thick_walls():
    walls = [*floorplan_making.WALLS]
    walls[4] = ((-0.3, 3.1, -0.3, -0.1), 0.6, 4, -1, "observed")
    sheet = composed(walls=floorplan_making.walls(walls))
    assert "7.70" in {dimension.word.text for dimension in sheet.dimensions}


def test_walls_are_as_black_in_cad_as_on_paper():
    document = ezdxf.filemanagement.read(io.StringIO(dxf.format_dxf(composed())))
    assert {hatch.dxf.color for hatch in document.modelspace().query("HATCH")} == {7}


def test_walls_are_straight_where_outlines_of_rooms_waver_by_a_millimetre():
    wavering = [(0, 0), (1.5, 0), (1.51, -0.001), (2.5, -0.001), (2.5, 0), (4, 0), (4, 3), (0, 3)]
    rooms = floorplan_making.rooms([shapely.Polygon(wavering), floorplan_making.ROOMS[1]])
    n_corners = [
        shapely.get_num_coordinates(ground(sheet, "poche"))
        for sheet in (composed(), composed(rooms=rooms))
    ]
    assert n_corners[1] == n_corners[0]


def test_columns_are_solid_and_furniture_is_not_drawn():
    column = floorplan_making.furniture([shapely.box(1, 1, 1.3, 1.3)], schemas.COLUMN)
    sheet = composed(furniture=column)
    assert ground(sheet, "post").equals(shapely.box(1, 1, 1.3, 1.3))
    document = ezdxf.filemanagement.read(io.StringIO(dxf.format_dxf(sheet)))
    drawn = document.modelspace().query('*[layer=="A-COLS"]')
    assert [entity.dxftype() for entity in drawn] == ["LWPOLYLINE"]
    # net: less what it stands on
    assert [stamp.facts["AREA"] for stamp in sheet.stamps] == ["11.9 m²", "9.0 m²"]
    piece = composed(furniture=floorplan_making.furniture())
    assert "furniture" not in {mark.kind for mark in piece.marks}


def test_lengths_end_at_surfaces_that_were_measured():
    sheet = composed()
    lengths = {dimension.word.text for dimension in sheet.dimensions}
    # from the outer side in the west to the room's in the east, whose wall has no known thickness
    assert {"7.30", "3.40", "1.20"} <= lengths
    # the small room's wall in the north is to be verified
    assert {text for text in lengths if text.startswith("~")} == {"~3.00"}
    sure = composed(walls=floorplan_making.walls() | {"verify": np.zeros(6, bool)})
    assert not any(dimension.word.text.startswith("~") for dimension in sure.dimensions)


def test_chains_run_along_open_rooms_as_along_closed_ones():
    opened = floorplan_making.rooms() | {"closed": np.array([True, False])}
    closed, with_open = (composed(**tables).dimensions for tables in ({}, {"rooms": opened}))
    np.testing.assert_allclose([d.ends_m for d in with_open], [d.ends_m for d in closed])


def test_doors_within_have_their_width_beside_them_and_no_doubt():
    openings = floorplan_making.openings()
    openings["verify"] = np.ones(3, bool)
    (word,) = composed(openings=openings).words
    assert (word.kind, word.text, word.element) == ("width", "0.90", "door-1")
    # beside its wall, along it
    assert 0.05 < abs(word.place[0] - 4.05) < 0.4 and 1.0 < word.place[1] < 1.9
    openings["type"][1] = "glass"
    assert composed(openings=openings).words == []


def test_panes_in_no_wall_are_drawn_where_they_bound_a_room():
    rows = [
        ((0, 0, 4, 0), -1, "glass", 0.0, 2.5, 0, -1),
        ((1, 1, 3, 1.5), -1, "glass", 0, 2.5, 0, -1),
        # floor that was seen as far as what holds the pane, and the first once more
        ((7.35, 0, 7.35, 3), -1, "glass", 0, 2.5, 1, -1),
        ((0.5, -0.2, 3.5, -0.1), -1, "glass", 0, 2.5, 0, -1),
    ]
    sheet = composed(walls=floorplan_making.walls([]), openings=floorplan_making.openings(rows))
    assert [symbol.element for symbol in sheet.symbols] == ["glass-0", "glass-2"]


def test_a_pane_hides_panes_alone_and_only_where_it_is_drawn():
    """One of 8 m bounds a room on 3 m, and is not drawn; of two alike the first is."""
    alike = [((4.1, y_m, 7.0, y_m), -1, "glass", 0.0, 2.5, 1, -1) for y_m in (0.0, -0.1)]
    wide = ((4.1, -0.1, 12.1, -0.1), -1, "glass", 0.0, 2.5, 1, -1)
    door = ((5.0, 0.05, 5.9, 0.05), -1, "door", 0.0, 2.0, 1, -1)
    for rows, drawn in [
        ([alike[0], wide], ["glass-0"]),
        (alike, ["glass-0"]),
        ([alike[0], door], ["glass-0", "door-1"]),
    ]:
        openings = floorplan_making.openings(rows)
        sheet = composed(walls=floorplan_making.walls([]), openings=openings)
        assert [symbol.element for symbol in sheet.symbols] == drawn


@pytest.mark.parametrize(
    ("kind", "y_m", "drawn"),
    [
        # where two rooms end nowhere each has a gap: they lie on one another, or apart
        ("gap", -0.04, ["gap-0"]),
        ("gap", -0.2, ["gap-0", "gap-1"]),
        # a door is no gap once more, but a gap may be where a door is
        ("door", -0.04, ["door-1"]),
    ],
)
def test_what_two_rooms_have_between_them_is_drawn_once(kind, y_m, drawn):
    rows = [
        ((4.1, 0.0, 7.1, 0.0), -1, "gap", np.nan, np.nan, 1, -1),
        ((4.1, y_m, 7.1, y_m), -1, kind, 0.0, 2.5, 1, -1),
    ]
    openings = floorplan_making.openings(rows)
    sheet = composed(walls=floorplan_making.walls([]), openings=openings)
    assert [symbol.element for symbol in sheet.symbols] == drawn


def test_a_pane_in_no_wall_is_drawn_as_far_as_it_bounds_a_room():
    # 2 m beyond the room that it bounds, which ends at x 7.1
    row = ((4.1, -0.2, 9.1, -0.2), -1, "glass", 0.0, 2.5, 1, -1)
    sheet = composed(walls=floorplan_making.walls([]), openings=floorplan_making.openings([row]))
    (pane,) = sheet.symbols
    assert pane.ends_m[0] == pytest.approx([4.1, -0.2])
    # and what a thick wall at the corner would take
    assert 7.1 <= pane.ends_m[1, 0] <= 7.4 and pane.ends_m[1, 1] == pytest.approx(-0.2)
    # what is known of it is of what is drawn
    assert pane.facts["width_m"] == pytest.approx(pane.width_m)
    assert pane.facts["width_changed_m"] == pytest.approx(pane.width_m - 5)


def test_holes_of_walls_are_drawn_and_what_parts_a_room_in_no_wall_is_not():
    wall = ((8.0, 0, 8.0, 3), 0.2, 9, 10, "observed")
    rows = [
        ((8.0, 1, 8.0, 1.6), 6, "gap", 0, 2.5, -1, -1),
        ((8.0, 2, 8.0, 2.6), 6, "passage", 0, 2.5, 1, 1),
        ((4.1, 1.5, 7.1, 1.5), -1, "passage", 0, 2.5, 1, 1),
    ]
    walls = [*floorplan_making.WALLS, wall]
    openings = floorplan_making.openings(rows, walls)
    sheet = composed(walls=floorplan_making.walls(walls), openings=openings)
    assert [(symbol.element, symbol.kind) for symbol in sheet.symbols] == [
        ("gap-0", "passage"),
        ("passage-1", "passage"),
    ]


def test_what_was_changed_and_how_areas_are_measured_is_said():
    said = " ".join(word.text for word in paper_words(composed()))
    assert "6 are square" in said and "0 mm" in said and "DIN 277" in said


def test_the_overview_is_a_page_of_a4_without_dimensions():
    measured = floorplan_making.plan()
    regular, _ = draft_plan(measured, SETTINGS)
    page = compose_overview(measured, regular)
    assert page is not None and page.page.name == "A4" and page.dimensions == []
    # what a manager asks: how much floor, which doors, what it is worth
    said = " ".join(word.text for word in paper_words(page))
    assert "2 closed rooms, 21.0 m² net." in said and "2 doors: 1 × 0.90 m, 1 × 1.00 m." in said
    assert [stamp.facts["NAME"] for stamp in page.stamps] == ["Room 0", "Room 1"]
    assert any(word.element == "title:VERDICT" for word in paper_words(page))
    # more rooms than A4 has rows
    tiles = [shapely.box(x, y, x + 0.9, y + 0.9) for x in range(20) for y in range(20)]
    many, _ = draft_plan(floorplan_making.plan(rooms=floorplan_making.rooms(tiles)), SETTINGS)
    assert compose_overview(measured, many) is None
    assert np.array_equal(many.rooms["room"], np.arange(400))


def test_names_are_whole_in_the_overview():
    name = "Besprechungsraum Nord"
    rooms = floorplan_making.rooms() | {"name": np.array([name, ""], object)}
    measured = floorplan_making.plan(rooms=rooms)
    regular, _ = draft_plan(measured, SETTINGS)
    page = compose_overview(measured, regular)
    assert page is not None and name in [word.text for word in page.paper_words]


def facing(line, side):
    """A wall of 6 m seen from its left or right alone."""
    left, right = (0, -1) if side == "left" else (-1, 0)
    return (line, np.nan, left, right, "observed")


@pytest.mark.parametrize(
    ("rows", "facades"),
    [
        # seen from the north: nothing to the south, and then another wall 3 m or 5 m away
        ([facing((0, 0, 6, 0), "left")], [True]),
        ([facing((0, 0, 6, 0), "left"), facing((0, -3, 6, -3), "right")], [False, False]),
        ([facing((0, 0, 6, 0), "left"), facing((0, -5, 6, -5), "right")], [True, True]),
        # a core of 6 m x 6 m that nobody saw, all around seen from outside
        ([facing((0, 0, 6, 0), "right"), facing((6, 0, 6, 6), "right"),
          facing((6, 6, 0, 6), "right"), facing((0, 6, 0, 0), "right")], [False] * 4),
    ],
)  # fmt: skip
def test_facades_have_nothing_of_the_building_behind(rows, facades):
    drawn = floorplan_making.plan(
        walls=floorplan_making.walls(rows),
        rooms=floorplan_making.rooms([]),
        openings=floorplan_making.openings([]),
    )
    assert find_facades(drawn).tolist() == facades
    assert find_facades(floorplan_making.plan()).tolist() == [False, True, *[False] * 4]


@pytest.mark.parametrize("thickness_m", [0.2, np.nan])
def test_curved_walls_stay_as_measured_and_are_drawn_in_arcs(thickness_m):
    first, *others = quarter_disc.WALLS
    walls = [(first[0], thickness_m, *first[2:]), *others]
    jambs_m = trace_arc(np.array(first[0]).reshape(2, 2), np.zeros(2))[[4, 7]]
    door = (tuple(jambs_m.ravel()), 0, "door", 0.0, 2.0, 0, -1)
    measured = quarter_disc.quarter(walls, openings=floorplan_making.openings([door]))
    regular, drafted = draft_plan(measured, SETTINGS)
    for name in ("x0_m", "y0_m", "x1_m", "y1_m", "thickness_m", *schemas.ARC):
        np.testing.assert_array_equal(regular.walls[name][0], measured.walls[name][0])
    assert centrelines_m(regular.openings)[0] == pytest.approx(jambs_m)
    assert drafted.moved_m == drafted.width_m == 0
    sheet = compose_presentation(measured, regular, drafted)
    solid = [path for mark in sheet.marks if mark.kind == "poche" for path in mark.bent_paths]
    # about a quarter of a circle, but for the door
    assert max(abs(path[:, 2]).max() for path in solid) > np.tan(np.radians(60) / 4)
    assert all(np.isfinite(path).all() for path in solid)


@pytest.mark.parametrize("reach_m", [quarter_disc.RADIUS_M, 3.0])
def test_an_unlikely_curved_wall_that_bounds_a_room_is_drawn(reach_m):
    first, second, _ = quarter_disc.WALLS
    room = shapely.Point(0, 0).buffer(reach_m, quad_segs=90) & shapely.box(0.1, 0.1, 9, 9)
    # it ends loose, seen from one side
    measured = quarter_disc.quarter(
        [(first[0], np.nan, *first[2:]), second], rooms=floorplan_making.rooms([room])
    )
    walls = {**measured.walls, "p_true": np.array([0.3, 0.99])}
    regular, _ = draft_plan(replace(measured, walls=walls), SETTINGS)
    assert (0 in regular.walls["wall"]) == (reach_m == quarter_disc.RADIUS_M)


def test_curved_walls_have_their_radius_beside_them():
    measured = quarter_disc.quarter(quarter_disc.WALLS)
    regular, changes = draft_plan(measured, SETTINGS)
    sheet = compose_presentation(measured, regular, changes)
    # of the inner side, as it is measured
    radius_m = measured.walls["arc_radius_m"][0] - measured.walls["thickness_m"][0] / 2
    assert f"R {radius_m:.2f}" in [word.text for word in sheet.words]


def test_names_of_rooms_are_read_before_their_heights_and_perimeters():
    def words(name, number):
        told = {"NAME": name, "NUMBER": number, "HEIGHT": "at least 2.70 m"}
        stamps = [replace(of, facts={**of.facts, **told}) for of in composed().stamps]
        drawn = draw_room_table(stamps, [Slot(0.0, 0.0, len(stamps))], Locale())
        return {word.text for word in drawn if isinstance(word, Word)}

    assert {"Perim. m", "Height m", "Hall"} <= words("Hall", "1")
    long = words("Reading room", "A-001-0002-3")
    assert "Height m" not in long and {"A-001-0002-3", "Reading room", "Area m²"} <= long


@pytest.mark.parametrize("marks", ["", " *", " * ?"])
def test_a_mark_cuts_no_name(marks):
    def words(name):
        known = {"NUMBER": "1.02", "PERIMETER": "24.10 m", "HEIGHT": "at least 2.50 m"}
        rooms = [{"NAME": name, "AREA": "4.7 m²"}, {"NAME": "Hall", "AREA": "about 1128.7 m²"}]
        stamps = [
            replace(of, facts={**of.facts, **known, **own}, marks=marks)
            for of, own in zip(composed().stamps, rooms, strict=True)
        ]
        drawn = draw_room_table(stamps, [Slot(0.0, 0.0, len(stamps))], Locale())
        return [word for word in drawn if isinstance(word, Word)]

    # however long it is, it ends before its own area, and is whole if it is not very long
    for length in range(6, 40):
        name = "Besprechungsraum im Obergeschoss am Ende"[:length].strip()
        found = words(name)
        (shown,) = [word for word in found if word.text.startswith("Bespr")]
        (area,) = [word for word in found if word.text == "4.7"]
        end_mm = shown.place[0] + measure_width_mm(shown.text, Letters.SMALL)
        assert end_mm < area.place[0] - measure_width_mm(area.text, Letters.SMALL)
        assert shown.text.endswith(marks)
        if measure_width_mm(name, Letters.SMALL) <= 18.0:
            assert shown.text == name + marks


def test_the_legend_explains_the_sign_for_about_only_where_it_stands():
    sign = "~ about, an end is not known"
    sure = composed(walls=floorplan_making.walls() | {"verify": np.zeros(6, bool)})
    assert sign not in [word.text for word in paper_words(sure)]
    opened = floorplan_making.rooms()
    opened["closed"][1] = False
    assert sign in [word.text for word in paper_words(composed(rooms=opened))]
