"""What is told of the changes of a floor that is rebuilt, in pairs of simulated surveys.

The demo office before and after edits of its drawing, in another frame, by other sensors and on
other ways; edits are known, so that each change that is told is right or wrong.
"""

import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import shapely
from grown_offices import GROWN, evaluate_grown
from office_drawings import BACK, kind_of
from office_surveys import PARTS, SURVEYS, make_plan, read_survey
from rebuilt_offices import Edit, list_edits
from seen_edits import Stretch, cast_rays, find_shared
from told_changes import OUTCOMES, Judged, judge, say

from scanplan.changes import comparison
from scanplan.errors import StageError
from scanplan.types import BoolArray

_SEEN = 0.5  # of the length of an edit, seen by both surveys: it ought to be told
_HALF_M = 0.05  # half of the thickness of walls that are added
_ON_M = 0.1  # of a wall that is drawn from the faces of a true one


def bench(project: Path, folder: Path, names: Sequence[str]) -> None:
    """Simulate and plan surveys as far as they are not there, and print what is told of pairs.

    Parameters
    ----------
    names : sequence of str
        Of `SURVEYS`, which are the default, or of floors that are drawn.
    """
    wanted = list(names) or list(SURVEYS)
    for name in wanted:
        make_plan(project, folder, name)
    evaluate(folder, wanted)
    for name in PARTS if not names else ():
        make_plan(project, folder, name)
        wanted.append(name)
    for pair in GROWN:
        if set(pair) <= set(wanted):
            evaluate_grown(project, folder, pair)


def evaluate(folder: Path, names: Sequence[str]) -> None:
    """Print precision and recall over all pairs of surveys before and after."""
    earlier = [name for name in names if name.startswith("a_")]
    later = [name for name in names if not name.startswith("a_")]
    made = {edit for name in later for edit in list_edits(_kind_of(name))}
    reached = {name: _list_reached(folder, name, made) for name in names}
    judged: list[Judged] = []
    for before in earlier:
        for after in later:
            try:
                found = _compare(folder, before, after)
            except StageError as fault:
                print(f"changes, {before} to {after}: refused, {fault}"[:150], flush=True)
                continue
            made = list_edits(_kind_of(after))
            edits = [edit for edit in made if edit.counts]
            observable = {
                edit
                for edit in edits
                if find_shared((reached[before][edit], reached[after][edit]), edit.sides) >= _SEEN
            }
            judged.append(judge(found.changes, made, observable))
            print(f"changes, {before} to {after}: {say(judged[-1:])}", flush=True)
    print(f"changes, all: {say(judged)}")
    by_kind: Counter[tuple[str, bool, str]] = Counter()
    for of in judged:
        by_kind.update(
            (f"{edit.table} {edit.verdict}", edit in of.observable, outcome)
            for edit, outcome in of.became.items()
        )
    for kind, is_seen in sorted({key[:2] for key in by_kind}):
        counts = [(by_kind[kind, is_seen, outcome], outcome) for outcome in OUTCOMES]
        said = ", ".join(f"{n} {outcome}" for n, outcome in counts if n)
        print(f"changes, {kind}{'' if is_seen else ', not observable'}: {said}")


def _list_reached(folder: Path, name: str, made: set[Edit]) -> dict[Edit, BoolArray]:
    """Return which cells of edits the true rays of a survey reach, see `TrueRays.reach`.

    Of an earlier survey those of all that were made since.
    """
    rays = cast_rays(folder / f"surveys/{name}.yaml")
    kind = _kind_of(name)
    is_later = kind != "a"
    if is_later:
        rays = rays.moved(BACK.move)
    walls = [
        (shapely.LineString(f["geometry"]["coordinates"]), f["properties"]["thickness_m"] / 2)
        for f in json.loads((folder / "drawings/a.geojson").read_text())["features"]
        if kind_of(f) == "wall"
    ]
    listed = list_edits(kind) if is_later else made
    reached = {}
    for edit in listed:
        middle = edit.line.centroid
        half_m = next((half_m for line, half_m in walls if line.distance(middle) < _ON_M), _HALF_M)
        east_m = np.array([edit.east_m if is_later else 0.0, 0.0])
        reached[edit] = rays.reach(Stretch(np.array(edit.ends_m) + east_m, half_m))
    return reached


def _kind_of(name: str) -> str:
    return name.partition("_")[0]


def _compare(folder: Path, before: str, after: str) -> comparison.Comparison:
    plans, scans = zip(*(read_survey(folder / "results" / n) for n in (before, after)), strict=True)
    return comparison.compare_surveys((plans[0], plans[1]), (scans[0], scans[1]))
