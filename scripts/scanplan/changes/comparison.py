"""Two surveys of a floor compared, from their tables to a list of what became of each element."""

from collections.abc import Sequence
from dataclasses import dataclass

from scanplan.changes import face_shifts, frames, opening_changes, room_changes, wall_changes
from scanplan.changes.curve_shifts import find_moved_curves
from scanplan.changes.frames import FrameTie
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.ray_cells import AT_M
from scanplan.changes.seen_faces import list_seen_faces
from scanplan.changes.surveys import Survey, find_free_floor, read_rays
from scanplan.changes.verdicts import SIGMAS, Change
from scanplan.plan.floorplan import FloorPlan
from scanplan.store.registered_scans import RegisteredScans
from scanplan.store.tables import ScanStore

Scans = tuple[ScanStore, RegisteredScans]
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
        Of walls, openings, rooms and furniture, in this order.
    """

    a: Survey
    b: Survey
    tie: FrameTie
    changes: Sequence[Change]


def compare_surveys(plans: tuple[FloorPlan, FloorPlan], scans: tuple[Scans, Scans]) -> Comparison:
    """Compare an earlier survey of a floor with a later one.

    Raises
    ------
    StageError
        If their frames cannot be tied, see `frames.tie_frames`.
    """
    first, second = plans
    tie = frames.tie_frames(
        (list_seen_faces(first), list_seen_faces(second)),
        (find_free_floor(first), find_free_floor(second)),
        (first.name, second.name),
    )
    motions = (PlaneMotion(), tie.fit.motion)
    slack_m = max(AT_M, SIGMAS * tie.fit.scatter_m)
    a, b = (
        Survey(plan, read_rays(*of, plan, motion), motion, slack_m)
        for plan, of, motion in zip(plans, scans, motions, strict=True)
    )
    shifts = face_shifts.measure_shifts(a, b, tie.fit)
    curves = find_moved_curves(a, b, tie.fit)
    changes = wall_changes.compare_walls(a, b, shifts, curves)
    changes += opening_changes.compare_openings(a, b)
    changes += room_changes.compare_rooms(a, b, changes)
    changes += room_changes.compare_furniture(a, b)
    return Comparison(a, b, tie, changes)
