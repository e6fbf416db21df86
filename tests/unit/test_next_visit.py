"""Second visits to rooms in which one sees on paper from where."""

import json
import re
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from helpers import floorplan_making
from scanplan.exports import visit_geojson
from scanplan.exports.model_origin import Site
from scanplan.plan.floorplan import FloorPlan
from scanplan.rays.tolerances import STRAY_SHARE
from scanplan.report.facts import VisitFacts
from scanplan.report.plan_view.next_visit import draw_visit_map
from scanplan.validation.confidence import NOT_CLOSED, OF_DOUBTFUL_WALLS
from scanplan.visit import next_visit, questions, sight, standpoints
from scanplan.visit.sensor_reach import SensorReach

ALL_AROUND = SensorReach(range_m=50.0, field_rad=2 * np.pi, height_m=0.4)
SETTINGS = next_visit.VisitSettings(clearance_m=0.3, spacing_m=0.5)
# two arms, each 2 m wide and 8 m long, and the spans at their ends
BENT = [(0, 0), (8, 0), (8, 2), (2, 2), (2, 8), (0, 8)]
ENDS = [((8, 0), (8, 2)), ((2, 8), (0, 8))]


def rated(columns, doubtful=()):
    numbers = next(iter(columns.values()))
    verify = np.isin(numbers, doubtful)
    words = np.where(verify, "few rays", "").astype(object)
    return columns | {"verify": verify, "doubt": words, "needs_person": np.zeros(len(verify), bool)}


def unseen(spans):
    """Spans of room 0's outline, numbered from 10."""
    lines = [(*begin, *end) for begin, end in spans]
    columns = floorplan_making.openings([(line, -1, "unseen", 0, 2, 0, -1) for line in lines])
    return columns | {"opening": columns["opening"] + 10}


def room_plan(corners, spans=(), *, openings=(), walls=(), others=(), doubtful_rooms=()):
    """A room of single surfaces with spans of its outline that were not seen."""
    rooms = [shapely.Polygon(corners), *others]
    rings = [shapely.get_coordinates(room)[:, :2] for room in rooms]
    faces = [(*a, *b, -1) for ring in rings for a, b in pairwise(ring)]
    return FloorPlan(
        name="bent",
        faces=rated(floorplan_making.faces(faces)),
        walls=rated(floorplan_making.walls(list(walls))),
        openings=rated(floorplan_making.openings(list(openings))),
        rooms=rated(floorplan_making.rooms(rooms), doubtful_rooms),
        free=floorplan_making.free(rooms),
        unseen=unseen(spans),
    )


def visited(plan, start=(1, 1), reach=ALL_AROUND):
    return next_visit.plan_visit(plan, np.array([start], float), reach, SETTINGS)


def test_one_standpoint_at_the_bend_sees_both_ends():
    visit = visited(room_plan(BENT, ENDS), start=(7, 1))
    assert len(visit.standpoints["standpoint"]) == 1
    x_m, y_m = visit.standpoints["x_m"][0], visit.standpoints["y_m"][0]
    assert x_m < 2 and y_m < 2
    assert visit.questions["number"].tolist() == [10, 11]
    assert visit.questions["standpoint"].tolist() == [1, 1]
    assert visit.questions["seen"].min() > 0.7
    assert visit.standpoints["way_m"][0] == pytest.approx(7 - x_m, abs=1.0)


def test_a_short_range_takes_a_standpoint_at_each_end_the_nearer_first():
    near = SensorReach(range_m=3.0, field_rad=2 * np.pi, height_m=0.4)
    visit = visited(room_plan(BENT, ENDS), start=(5, 1), reach=near)
    assert visit.standpoints["standpoint"].tolist() == [1, 2]
    assert visit.standpoints["x_m"][0] > 5 and visit.standpoints["y_m"][1] > 5
    # round the corner at (2, 2), from no nearer than (4.9, 1) to (1, 4.9), by steps of a grid
    assert 2 * np.hypot(2.9, 1) - 1 < visit.standpoints["way_m"][1] < 14


def test_a_narrow_field_is_turned_towards_what_is_asked():
    half = SensorReach(range_m=50.0, field_rad=np.pi / 2, height_m=0.4)
    visit = visited(room_plan([(0, 0), (6, 0), (6, 2), (0, 2)], [((6, 0), (6, 2))]), reach=half)
    assert len(visit.standpoints["standpoint"]) == 1
    heading_rad = np.radians(visit.standpoints["heading_deg"][0])
    toward = np.array([6.0, 1.0]) - [visit.standpoints["x_m"][0], visit.standpoints["y_m"][0]]
    assert np.cos(heading_rad - np.arctan2(*toward[::-1])) > np.cos(np.pi / 4)


def test_to_look_another_way_from_one_place_no_way_is_drawn():
    """A hall too narrow to stand elsewhere, asked at both ends, of which one is seen at a time."""
    half = SensorReach(range_m=50.0, field_rad=np.pi / 2, height_m=0.4)
    ends = [((0, 0), (0, 0.8)), ((2, 0.8), (2, 0))]
    hall = room_plan([(0, 0), (2, 0), (2, 0.8), (0, 0.8)], ends)
    wide = next_visit.VisitSettings(clearance_m=0.3, spacing_m=5.0)
    visit = next_visit.plan_visit(hall, np.array([[1.0, 0.4]]), half, wide)
    x_m, way_m = visit.standpoints["x_m"].tolist(), visit.standpoints["way_m"].tolist()
    assert x_m[0] == x_m[1] and way_m[1] == 0
    ways = shapely.from_wkb(visit.standpoints["geometry"])
    assert (shapely.is_empty(ways) == (visit.standpoints["way_m"] == 0)).all()
    features = json.loads(visit_geojson.format_visit("hall", visit, ""))["features"]
    drawn = [f["properties"]["standpoint"] for f in features if f["properties"]["feature"] == "way"]
    assert drawn == [number for number, m in enumerate(way_m, 1) if m > 0]
    shown = draw_visit_map(hall, VisitFacts(visit.questions, visit.standpoints, ""))
    assert shown.count('class="way"') == len(drawn)


def test_what_lies_where_nobody_comes_is_said_to_be_out_of_sight():
    apart = shapely.box(20, 0, 24, 3)
    visit = visited(room_plan(BENT, others=[apart], doubtful_rooms=[1]))
    assert visit.questions["standpoint"].tolist() == [-1]
    assert visit.questions["seeable"].tolist() == [0.0]
    assert re.search(r"\b1 cannot be seen", next_visit.summarise_visit(visit))


def test_what_no_scan_settles_is_for_a_person_to_look_at():
    plan = room_plan(BENT, ENDS, doubtful_rooms=[0])
    plan.rooms["needs_person"][:] = True
    visit = visited(plan)
    assert visit.questions["needs_person"].tolist() == [
        k == "room" for k in visit.questions["kind"]
    ]
    assert re.search(r"\bperson\b.* 1\b", next_visit.summarise_visit(visit))


def test_nothing_doubtful_is_said_and_gives_an_empty_collection():
    visit = visited(room_plan(BENT))
    words = next_visit.summarise_visit(visit)
    assert words == "nothing of the plan is unseen or doubtful"
    read = json.loads(visit_geojson.format_visit("bent", visit, words))
    assert read["features"] == [] and read["summary"] == words


def test_a_visit_lies_where_the_plan_does_and_states_places_of_the_map():
    """Turned by a quarter, and of a map that is too small by a hundredth."""
    visit = visited(room_plan(BENT, ENDS))
    site = Site("EPSG:25832", 500_000.0, 5_400_000.0, turn_deg=90.0)
    read = json.loads(visit_geojson.format_visit("bent", visit, "", site, 1.01))
    assert read["crs"]["properties"]["name"].endswith("EPSG::25832")
    standpoint, way, question, _ = read["features"]
    x_m, y_m = (standpoint["properties"][name] for name in ("x_m", "y_m"))
    assert (x_m, y_m) == pytest.approx(
        (visit.standpoints["x_m"][0], visit.standpoints["y_m"][0]), abs=1e-4
    )
    placed = [500_000 - 1.01 * y_m, 5_400_000 + 1.01 * x_m]
    assert standpoint["geometry"]["coordinates"] == pytest.approx(placed, abs=1e-3)
    assert way["geometry"]["coordinates"][-1] == pytest.approx(placed, abs=1e-3)
    ((low, high),) = question["geometry"]["coordinates"]
    assert low == pytest.approx([500_000, 5_400_008.08])
    assert high == pytest.approx([500_000 - 2.02, 5_400_008.08])


def test_the_collection_has_standpoints_ways_and_questions():
    visit = visited(room_plan(BENT, ENDS))
    read = json.loads(visit_geojson.format_visit("bent", visit, ""))["features"]
    assert [f["properties"]["feature"] for f in read] == [
        *("standpoint", "way", "question", "question")
    ]
    assert read[0]["geometry"]["coordinates"] == read[1]["geometry"]["coordinates"][-1]
    assert read[0]["properties"]["heading_deg"] is None
    assert read[2]["properties"]["standpoint"] == 1
    assert read[2]["geometry"] == {
        "type": "MultiLineString", "coordinates": [[[8.0, 0.0], [8.0, 2.0]]]
    }  # fmt: skip


@pytest.mark.parametrize(("place", "asked"), [((3.6, 1.0), []), ((1.0, 1.0), ["way"])])
def test_where_a_way_out_leads_is_asked_until_someone_stood_at_it(place, asked):
    door = ((4, 0.5, 4, 1.5), -1, "door", 0.0, 2.0, 0, -1)
    plan = room_plan([(0, 0), (4, 0), (4, 2), (0, 2)], openings=[door])
    found = questions.list_questions(plan, np.array([place]))
    assert [one.kind for one in found] == asked


@pytest.mark.parametrize("doubt", [NOT_CLOSED, OF_DOUBTFUL_WALLS])
def test_of_a_room_that_is_doubtful_by_what_bounds_it_only_that_is_asked(doubt):
    plan = room_plan(BENT, ENDS, doubtful_rooms=[0])
    plan.rooms["doubt"][:] = doubt
    assert set(visited(plan, start=(7, 1)).questions["kind"]) == {"unseen"}


def test_doubtful_openings_are_seen_from_either_side_and_rooms_from_within():
    door = ((4, 0.5, 4, 1.5), -1, "door", 0.0, 2.0, 0, 1)
    plan = room_plan([(0, 0), (4, 0), (4, 2), (0, 2)], openings=[door], doubtful_rooms=[0])
    plan.openings["verify"][:] = True
    opening, room = questions.list_questions(plan, np.array([[1.0, 1.0]]))
    np.testing.assert_allclose(opening.sides_m, [[0.1, -0.1]])
    assert opening.reach_m == pytest.approx(0.5)
    pieces = questions.cut_questions([room])
    inside = shapely.contains_xy(plan.areas[0], pieces.place_m[:, 0])
    assert inside.all() and np.isnan(pieces.place_m[:, 1]).all()
    assert pieces.share.sum() == pytest.approx(1.0)


def test_pieces_are_equal_parts_of_at_most_three_tenths_of_a_metre():
    line = np.array([[[0.0, 0.0], [1.0, 0.0]]])
    one = questions.Question("unseen", 0, "", line, np.array([[0.1, np.nan]]))
    pieces = questions.cut_questions([one, one])
    assert pieces.question.tolist() == [0] * 4 + [1] * 4
    np.testing.assert_allclose(pieces.place_m[:4, 0, 0], [0.125, 0.375, 0.625, 0.875])
    np.testing.assert_allclose(pieces.place_m[:, 0, 1], 0.1)
    np.testing.assert_allclose(pieces.share, 0.25)


@pytest.mark.parametrize(("height_m", "is_seen"), [(0.4, False), (1.5, True), (np.nan, False)])
def test_a_sensor_looks_over_a_wall_that_ends_below_it(height_m, is_seen):
    wall = ((3, 0, 3, 2), 0.1, -1, -1, "observed")
    plan = room_plan([(0, 0), (6, 0), (6, 2), (0, 2)], [((6, 0), (6, 2))], walls=[wall])
    plan.walls["top_m"][:] = 1.2
    reach = SensorReach(50.0, 2 * np.pi, height_m)
    pieces = questions.cut_questions(questions.list_questions(plan, np.array([[1.0, 1.0]])))
    views = sight.turn_views(np.array([[1.0, 1.0]]), reach)
    seen = sight.find_seen(views, pieces, sight.block_sight(plan, height_m), reach)
    assert seen[0].tolist() == (list(range(len(pieces.share))) if is_seen else [])


@given(st.tuples(st.floats(0.1, 7.9), st.floats(0.1, 7.9)))
def test_a_piece_is_seen_where_a_straight_line_to_it_stays_in_the_room(place):
    """Held against geometry: inside the room, in front and less than 60 degrees aside."""
    room = shapely.Polygon(BENT)
    plan = room_plan(BENT, ENDS)
    asked = questions.list_questions(plan, np.array([[1.0, 1.0]]))
    pieces = questions.cut_questions(asked)
    views = sight.turn_views(np.array([place]), ALL_AROUND)
    seen = sight.find_seen(views, pieces, sight.block_sight(plan, 0.4), ALL_AROUND)[0]
    if not room.contains(shapely.Point(place)):
        return
    for piece in range(len(pieces.share)):
        way = shapely.LineString([place, pieces.place_m[piece, 0]])
        aside = np.subtract(place, pieces.place_m[piece, 0])
        cosine = aside @ pieces.normal[piece, 0] / np.hypot(*aside)
        assert (piece in seen) == (room.contains(way) and cosine >= 0.5)


@given(st.integers(1, 6), st.integers(1, 5), st.integers(0, 2**32 - 1))
def test_no_view_that_was_left_out_shows_more_than_a_stray_part(n_views, n_questions, seed):
    random = np.random.default_rng(seed)
    question = np.repeat(np.arange(n_questions), 4)
    places = np.zeros((len(question), 2, 2))
    share, reach = np.full(len(question), 0.25), np.full(len(question), np.inf)
    pieces = questions.Pieces(question, share, places, places, reach)
    seen = random.random((n_views, len(question))) < 0.5
    chosen = standpoints.choose_views([np.flatnonzero(row) for row in seen], pieces)
    assert len(set(chosen)) == len(chosen)

    def worth(views):
        return seen[views].any(axis=0).sum() / 4

    for view in set(range(n_views)) - set(chosen):
        assert worth([*chosen, view]) - worth(chosen) <= STRAY_SHARE + 1e-9
