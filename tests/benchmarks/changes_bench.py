"""What is told of the changes of a floor that is rebuilt, in pairs of simulated surveys.

The demo office before and after edits of its drawing, in another frame, by other sensors and on
other ways; edits are known, so that each change that is told is right or wrong.
"""

import copy
import json
import math
import random
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import shapely
import shapely.affinity
import yaml
from drawn_edits import rebuild_office
from seen_edits import Stretch, cast_rays, find_shared

from helpers.default_settings import SETTINGS
from scanplan.arrays import array_plan
from scanplan.changes import comparison, growth
from scanplan.changes.joined_scans import JoinedScans
from scanplan.changes.verdicts import GONE, LIKELY, MOVED, NEW, OPENED, SHUT, Change
from scanplan.errors import StageError
from scanplan.plan import floorplan_files
from scanplan.plan.floorplan import FloorPlan, centrelines_m
from scanplan.store import registered_scans, tables
from scanplan.types import BoolArray, FloatArray

Drawing = dict[str, Any]
TURN_RAD, SHIFT_M = math.radians(40), (3.0, 0.5)
"""Of the frame of every later survey."""
_LASER = {
    "mount": {"height_m": 0.3},
    "sensor": {"model": "laser", "n_azimuth": 541, "field_deg": 270.0, "max_range_m": 30.0},
    "people": {"count": 3},
}
SENSORS: dict[str, dict[str, Any]] = {
    "vlp": {},
    "las": _LASER,
    "ous": {"sensor": {"model": "ouster64", "n_azimuth": 512}},
}
"""By the last word of a survey's name."""
SURVEYS = (
    *("a_vlp", "a_las", "a_ous", "same_vlp", "same_las", "furn_vlp", "furn_las"),
    *("mix1_vlp", "mix1_las", "mix2_vlp", "mix2_ous", "part_vlp"),
    *("furn2_vlp", "furn2_las", "mix3_vlp", "mix3_las"),
    *("mix4_vlp", "mix4_las", "mix5_vlp", "mix5_las"),
)
"""By what was done to the floor (a: nothing yet) and the sensor; `part` is a shorter way.

What is likely enough to be told was chosen on all but the last eight, and on surveys of floors that
are drawn at random (drawn1_vlp: a seed and a sensor), which have to be named.
"""
GROWN = (("part_vlp", "mix1_las"), ("mix1_las", "part_vlp"), ("a_las", "same_vlp"))
"""Surveys of which one plan is made, of a scanner in space and a planar one, nothing changed."""
TABLES = ("faces", "walls", "openings", "rooms", "free", "furniture", "confidence")
"""Of a plan: what is compared."""
_NEAR_M = 0.4  # of a change from where it was made: a wall moved by 30 cm, and what plans err by
_SWUNG = {SHUT: GONE, OPENED: NEW}
"""What else a door may be that is shut, or opened."""
OUTCOMES = _TOLD, _SHUT, _DOUBTED, _UNSEEN, _MISSED = (
    "told",
    "told as shut or walled up",
    "doubtful",
    "not seen",
    "missed",
)
"""What may become of an edit."""
_ON_M = 0.1  # of a wall that is drawn from the faces of a true one
_FOUND = 0.5  # of the length of an edit that rows of its verdict cover
_SEEN = 0.5  # of the length of an edit, seen by both surveys: it ought to be told
_LEAST_M = 0.1  # that a wall is moved by which ought to be told
_HALF_M = 0.05  # half of the thickness of walls that are added
_PART_M = ((0.8, 5.95), (1.7, 5.95), (1.7, 8.6), (5.4, 8.6), (5.4, 3.0), (1.9, 3.0))
_PART_ON_M = ((1.9, 5.95), (7.7, 5.95), (7.7, 3.6))


@dataclass(frozen=True)
class Edit:
    """What was done to a wall or an opening: where it was, or is, in the frame before.

    `east_m` is how far a wall was moved; `goes_along` says of an opening that it went with its
    wall.
    """

    table: str
    verdict: str
    ends_m: tuple[tuple[float, float], tuple[float, float]]
    east_m: float = 0.0
    goes_along: bool = False

    @property
    def counts(self) -> bool:
        """Whether it has to be found: by 10 cm or more."""
        return self.verdict != MOVED or abs(self.east_m) >= _LEAST_M

    @property
    def sides(self) -> tuple[int, int]:
        """From how many sides either survey has to see it, see `seen_edits.find_shared`.

        What closes a door may be a leaf, flush with one side of the wall: both tell.
        """
        if self.table == "opening" and self.verdict == GONE:
            return (0, 0) if self.goes_along else (0, 2)
        stands = {MOVED: (1, 1), GONE: (1, 0), NEW: (0, 1)}
        return stands[self.verdict] if self.table == "wall" else (1, 0)

    @property
    def line(self) -> shapely.LineString:
        """Its line."""
        return shapely.LineString(self.ends_m)


def bench(project: Path, folder: Path, names: Sequence[str]) -> None:
    """Simulate and plan surveys as far as they are not there, and print what is told of pairs.

    Parameters
    ----------
    names : sequence of str
        Of `SURVEYS`, which are the default, or of floors that are drawn.
    """
    wanted = list(names) or list(SURVEYS)
    for name in wanted:
        _make_plan(project, folder, name)
    evaluate(folder, wanted)
    for pair in GROWN:
        if set(pair) <= set(wanted):
            _evaluate_grown(project, folder, pair)


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
            judged.append(_judge(found.changes, made, observable))
            print(f"changes, {before} to {after}: {_say(judged[-1:])}", flush=True)
    print(f"changes, all: {_say(judged)}")
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


@dataclass(frozen=True)
class Judged:
    """What is right of what was told of a pair, and what became of the edits that count.

    Attributes
    ----------
    n_right, n_told, n_wrongly_gone : int
        Changes of walls and openings that are right, all that are told, and those told as gone
        that are there.
    became : dict
        What of `OUTCOMES` became of each edit.
    observable : set
        Edits of which both surveys see enough, by true rays.
    """

    n_right: int
    n_told: int
    n_wrongly_gone: int
    became: dict[Edit, str]
    observable: set[Edit]


def _say(judged: Sequence[Judged]) -> str:
    right, told, gone = (
        sum(getattr(of, name) for of in judged) for name in ("n_right", "n_told", "n_wrongly_gone")
    )
    parts = []
    for name, of_seen in (("observable", True), ("all", False)):
        outcomes = Counter(
            outcome
            for of in judged
            for edit, outcome in of.became.items()
            if edit in of.observable or not of_seen
        )
        counted = ", ".join(f"{outcomes[key]} {key}" for key in OUTCOMES if outcomes[key])
        parts.append(f"of {outcomes.total()} edits ({name}) {counted or 'none'}")
    return (
        f"{right} of {told} told are right; {'; '.join(parts)}; {gone} told as gone that are there"
    )


def _judge(changes: Sequence[Change], edits: Sequence[Edit], observable: set[Edit]) -> Judged:
    """Return what became of the edits of a pair.

    A change of walls and openings is right if an edit of its verdict was made there; a wall that
    moved may also be gone and new.
    """
    likely = [c for c in changes if c.is_change and c.table in ("wall", "opening")]
    right = [c for c in likely if any(_fits(c, edit) for edit in edits)]
    wrong = [c for c in likely if c not in right]
    for change in wrong:
        print(f"  wrong: {change.table} {change.verdict} {change.shape.wkt[:70]} {change.p:.2f}")
    states = [replace(c, verdict=_SWUNG[c.verdict]) for c in changes if c.verdict in _SWUNG]
    shut = [c for c in states if c.p >= LIKELY]
    ways = list(zip(OUTCOMES[:3], (likely, shut, changes), strict=True))
    became = {
        edit: next(
            (outcome for outcome, found in ways if _is_found(edit, found)),
            _UNSEEN if _is_unseen(edit, changes) else _MISSED,
        )
        for edit in edits
        if edit.counts
    }
    for edit, outcome in became.items():
        if outcome != _TOLD:
            said = "" if edit in observable else ", not observable"
            print(f"  {outcome}{said}: {edit.table} {edit.verdict} {edit.ends_m}")
    for state in states:
        if not any(_fits(state, edit) for edit in edits):
            print(f"  swung: {state.verdict} {state.shape.wkt[:70]} {state.p:.2f}")
    gone = sum(c.verdict == GONE for c in wrong)
    return Judged(len(right), len(likely), gone, became, observable)


def _list_reached(folder: Path, name: str, made: set[Edit]) -> dict[Edit, BoolArray]:
    """Return which cells of edits the true rays of a survey reach, see `TrueRays.reach`.

    Of an earlier survey those of all that were made since.
    """
    rays = cast_rays(folder / f"surveys/{name}.yaml")
    kind = _kind_of(name)
    is_later = kind != "a"
    if is_later:
        rays = rays.moved(_turn_back)
    walls = [
        (shapely.LineString(f["geometry"]["coordinates"]), _own(f)["thickness_m"] / 2)
        for f in json.loads((folder / "drawings/a.geojson").read_text())["features"]
        if _kind(f) == "wall"
    ]
    listed = list_edits(kind) if is_later else made
    reached = {}
    for edit in listed:
        middle = edit.line.centroid
        half_m = next((half_m for line, half_m in walls if line.distance(middle) < _ON_M), _HALF_M)
        east_m = np.array([edit.east_m if is_later else 0.0, 0.0])
        reached[edit] = rays.reach(Stretch(np.array(edit.ends_m) + east_m, half_m))
    return reached


def _turn_back(xy_m: FloatArray) -> FloatArray:
    """Return places in the frame of later surveys in that of earlier ones, as `_turn` turns."""
    cosine, sine = math.cos(TURN_RAD), math.sin(TURN_RAD)
    return (xy_m - SHIFT_M) @ np.array([[cosine, -sine], [sine, cosine]])


def _kind_of(name: str) -> str:
    return name.partition("_")[0]


def _fits(change: Change, edit: Edit) -> bool:
    verdicts = {edit.verdict, GONE, NEW} if edit.verdict == MOVED else {edit.verdict}
    # a door in a wall that was taken away went with it
    is_of_table = change.table == edit.table or (edit.table == "wall" and edit.verdict == GONE)
    far_m = shapely.hausdorff_distance(change.shape, edit.line)
    beside = shapely.distance(shapely.get_point(change.shape, [0, -1]), edit.line).max()
    return change.verdict in verdicts and is_of_table and bool(min(far_m, beside) <= _NEAR_M)


def _is_found(edit: Edit, likely: Sequence[Change]) -> bool:
    rows = [c.shape for c in likely if _fits(c, edit)]
    near = edit.line.buffer(_NEAR_M + 0.1)
    return sum(row.intersection(near).length for row in rows) >= _FOUND * edit.line.length


def _evaluate_grown(project: Path, folder: Path, names: Sequence[str]) -> None:
    """Print how much of a floor the plans of two surveys have, and the one plan of both."""
    known = [read_survey(folder / "results" / name) for name in names]

    def assemble(joined: JoinedScans) -> tuple[FloorPlan, Mapping[str, Any]]:
        made = array_plan.assemble_plan(joined, names[-1], 1)
        return array_plan.rate_plan(made, joined), made.evidence

    grown = growth.grow_plan(known, SETTINGS, assemble)
    changed = sum(c.is_change for step in grown.steps for c in step.changes)
    print(f"grown, {' and '.join(names)}: {changed} told as changed")
    truth = draw(project, names[0].partition("_")[0])
    first_from_last = grown.steps[0].tie.fit.motion
    for name, plan, move in (
        (names[0], known[0][0], None),
        (names[1], known[1][0], first_from_last.move),
        ("both", grown.plan, None),
    ):
        print(f"grown, {name}: {_measure_drawn(plan, move, truth)}", flush=True)


def _measure_drawn(plan: FloorPlan, move: Any, truth: Drawing) -> str:
    def place(shape: Any) -> Any:
        return shapely.transform(shape, move) if move else shape

    walls = [f for f in truth["features"] if _kind(f) == "wall" and "height_m" not in _own(f)]
    lines = [shapely.LineString(f["geometry"]["coordinates"]) for f in walls]
    reach_m = [_own(f)["thickness_m"] / 2 + _ON_M for f in walls]
    drawn = place(shapely.union_all(shapely.linestrings(plan.wall_shapes.lines_m)))
    found_m = sum(
        line.intersection(drawn.buffer(far_m)).length
        for line, far_m in zip(lines, reach_m, strict=True)
    )
    grounds = [line.buffer(far_m) for line, far_m in zip(lines, reach_m, strict=True)]
    right_m = drawn.intersection(shapely.union_all(grounds)).length
    said = [f"{found_m:.0f} of {sum(line.length for line in lines):.0f} m of wall"]
    said.append(f"{drawn.length - right_m:.0f} m that are none")
    middles = place(shapely.points(centrelines_m(plan.openings).mean(axis=1)))
    for kind in ("door", "window"):
        placed = shapely.MultiPoint(middles[plan.openings["type"] == kind])
        there = [_middle(f) for f in truth["features"] if _own(f).get("type") == kind]
        n_right = sum(middle.distance(placed) <= _NEAR_M for middle in there if not placed.is_empty)
        said.append(f"{n_right} of {len(there)} {kind}s ({len(placed.geoms)} drawn)")
    return ", ".join(said)


def _own(feature: Drawing) -> dict[str, Any]:
    return feature["properties"]


def _middle(opening: Drawing) -> shapely.Point:
    coordinates = np.array(opening["geometry"]["coordinates"], float)
    return shapely.Point(coordinates.reshape(-1, 2).mean(axis=0))


def _is_unseen(edit: Edit, changes: Sequence[Change]) -> bool:
    """Return whether most of an edit is told as not seen by one of the two."""
    rows = [c.shape for c in changes if c.table == edit.table and c.verdict == "not_seen"]
    near = edit.line.buffer(_NEAR_M)
    return sum(row.intersection(near).length for row in rows) >= _FOUND * edit.line.length


def _compare(folder: Path, before: str, after: str) -> comparison.Comparison:
    plans, scans = zip(*(read_survey(folder / "results" / n) for n in (before, after)), strict=True)
    return comparison.compare_surveys((plans[0], plans[1]), (scans[0], scans[1]))


def read_survey(results: Path) -> tuple[FloorPlan, comparison.Scans]:
    """Return the plan and the scans of a survey's results."""
    files = {table: results / f"plan/{table}.parquet" for table in TABLES}
    plan = floorplan_files.read_floorplan(files, results.name)
    registered = registered_scans.read_registered_scans(results / "registration.parquet")
    return plan, (tables.ScanStore(results / "scans.parquet"), registered)


def _make_plan(project: Path, folder: Path, name: str) -> None:
    kind, _, sensor = name.partition("_")
    drawing = folder / f"drawings/{kind}.geojson"
    drawing.parent.mkdir(parents=True, exist_ok=True)
    drawing.write_text(json.dumps(draw(project, kind)))
    seed = 1 + SURVEYS.index(name) if name in SURVEYS else _DRAWN_SEEDS + _seed_of(kind)
    simulated: dict[str, Any] = {
        "building": str(drawing.resolve()),
        "seed": seed,
        **SENSORS[sensor],
    }
    if kind == "same":
        simulated["site"] = {"route": "rooms"}
    if kind.startswith("furn"):
        simulated["site"] = {"leaves": 0.6}
    plan_survey(project, folder, name, simulated)


def plan_survey(project: Path, folder: Path, name: str, simulated: Mapping[str, Any]) -> None:
    """Simulate a survey and make its plan, as far as both are not there."""
    survey = folder / f"surveys/{name}.yaml"
    survey.parent.mkdir(parents=True, exist_ok=True)
    survey.write_text(yaml.safe_dump({"simulate": dict(simulated)}))
    wanted = [f"results/{name}/plan/{table}.parquet" for table in TABLES]
    command = [sys.executable, "-m", "snakemake", "-s", str(project / "Snakefile"), *wanted]
    command += ["--cores", "2", "--config", f"dataset={survey.resolve()}"]
    subprocess.run(command, cwd=folder, check=True)


def draw(project: Path, kind: str) -> Drawing:
    """Return the demo office after what a kind of surveys has done to it."""
    path = project / "config/buildings/demo_office.geojson"
    drawing: Drawing = json.loads(path.read_text(encoding="utf-8"))
    rebuild = {
        "mix1": _rebuild_first,
        "part": _rebuild_first,
        "mix2": _rebuild_second,
        "mix3": _rebuild_third,
        "mix4": _rebuild_fourth,
        "mix5": _rebuild_fifth,
    }
    if kind in rebuild:
        rebuild[kind](drawing)
    if kind.startswith(_DRAWN):
        rebuild_office(drawing, _seed_of(kind))
        _carry_furniture(drawing, _DRAWN_CARRIED + _seed_of(kind))
    if kind in _CARRIED:
        _carry_furniture(drawing, _CARRIED[kind])
    if kind.startswith(("mix", _DRAWN)):
        drawing["features"] = [f for f in drawing["features"] if _kind(f) != "waypoints"]
    if kind == "part":
        _find(drawing, "waypoints")["geometry"]["coordinates"] = [*_PART_M, *_PART_ON_M]
    return drawing if kind == "a" else _turn(drawing)


def list_edits(kind: str) -> tuple[Edit, ...]:
    """Return what was done to a floor."""
    if not kind.startswith(_DRAWN):
        return EDITS.get(kind, ())
    drawing = json.loads(_OFFICE.read_text(encoding="utf-8"))
    return tuple(Edit(*edit) for edit in rebuild_office(drawing, _seed_of(kind)))


def _seed_of(kind: str) -> int:
    return int(kind.removeprefix(_DRAWN))


_DRAWN = "drawn"
_DRAWN_SEEDS, _DRAWN_CARRIED = 1000, 100  # of surveys and furniture of floors that are drawn
_OFFICE = Path(__file__).parents[2] / "config/buildings/demo_office.geojson"
_CARRIED = {"furn": 3, "furn2": 5, "mix3": 7, "mix4": 11, "mix5": 13}
"""Seeds of where furniture is carried to, by what was done."""
EDITS: dict[str, tuple[Edit, ...]] = {
    "same": (),
    "furn": (),
    "furn2": (),
    "mix1": (
        Edit("wall", MOVED, ((6.8, 0.15), (6.8, 4.9)), 0.1),
        Edit("wall", MOVED, ((7.4, 7.0), (7.4, 11.85)), 0.3),
        Edit("wall", GONE, ((3.2, 7.0), (3.2, 8.0))),
        Edit("wall", GONE, ((3.2, 9.2), (3.2, 11.85))),
        Edit("opening", GONE, ((3.2, 8.0), (3.2, 9.2)), goes_along=True),
        Edit("wall", NEW, ((11.3, 1.7), (14.7, 1.7))),
        Edit("opening", GONE, ((13.4, 5.0), (14.2, 5.0))),
        Edit("opening", NEW, ((11.2, 3.15), (11.2, 4.05))),
    ),
    "mix2": (
        Edit("wall", MOVED, ((3.8, 0.15), (3.8, 4.9)), 0.05),
        Edit("wall", MOVED, ((11.2, 0.15), (11.2, 4.9)), 0.02),
        Edit("wall", MOVED, ((12.9, 7.0), (12.9, 11.85)), 0.1),
        Edit("wall", GONE, ((11.2, 7.0), (11.2, 11.85))),
        Edit("wall", NEW, ((3.25, 9.6), (4.9, 9.6))),
        Edit("opening", GONE, ((1.25, 6.9), (2.15, 6.9))),
        Edit("opening", NEW, ((7.4, 9.05), (7.4, 9.95))),
    ),
    "mix3": (
        Edit("wall", MOVED, ((3.8, 0.15), (3.8, 4.9)), 0.2),
        Edit("wall", MOVED, ((11.2, 7.0), (11.2, 11.85)), -0.12),
        Edit("wall", GONE, ((4.6, 11.85), (4.6, 10.3))),
        Edit("wall", NEW, ((0.15, 1.6), (3.95, 1.6))),
        Edit("wall", NEW, ((15.2, 7.0), (15.2, 9.2))),
        Edit("opening", GONE, ((9.85, 5.0), (10.75, 5.0))),
        Edit("opening", NEW, ((6.8, 3.15), (6.8, 4.05))),
    ),
    "mix4": (
        Edit("wall", MOVED, ((14.8, 0.15), (14.8, 4.9)), 0.1),
        Edit("wall", MOVED, ((12.9, 7.0), (12.9, 11.85)), -0.15),
        Edit("wall", GONE, ((3.8, 0.15), (3.8, 4.9))),
        Edit("opening", GONE, ((3.8, 2.55), (3.8, 3.45)), goes_along=True),
        Edit("wall", NEW, ((7.5, 9.6), (11.1, 9.6))),
        Edit("wall", NEW, ((16.0, 11.85), (16.0, 10.2))),
        Edit("opening", GONE, ((4.95, 6.9), (5.85, 6.9))),
        Edit("opening", NEW, ((11.2, 8.15), (11.2, 9.05))),
    ),
    "mix5": (
        Edit("wall", MOVED, ((6.8, 0.15), (6.8, 4.9)), 0.15),
        Edit("wall", MOVED, ((3.2, 9.2), (3.2, 11.85)), 0.1),
        Edit("wall", MOVED, ((3.2, 7.0), (3.2, 8.0)), 0.1),
        Edit("wall", GONE, ((12.9, 7.0), (12.9, 11.85))),
        Edit("wall", NEW, ((0.15, 9.7), (3.25, 9.7))),
        Edit("wall", NEW, ((15.4, 7.0), (15.4, 8.6))),
        Edit("opening", GONE, ((11.65, 5.0), (12.55, 5.0))),
        Edit("opening", NEW, ((3.8, 1.45), (3.8, 2.35))),
    ),
}
"""What was done to walls and openings."""
EDITS["part"] = tuple(edit for edit in EDITS["mix1"] if edit.ends_m[0][0] < 11.25)
"""The shorter way leads past what is farther east."""


def _rebuild_first(drawing: Drawing) -> None:
    """Move walls by 10 and 30 cm, take one away, add one, wall a door up, break one through."""
    _find(drawing, "wall", [[6.8, 0], [6.8, 5]])["geometry"]["coordinates"] = [[6.9, 0], [6.9, 5]]
    moved = _find(drawing, "wall", [[7.4, 6.9], [7.4, 12]])
    moved["geometry"]["coordinates"] = [[7.7, 6.9], [7.7, 12]]
    _remove(drawing, "wall", [[3.2, 6.9], [3.2, 12]])
    _remove(drawing, "opening", [[3.2, 8.0], [3.2, 9.2]])
    _remove(drawing, "opening", [13.8, 5])
    drawing["features"] += [_wall([[11.2, 1.7], [14.8, 1.7]]), _door([11.2, 3.6])]


def _rebuild_second(drawing: Drawing) -> None:
    """Move walls by 2, 5 and 10 cm, take one away, add one, wall a door up, break one through."""
    _find(drawing, "wall", [[3.8, 0], [3.8, 5]])["geometry"]["coordinates"] = [[3.85, 0], [3.85, 5]]
    _find(drawing, "opening", [3.8, 3.0])["geometry"]["coordinates"] = [3.85, 3.0]
    nudged = _find(drawing, "wall", [[11.2, 0], [11.2, 5]])
    nudged["geometry"]["coordinates"] = [[11.22, 0], [11.22, 5]]
    moved = _find(drawing, "wall", [[12.9, 6.9], [12.9, 12]])
    moved["geometry"]["coordinates"] = [[13.0, 6.9], [13.0, 12]]
    _remove(drawing, "wall", [[11.2, 6.9], [11.2, 12]])
    _remove(drawing, "opening", [1.7, 6.9])
    drawing["features"] += [_wall([[3.2, 9.6], [4.9, 9.6]]), _door([7.4, 9.5])]


def _rebuild_third(drawing: Drawing) -> None:
    """Move walls by 12 and 20 cm, take one away, add two, wall a door up, break one through."""
    _find(drawing, "wall", [[3.8, 0], [3.8, 5]])["geometry"]["coordinates"] = [[4.0, 0], [4.0, 5]]
    _find(drawing, "opening", [3.8, 3.0])["geometry"]["coordinates"] = [4.0, 3.0]
    moved = _find(drawing, "wall", [[11.2, 6.9], [11.2, 12]])
    moved["geometry"]["coordinates"] = [[11.08, 6.9], [11.08, 12]]
    _remove(drawing, "wall", [[4.6, 12], [4.6, 10.3]])
    _remove(drawing, "opening", [10.3, 5])
    added = [_wall([[0, 1.6], [4.0, 1.6]]), _wall([[15.2, 6.9], [15.2, 9.2]])]
    drawing["features"] += [*added, _door([6.8, 3.6])]


def _rebuild_fourth(drawing: Drawing) -> None:
    """Move walls by 10 and 15 cm, take one away, add two, wall a door up, break one through."""
    moved = _find(drawing, "wall", [[14.8, 0], [14.8, 5]])
    moved["geometry"]["coordinates"] = [[14.9, 0], [14.9, 5]]
    _find(drawing, "opening", [14.8, 2.4])["geometry"]["coordinates"] = [14.9, 2.4]
    around = _find(drawing, "wall", [[13.0, 5], [13.0, 3.3], [14.8, 3.3]])
    around["geometry"]["coordinates"][-1] = [14.9, 3.3]
    moved = _find(drawing, "wall", [[12.9, 6.9], [12.9, 12]])
    moved["geometry"]["coordinates"] = [[12.75, 6.9], [12.75, 12]]
    _remove(drawing, "wall", [[3.8, 0], [3.8, 5]])
    _remove(drawing, "opening", [3.8, 3.0])
    _remove(drawing, "opening", [5.4, 6.9])
    added = [_wall([[7.4, 9.6], [11.2, 9.6]]), _wall([[16.0, 12], [16.0, 10.2]])]
    drawing["features"] += [*added, _door([11.2, 8.6])]


def _rebuild_fifth(drawing: Drawing) -> None:
    """Move walls by 10 and 15 cm, take one away, add two, wall a door up, break one through."""
    _find(drawing, "wall", [[6.8, 0], [6.8, 5]])["geometry"]["coordinates"] = [[6.95, 0], [6.95, 5]]
    moved = _find(drawing, "wall", [[3.2, 6.9], [3.2, 12]])
    moved["geometry"]["coordinates"] = [[3.3, 6.9], [3.3, 12]]
    passage = _find(drawing, "opening", [[3.2, 8.0], [3.2, 9.2]])
    passage["geometry"]["coordinates"] = [[3.3, 8.0], [3.3, 9.2]]
    _remove(drawing, "wall", [[12.9, 6.9], [12.9, 12]])
    _remove(drawing, "opening", [12.1, 5])
    added = [_wall([[0, 9.7], [3.3, 9.7]]), _wall([[15.4, 6.9], [15.4, 8.6]])]
    drawing["features"] += [*added, _door([3.8, 1.9])]


def _carry_furniture(drawing: Drawing, seed: int) -> None:
    """Carry every piece elsewhere in its room, clear of walls and way, by 0.4 to 2.1 m."""
    drawn = random.Random(seed)
    lines = [f["geometry"]["coordinates"] for f in drawing["features"] if _kind(f) == "wall"]
    way = shapely.LineString(_find(drawing, "waypoints")["geometry"]["coordinates"])
    walls = shapely.union_all([shapely.LineString(line).buffer(0.2) for line in lines])
    taken = walls.union(way.buffer(0.4))
    for feature in drawing["features"]:
        if _kind(feature) != "furniture":
            continue
        piece = shapely.Polygon(feature["geometry"]["coordinates"][0])
        for carried in _carry(piece, drawn):
            passed = shapely.LineString([piece.centroid, carried.centroid])
            if not carried.intersects(taken) and not passed.intersects(walls):
                corners = [list(corner) for corner in carried.exterior.coords]
                feature["geometry"]["coordinates"] = [corners]
                break


def _carry(piece: shapely.Polygon, drawn: random.Random) -> Iterator[shapely.Polygon]:
    for _ in range(200):
        x_m, y_m = drawn.uniform(-1.5, 1.5), drawn.uniform(-1.5, 1.5)
        if math.hypot(x_m, y_m) >= 0.4:
            yield shapely.affinity.translate(piece, x_m, y_m)


def _turn(drawing: Drawing) -> Drawing:
    cosine, sine = math.cos(TURN_RAD), math.sin(TURN_RAD)

    def turn(coordinates: Any) -> Any:
        if isinstance(coordinates[0], list | tuple):
            return [turn(inner) for inner in coordinates]
        x, y = coordinates
        return [cosine * x - sine * y + SHIFT_M[0], sine * x + cosine * y + SHIFT_M[1]]

    turned = copy.deepcopy(drawing)
    for feature in turned["features"]:
        feature["geometry"]["coordinates"] = turn(feature["geometry"]["coordinates"])
    return turned


def _kind(feature: Drawing) -> str:
    return feature["properties"]["kind"]


def _find(drawing: Drawing, kind: str, coordinates: Any = None) -> Drawing:
    return next(
        feature
        for feature in drawing["features"]
        if _kind(feature) == kind and coordinates in (None, feature["geometry"]["coordinates"])
    )


def _remove(drawing: Drawing, kind: str, coordinates: Any) -> None:
    drawing["features"].remove(_find(drawing, kind, coordinates))


def _wall(ends_m: Sequence[Sequence[float]]) -> Drawing:
    return {
        "type": "Feature",
        "properties": {"kind": "wall", "thickness_m": 0.1},
        "geometry": {"type": "LineString", "coordinates": ends_m},
    }


def _door(place_m: Sequence[float]) -> Drawing:
    properties = {"kind": "opening", "type": "door", "width_m": 0.9, "sill_m": 0, "lintel_m": 2.05}
    return {
        "type": "Feature",
        "properties": properties,
        "geometry": {"type": "Point", "coordinates": place_m},
    }
