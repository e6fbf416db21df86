"""What cannot be carried out: told in the page's own words, marked where it is, taken back."""

import json
import shutil
import tempfile
from pathlib import Path

import pytest

from helpers import report_making
from helpers.correcting import write_plan
from helpers.pages import (
    click,
    entries,
    in_sight,
    middle_of,
    needs_browser,
    press,
    settle,
    tap,
    text_of,
)
from helpers.serving import serving
from helpers.warm_python import serve_python
from scanplan.project.corrections_file import read_corrections
from scanplan.project.run.edit_session import EditSession

pytestmark = needs_browser
# what a run does here: the stages that carry corrections out and write the page, and no others
RUN = """
import sys
sys.path[:0] = {paths}
from pathlib import Path
from correct_plan import correct_plan
from helpers import report_making
from scanplan.errors import StageError
from scanplan.plan import planning
folder, corrections, page = map(Path, sys.argv[1:4])
tables = {{n: folder / f"{{n}}.parquet" for n in planning.TABLES}}
corrected = {{n: folder / f"corrected/{{n}}.parquet" for n in planning.TABLES}}
try:
    correct_plan(corrections, tables, corrected)
except StageError as error:
    sys.exit(print(f"scanplan: correct_plan: {{error}}") or 1)
files = report_making.files(folder / "other") | corrected | {{"corrections": corrections}}
report_making.written(folder / "other", files, name="office", output=page)
"""
ROOT = Path(__file__).resolve().parents[2]
PATHS = [str(ROOT / "tests"), str(ROOT / "scripts")]
GONE = {"element": "wall", "at": [1.975, 3.1], "action": "remove"}
NAMED = {"element": "room", "at": [5.6, 1.5], "name": "Hall"}
# 2.9 m beyond the wall that it is nearest to
DOOR = {"element": "opening", "action": "add", "kind": "door", "line": [[4.05, -3], [4.05, 6]]}
FAR = {"element": "wall", "action": "add", "line": [[300, 0], [304, 0]]}


@pytest.fixture(scope="module")
def python():
    with tempfile.TemporaryDirectory() as folder, serve_python(folder) as program:
        yield program


@pytest.fixture
def served(chromium, python, tmp_path):
    """The page of a plan whose corrections a run carries out, and where they are saved."""
    results, recording = tmp_path / "results/office", tmp_path / "recording"
    for folder in (results, recording, tmp_path / "other"):
        folder.mkdir(parents=True)
    (results / "source.txt").write_text("recording\n")
    write_plan(tmp_path)
    first = report_making.written(tmp_path / "other", report_making.files(tmp_path / "other"),
                                  name="office")  # fmt: skip
    shutil.copy(first, results / "report.html")
    corrections = recording / "corrections.yaml"
    given = [str(path) for path in (tmp_path, corrections, results / "report.html")]
    (tmp_path / "run.py").write_text(RUN.format(paths=PATHS))
    run = [python, str(tmp_path / "run.py"), *given]
    with serving(EditSession(results, run)) as server:
        chromium.open(server.address)
        settle(chromium, "!document.getElementById('save').hidden")
        yield chromium, corrections
        # another test's server may have the port, by which a browser keeps what was said
        chromium.run("Storage.prototype.setItem = () => {}; localStorage.clear()")


def say(page, *said):
    for entry in said:
        page.run(f"edits.add({json.dumps(entry)})")


def save(page):
    page.run("document.getElementById('told').textContent = ''")
    press(page, "Save and make the plan anew", "#corrections")


def save_well(page, made):
    save(page)
    settle(page, f"planView.data.made !== {made!r} && !document.getElementById('save').hidden")


def marked(page):
    return page.run("[...document.querySelectorAll('#corrections li.fault')].map(e => e.innerText)")


def test_what_ends_a_run_is_named_by_its_words_taken_back_and_made_again(served):
    page, corrections = served
    made = page.run("planView.data.made")
    say(page, GONE, FAR, NAMED)
    save(page)
    settle(page, "document.getElementById('told').classList.contains('flag')")
    told = text_of(page, "#told")
    assert told.startswith("“New wall of 4.00 m”: the wall lies 297 m beyond the plan")
    assert "entry" not in told and str(corrections) not in told
    # the others are kept, and nothing is marked of them
    assert entries(page) == [GONE, FAR, NAMED]
    (words,) = marked(page)
    assert words.startswith("New wall of 4.00 m") and "297 m beyond the plan" in words
    assert page.run("document.querySelectorAll('#ticks .fault').length") == 1
    press(page, "×", "#corrections li.fault")
    assert marked(page) == [] and not in_sight(page, "#ticks .fault")
    # what was taken back does not come again where somebody was in another window
    page.run("dispatchEvent(new Event('focus'))")
    page.run("fetch('api/state')")
    assert entries(page) == [GONE, NAMED]
    save_well(page, made)
    assert [c.element for c in read_corrections(corrections)] == ["wall", "room"]
    assert text_of(page, "#told") == "" and page.run("edits.fresh().length") == 0


LATE = """(() => {
  const ask = window.fetch;
  const held = new Promise((go) => { window.late = go; });
  window.fetch = async (...asked) => {
    if (asked[0] !== "api/state") return ask(...asked);
    const answer = await ask(...asked);
    window.isHeld = true;
    await held;
    return answer;
  };
})()"""
"""What the server says of its state arrives when `late` is called."""


def test_what_the_server_said_before_a_save_is_not_news_after_it(served):
    page, _ = served
    page.run(LATE)
    page.run("dispatchEvent(new Event('focus'))")
    settle(page, "window.isHeld")
    say(page, GONE, FAR)
    save(page)
    settle(page, "document.getElementById('told').classList.contains('flag')")
    page.run("late()")
    page.run("new Promise((wait) => setTimeout(wait, 50))")
    press(page, "×", "#corrections li.fault")
    page.run("dispatchEvent(new Event('focus'))")
    page.run("new Promise((wait) => setTimeout(wait, 500))")
    assert entries(page) == [GONE]


def test_nothing_moves_where_a_window_is_come_back_to_after_a_failed_run(served):
    page, _ = served
    say(page, FAR)
    save(page)
    settle(page, "document.querySelector('#corrections li.fault') !== null")
    page.run("""(() => {
      window.moved = [];
      const see = new ResizeObserver(() => window.moved.push(1));
      see.observe(document.querySelector("#corrections"));
    })()""")
    page.run("new Promise((wait) => setTimeout(wait, 100))")
    page.run("dispatchEvent(new Event('focus'))")
    page.run("new Promise((wait) => setTimeout(wait, 500))")
    assert page.run("window.moved.length") == 1


def test_a_failed_run_is_told_again_to_a_page_that_was_closed(served):
    page, _ = served
    say(page, FAR)
    save(page)
    settle(page, "document.querySelector('#corrections li.fault') !== null")
    page.open(page.run("location.href"))
    settle(page, "document.querySelector('#corrections li.fault') !== null")
    # the only change: without it the plan is made anew, too
    press(page, "×", "#corrections li.fault")
    assert page.run("!document.getElementById('save').disabled")
    page.open(page.run("location.href"))
    settle(page, "!document.getElementById('save').hidden")
    settle(page, "!document.getElementById('save').disabled")
    assert entries(page) == [] and text_of(page, "#told") == ""


def test_two_of_one_wall_are_both_marked_and_named(served):
    page, _ = served
    kept = {"element": "wall", "at": [7.1, 1], "action": "keep"}
    say(page, kept, {"element": "wall", "at": [7.1, 2], "action": "remove"})
    save(page)
    settle(page, "document.querySelectorAll('#corrections li.fault').length === 2")
    assert text_of(page, "#told").startswith(
        "“Wall 1 is not there”: is of wall 1, as “Wall 1 is right” is; keep one of the two"
    )


def test_what_fits_no_wall_is_marked_in_a_plan_that_has_the_rest(served):
    page, _ = served
    made = page.run("planView.data.made")
    say(page, GONE, DOOR)
    save_well(page, made)
    assert page.run("edits.fresh().length") == 0 and in_sight(page, "#known li") == 2
    (words,) = marked(page)
    assert words.startswith("New door of 9.00 m") and "2.9 m beyond wall 5" in words
    assert "“New door of 9.00 m" in text_of(page, "header [role=alert]")
    assert "entry" not in text_of(page, "header [role=alert]")
    press(page, "Show", "#corrections li.fault")
    assert "2.9 m beyond wall 5" in text_of(page, "#hint")
    click(page, middle_of(page, "#ticks .fault"))
    press(page, "Take it back", "#card")
    assert marked(page) == [] and not in_sight(page, "#ticks .fault")
    made = page.run("planView.data.made")
    save_well(page, made)
    assert not in_sight(page, "header [role=alert]") and entries(page) == [GONE]


def test_a_refused_change_is_marked_before_anything_is_saved(served):
    page, corrections = served
    say(page, GONE, {"element": "wall", "action": "add", "line": [[0, 0], [0, 0.01]]})
    save(page)
    settle(page, "document.querySelector('#corrections li.fault') !== null")
    assert text_of(page, "#told").startswith("“New wall of 0.01 m in Room 0”: line is 0.01 m long")
    assert not corrections.exists() and len(entries(page)) == 2


def test_both_ends_of_an_opening_lie_on_one_wall(page):
    # the wall between the rooms is nearer to the first, another one to both
    page.run("edits.add({element: 'wall', action: 'add', line: [[4.2, 0.2], [5.2, 2.9]]})")
    press(page, "Draw")
    press(page, "Door", "#draw")
    tap(page, (4.1, 0.5), (4.9, 2.2))
    door = entries(page)[-1]
    assert door["element"] == "opening"
    off_m = [x_m - (4.2 + (y_m - 0.2) / 2.7) for x_m, y_m in door["line"]]
    assert off_m == pytest.approx([0, 0], abs=0.002)


def test_no_opening_is_drawn_in_a_wall_that_is_said_to_be_none(page):
    page.run("edits.change('wall 5', {action: 'remove'})")
    press(page, "Draw")
    press(page, "Door", "#draw")
    tap(page, (4.05, 1.0))
    assert "tap on one" in text_of(page, "#hint") and entries(page)[1:] == []
