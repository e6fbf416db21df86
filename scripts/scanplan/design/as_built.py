"""What was built compared with its design: the storey that it is, and where both agree."""

from collections.abc import Sequence
from dataclasses import dataclass

from scanplan.changes import comparison
from scanplan.changes.comparison import Comparison, Scans
from scanplan.changes.frames import FrameTie
from scanplan.design.design_plan import see_design
from scanplan.design.drawn_storey import DrawnStorey
from scanplan.design.storey_choice import find_storey
from scanplan.errors import StageError
from scanplan.plan.floorplan import FloorPlan, say_count

_NEARLY = 0.9  # of the walls of the best storey: as different as two surveys of one floor are


@dataclass(frozen=True, eq=False)
class TiedStorey:
    """The storey of a design that a plan fits best.

    Attributes
    ----------
    storey : DrawnStorey
    tie : FrameTie
        The design is a.
    alike : sequence of str
        Other storeys that fit nearly as well.
    """

    storey: DrawnStorey
    tie: FrameTie
    alike: Sequence[str]


@dataclass(frozen=True, eq=False)
class AsBuilt:
    """A survey against a storey of a design.

    Attributes
    ----------
    storey : DrawnStorey
    compared : Comparison
        The design is a, the survey b, in the design's frame.
    alike : sequence of str
        Other storeys that fit nearly as well.
    """

    storey: DrawnStorey
    compared: Comparison
    alike: Sequence[str]


def compare_design(
    storeys: Sequence[DrawnStorey],
    source: str,
    plan: FloorPlan,
    scans: Scans,
    chosen: str | int | None = None,
) -> AsBuilt:
    """Compare what was built with the storey of a design that it fits best.

    Parameters
    ----------
    storeys : sequence of DrawnStorey
        From below.
    source : str
        The design's file, for messages.
    chosen : str or int, optional
        Name of a storey, or its number from below; all are tried if None.

    Raises
    ------
    StageError
        See `tie_storey`.
    """
    tied = tie_storey(storeys, source, plan, chosen)
    storey, tie = tied.storey, tied.tie
    design = see_design(storey, f"{source}, {storey.name}")
    built = comparison.place_survey(plan, scans, tie.fit.motion, tie)
    return AsBuilt(storey, comparison.compare_placed(design, built, tie), tied.alike)


def tie_storey(
    storeys: Sequence[DrawnStorey], source: str, plan: FloorPlan, chosen: str | int | None = None
) -> TiedStorey:
    """Tie the frame of a plan to that of the storey that it fits best.

    Parameters
    ----------
    storeys, source, chosen
        As of `compare_design`.

    Raises
    ------
    StageError
        If there is no such storey, or none of those that are tried fits.
    """
    tried = storeys
    if chosen is not None:
        listed = [(storey.name, storey.floor_m) for storey in storeys]
        tried = [storeys[find_storey(listed, chosen, source, "plan.design.storey")]]
    ties: list[tuple[DrawnStorey, FrameTie]] = []
    faults: list[str] = []
    for storey in tried:
        design = see_design(storey, storey.name)
        try:
            ties.append((storey, comparison.tie_plans(design.plan, plan)))
        except StageError as fault:
            faults.append(str(fault).partition("; ")[0])
    if not ties:
        remedy = "give the design of this building, or the storey by plan.design.storey"
        more = f", nor does any of its {len(faults) - 1} other storeys fit" * (len(faults) > 1)
        raise StageError(f"{source}: {faults[0]}{more}; {remedy}")
    # of as many metres each: a storey of which more agrees is not the other one
    storey, tie = max(ties, key=lambda of: of[1].fit.matched_m)
    least_m = _NEARLY * tie.fit.matched_m
    alike = [of.name for of, t in ties if of is not storey and t.fit.matched_m >= least_m]
    return TiedStorey(storey, tie, alike)


def warn_of_alike(found: AsBuilt | TiedStorey) -> str:
    """Return in words which other storeys fit nearly as well; nothing where none does."""
    if not found.alike:
        return ""
    others = ", ".join(found.alike)
    count = say_count(len(found.alike), "other storey")
    return f"{count} fits as well as {found.storey.name}: {others}; set plan.design.storey"
