"""What buildings of the catalogue are drawn with, on plans small enough to draw by hand."""

import json

import numpy as np
import pytest
import shapely
from shapely import LineString, Point

from benchmarks.catalogue import common, doors, facade, furnish, layout, niche, phenomena
from benchmarks.catalogue.plan import Plan, rectangle

STYLE = doors.DoorStyle(width_m=0.9, lintel_m=2.0, frame_m=0.0)


@pytest.fixture
def plan():
    return Plan(np.random.default_rng(1))


def features(plan, kind):
    return [f for f in plan.features if f["properties"]["kind"] == kind]


def line(feature):
    return LineString(feature["geometry"]["coordinates"])


def test_boxes_that_touch_have_a_border_and_others_none():
    a, b, c = (0, 0, 2, 2), (2, 1, 4, 3), (5, 0, 6, 1)
    assert layout.border(a, b) == layout.border(b, a) == ((2, 1), (2, 2))
    assert layout.border(a, c) is None


def test_walls_between_rooms_are_as_long_as_they_are_straight(plan):
    layout.draw_partitions(plan, [(0, 0, 4, 2), (0, 2, 2, 4), (2, 2, 4, 4)], 0.1)
    assert sorted(list(line(f).coords) for f in features(plan, "wall")) == [
        [(0, 2), (4, 2)],
        [(2, 2), (2, 4)],
    ]


def test_strips_are_filled_by_rooms_of_widths_between_the_limits():
    boxes = layout.strip(np.random.default_rng(2), (1.0, 21.0), (0.0, 3.0), (3.0, 5.0))
    edges = [box[0] for box in boxes] + [boxes[-1][2]]
    assert edges[0] == 1 and edges[-1] == 21
    assert all(2.5 < width < 5.6 for width in np.diff(edges))


def test_a_leaf_opens_into_the_room_that_is_named_from_the_jamb_that_is_named(plan):
    plan.wall((4, 0), (0, 0), 0.2)
    options = {"at_m": 1.0, "into": (2, 5), "hinge": "start", "open_deg": 90.0}
    assert doors.door(plan, (0, 0), (4, 0), STYLE, **options)
    (door,) = features(plan, "opening")
    values = door["properties"]
    assert list(line(door).coords) == [(1, 0), (1.9, 0)]
    assert (values["side"], values["hinge"], values["open_deg"]) == ("left", "start", 90)
    # the leaf sweeps a quarter of a circle before the wall's face, and is kept clear
    swept = shapely.union_all(plan.kept)
    assert swept.contains(Point(1.5, 0.6)) and not swept.contains(Point(1.5, 1.2))


def test_a_door_is_not_drawn_where_its_leaf_would_hit_a_wall_or_furniture(plan):
    plan.wall((0, 0), (4, 0), 0.2)
    plan.wall((1.5, 0), (1.5, 3), 0.2)
    options = {"at_m": 1.65, "into": (2, 5), "hinge": "start", "open_deg": 175.0}
    assert doors.door(plan, (0, 0), (4, 0), STYLE, **options)
    # where it cannot lie back at the wall it stands at a right angle
    assert features(plan, "opening")[0]["properties"]["open_deg"] == 90
    plan.solid("furniture", rectangle((0.2, 0.2, 1.2, 0.6)), height_m=1.0)
    assert not doors.door(plan, (0, 0), (4, 0), STYLE, at_m=0.3, into=(1, 5))


def test_who_is_to_go_through_finds_the_door_wide_open(plan):
    angles = [doors.draw_angle(plan.rng, driven=True) for _ in range(100)]
    assert min(angles) >= 82 and max(angles) <= 180


def test_windows_are_a_pitch_apart_about_the_middle_and_on_no_door(plan):
    plan.shell((0, 0, 8, 4), 0.2)
    room = plan.room("room", (0, 0, 8, 4))
    style = facade.WindowStyle(width_m=1.0, pitch_m=2.0, radiators=0.0)
    doors.door(plan, (0, 0), (8, 0), STYLE, at_m=4.6)
    assert facade.windows(plan, room, "s", style) == 4
    windows = [line(f) for f in features(plan, "opening") if f["properties"]["type"] == "window"]
    assert [w.centroid.x for w in windows] == [1, 3, 7]


def test_a_niche_leaves_the_wall_thinner_with_its_other_face_where_it_was(plan):
    plan.wall((0, 0), (6, 0), 0.5)
    assert niche.cut_niche(plan, (2, 0), (3, 0), side="n", depth_m=0.2)
    widths = [(f["properties"]["thickness_m"], line(f)) for f in features(plan, "wall")]
    solid = shapely.union_all([w.buffer(t / 2, cap_style="flat") for t, w in widths])
    niche_box = rectangle((2, 0.05, 3, 0.25))
    assert solid.area == pytest.approx(6 * 0.5 - 1 * 0.2)
    assert solid.intersection(niche_box).area == pytest.approx(0)
    assert not niche.cut_niche(plan, (2, 0), (3, 0), side="n", depth_m=0.3)


def test_furniture_stands_at_walls_and_never_before_doors(plan):
    plan.shell((0, 0, 4, 3), 0.2)
    room = plan.room("room", (0, 0, 4, 3))
    doors.door(plan, (0, 0), (4, 0), STYLE, at_m=1.0, into=(2, 1), open_deg=90.0)
    assert furnish.row(plan, room, "s", (0.5, 0.4), 1.9, "cupboard") == 4
    boxes = [shapely.Polygon(f["geometry"]["coordinates"][0]) for f in features(plan, "furniture")]
    assert all(box.bounds[1] == 0.11 for box in boxes)
    assert [box.bounds[0] >= 1.9 or box.bounds[2] <= 1.0 for box in boxes] == [True] * 4


def test_a_bow_is_as_deep_as_its_sagitta_and_its_vertices_lie_close(plan):
    bow = common.bow(plan, (0, 0), (0, 6), 1.0, 0.3, windows=2)
    assert bow[:, 0].min() == pytest.approx(-1.0, abs=0.002)
    assert np.hypot(*np.diff(bow, axis=0).T).max() < 0.3
    assert len(features(plan, "opening")) == 2


def test_a_drawing_is_turned_with_its_slopes(plan):
    plan.turn_deg = 90.0
    plan.solid("ceiling", rectangle((0, 0, 2, 1)), height_m=1.0, rise_y=0.5)
    (ceiling,) = json.loads(plan.text())["features"]
    assert ceiling["geometry"]["coordinates"][0][1] == [0, 2]
    assert ceiling["properties"]["rise_x"] == -0.5 and ceiling["properties"]["rise_y"] == 0


def test_corners_of_a_skewed_drawing_move_and_straight_walls_stay_straight(plan):
    plan.extent, plan.skew = (0, 0, 4, 2), [(0, 0), (0.4, 0), (0, 0.2), (0, 0)]
    plan.wall((2, 0), (2, 2), 0.2)
    plan.add("opening", "LineString", [(2, 0.5), (2, 1.5)], type="door")
    wall, opening = (
        LineString(f["geometry"]["coordinates"]) for f in json.loads(plan.text())["features"]
    )
    assert list(wall.coords) == [(2.2, 0), (2, 2.1)]
    assert all(Point(xy).distance(wall) < 1e-4 for xy in opening.coords)


def test_phenomena_are_counted_by_what_is_drawn(plan):
    plan.wall((0, 0), (10, 0), 0.5)
    niche.cut_niche(plan, (2, 0), (3, 0), side="n")
    plan.wall((0, 0), (3, 3), 0.05)
    facade.glass_wall(plan, (0, 3), (6, 3), pitch_m=2.0)
    facade.window(plan, (6, 0), (7, 0), 0.9, 2.0)
    doors.door(plan, (0, 0), (1.5, 0), STYLE, open_deg=0.0)
    furnish.put(plan, (6, 0.3, 7, 0.7), 2.0, "cupboard")
    counts = phenomena.count_phenomena(json.loads(plan.text()))
    found = {name: counts[name] for name in phenomena.NAMES if counts[name]}
    assert found == {
        "leaves": 1,
        "shut doors": 1,
        "panes": 1,
        "glass walls": 1,
        "oblique walls": 1,
        "thick walls": 2,
        "thin walls": 1,
        "niches": 1,
        "cupboards before a facade": 1,
    }
