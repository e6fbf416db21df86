"""What is told of the changes of a floor held against what was done to it."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import shapely
from rebuilt_offices import Edit

from scanplan.changes.verdicts import GONE, LIKELY, MOVED, NEW, OPENED, SHUT, Change

NEAR_M = 0.4  # of a change from where it was made: a wall moved by 30 cm, and what plans err by
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
_FOUND = 0.5  # of the length of an edit that rows of its verdict cover


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


def say(judged: Sequence[Judged]) -> str:
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


def judge(changes: Sequence[Change], edits: Sequence[Edit], observable: set[Edit]) -> Judged:
    """Return what became of the edits of a pair.

    A change of walls and openings is right if an edit of its verdict was made there; a wall that
    moved may also be gone and new.
    """
    likely = [c for c in changes if c.is_change and c.table in ("wall", "opening")]
    right = [c for c in likely if any(fits(c, edit) for edit in edits)]
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
        if not any(fits(state, edit) for edit in edits):
            print(f"  swung: {state.verdict} {state.shape.wkt[:70]} {state.p:.2f}")
    gone = sum(c.verdict == GONE for c in wrong)
    return Judged(len(right), len(likely), gone, became, observable)


def fits(change: Change, edit: Edit) -> bool:
    """Return whether a change is of the kind of an edit, and where that was made."""
    verdicts = {edit.verdict, GONE, NEW} if edit.verdict == MOVED else {edit.verdict}
    # a door in a wall that was taken away went with it
    is_of_table = change.table == edit.table or (edit.table == "wall" and edit.verdict == GONE)
    far_m = shapely.hausdorff_distance(change.shape, edit.line)
    beside = shapely.distance(shapely.get_point(change.shape, [0, -1]), edit.line).max()
    return change.verdict in verdicts and is_of_table and bool(min(far_m, beside) <= NEAR_M)


def _is_found(edit: Edit, likely: Sequence[Change]) -> bool:
    rows = [c.shape for c in likely if fits(c, edit)]
    near = edit.line.buffer(NEAR_M + 0.1)
    return sum(row.intersection(near).length for row in rows) >= _FOUND * edit.line.length


def _is_unseen(edit: Edit, changes: Sequence[Change]) -> bool:
    """Return whether most of an edit is told as not seen by one of the two."""
    rows = [c.shape for c in changes if c.table == edit.table and c.verdict == "not_seen"]
    near = edit.line.buffer(NEAR_M)
    return sum(row.intersection(near).length for row in rows) >= _FOUND * edit.line.length
