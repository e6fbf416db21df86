"""Ten minutes with the page and nothing else: a plan before and after somebody who knows the floor.

A browser opens the report that `scanplan open` serves. All is done there by mouse and keys: the
walk through the doubts, answered by the truth; cards of what is wrong and nobody asked for; lines
that part rooms, and rooms that are one; openings and walls that are missing, the longest first.
Then it is saved, and the stages run. A person's time is by the keystroke-level model.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import shapely

from helpers import browser
from helpers.pages import click, on_screen, press
from scanplan.lab.evaluation.scores import score_files

_MINUTES = 10
_NEARER = float(np.exp(1))  # by one turn of the wheel, as the page has it
_ALONG = (0.5, 0.3, 0.7, 0.1, 0.9)  # shares of a line
_SIDES_M = 0.6  # from one side of a wall to the other
_OFF_M = 0.3  # of a line's end: the page draws it where it went
_LEAST_M = 0.5  # of a wall or an opening that somebody would notice is not drawn
_PATIENCE_S = 900  # of a run that makes a plan anew
_UNFIT = "#corrections li.fault"  # what cannot be carried out
SECONDS = {"K": 0.28, "P": 1.10, "H": 0.40, "M": 1.35}
"""Of an average typist: a key or button, pointing, a hand to the other device, a thought. Card,
Moran and Newell 1980, The keystroke-level model for user performance time with interactive systems,
Communications of the ACM 23 (7), 396-410. Looking at the building comes to it."""
_MEASURES = (
    *("floorsp_room_f1", "room_iou", "bormann_recall", "bormann_precision"),
    *("wall_completeness_005", "wall_completeness_010", "hand_doors_true", "hand_doors_found"),
    *("wall_n_wrong", "opening_n_wrong", "room_n_wrong", "all_n_wrong"),
)
_KINDS = {"door": "a door", "window": "a window", "passage": "an open passage"}
_DRAWN = {"door": "Door", "window": "Window", "passage": "Open passage"}

SAID = {
    "intel": {
        "parted": [
            ((4.1, 1.25), (7.15, 2.35)),
            ((9.95, 0.1), (12.0, -2.15)),
            ((13.35, -4.6), (13.85, -7.9)),
            ((13.5, -4.55), (17.95, -4.4)),
            ((-6.1, -18.4), (-2.6, -19.65)),
        ],
        "one": [((10, -21), (13.3, -21.4))],
    },
    "lab_ipa": {
        "parted": [
            ((18.25, 16.05), (20.25, 16.1)),
            ((9.95, 20.9), (11.5, 20.9)),
            ((11.95, 23.9), (11.95, 25.2)),
            ((16.15, 14.5), (16.15, 16.05)),
        ],
        "one": [((10.5, 24), (11, 29)), ((12.2, 24.5), (13.5, 24.3)), ((16.6, 15.2), (18, 15.2))],
    },
}
"""What is known of rooms of real floors, in the map frame: seen on a picture of plan and truth."""


@dataclass
class Hand:
    """Somebody's hand on a page: what it does, one act after the other.

    Attributes
    ----------
    page : browser.Page
    acts : str
        Of the model, in order: a letter each.
    """

    page: browser.Page
    acts: str = ""
    _is_at_mouse: bool = field(default=True, repr=False)

    @property
    def seconds(self):
        return time_acts(self.acts)

    def think(self):
        self.acts += "M"

    def press(self, words, within="body"):
        """Click a button by its words."""
        self._point()
        press(self.page, words, within)

    def tap(self, x_m, y_m):
        """Click a place of the plan."""
        self._point()
        click(self.page, on_screen(self.page, x_m, y_m))

    def come_near(self, line_m):
        """Turn the wheel with Ctrl over a line's middle, as far as both ends stay in sight."""
        places = [on_screen(self.page, *place) for place in line_m]
        left, top, right, bottom = self.page.run(
            "(r => [r.left, r.top, r.right, r.bottom])"
            "(document.getElementById('view').getBoundingClientRect())"
        )
        middle = np.mean(places, axis=0)
        ends = middle + _NEARER * (np.array(places) - middle)
        if ((ends > [left, top]) & (ends < [right, bottom])).all():
            self._point()
            self.acts += "K"
            turn = {"deltaX": 0, "deltaY": -300, "modifiers": 2}
            self.page.mouse("mouseWheel", *middle.tolist(), **turn)

    def key(self, key):
        self.acts += "H" * self._is_at_mouse + "K"
        self._is_at_mouse = False
        self.page.key(key)

    def _point(self):
        self.acts += "H" * (not self._is_at_mouse) + "PK"
        self._is_at_mouse = True


def time_acts(acts):
    """Return how many seconds the model gives a person for some acts."""
    return sum(SECONDS[act] for act in acts)


@dataclass
class Known:
    """What somebody knows of a floor: its truth, where the plan has it."""

    elements: dict
    openings: list  # kind, and ground in the map
    missing: list  # table, kind, line (2, 2) in the map, the longest first

    def judge(self, element):
        """Return what is right of an element of the plan: keep, a kind, remove; None if unsure."""
        kind, number = element.split(" ")
        verdict = self.elements.get((kind, int(number)), ("", None))[0]
        if verdict in ("right", "not_entered"):
            return "keep"
        if verdict == "unknown":
            return None
        if kind == "opening" and verdict and self.openings:
            axis = shapely.from_wkb(self.elements[kind, int(number)][1])
            half_m = axis.length / 2
            true = [of for of, ground in self.openings if ground.intersection(axis).length > half_m]
            return true[0] if true else "remove"
        if kind == "wall" and verdict:
            return "furniture" if verdict == "furniture" else "remove"
        return "remove" if kind == "face" and verdict else None


def read_known(placed, score):
    """What the truth says of a plan that was scored."""
    map_from_truth = np.linalg.inv(placed.motion)

    def to_map(shape):
        turn, shift = map_from_truth[:2, :2], map_from_truth[:2, 3]
        return shapely.transform(shape, lambda xy_m: xy_m @ turn.T + shift)

    columns = ("table", "number", "kind", "verdict", "geometry")
    rows = list(zip(*(score.elements[name] for name in columns), strict=True))
    found = {
        (table, int(number)): (verdict, shapely.to_wkb(to_map(shapely.from_wkb(geometry))))
        for table, number, _, verdict, geometry in rows
        if table in ("wall", "face", "opening", "room") and number >= 0
    }
    true = placed.scene.openings
    grounds = [to_map(ground) for ground in true.footprints(0.1)]
    missing = []
    for table, _, kind, verdict, geometry in rows:
        line = to_map(shapely.from_wkb(geometry))
        is_line = line.geom_type == "LineString" and line.length >= _LEAST_M
        if table in ("opening", "stretch") and verdict == "missed" and is_line:
            missing.append((table, kind, shapely.get_coordinates(line)))
    # what an opening lies in comes before it, then the longest
    missing.sort(key=lambda row: (row[0] == "opening", -np.hypot(*(row[2][1] - row[2][0]))))
    kept = [row for i, row in enumerate(missing) if not _is_side(row, missing[:i])]
    return Known(found, list(zip(true.type.tolist(), grounds, strict=True)), kept)


def _is_side(row, before):
    """Whether a line that is missing is the other side of a wall that is drawn already."""
    line = shapely.LineString(row[2])
    grounds = [shapely.LineString(of[2]).buffer(_SIDES_M) for of in before if of[0] == row[0]]
    return row[0] == "stretch" and any(ground.covers(line) for ground in grounds)


def walk(hand, known):
    """Answer the doubts that the page asks, as far as the truth knows."""
    page = hand.page
    if not page.run("!!document.querySelector('#answers button')"):
        return
    hand.press("Start", "#walk")
    for _ in range(int(page.run("document.getElementById('progress').max"))):
        asked = page.run("document.querySelector('.picked')?.dataset.element ?? ''")
        if not asked or page.run("document.getElementById('walk').classList.contains('done')"):
            break
        hand.think()
        right = known.judge(asked)
        if right is None:
            hand.key("ArrowRight")
        elif right == "keep":
            hand.key("y")
        else:
            hand.key("n")
            _correct(hand, asked, right, "#answers")
    hand.press("Stop", "#walk")
    hand.press("Fit")  # the walk has come near


def _correct(hand, element, right, within):
    kind = element.split(" ")[0]
    words = {"furniture": "Furniture", "remove": "It is wall" if kind == "opening" else
             "Nothing is there"}.get(right) or f"It is {_KINDS[right]}"  # fmt: skip
    offered = hand.page.run(
        f"[...document.querySelectorAll('{within} button')].map(b => b.textContent.trim())"
    )
    # what is drawn as of that kind already differs in something else, such as its width
    hand.press(words if words in offered else "Back" if within == "#answers" else "×", within)
    if words not in offered and within == "#answers":
        hand.key("ArrowRight")


def open_card(hand, element, at_m):
    """Click an element where it is, or else its row of the tables; whether its card is open."""
    hand.tap(*at_m)
    title = (
        "document.getElementById('card').hidden ? '' : document.querySelector('#card h2').innerText"
    )
    if hand.page.run(title).lower() != element:
        hand._point()
        hand.page.run(f"document.querySelector('tr[data-element=\"{element}\"]').click()")
    return hand.page.run(title).lower() == element


def mend_unasked(hand, known):
    """Correct walls and openings that are none, or others, and that nobody asked for."""
    answered = "edits.entries().map(e => edits.elementOf(e))"
    for kind, number in known.elements:
        element = f"{kind} {number}"
        right = known.judge(element) if kind in ("wall", "opening") else None
        if right in (None, "keep") or element in hand.page.run(answered):
            continue
        at_m = hand.page.run(f"edits.placeOf('{element}')")
        hand.think()
        if open_card(hand, element, at_m):
            _correct(hand, element, right, "#card")


def part_and_join(hand, said):
    """Part rooms by lines, and join others."""
    page = hand.page
    room_at = "edits.nearest('room', [{}, {}]) ?? ''"
    for start, end in said.get("parted", []):
        # something may stand where the line's middle is
        along = [np.add(start, share * np.subtract(end, start)) for share in _ALONG]
        room = next(filter(None, (page.run(room_at.format(*place)) for place in along)), "")
        hand.think()
        if room and open_card(hand, room, page.run(f"edits.placeOf('{room}')")):
            hand.press("Two rooms: draw the line", "#card")
            hand.tap(*start)
            hand.tap(*end)
    for at, other in said.get("one", []):
        room = page.run(room_at.format(*at))
        hand.think()
        if room and open_card(hand, room, at):
            hand.press("One with: tap the other", "#card")
            hand.tap(*other)


def draw_missing(hand, known, most_s):
    """Draw what is missing until the time is over."""
    parted = [of["line"] for of in hand.page.run("edits.entries()") if of.get("action") == "split"]
    grounds = [shapely.LineString(line_m).buffer(_SIDES_M) for line_m in parted]
    for table, kind, line_m in known.missing:
        if hand.seconds > most_s:
            return
        if any(ground.covers(shapely.LineString(line_m)) for ground in grounds):
            continue  # a line that parts two rooms is a passage
        hand.think()
        hand.come_near(line_m)
        hand.press("Draw")
        hand.press("Wall" if table == "stretch" else _DRAWN[kind], "#draw")
        before = hand.page.run("edits.entries().length")
        hand.tap(*line_m[0])
        hand.tap(*line_m[1])
        drawn = hand.page.run("edits.entries()")
        if len(drawn) == before:
            hand.key("Escape")
        elif not _is_as_meant(drawn[-1]["line"], line_m):
            hand.think()
            hand.press("Undo", "#corrections")
        hand.press("Fit")


def _is_as_meant(drawn_m, line_m):
    """Whether a line went where it was meant to go, and not to another wall."""
    off_m = min(np.abs(np.subtract(drawn_m, ends)).max() for ends in (line_m, line_m[::-1]))
    return off_m <= _OFF_M


def save(hand):
    """Save and wait for the plan, without what ends the run.

    Returns
    -------
    machine_s : float
        What the stages take.
    unfit : list of str
        What could not be carried out, in the page's words: taken back where it ended a run.
    """
    page = hand.page
    made = page.run("planView.data.made")
    begin = time.monotonic()
    taken_back = []
    while True:
        hand.think()
        # what was told of an earlier try is none of this one
        page.run("document.getElementById('told').textContent = ''")
        hand.press("Save and make the plan anew", "#corrections")
        told = _wait(page, made, begin + _PATIENCE_S)
        unfit = page.run(f"[...document.querySelectorAll('{_UNFIT}')].map(e => e.innerText)")
        if not told:
            return time.monotonic() - begin, taken_back + unfit
        assert unfit, told
        taken_back += unfit
        for _ in unfit:
            hand.think()
            hand.press("×", _UNFIT)


def _wait(page, made, deadline):
    """Wait for a plan that is another one; return what the page tells where there is none."""
    while time.monotonic() < deadline:
        with suppress(AssertionError):  # the page that is about to be another one
            if page.run("planView.data.made") != made:
                return ""
            told = page.run("document.getElementById('told').classList.contains('flag')"
                            " ? document.getElementById('told').innerText : ''")  # fmt: skip
            if told:
                return told
        time.sleep(0.2)
    raise AssertionError("no plan was made")


@contextmanager
def served(results):
    """The address under which a command of its own serves results."""
    root = Path(__file__).resolve().parents[2]
    main = "import sys; from scanplan.project.run import command; sys.exit(command.main())"
    command = [sys.executable, "-c", main, "open", str(results)]
    with subprocess.Popen(
        [*command, "--no-browser"], stdout=subprocess.PIPE, text=True, cwd=results.parents[1],
        env={**os.environ, "PYTHONPATH": str(root / "scripts")},
    ) as process:  # fmt: skip
        try:
            assert process.stdout is not None
            yield process.stdout.readline().split()[-1]
        finally:
            process.terminate()


def score_corrected(placed):
    """The score of the plan as it is corrected."""
    results = placed.folder
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        shutil.copytree(results / "plan/corrected", folder / "plan")
        shutil.copy(results / "plan/confidence.parquet", folder / "plan")
        shutil.copy(results / "registration.parquet", folder)
        return score_files.score_results(replace(placed, folder=folder))


def place_floor(results, truth):
    """A floor on its truth: drawn by hand (.geojson), of a map (.npz), or simulated (none)."""
    if truth is None:
        return score_files.place_results(results)
    by_hand = Path(truth).suffix == ".geojson"
    place = score_files.place_results_by_hand if by_hand else score_files.place_results_by_raster
    return place(results, truth)


@dataclass(frozen=True)
class Walked:
    """What somebody did on a page, and what became of the plan."""

    before: dict
    after: dict
    entries: list
    acts: str
    machine_s: float
    unfit: list


def walk_floor(results, truth=None, *, minutes=_MINUTES):
    """Mend the plan of results, uncorrected yet, on their page; the corrections stay.

    Parameters
    ----------
    results : pathlib.Path
        A folder below results/.
    truth : path-like, optional
        See `place_floor`.
    minutes : float, optional
        Of a person's time, after which nothing more is drawn.
    """
    if (results / "plan/corrected").exists():
        sys.exit(f"{results}: is corrected already; remove its corrections and run it again")
    placed = place_floor(results, truth)
    before = score_files.score_results(placed)
    known = read_known(placed, before)
    with served(results) as address:
        entries, hand, (machine_s, unfit) = _mend(address, results.name, known, minutes)
    after = score_corrected(placed)
    return Walked(before.measures, after.measures, entries, hand.acts, machine_s, unfit)


def _mend(address, name, known, minutes):
    with (
        tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder,
        browser.Page(folder) as page,
    ):
        page.open(address, width=1600, height=1200)
        deadline = time.monotonic() + 30
        while page.run("document.getElementById('save').hidden"):
            assert time.monotonic() < deadline, "the page found no server"
            time.sleep(0.05)
        hand = Hand(page)
        walk(hand, known)
        mend_unasked(hand, known)
        part_and_join(hand, SAID.get(name, {}))
        draw_missing(hand, known, 60 * minutes)
        entries = page.run("edits.entries()")
        return entries, hand, save(hand)


def bench(results, truth=None):
    """Print what a plan is worth before and after, and what that took."""
    results = Path(results).absolute()
    walked = walk_floor(results, truth)
    counts = Counter(
        f"{entry['element']} {entry.get('action', 'change')}" for entry in walked.entries
    )
    acts = Counter(walked.acts)
    print(f"  {len(walked.unfit)} could not be carried out")
    for words in walked.unfit:
        print(f"    {' '.join(words.split())}")
    n_acts = acts["K"]
    print(f"{results.name}: {len(walked.entries)} things said: {dict(counts)}")
    print(
        f"  {n_acts} presses of keys and buttons; {time_acts(walked.acts):.0f} s by the"
        f" keystroke-level model ({dict(acts)}), {walked.machine_s:.0f} s of the machine"
    )
    for name in _MEASURES:
        was, is_now = (of.get(name, np.nan) for of in (walked.before, walked.after))
        print(f"  {name:24} {was:7.3f} -> {is_now:.3f}")
