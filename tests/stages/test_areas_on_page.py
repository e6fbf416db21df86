"""Areas and neighbours that the page works out at once, held against the plan that is made anew."""

import json

import numpy as np
import pytest

from helpers.correcting import corrected, write_plan
from helpers.pages import entries, in_sight, needs_browser, text_of

pytestmark = [needs_browser, pytest.mark.wording]
APART_M2 = 0.02  # the page knows places to the millimetre; gaps between rooms are bridged with 1 cm
WALL = "wall 5"


def say(page, *said):
    """Say things in the page's own way: changes of elements, or entries."""
    for of in said:
        if isinstance(of, tuple):
            page.run(f"edits.change('{of[0]}', {json.dumps(of[1])})")
        else:
            page.run(f"edits.add({json.dumps(of)})")


def split(*line):
    return {"element": "room", "action": "split", "line": [list(place) for place in line]}


def merge(at, other):
    return {"element": "room", "action": "merge", "at": list(at), "with": list(other)}


def listed(page):
    """Areas of the rooms as the page has them, and whether all of them are known."""
    rooms = page.run("areas.list().map(r => [r.area_m2, r.isKnown])")
    return sorted(area for area, _ in rooms), all(known for _, known in rooms)


def joined(page):
    """Areas of the rooms that each opening of the plan joins; 0 outside."""
    return page.run(
        "[0, 1, 2].map(n => (areas.neighboursOf(`opening ${n}`) ?? []).map(side =>"
        " areas.list().find(r => r.element === side)?.area_m2 ?? 0).sort((a, b) => a - b))"
    )


def held_against(page, tmp_path):
    """Assert that areas and neighbours are those of the plan that is made anew."""
    plan = corrected(write_plan(tmp_path), *entries(page))
    areas_m2, _ = listed(page)
    assert areas_m2 == pytest.approx(sorted(plan.rooms["area_m2"]), abs=APART_M2)
    area_of = dict(zip(plan.rooms["room"].tolist(), plan.rooms["area_m2"].tolist(), strict=True))
    for number, sides_m2 in enumerate(joined(page)):
        rows = np.flatnonzero(plan.openings["opening"] == number)
        made = [
            sorted(area_of.get(int(plan.openings[side][row]), 0.0) for side in ("room_a", "room_b"))
            for row in rows
        ]
        assert [sides_m2] * len(rows) == [pytest.approx(of, abs=APART_M2) for of in made]
    return plan


@pytest.mark.parametrize(
    ("said", "areas_m2"),
    [
        ([split((1.5, 0.05), (1.5, 2.95))], [4.5, 7.5, 9]),
        ([split((0.3, 1.0), (3.8, 1.0))], [4, 8, 9]),
        # two lines that meet nothing of each other
        ([split((1, 0), (1, 3)), split((3, 0), (3, 3))], [3, 3, 6, 9]),
        # across the first
        ([split((1, 0), (1, 3)), split((1.1, 1), (3.9, 1))], [3, 3, 6, 9]),
        ([(WALL, {"line": [[4.25, -0.1], [4.25, 3.1]]})], [8.4, 12.6]),
        ([(WALL, {"line": [[4.25, 3.1], [4.05, -0.1]]})], [8.7, 12.3]),
        ([(WALL, {"thickness_m": 0.3})], [8.7, 11.7]),
        ([(WALL, {"line": [[4.25, -0.1], [4.25, 3.1]], "thickness_m": 0.3})], [8.1, 12.3]),
        ([("wall 3", {"line": [[4.05, 3.4], [-0.1, 3.4]]})], [9, 13.2]),
        # what is between: through the door alone, and all of it
        ([merge((2, 1.5), (5, 1.5))], [21.09]),
        ([(WALL, {"action": "remove"}), merge((2, 1.5), (5, 1.5))], [21.3]),
        ([("opening 1", {"line": [[4.05, 1.0], [4.05, 2.5]]}), merge((2, 1), (5, 1))], [21.15]),
        ([(WALL, {"line": [[4.25, -0.1], [4.25, 3.1]]}), merge((2, 1), (6, 1))], [21.09]),
        ([(WALL, {"action": "remove"}), split((3, 0), (3, 3)), merge((3.5, 1), (6, 1))],
         [9, 12.3]),
        # a part and the rest are one again
        ([split((1, 0), (1, 3)), merge((0.5, 1), (2, 1))], [9, 12]),
        ([("room 1", {"action": "remove"})], [12]),
    ],
)  # fmt: skip
def test_areas_follow_at_once_as_the_plan_does(page, tmp_path, said, areas_m2):
    say(page, *said)
    found_m2, known = listed(page)
    assert known and found_m2 == pytest.approx(areas_m2, abs=0.01)
    held_against(page, tmp_path)


@pytest.mark.parametrize("seed", range(40))
def test_whatever_is_said_what_the_page_knows_is_what_is_made(page, tmp_path, seed):
    rng = np.random.default_rng(seed)
    said = []
    if rng.random() < 0.5:
        (a, b), t = rng.uniform(-0.7, 0.7, 2).round(3).tolist(), rng.choice([None, 0.08, 0.25])
        line = [[4.05 + a, -0.1], [4.05 + (b if rng.random() < 0.5 else a), 3.1]]
        said.append((WALL, {"line": line} | ({} if t is None else {"thickness_m": float(t)})))
    elif rng.random() < 0.5:
        said.append((WALL, {"action": "remove"}))
    for _ in range(rng.integers(0, 3)):
        x_m = rng.uniform(0.4, 3.0) if rng.random() < 0.6 else rng.uniform(5.0, 6.8)
        lean_m = rng.uniform(-0.3, 0.3)
        said.append(split((round(x_m, 3), 0.1), (round(x_m + lean_m, 3), 2.9)))
    if rng.random() < 0.4:
        said.append(merge((3.2, rng.uniform(0.2, 2.8)), (4.9, rng.uniform(0.2, 2.8))))
    say(page, *said)
    _, known = listed(page)
    if known:
        held_against(page, tmp_path)
    else:
        # lines that cross, niches, walls that part: not where nothing of the kind was said
        assert any(of.get("action") in ("split", "merge") for of in said if isinstance(of, dict))


def test_what_is_not_simple_says_so(page):
    # a line that ends in the open
    say(page, split((1.5, 0.05), (1.5, 1.5)))
    assert page.run("areas.of('room 0').isKnown") is False
    labels = (
        "[...document.querySelectorAll('[data-label=\"room 0\"] text')].map(t => t.textContent)"
    )
    assert page.run(labels) == ["Room 0", "area to be recomputed"]
    page.run("elements.showElement('room 0')")
    assert "Area: to be recomputed" in text_of(page, "#card")


def test_areas_stand_on_the_plan_and_on_cards_and_go_with_an_undo(page):
    say(page, split((1.5, 0.05), (1.5, 2.95)))
    labels = (
        "[...document.querySelectorAll('[data-label=\"room 0\"] text')].map(t => t.textContent)"
    )
    assert page.run(labels) == ["Room 0", "7.5 m²"]
    assert page.run("document.querySelector('#edits [data-part-of]').textContent") == "part: 4.5 m²"
    # what it is called stands in the larger part
    assert (
        page.run("Number(document.querySelector('[data-label=\"room 0\"] text').getAttribute('x'))")
        > 1.5
    )
    page.run("elements.showElement('room 0')")
    card = text_of(page, "#card")
    assert "Area with your changes: 7.50 m²" in card and "Leads to: Room 1" in card
    page.run("elements.showElement('opening 0')")
    assert "Joins with your changes: a part of Room 0 – outside" in text_of(page, "#card")
    page.run("edits.undo()")
    assert page.run(labels) == ["Room 0", "12.0 m²"] and in_sight(page, "[data-part-of]") == 0


def test_a_room_is_drawn_as_far_as_its_wall_is_moved(page):
    say(page, (WALL, {"line": [[4.25, -0.1], [4.25, 3.1]]}))
    boxes = page.run(
        "[...document.querySelectorAll('#edits .floor')].map(p => p.getBBox())"
        ".map(box => [box.x, box.width])"
    )
    assert sorted(boxes) == [pytest.approx([0, 4.2]), pytest.approx([4.3, 2.8])]
