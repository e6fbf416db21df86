"""Two surveys of a floor compared, from their tables to a list of what became of each element."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from scanplan.changes import face_shifts, frames, opening_changes, room_changes, wall_changes
from scanplan.changes.curve_shifts import join_curves, measure_curves
from scanplan.changes.frames import FrameTie
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.ray_cells import AT_M
from scanplan.changes.seen_floors import see_floor
from scanplan.changes.surveys import RaySight, Survey, read_rays
from scanplan.changes.verdicts import SIGMAS, Change
from scanplan.changes.wholes import list_wholes
from scanplan.plan.floorplan import FloorPlan
from scanplan.store.registered_scans import RegisteredScans, ScanReader
from scanplan.store.schemas import COLUMN, PIECE

Scans = tuple[ScanReader, RegisteredScans]
"""The points of a survey's scans, and where they were taken."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """What two surveys of a floor differ by.

    Attributes
    ----------
    a, b : Survey
        In the frame of a.
    tie : FrameTie
    changes : sequence of Change
        Of walls, openings, rooms, columns and furniture, in this order.
    """

    a: Survey
    b: Survey
    tie: FrameTie
    changes: Sequence[Change]

    @cached_property
    def wholes(self) -> list[list[Change]]:
        """The changes by what they are of, see `wholes.list_wholes`."""
        return list_wholes(self.changes)


def compare_surveys(plans: tuple[FloorPlan, FloorPlan], scans: tuple[Scans, Scans]) -> Comparison:
    """Compare an earlier survey of a floor with a later one.

    Raises
    ------
    StageError
        If their frames cannot be tied, see `frames.tie_frames`.
    """
    first, second = plans
    tie = tie_plans(first, second)
    a = place_survey(first, scans[0], PlaneMotion(), tie)
    b = place_survey(second, scans[1], tie.fit.motion, tie)
    compared = compare_placed(a, b, tie)
    furniture = room_changes.compare_pieces(a, b, PIECE)
    return replace(compared, changes=[*compared.changes, *furniture])


def tie_plans(a: FloorPlan, b: FloorPlan) -> FrameTie:
    """Tie the frames of two plans of a floor.

    Raises
    ------
    StageError
        See `frames.tie_frames`.
    """
    return frames.tie_frames((see_floor(a), see_floor(b)), (a.name, b.name))


def place_survey(plan: FloorPlan, scans: Scans, motion: PlaneMotion, tie: FrameTie) -> Survey:
    """Return a survey in the common frame, to which a motion leads from its own."""
    return Survey(plan, RaySight(read_rays(*scans, plan, motion), find_slack_m(tie)), motion)


def find_slack_m(tie: FrameTie) -> float:
    """Return what rays are off by at walls of two surveys that were tied."""
    return max(AT_M, SIGMAS * tie.fit.scatter_m)


def compare_placed(a: Survey, b: Survey, tie: FrameTie) -> Comparison:
    """Return what became of walls, openings, rooms and columns, of surveys in one frame."""
    shifts = face_shifts.measure_shifts(a, b, tie.fit)
    curves = measure_curves(a, b, tie.fit)
    changes = join_curves(wall_changes.compare_walls(a, b, shifts), curves)
    changes += opening_changes.compare_openings(a, b, changes)
    changes += room_changes.compare_rooms(a, b, changes)
    changes += room_changes.compare_pieces(a, b, COLUMN)
    return Comparison(a, b, tie, changes)
