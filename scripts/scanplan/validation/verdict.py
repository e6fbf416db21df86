"""Verdict on a plan in one line, with the likeliest cause and the remedy."""

from dataclasses import dataclass

import numpy as np

from scanplan.errors import MOST_NAMED
from scanplan.plan.floorplan import FloorPlan, say_count
from scanplan.stage.witness_table import PLAN, SKETCH, WITNESSES
from scanplan.stage.witnesses import rank_findings, worth_left
from scanplan.store.doubts import Finding

_LEAST_CLOSED = 0.5
"""Of the rooms, and of their floor, that are closed. Where it is less, rooms of the bench's tuning
half have an IoU of .55 and 45 % of them are right; where it is more, .77 and 71 %. (Reporting half:
.69 and 53 %, .78 and 68 %; real floors .25 and 10 %, .75 and 72 %.)"""


@dataclass(frozen=True)
class Verdict:
    """What a drawing is worth.

    Attributes
    ----------
    worth : str
        Of `witness_table.WORTHS`.
    gist : str
        Why, in a few words.
    cause, remedy : str
        Why it is likely so, and what would help; empty of a plan.
    witness : str
        By which finding; empty where rooms alone tell it.
    """

    worth: str
    gist: str
    cause: str = ""
    remedy: str = ""
    witness: str = ""

    @property
    def head(self) -> str:
        """Worth and gist."""
        return f"{self.worth}: {self.gist}"

    @property
    def line(self) -> str:
        """All of it."""
        return "; ".join(filter(None, (self.head, self.cause, self.remedy)))


def judge_plan(plan: FloorPlan) -> Verdict:
    """Return the verdict on a plan.

    It is none where a witness is beyond a limit that no plan of a building has, a sketch where one
    is that leaves measures or parts in doubt, or where less than half of the rooms, or of the
    floor, is closed.
    """
    findings = plan.doubted.findings
    worth = worth_left(findings)
    if worth != PLAN:
        first = rank_findings([f for f in findings if not is_note(f)])[0]
        gist = WITNESSES[first.witness].gist
        return Verdict(worth, gist, first.cause, first.remedy, first.witness)
    closed = np.asarray(plan.rooms["closed"], bool)
    if len(closed) == 0:
        return Verdict(
            SKETCH,
            "no room was found",
            "the sensor saw no floor that walls part",
            "drive through the rooms, and through their doors",
        )
    areas_m2 = np.asarray(plan.rooms["area_m2"], float)
    share = float(areas_m2[closed].sum() / areas_m2.sum())
    counted = f"{closed.sum():,} of {say_count(len(closed), 'room')}"
    verb = "is" if 1 in (closed.sum(), len(closed)) else "are"
    gist = f"{counted} {verb} closed, {share:.0%} of the floor"
    if min(share, closed.mean()) >= _LEAST_CLOSED:
        return Verdict(PLAN, gist)
    by_hand = ~closed & np.isin(plan.rooms["room"], plan.opened_by_hand)
    unseen = ~closed & ~by_hand
    # the likelier cause is that which most of the open floor has
    is_by_hand = bool(areas_m2[by_hand].sum() > areas_m2[unseen].sum())
    open_rows = np.flatnonzero(by_hand if is_by_hand else unseen)
    widest = open_rows[np.argsort(-areas_m2[open_rows], kind="stable")][:MOST_NAMED]
    named = ", ".join(plan.room_labels[row] for row in sorted(widest.tolist()))
    more = " and others" if len(open_rows) > len(widest) else ""
    if is_by_hand:
        remedy = f"merge {named}{more} with the room beyond, or add a wall or an opening"
        return Verdict(SKETCH, gist, "corrections took away what closed them", remedy)
    return Verdict(
        SKETCH,
        gist,
        "parts of the outlines were not seen",
        f"look into {named}{more} from the places that the report names for a next visit",
    )


def is_note(finding: Finding) -> bool:
    """Return whether a finding leaves the verdict unchanged."""
    return worth_left([finding]) == PLAN
