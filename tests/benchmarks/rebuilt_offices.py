"""The demo office rebuilt: what is done to it by each kind of survey, and the drawing after it."""

import json
from dataclasses import dataclass
from pathlib import Path

import shapely
from drawn_edits import rebuild_office
from office_drawings import (
    Drawing,
    carry_furniture,
    draw_door,
    draw_wall,
    find,
    kind_of,
    remove,
    turn_drawing,
)

from scanplan.changes.verdicts import GONE, MOVED, NEW

_LEAST_M = 0.1  # that a wall is moved by which ought to be told
_PART_M = ((0.8, 5.95), (1.7, 5.95), (1.7, 8.6), (5.4, 8.6), (5.4, 3.0), (1.9, 3.0))
_PART_ON_M = ((1.9, 5.95), (7.7, 5.95), (7.7, 3.6))
_EAST_M = (
    *((4.0, 5.95), (5.4, 5.95), (5.4, 8.6), (5.4, 5.95), (10.3, 5.95), (10.3, 8.2), (10.3, 3.6)),
    *((10.3, 5.95), (12.1, 5.95), (12.1, 2.4), (16.5, 2.4), (16.5, 8.8), (13.8, 8.8)),
)
_WAYS_M = {"part": (*_PART_M, *_PART_ON_M), "west": _PART_M, "east": _EAST_M}
"""Of surveys that see a part of the floor."""
DRAWN = "drawn"
_DRAWN_CARRIED = 100  # seeds of furniture of floors that are drawn
_OFFICE = Path(__file__).parents[2] / "config/buildings/demo_office.geojson"
_CARRIED = {"furn": 3, "furn2": 5, "mix3": 7, "mix4": 11, "mix5": 13, "east": 17}
"""Seeds of where furniture is carried to, by what was done."""


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


def draw(project: Path, kind: str) -> Drawing:
    """Return the demo office after what a kind of surveys has done to it, in their frame."""
    drawing = rebuild(project, kind)
    return drawing if is_earlier(kind) else turn_drawing(drawing)


def is_earlier(kind: str) -> bool:
    """Return whether nothing has been done yet."""
    return kind in ("a", "west")


def rebuild(project: Path, kind: str) -> Drawing:
    """Return the demo office after what a kind of surveys has done to it, in the frame before."""
    path = project / "config/buildings/demo_office.geojson"
    drawing: Drawing = json.loads(path.read_text(encoding="utf-8"))
    steps = {
        "mix1": _rebuild_first,
        "part": _rebuild_first,
        "east": _rebuild_first,
        "mix2": _rebuild_second,
        "mix3": _rebuild_third,
        "mix4": _rebuild_fourth,
        "mix5": _rebuild_fifth,
    }
    if kind in steps:
        steps[kind](drawing)
    if kind in _WAYS_M:
        find(drawing, "waypoints")["geometry"]["coordinates"] = list(_WAYS_M[kind])
    if kind.startswith(DRAWN):
        rebuild_office(drawing, seed_of(kind))
        carry_furniture(drawing, _DRAWN_CARRIED + seed_of(kind))
    if kind in _CARRIED:
        carry_furniture(drawing, _CARRIED[kind])
    if kind.startswith(("mix", DRAWN)):
        drawing["features"] = [f for f in drawing["features"] if kind_of(f) != "waypoints"]
    return drawing


def list_edits(kind: str) -> tuple[Edit, ...]:
    """Return what was done to a floor."""
    if not kind.startswith(DRAWN):
        return EDITS.get(kind, ())
    drawing = json.loads(_OFFICE.read_text(encoding="utf-8"))
    return tuple(Edit(*edit) for edit in rebuild_office(drawing, seed_of(kind)))


def seed_of(kind: str) -> int:
    return int(kind.removeprefix(DRAWN))


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
EDITS["east"] = EDITS["mix1"]
EDITS["part"] = tuple(edit for edit in EDITS["mix1"] if edit.ends_m[0][0] < 11.25)
"""The shorter way leads past what is farther east."""


def _rebuild_first(drawing: Drawing) -> None:
    """Move walls by 10 and 30 cm, take one away, add one, wall a door up, break one through."""
    find(drawing, "wall", [[6.8, 0], [6.8, 5]])["geometry"]["coordinates"] = [[6.9, 0], [6.9, 5]]
    moved = find(drawing, "wall", [[7.4, 6.9], [7.4, 12]])
    moved["geometry"]["coordinates"] = [[7.7, 6.9], [7.7, 12]]
    remove(drawing, "wall", [[3.2, 6.9], [3.2, 12]])
    remove(drawing, "opening", [[3.2, 8.0], [3.2, 9.2]])
    remove(drawing, "opening", [13.8, 5])
    drawing["features"] += [draw_wall([[11.2, 1.7], [14.8, 1.7]]), draw_door([11.2, 3.6])]


def _rebuild_second(drawing: Drawing) -> None:
    """Move walls by 2, 5 and 10 cm, take one away, add one, wall a door up, break one through."""
    find(drawing, "wall", [[3.8, 0], [3.8, 5]])["geometry"]["coordinates"] = [[3.85, 0], [3.85, 5]]
    find(drawing, "opening", [3.8, 3.0])["geometry"]["coordinates"] = [3.85, 3.0]
    nudged = find(drawing, "wall", [[11.2, 0], [11.2, 5]])
    nudged["geometry"]["coordinates"] = [[11.22, 0], [11.22, 5]]
    moved = find(drawing, "wall", [[12.9, 6.9], [12.9, 12]])
    moved["geometry"]["coordinates"] = [[13.0, 6.9], [13.0, 12]]
    remove(drawing, "wall", [[11.2, 6.9], [11.2, 12]])
    remove(drawing, "opening", [1.7, 6.9])
    drawing["features"] += [draw_wall([[3.2, 9.6], [4.9, 9.6]]), draw_door([7.4, 9.5])]


def _rebuild_third(drawing: Drawing) -> None:
    """Move walls by 12 and 20 cm, take one away, add two, wall a door up, break one through."""
    find(drawing, "wall", [[3.8, 0], [3.8, 5]])["geometry"]["coordinates"] = [[4.0, 0], [4.0, 5]]
    find(drawing, "opening", [3.8, 3.0])["geometry"]["coordinates"] = [4.0, 3.0]
    moved = find(drawing, "wall", [[11.2, 6.9], [11.2, 12]])
    moved["geometry"]["coordinates"] = [[11.08, 6.9], [11.08, 12]]
    remove(drawing, "wall", [[4.6, 12], [4.6, 10.3]])
    remove(drawing, "opening", [10.3, 5])
    added = [draw_wall([[0, 1.6], [4.0, 1.6]]), draw_wall([[15.2, 6.9], [15.2, 9.2]])]
    drawing["features"] += [*added, draw_door([6.8, 3.6])]


def _rebuild_fourth(drawing: Drawing) -> None:
    """Move walls by 10 and 15 cm, take one away, add two, wall a door up, break one through."""
    moved = find(drawing, "wall", [[14.8, 0], [14.8, 5]])
    moved["geometry"]["coordinates"] = [[14.9, 0], [14.9, 5]]
    find(drawing, "opening", [14.8, 2.4])["geometry"]["coordinates"] = [14.9, 2.4]
    around = find(drawing, "wall", [[13.0, 5], [13.0, 3.3], [14.8, 3.3]])
    around["geometry"]["coordinates"][-1] = [14.9, 3.3]
    moved = find(drawing, "wall", [[12.9, 6.9], [12.9, 12]])
    moved["geometry"]["coordinates"] = [[12.75, 6.9], [12.75, 12]]
    remove(drawing, "wall", [[3.8, 0], [3.8, 5]])
    remove(drawing, "opening", [3.8, 3.0])
    remove(drawing, "opening", [5.4, 6.9])
    added = [draw_wall([[7.4, 9.6], [11.2, 9.6]]), draw_wall([[16.0, 12], [16.0, 10.2]])]
    drawing["features"] += [*added, draw_door([11.2, 8.6])]


def _rebuild_fifth(drawing: Drawing) -> None:
    """Move walls by 10 and 15 cm, take one away, add two, wall a door up, break one through."""
    find(drawing, "wall", [[6.8, 0], [6.8, 5]])["geometry"]["coordinates"] = [[6.95, 0], [6.95, 5]]
    moved = find(drawing, "wall", [[3.2, 6.9], [3.2, 12]])
    moved["geometry"]["coordinates"] = [[3.3, 6.9], [3.3, 12]]
    passage = find(drawing, "opening", [[3.2, 8.0], [3.2, 9.2]])
    passage["geometry"]["coordinates"] = [[3.3, 8.0], [3.3, 9.2]]
    remove(drawing, "wall", [[12.9, 6.9], [12.9, 12]])
    remove(drawing, "opening", [12.1, 5])
    added = [draw_wall([[0, 9.7], [3.3, 9.7]]), draw_wall([[15.4, 6.9], [15.4, 8.6]])]
    drawing["features"] += [*added, draw_door([3.8, 1.9])]
