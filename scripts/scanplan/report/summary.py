"""A plan in a few lines of text: what there is, what is doubtful, what it was made of."""

import numpy as np

from scanplan.errors import MOST_NAMED
from scanplan.plan import floorplan
from scanplan.project.texts import fold_line
from scanplan.report import page_tables, wording
from scanplan.report.facts import SurveyFacts
from scanplan.validation.doubts import group_by_kind, list_unrated
from scanplan.validation.verdict import judge_plan

_INDENT = 9  # of the longest word before a line, `doubtful`


def summarise_survey(plan: floorplan.FloorPlan, survey: SurveyFacts) -> str:
    """Return the lines that say what was found, how far to trust it, and of how many scans.

    Returns
    -------
    str
        Each line ends with a newline; what is longer than the console is wide goes on below.
    """
    rooms, walls, openings = plan.rooms, plan.walls, plan.openings
    counts = [
        _count(int((openings["type"] == kind).sum()), noun)
        for kind, noun in floorplan.OPENINGS.items()
    ]
    found = (
        f"{_count(len(rooms['room']), 'room')}, {_state_floor(plan)};"
        f" {', '.join(counts)}; {_count(len(walls['wall']), 'wall')},"
        f" {page_tables.wall_lengths_m(plan).sum():,.1f} m"
    )
    doubts = [
        *wording.list_contradictions(plan),
        *_count_doubts(plan),
        *list_unrated(plan),
    ]
    n_kept, n_candidates = (int(f(survey.registration["kept"])) for f in (np.sum, np.size))
    used = (
        f"{survey.chosen:,} of {_count(n_kept, 'registered scan')}"
        f" ({n_candidates:,} candidates of {survey.n_recorded:,} recorded)"
    )
    damage, rayless = plan.doubted.damage, plan.doubted.rayless
    notes, reference = wording.list_notes(plan), plan.georeference
    lines = [
        ("verdict", judge_plan(plan).line),
        *([("damaged", "; ".join(damage))] if damage else []),
        *([("no rays", "; ".join(rayless))] if rayless else []),
        ("found", found),
        ("doubtful", "; ".join(doubts) or "nothing that the plan marks"),
        *([("placed", wording.state_reference(reference))] if reference else []),
        *([] if plan.scale is None else [("lengths", wording.state_lengths(plan))]),
        *([("noted", "; ".join(notes))] if notes else []),
        ("made of", used),
        ("tested", wording.prediction_sentence(survey.prediction)),
    ]
    told = (f"{what:<{_INDENT}}{text}" for what, text in lines)
    return "".join(f"{part}\n" for line in told for part in fold_line(line, indent=_INDENT))


def _count_doubts(plan: floorplan.FloorPlan) -> list[str]:
    """Return in a phrase which elements to verify on site, the few of a kind by their numbers."""
    named: list[str] = []
    for kind, found in group_by_kind(plan).items():
        numbers = [doubt.number for doubt in found]
        few = f" ({', '.join(map(str, numbers))})" if len(numbers) <= MOST_NAMED else ""
        named.append(_count(len(numbers), kind) + few)
    return [f"{', '.join(named)} to verify on site (report.html says why)"] if named else []


def _count(n: int, noun: str) -> str:
    return f"{n:,} {noun}{'' if n == 1 else 's'}"


def _state_floor(plan: floorplan.FloorPlan) -> str:
    """Return in a phrase how much floor rooms have: about so much where outlines are not closed."""
    areas_m2 = plan.net_areas_m2
    open_m2 = areas_m2[~plan.rooms["closed"].astype(bool)].sum()
    whole = f"{areas_m2.sum():,.1f} m² of floor"
    return f"about {whole} ({open_m2:,.1f} m² in rooms that are not closed)" if open_m2 else whole
