"""A floor that is surveyed again and again: one plan of all surveys, in the frame of the first."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from scanplan.changes import comparison
from scanplan.changes.comparison import Comparison, Scans
from scanplan.changes.contributions import Contribution, rate_contributions
from scanplan.changes.joined_scans import (
    Drive,
    JoinedScans,
    find_lift_m,
    place_drive,
)
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.stale_rays import find_stale_places
from scanplan.changes.surveys import RaySight, Survey, read_rays
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import Columns, Settings


@dataclass(frozen=True, eq=False)
class Grown:
    """A plan of several surveys.

    Attributes
    ----------
    plan : FloorPlan
    evidence : dict of str to (n,) array
        The columns of `schemas.EVIDENCE`.
    names : sequence of str
        Of the surveys, the earliest first.
    n_scans : sequence of int
        That each gave.
    n_unlevelled : int
        Surveys of which neither floor nor ceiling ties heights to those of the first.
    steps : sequence of Comparison
        What each survey but the first changed in what was known before.
    contributions : sequence of Contribution
    """

    plan: FloorPlan
    evidence: Columns
    names: Sequence[str]
    n_scans: Sequence[int]
    n_unlevelled: int
    steps: Sequence[Comparison]
    contributions: Sequence[Contribution]


Assemble = Callable[[JoinedScans], tuple[FloorPlan, Columns]]
"""What makes a plan of scans and rates it, and the evidence of its walls."""


def grow_plan(
    surveys: Sequence[tuple[FloorPlan, Scans]], settings: Settings, assemble: Assemble
) -> Grown:
    """Make one plan of surveys of a floor, the earliest first.

    Each is compared with the plan of those before it; where it found a change, rays of those are
    left out. So what is new, and what nobody looked at again, stand beside one another.

    Raises
    ------
    StageError
        If two do not fit each other.
    """
    (first, scans), *later = surveys
    level: FloorPlan | None = None if scans[0].planar else first
    drives = [place_drive(scans, first, PlaneMotion(), level)]
    known: tuple[FloorPlan, Scans] = (first, scans)
    evidence: Columns = {}
    steps: list[Comparison] = []
    for plan, own in later:
        step = comparison.compare_surveys((known[0], plan), (known[1], own))
        if level is None and not own[0].planar:
            # planar ones before it were compared in their own heights
            level = plan
            before = zip(drives, surveys, strict=False)
            drives = [
                replace(place_drive(of.own, planar, of.motion, level), stale=of.stale)
                for of, (planar, _) in before
            ]
        stale = find_stale_places(step)
        drives = [replace(drive, stale=(*drive.stale, stale)) for drive in drives]
        drives.append(place_drive(own, plan, step.tie.fit.motion, level))
        joined = JoinedScans(drives, settings)
        drawn, evidence = assemble(joined)
        known = drawn, (joined, joined.known)
        steps.append(step)
    contributions = rate_contributions(
        known[0],
        [
            _see(drive, plan, level or first, step)
            for drive, (plan, _), step in zip(drives, surveys, [steps[0], *steps], strict=True)
        ],
        [int(drive.known.t_ns.max()) for drive in drives],
        [step.changes for step in steps],
    )
    return Grown(
        known[0],
        evidence,
        [plan.name for plan, _ in surveys],
        [len(drive.known.scan_ids) for drive in drives],
        sum(
            not own[0].planar and find_lift_m(plan, level) is None
            for plan, own in surveys
            if level is not None and level is not plan
        ),
        steps,
        contributions,
    )


def _see(drive: Drive, plan: FloorPlan, level: FloorPlan, step: Comparison) -> Survey:
    """Return a survey in the frame of the first, without rays that were overtaken."""
    rays = read_rays(drive, drive.known, level, PlaneMotion())
    slack_m = comparison.find_slack_m(step.tie)
    return Survey(plan, RaySight(rays, slack_m), drive.motion)
