"""The report as an editor: what a person says there is drawn, kept, taken back and written."""

import json
import re
import shutil
import sys

import numpy as np
import pytest

from helpers import report_making
from helpers.correcting import corrected, write_plan
from helpers.pages import (
    click,
    entries,
    in_sight,
    middle_of,
    needs_browser,
    on_screen,
    press,
    settle,
    text_of,
    type_into,
)
from helpers.serving import serving
from scanplan.project import corrections_file
from scanplan.project.run.edit_session import EditSession
from scanplan.store import schemas, tables
from scanplan.validation import doubts

pytestmark = [needs_browser, pytest.mark.wording]
CTRL, SHIFT = 2, 8  # of DevTools' modifier keys
PHONE = {"width": 360, "height": 640}


def label_of(page, room):
    texts = f"[...document.querySelector('[data-label=\"{room}\"]').children]"
    return page.run(f"{texts}.map(text => text.textContent)")


def ends_of(entry):
    return [m for place in entry["line"] for m in place]


def show(page, element):
    page.run(f"elements.showElement('{element}')")


def shortcut(page, key, modifiers=CTRL):
    for kind in ("keyDown", "keyUp"):
        page.ask("Input.dispatchKeyEvent", type=kind, key=key, modifiers=modifiers)


def test_a_wall_that_is_not_there_is_struck_out_at_once(page):
    show(page, "wall 3")
    press(page, "Nothing is there", "#card")
    assert entries(page) == [{"element": "wall", "at": [1.975, 3.1], "action": "remove"}]
    assert in_sight(page, "#edits .gone") == 1
    assert "Wall 3 is not there" in text_of(page, "#fresh")


def test_a_kind_is_drawn_at_once_and_joins_a_width_said_of_the_same_opening(page):
    show(page, "opening 1")
    press(page, "It is a window", "#card")
    show(page, "opening 1")
    type_into(page, "#card [name=width_m]", "110")
    page.key("Enter")
    press(page, "×", "#card")
    (entry,) = entries(page)
    assert (entry["kind"], entry["width_m"]) == ("window", 1.1)
    box = page.run(
        "(b => [b.height, b.y])(document.querySelector('#edits .opening.window').getBBox())"
    )
    # about the middle of the door, at y 1.45
    assert box == pytest.approx([1.1, -2.0], abs=0.01)


def test_what_is_drawn_anew_hides_the_symbol_that_it_takes_the_place_of(page):
    # opening 1 is in wall 5, opening 0 in wall 4
    shown = (
        "[0, 1, 2].filter((n) => getComputedStyle(document.querySelector("
        "`#finished [data-opening='opening ${n}']`)).display !== 'none')"
    )
    assert page.run(shown) == [0, 1, 2]
    show(page, "opening 1")
    press(page, "It is a window", "#card")
    show(page, "wall 4")
    press(page, "Nothing is there", "#card")
    assert page.run(shown) == [2]
    press(page, "Undo", "#corrections")
    assert page.run(shown) == [0, 2]


def test_a_name_that_is_typed_and_left_is_kept_and_shown(page):
    show(page, "room 1")
    type_into(page, "#card [name=name]", "Küche <b>")
    click(page, middle_of(page, "#said"))
    assert entries(page) == [{"element": "room", "at": [5.6, 1.5], "name": "Küche <b>"}]
    assert label_of(page, "room 1") == ["Küche <b>", "9.0 m²"]


def test_every_change_is_undone_and_redone_and_outlasts_a_reload(page, report):
    for wall in (3, 4):
        show(page, f"wall {wall}")
        press(page, "Furniture", "#card")
    shortcut(page, "z")
    assert [e["at"] for e in entries(page)] == [[1.975, 3.1]]
    page.open(report.as_uri())
    assert [e["at"] for e in entries(page)] == [[1.975, 3.1]]
    assert in_sight(page, "#edits .gone.furniture") == 1
    shortcut(page, "y")
    assert len(entries(page)) == 2
    press(page, "Undo", "#corrections")
    press(page, "Undo", "#corrections")
    assert entries(page) == [] and page.run("document.getElementById('undo').disabled")


def test_a_wall_is_drawn_by_two_taps_that_go_to_walls_nearby(page):
    press(page, "Draw")
    press(page, "Wall", "#draw")
    for x_m, y_m in ((2.02, -0.03), (2.06, 3.05)):
        click(page, on_screen(page, x_m, y_m))
    (entry,) = entries(page)
    assert (entry["element"], entry["action"]) == ("wall", "add")
    start, end = entry["line"]
    # on the walls' lines, and square to them
    assert (start[1], end[1]) == pytest.approx((-0.1, 3.1), abs=1e-3)
    assert start[0] == pytest.approx(end[0], abs=0.01)
    assert in_sight(page, "#edits [data-entry]") == 1


def test_an_opening_is_drawn_in_the_wall_that_is_tapped(page):
    press(page, "Draw")
    press(page, "Door", "#draw")
    click(page, on_screen(page, 2.0, 1.5))
    assert "lies in a wall" in text_of(page, "#hint")
    click(page, on_screen(page, 4.1, 2.1))
    click(page, on_screen(page, 4.0, 2.9))
    (entry,) = entries(page)
    assert (entry["kind"], entry["action"]) == ("door", "add")
    assert ends_of(entry) == pytest.approx([4.05, 2.1, 4.05, 2.9], abs=0.02)


def test_an_opening_is_drawn_in_a_wall_that_was_just_drawn(page, tmp_path):
    page.run("edits.add({element: 'wall', action: 'add', line: [[2, 0.5], [2, 1.5]]})")
    page.run("edits.add({element: 'wall', action: 'add', line: [[2, 1.5], [2, 2.5]]})")
    press(page, "Draw")
    press(page, "Window", "#draw")
    for y_m in (1.5, 2.2):
        click(page, on_screen(page, 2.05, y_m))
    *walls, window = entries(page)
    assert ends_of(window) == pytest.approx([2, 1.5, 2, 2.2], abs=0.02)
    plan = corrected(write_plan(tmp_path), *walls, window)
    assert plan.openings["wall"][-1] == plan.walls["wall"][-1]


def test_a_wall_is_drawn_by_keys_alone(page):
    page.run("document.querySelector('#draw [data-kind=wall]').click()")
    assert page.run("document.activeElement.id") == "plan"
    for key in ("ArrowLeft", "Enter", *["ArrowUp"] * 8, "Enter"):
        page.key(key)
    (entry,) = entries(page)
    (x0, y0), (x1, y1) = entry["line"]
    assert (x1 - x0, y1 - y0) == pytest.approx((0, 0.8), abs=0.02)


def test_an_end_of_a_wall_is_dragged_and_a_key_moves_it_by_a_tenth_of_a_metre(page):
    show(page, "wall 5")
    press(page, "Move or resize", "#card")
    page.drag(on_screen(page, 4.05, 3.1), on_screen(page, 4.05, 2.2))
    page.run("document.querySelectorAll('.handle')[2].focus()")
    page.key("ArrowDown")
    press(page, "Done", "#moving")
    (entry,) = entries(page)
    assert entry["at"] == [4.05, 1.5] and "action" not in entry
    assert ends_of(entry) == pytest.approx([4.05, -0.1, 4.05, 2.1], abs=0.03)


def test_a_room_is_parted_by_a_line_and_its_areas_follow(page):
    show(page, "room 0")
    press(page, "Two rooms: draw the line", "#card")
    click(page, on_screen(page, 1.5, 0.05))
    click(page, on_screen(page, 1.5, 2.95))
    (entry,) = entries(page)
    assert (entry["element"], entry["action"]) == ("room", "split")
    assert in_sight(page, "#edits .cut") == 1
    # by two taps on the screen, at about 1.5 m
    assert label_of(page, "room 0") == ["Room 0", "7.5 m²"]


def test_two_rooms_are_one(page):
    show(page, "room 0")
    page.run(
        "(s => { s.value = 'room 1'; s.dispatchEvent(new Event('change')); })"
        "(document.querySelector('#card select'))"
    )
    assert entries(page) == [
        {"element": "room", "action": "merge", "at": [2, 1.5], "with": [5.6, 1.5]}
    ]
    assert "Room 0 and Room 1 are one" in text_of(page, "#fresh") and in_sight(page, ".joined") == 2


def test_the_file_that_is_downloaded_is_carried_out_and_can_be_opened_again(page, tmp_path):
    page.ask("Page.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    page.run("edits.change('wall 3', {thickness_m: 0.36})")
    page.run("edits.change('opening 2', {action: 'remove'})")
    page.run("edits.change('room 1', {name: 'Küche \"2\", {a: b}', number: '0.01'})")
    page.run("edits.name('A. Meier')")
    page.run("edits.change('wall 5', {line: [[4.3, 0], [4.3, 3]]})")
    page.run("edits.add({element: 'room', action: 'split', line: [[1.5, 0], [1.5, 3]]})")
    before = entries(page)
    page.run("document.getElementById('download').click()")
    path = tmp_path / "corrections.yaml"
    for _ in range(100):
        if path.exists():
            break
        page.run("new Promise(done => setTimeout(done, 50))")
    assert len(corrections_file.read_corrections(path)) == 5
    text = path.read_text()
    assert re.search(r'"when":"20\d\d-[^"]*Z","by":"A. Meier"', text)
    plan = corrected(write_plan(tmp_path), *corrections_file.read_entries(path))
    assert plan.n_corrections == 5 and plan.unmatched_corrections == []
    page.run("localStorage.clear()")
    page.open(page.run("location.href"))
    open_file(page, text)
    assert text_of(page, "#told") == "5 entries taken over." and entries(page) == before


def open_file(page, text):
    page.run(
        "(data => { const i = document.getElementById('import'); i.files = data.files;"
        " i.dispatchEvent(new Event('change')); })"
        f"((d => (d.items.add(new File([{json.dumps(text)}], 'c.yaml')), d))(new DataTransfer()))"
    )
    page.run("new Promise(done => setTimeout(done, 200))")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("survey: hall 12\ncorrections:\n", "are of hall 12, this page is of office"),
        ("corrections:\n- element: room\n", "Line 2 is no entry in braces"),
        ("corrections:\n- {element: wall, action: keep}\n", "Line 2 is no entry in braces"),
        ("[" * 1000, "Line 1 is no entry in braces"),
        ("a" * (2**18 + 1), "at most 262144 are read"),
    ],
)
def test_a_file_of_something_else_is_told_in_a_line_and_nothing_is_taken(page, text, told):
    open_file(page, text)
    assert told in text_of(page, "#told") and entries(page) == []


def test_entries_that_a_person_wrote_by_hand_are_taken_over(page):
    text = (
        "# of the manual\ncorrections:\n- {element: room, at: [5, 1], name: Big room}\n"
        "- {element: reference_point, at: [0, 0], world: [1, 2], crs: EPSG:25832}\n"
    )
    open_file(page, text)
    room, point = entries(page)
    assert room == {"element": "room", "at": [5, 1], "name": "Big room"}
    assert point["crs"] == "EPSG:25832"


def test_doubts_are_walked_through_by_keys_alone(page):
    press(page, "Start", "#walk")
    assert "Is there a wall" in text_of(page, "#question") and in_sight(page, "#plan .doubt") == 1
    page.key("n")
    assert page.run("document.activeElement.textContent") == "Nothing is there"
    press(page, "Back", "#walk")
    page.key("y")
    assert entries(page) == [{"element": "wall", "at": [5.575, 3.1], "action": "keep"}]
    assert text_of(page, "#how-far") == "1 of 1 answered"
    assert page.run("document.querySelector('#ticks text').textContent") == "✓"
    assert in_sight(page, "#plan .doubt") == 0


def test_on_a_phone_the_question_and_its_answers_are_under_the_thumb(page, report):
    page.open(report.as_uri(), **PHONE)
    press(page, "Start", "#walk")
    for words in ("✓ Yes", "✗ No"):
        place = page.run(
            "(r => [r.top, r.bottom, r.height, r.width])"
            "([...document.querySelectorAll('#walk button')]"
            f".find(b => b.textContent === {words!r}).getBoundingClientRect())"
        )
        top, bottom, height, width = place
        assert top > 0.5 * PHONE["height"] and bottom <= PHONE["height"]
        assert height >= 44 and width >= 120
    x, y = middle_of(page, '#plan .pick[data-element="wall 2"]')
    assert 0 < x < PHONE["width"] and 0 < y < 0.58 * PHONE["height"]
    assert page.run("document.documentElement.scrollWidth") <= PHONE["width"]
    press(page, "Stop", "#walk")
    assert in_sight(page, "#bar") == 1


def test_a_page_that_was_made_anew_keeps_what_it_has_not(page, tmp_path):
    page.run("edits.change('wall 3', {thickness_m: 0.36})")
    page.run("edits.change('room 1', {name: 'Hall'})")
    (hall,) = [e for e in entries(page) if e["element"] == "room"]
    files = report_making.files(tmp_path)
    files["corrections"] = tmp_path / "corrections.yaml"
    files["corrections"].write_text(f"corrections:\n- {json.dumps(hall)}\n")
    page.open(report_making.written(tmp_path, files, name="office").as_uri())
    assert "1 change of yours not in it is kept" in text_of(page, "#told")
    assert len(entries(page)) == 2
    assert page.run("edits.fresh().map(e => e.element)") == ["wall"]
    assert page.run("document.getElementById('known').textContent").startswith("Room 1 is Hall")


def test_corrections_of_another_survey_of_that_name_are_not_mixed_up(page, tmp_path):
    page.run("edits.change('wall 3', {thickness_m: 0.36})")
    made = report_making.written(tmp_path, report_making.files(tmp_path), name="other")
    assert entries(page.open(made.as_uri())) == []


def test_what_the_plan_has_of_a_person_can_be_taken_back(page, tmp_path):
    files = report_making.files(tmp_path)
    files["corrections"] = tmp_path / "corrections.yaml"
    files["corrections"].write_text(
        "corrections:\n- {element: room, at: [1, 2], name: '</script> & co'}\n"
        "- {element: wall, at: [20, 2], action: remove}\n"
    )
    page.open(report_making.written(tmp_path, files, name="office").as_uri())
    words = page.run("[...document.querySelectorAll('#known li')].map(e => e.textContent)")
    assert words == ["Room 0 is </script> & co×", "Wall is not there×"]
    page.run("document.querySelector('#known button').click()")
    assert [e["element"] for e in entries(page)] == ["wall"]
    assert "Taken back" in text_of(page, "#fresh")


def test_sixty_changes_stay_quick(page):
    took = page.run(
        "(() => { const start = performance.now();"
        " for (let i = 0; i < 60; i++) edits.add({element: 'wall', action: 'add',"
        " line: [[1 + i / 50, 1], [1 + i / 50, 2]]});"
        " return (performance.now() - start) / 60; })()"
    )
    assert len(entries(page)) == 60
    # milliseconds a change: a frame of the screen is 16, of a busy machine three
    assert took < 50


def test_everything_that_is_pressed_has_a_name(page):
    page.run("elements.showElement('opening 1')")
    nodes = page.ask("Accessibility.getFullAXTree")["nodes"]
    roles = ("button", "textbox", "spinbutton", "combobox", "slider", "checkbox", "progressbar")
    pressed = [n for n in nodes if n.get("role", {}).get("value") in roles and not n["ignored"]]
    nameless = [n["role"]["value"] for n in pressed if not n.get("name", {}).get("value")]
    assert len(pressed) > 20 and nameless == []


def test_the_state_of_an_answer_is_told_by_more_than_colour(page):
    page.run("edits.change('wall 2', {action: 'remove'})")
    assert page.run("document.querySelector('#ticks text').textContent") == "✗"
    assert page.run("getComputedStyle(document.querySelector('#edits .gone')).strokeDasharray") != (
        "none"
    )


def test_a_page_of_a_plan_without_doubts_is_an_editor_too(chromium, tmp_path):
    files = report_making.files(tmp_path)
    files["confidence"] = []
    shutil.copy(files["walls"], tmp_path / "copy.parquet")
    page = chromium.open(report_making.written(tmp_path, files, name="office").as_uri())
    assert page.complaints == []


# what a run would do: the page of a plan with what was saved
RUN = """
import shutil, sys
shutil.copy(sys.argv[1], sys.argv[2])
"""


@pytest.fixture
def served(chromium, tmp_path):
    """A page behind its server, and the folder of its recording; a run puts another page there."""
    results, recording = tmp_path / "results/office", tmp_path / "recording"
    results.mkdir(parents=True)
    recording.mkdir()
    files = report_making.files(tmp_path)
    storeys = [("Ground floor", "office"), ("First floor", "upstairs")]
    first = report_making.written(tmp_path, files, name="office", storeys=storeys)
    shutil.copy(first, results / "report.html")
    files["corrections"] = tmp_path / "corrections.yaml"
    wall = {"element": "wall", "at": [1.975, 3.1], "action": "remove"}
    files["corrections"].write_text(f"corrections:\n- {json.dumps(wall)}\n")
    after = report_making.written(tmp_path, files, name="office", output="after.html")
    (results / "source.txt").write_text("recording\n")
    run = [sys.executable, "-c", RUN, str(after), str(results / "report.html")]
    with serving(EditSession(results, run)) as server:
        chromium.open(server.address)
        settle(chromium, "!document.getElementById('save').hidden")
        yield chromium, server, recording
    # what the server refuses the browser notes itself
    known = ("request of http://127.0.0.1", "Failed to load resource: the server responded")
    assert all(said.startswith(known) for said in chromium.complaints)


def test_what_is_saved_is_carried_out_and_the_page_shows_the_new_plan(served):
    page, _, recording = served
    page.run("edits.change('wall 3', {action: 'remove'})")
    press(page, "Save and make the plan anew", "#corrections")
    settle(page, "document.getElementById('n-known')?.textContent === '1'")
    settle(page, "!document.getElementById('save').hidden")
    (wall,) = corrections_file.read_corrections(recording / "corrections.yaml")
    assert (wall.action, wall.at_m) == ("remove", (1.975, 3.1))
    assert text_of(page, "#n-fresh") == "No changes yet" and text_of(page, "#told") == ""


def test_a_page_links_other_storeys_where_they_can_be_reached_alone(served):
    page, server, _ = served
    assert not in_sight(page, "#storeys a")
    page.open((server.session.results / "report.html").as_uri())
    assert in_sight(page, "#storeys a") == 2


def test_two_pages_lose_nothing(served):
    page, server, recording = served
    theirs = {"element": "room", "at": [2.0, 1.5], "name": "Theirs"}
    server.session.save({"survey": "office", "revision": "", "entries": [theirs]})
    server.session.run.wait()
    page.run("edits.change('wall 3', {action: 'remove'})")
    press(page, "Save and make the plan anew", "#corrections")
    settle(page, "document.getElementById('told').textContent.includes('Another page')")
    press(page, "Save and make the plan anew", "#corrections")
    settle(page, "document.getElementById('n-known')?.textContent === '1'")
    saved = corrections_file.read_corrections(recording / "corrections.yaml")
    assert {(c.element, c.name) for c in saved} == {("room", "Theirs"), ("wall", "")}


def test_a_page_older_than_the_results_says_so_and_keeps_its_changes(served):
    page, server, _ = served
    page.run("edits.change('wall 4', {action: 'remove'})")
    path = server.session.results / "report.html"
    text = path.read_text()
    made = re.search(r'"made": "(\w+)"', text)[1]
    path.write_text(text.replace(made, "0" * 12))
    page.run("dispatchEvent(new Event('focus'))")
    settle(page, "document.getElementById('told').textContent.includes('newer than this page')")
    assert len(entries(page)) == 1


def test_a_fault_is_told_in_one_line_and_nothing_is_lost(served):
    page, _, recording = served
    page.run("edits.add({element: 'wall', action: 'add', line: [[0, 0], [0, 0.01]]})")
    press(page, "Save and make the plan anew", "#corrections")
    settle(page, "document.getElementById('told').textContent.includes('0.01 m long')")
    assert len(entries(page)) == 1 and not (recording / "corrections.yaml").exists()


def test_what_matters_less_is_asked_when_the_rest_is_answered(chromium, tmp_path, monkeypatch):
    monkeypatch.setattr(doubts, "MOST", 1)
    files = report_making.files(tmp_path)
    rated = report_making.confidence()
    # two walls more
    rows = np.flatnonzero(rated["table"] == "walls")[3:5]
    rated["verify"][rows], rated["doubt"][rows], rated["about"][rows] = True, "few", "existence"
    tables.write_table(files["confidence"], schemas.CONFIDENCE, rated)
    page = chromium.open(report_making.written(tmp_path, files, name="more").as_uri())
    assert text_of(page, "#how-far") == "0 of 1 answered"
    press(page, "Start", "#walk")
    page.key("y")
    assert "2 more things may be looked at" in text_of(page, "#question")
    press(page, "Go on with these", "#walk")
    assert text_of(page, "#how-far") == "1 of 3 answered"
    assert text_of(page, "#walk .where") == "2 of 3"
