"""A plan in a few lines of text: what there is, what is doubtful, what it was made of."""

import numpy as np

from scanplan.plan import floorplan
from scanplan.report import page_tables, wording
from scanplan.report.facts import SurveyFacts
from scanplan.types import Array, FloatArray

_NAMED = 8  # of more than these the report has the list


def summarise_survey(plan: floorplan.FloorPlan, survey: SurveyFacts) -> str:
    """Return the lines that say what was found, how far to trust it, and of how many scans.

    Parameters
    ----------
    plan : floorplan.FloorPlan
    survey : SurveyFacts

    Returns
    -------
    str
        Each line ends with a newline.
    """
    rooms, walls, openings = plan.rooms, plan.walls, plan.openings
    ways = [
        _count(int((openings["type"] == kind).sum()), noun)
        for kind, noun in floorplan.OPENINGS.items()
    ]
    found = (
        f"{_count(len(rooms['room']), 'room')}, {_area(rooms['area_m2'])} of floor;"
        f" {', '.join(ways)}; {_count(len(walls['wall']), 'wall')},"
        f" {page_tables.wall_lengths_m(plan).sum():,.1f} m"
    )
    doubts = [
        *wording.list_contradictions(plan, survey.prediction),
        *_name_doubts(plan),
        _name_some("room", rooms["room"][~rooms["closed"]], "not closed: area is a guess"),
    ]
    n_kept, n_candidates = (int(f(survey.registration["kept"])) for f in (np.sum, np.size))
    n_recorded = survey.poses["scan_id"][-1] + 1  # a few more may follow the last candidate
    used = (
        f"{survey.chosen:,} of {_count(n_kept, 'registered scan')}"
        f" ({n_candidates:,} candidates of about {n_recorded:,} recorded)"
    )
    damage = plan.doubted.damage
    lines = [
        *([("damaged", "; ".join(damage))] if damage else []),
        ("found", found),
        ("doubtful", "; ".join(filter(None, doubts)) or "nothing that the plan marks"),
        ("made of", used),
        ("tested", wording.prediction_sentence(survey.prediction)),
    ]
    return "".join(f"{what:<9}{text}\n" for what, text in lines)


def _name_doubts(plan: floorplan.FloorPlan) -> list[str]:
    """Return which elements to verify on site, those of each table with what most are flagged for.

    The likeliest to be wrong first.
    """
    named: list[str] = []
    for table in ("openings", "walls", "rooms"):
        columns, noun = getattr(plan, table), floorplan.NUMBERS[table]
        if "p_true" not in columns or not columns["verify"].any():
            continue
        rows = np.flatnonzero(columns["verify"])
        rows = rows[np.argsort(columns["p_true"][rows], kind="stable")]
        reasons, counts = np.unique(columns["doubt"][rows].astype(str), return_counts=True)
        most = reasons[counts.argmax()]
        named.append(_name_some(noun, columns[noun][rows], f"verify on site, {most}"))
    return named


def _count(n: int, noun: str) -> str:
    return f"{n:,} {noun}{'' if n == 1 else 's'}"


def _area(area_m2: FloatArray) -> str:
    return f"{area_m2.sum():,.1f} m²"


def _name_some(noun: str, numbers: Array, fault: str) -> str:
    """Return which elements have a fault; nothing where none has."""
    if len(numbers) == 0:
        return ""
    named = ", ".join(map(str, numbers[:_NAMED].tolist()))
    more = f" and {len(numbers) - _NAMED} more" if len(numbers) > _NAMED else ""
    return f"{_count(len(numbers), noun)} ({named}{more}) {fault}"
