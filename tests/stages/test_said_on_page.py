"""More that the report's page lets a person say: leaves, things, tapes, points, settled rooms."""

import pytest

from helpers.correcting import corrected, write_plan
from helpers.pages import entries, in_sight, needs_browser, press, tap, text_of, type_into

pytestmark = needs_browser


def carried_out(page, tmp_path):
    """The plan with what is said."""
    found = corrected(write_plan(tmp_path), *entries(page))
    assert list(found.unmatched_corrections) == []
    return found


@pytest.mark.wording
def test_a_door_opens_as_two_taps_say(page, tmp_path):
    page.run("elements.showElement('opening 1')")
    press(page, "Opens so …", "#card")
    tap(page, (4.05, 1.0), (3.2, 1.02))
    (entry,) = entries(page)
    assert entry["swing"] == pytest.approx([3.2, 1.02], abs=0.05)
    assert in_sight(page, "#edits .leaf") == 1 and "opens as shown" in text_of(page, "#fresh")
    assert carried_out(page, tmp_path).furniture["kind"].tolist() == ["furniture", "leaf"]


@pytest.mark.parametrize(("words", "kind"), [("Furniture", "furniture"), ("Column", "column")])
def test_what_stands_about_is_drawn_by_two_corners(page, tmp_path, words, kind):
    press(page, "Draw")
    press(page, words, "#draw")
    tap(page, (1.0, 1.0), (2.0, 1.6))
    (entry,) = entries(page)
    assert entry["kind"] == kind and entry["outline"][2] == pytest.approx([2.0, 1.6], abs=0.03)
    assert in_sight(page, "#edits .thing") == 1
    found = carried_out(page, tmp_path)
    assert found.furniture["area_m2"][-1] == pytest.approx(0.6, abs=0.05)
    assert found.furniture["kind"][-1] == kind


def test_two_things_are_two_entries(page):
    for x_m in (1.0, 2.5):
        press(page, "Draw")
        press(page, "Furniture", "#draw")
        tap(page, (x_m, 1.0), (x_m + 0.6, 1.6))
    assert len(entries(page)) == 2
    press(page, "Undo", "#corrections")
    assert len(entries(page)) == 1


def test_a_wall_drawn_twice_is_one_entry_whichever_way(page, tmp_path):
    for line in ([[1, 2], [3, 2]], [[3, 2], [1, 2]]):
        page.run(f"edits.add({{element: 'wall', action: 'add', line: {line}}})")
    (entry,) = entries(page)
    assert entry["line"] == [[3, 2], [1, 2]]
    assert len(carried_out(page, tmp_path).walls["wall"]) == 7


def test_a_length_is_taped_between_two_walls(page, tmp_path):
    press(page, "Draw")
    press(page, "Taped length", "#draw")
    tap(page, (0.0, 1.5), (4.0, 1.5))
    type_into(page, "#moving input", "401.2")
    press(page, "Done", "#moving")
    (entry,) = entries(page)
    assert entry["length_m"] == 4.012 and "Taped 4.012 m" in text_of(page, "#fresh")
    found = carried_out(page, tmp_path)
    assert found.taped_m[0][:2] == pytest.approx([4.0, 4.012], abs=0.001)


def test_control_points_are_pasted(page, tmp_path):
    press(page, "Draw")
    press(page, "Control points", "#draw")
    page.run("document.querySelector('#moving textarea').value = "
             "'0 0 500000 5400000\\n0, 9, 500000, 5400009\\n5 5 500005 5400005 check'")  # fmt: skip
    type_into(page, "#moving input", "EPSG:25832")
    press(page, "Done", "#moving")
    assert [e["element"] for e in entries(page)] == [
        "reference_point", "reference_point", "check_point"]  # fmt: skip
    reference = carried_out(page, tmp_path).georeference
    assert (reference.crs, len(reference.check_off_m)) == ("EPSG:25832", 1)


def test_a_room_is_used_named_and_settled(page, tmp_path):
    page.run("elements.showElement('room 1')")
    type_into(page, "#card [name=use]", "store")
    press(page, "Nothing more to check here", "#card")
    used, settled = entries(page)
    assert used["use"] == "store" and settled["action"] == "settle"
    page.run("elements.showElement('room 1')")
    assert "Nothing more" not in text_of(page, "#card")
    found = carried_out(page, tmp_path)
    assert found.rooms["use"].tolist() == ["", "store"]


def test_a_wall_is_as_high_as_said(page, tmp_path):
    page.run("elements.showElement('wall 5')")
    type_into(page, "#card [name=height_m]", "120")
    page.key("Enter")
    (entry,) = entries(page)
    assert entry["height_m"] == 1.2
    assert carried_out(page, tmp_path).heights_m[5] == 1.2


def test_parts_of_rooms_are_one_as_two_taps_say(page, tmp_path):
    # a line parts the larger room, and what is east of it goes with the smaller one
    page.run("edits.add({element: 'room', action: 'split', line: [[3, 0], [3, 3]]})")
    page.run("edits.change('wall 5', {action: 'remove'})")
    tap(page, (3.5, 2.5))
    press(page, "One with: tap the other", "#card")
    tap(page, (6.0, 2.5))
    entry = entries(page)[-1]
    assert entry["action"] == "merge"
    assert [entry["at"], entry["with"]] == [
        pytest.approx(m, abs=0.03) for m in ([3.5, 2.5], [6, 2.5])
    ]
    assert "Room 0 and Room 1 are one" in text_of(page, "#fresh")
    found = carried_out(page, tmp_path)
    assert sorted(found.rooms["area_m2"].round()) == [9.0, 12.0]


@pytest.mark.wording
def test_two_parts_of_one_room_are_one_again(page, tmp_path):
    for x_m in (1, 3):
        page.run(f"edits.add({{element: 'room', action: 'split', line: [[{x_m}, 0], [{x_m}, 3]]}})")
    tap(page, (0.5, 2.5))
    press(page, "One with: tap the other", "#card")
    tap(page, (1.5, 2.5))
    assert "Parts of Room 0 are one" in text_of(page, "#fresh")
    assert in_sight(page, '[data-label="room 0"]') == 1
    assert sorted(carried_out(page, tmp_path).rooms["area_m2"].round()) == [3.0, 9.0, 9.0]
