"""Elements keep the ids of what lay in their place; new ones have ids of their own."""

import uuid

import ifcopenshell.guid
import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from helpers import floorplan_making
from helpers.floorplan_making import bare, plan
from scanplan.exports.data import element_ids
from scanplan.exports.data.element_ids import Elements


def elements(*placed):
    kinds, shapes = zip(*placed, strict=True)
    return Elements(np.array(kinds, object), np.array(shapes, object))


def wall(x0_m, x1_m, y_m=0.0):
    return "wall", shapely.box(x0_m, y_m - 0.05, x1_m, y_m + 0.05)


def run(found, known):
    ids = element_ids.identify_elements(found, known, "office")
    return ids, element_ids.merge_known(found, ids, known)


def first(*placed):
    return run(elements(*placed), element_ids.no_known())


def test_ids_are_those_of_ifc():
    words = ("office", "wall", 1.5)
    known = uuid.uuid5(element_ids._NAMESPACE, "office/wall/1.5")
    assert element_ids.derive_id(*words) == ifcopenshell.guid.compress(known.hex)


def test_a_wall_that_moves_and_grows_a_little_keeps_its_id():
    ids, known = first(wall(0, 4), wall(0, 4, y_m=3))
    again, after = run(elements(wall(0, 4.3, y_m=3.04), wall(-0.1, 4, y_m=0.05)), known)
    assert again == ids[::-1]
    assert after["global_id"].tolist() == known["global_id"].tolist()


def test_half_of_the_smaller_must_lie_in_the_other():
    # with 0.1 m around: 2.2 m of 4.2 m, then 2.0 m
    ids, known = first(wall(0, 4))
    assert run(elements(wall(2, 9)), known)[0] == ids
    assert run(elements(wall(2.2, 9)), known)[0] != ids
    assert run(elements(wall(1, 2)), known)[0] == ids


def test_walls_side_by_side_are_two():
    # with 0.1 m around they are 0.3 m wide, and share 0.14 m
    ids, known = first(wall(0, 4))
    assert run(elements(wall(0, 4, y_m=0.16)), known)[0] != ids


def test_of_the_parts_of_a_wall_the_longer_keeps_its_id():
    ids, known = first(wall(0, 10))
    parts, _ = run(elements(wall(0, 3), wall(4, 10)), known)
    assert parts[1] == ids[0] and parts[0] != ids[0]


def test_walls_that_become_one_have_the_id_of_the_longer_until_they_are_two_again():
    ids, known = first(wall(0, 3), wall(3.5, 10))
    joined, after = run(elements(wall(0, 10)), known)
    assert joined == [ids[1]]
    assert run(elements(wall(0, 3), wall(3.5, 10)), after)[0] == ids


def test_an_opening_keeps_its_id_in_whatever_wall():
    door = ("door", shapely.box(1, -0.05, 2, 0.05))
    ids, known = first(wall(0, 3), wall(3.5, 10), door)
    assert run(elements(wall(0, 10), door), known)[0] == ids[1:]


def test_an_opening_keeps_its_id_when_it_is_of_another_type():
    place = shapely.box(0, 0, 1, 0.1)
    ids, known = first(("door", place))
    again, after = run(elements(("window", place)), known)
    assert again == ids and after["kind"].tolist() == ["door"]
    # a wall or a room in its place is something else
    assert run(elements(("wall", place)), known)[0] != ids
    assert run(elements(("room", place)), known)[0] != ids


def test_an_opening_of_the_same_type_has_the_id_before_one_of_another():
    # with 0.1 m around both share 1.0 m of 1.2 m with the door that was there
    ids, known = first(("door", shapely.box(0, 0, 1, 0.1)))
    window, door = (
        ("window", shapely.box(-0.2, 0, 0.8, 0.1)),
        ("door", shapely.box(0.2, 0, 1.2, 0.1)),
    )
    again, _ = run(elements(window, door), known)
    assert again[1] == ids[0] and again[0] != ids[0]


def test_what_was_away_comes_back_under_its_id():
    ids, known = first(wall(0, 4), wall(0, 4, y_m=3))
    _, without = run(elements(wall(0, 4.2)), known)
    again, _ = run(elements(wall(0, 4), wall(0, 4, y_m=3)), without)
    assert again == ids


def test_two_elements_in_one_place_have_two_ids_that_stay():
    ids, known = first(wall(0, 4), wall(0, 4))
    assert len(set(ids)) == 2
    assert set(run(elements(wall(0, 4), wall(0, 4)), known)[0]) == set(ids)


places = st.lists(st.tuples(st.integers(0, 20), st.integers(0, 4)), min_size=1, max_size=8,
                  unique=True)  # fmt: skip


@given(places, places)
def test_whatever_came_between_the_same_plan_has_the_same_ids(plan_places, other_places):
    mine = elements(*(wall(x, x + 3, y_m=y / 2) for x, y in plan_places))
    others = elements(*(wall(x + 0.3, x + 3.1, y_m=y / 2) for x, y in other_places))
    ids, known = run(mine, element_ids.no_known())
    other_ids, after = run(others, known)
    assert run(mine, after)[0] == ids
    assert len(set(other_ids)) == len(other_ids)
    assert set(after["global_id"]) == {*ids, *other_ids}


def test_ids_of_a_plan_stand_in_the_order_of_its_tables():
    drawn = plan()
    found = element_ids.list_elements(drawn)
    assert found.kinds.tolist() == ["wall"] * 6 + ["door", "door", "window"] + ["room"] * 2
    ids = element_ids.identify_elements(found, element_ids.no_known(), "office")
    columns = element_ids.tabulate_ids(drawn, ids)
    assert columns["kind"].tolist() == ["opening"] * 3 + ["room"] * 2 + ["wall"] * 6
    assert element_ids.ids_of_table(columns) == {
        "wall": ids[:6],
        "opening": ids[6:9],
        "room": ids[9:],
    }
    assert element_ids.ids_from_places(drawn) == element_ids.ids_of_table(columns)


def test_walls_keep_their_ids_when_others_go_and_corners_change():
    known = element_ids.no_known()
    before, known = run(element_ids.list_elements(plan()), known)
    fewer = {name: values[2:] for name, values in floorplan_making.walls().items()}
    alone = plan(walls=fewer, openings=floorplan_making.openings([]))
    after, _ = run(element_ids.list_elements(alone), known)
    assert after == before[2:6] + before[9:]


def test_a_plan_of_faces_alone_has_no_ids():
    assert element_ids.ids_from_places(bare()) == {"wall": [], "opening": [], "room": []}


@pytest.mark.parametrize("name", ["<b>office</b>", "line\nbreak", "'); DROP"])
def test_an_id_holds_nothing_of_the_datasets_name(name):
    ids = element_ids.ids_from_places(plan(name=name))["room"]
    assert all(len(i) == 22 and set(i) <= set(element_ids._ALPHABET) for i in ids)
    assert ids != element_ids.ids_from_places(plan())["room"]
    assert len(ids) == len(floorplan_making.ROOMS)
