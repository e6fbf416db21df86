"""Reveals: the surfaces of openings across a wall, which show how thick it is."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry import intersections
from scanplan.geometry.lines import Line
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.openings import Opening
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import END_M, ENOUGH_RAYS, FACE_M, LOW_PERCENT
from scanplan.rays.face_observation import FaceObservation, observe_face
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import FEW
from scanplan.types import FloatArray, IntArray

_DEEPEST_M = 1.0  # of walls with windows, behind which is no room; and no reveal is longer
_OUTSIDE = ("window", "glass")
_FRAME_M = (
    0.2  # from a jamb: as far as the frame of a window, or a leaf in its rebate, is looked for
)

_HIDING_SHARE = 0.25  # of the returns at a reveal's end: what hides the rest has more, before it


@dataclass(frozen=True, eq=False)
class _Reveal:
    """What was seen of a reveal of a wall of which one side is known.

    Attributes
    ----------
    face : FaceInterval
        From the wall's face on.
    depth_m : float
    is_whole : bool
        Nothing at its end hides the rest of it: no frame, no shut leaf, no back of a niche.
    is_passed : bool
        Rays go on behind its end.
    """

    face: FaceInterval
    depth_m: float
    is_whole: bool
    is_passed: bool


def settle_reveals(
    walls: Sequence[PlanWall], tops_m: Sequence[float], rays: RaySet, *, max_thickness_m: float
) -> tuple[list[PlanWall], list[float]]:
    """Return walls with their reveals, and their tops; walls that are reveals of others are none.

    A wall that was seen from one side is as thick as its reveals are deep.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
        With their openings.
    tops_m : sequence of float
        How high each ends.
    rays : ray_set.RaySet
    max_thickness_m : float
        Of walls without windows: what goes on farther there is the wall of a room behind.
    """
    thick = [_thicken(wall, rays, max_thickness_m) for wall in walls]
    joined = list(_rejoin(walls, thick))
    host_of = dict(_find_hosts(joined))
    kept = [
        (_with_reveals(wall, [joined[row] for row in host_of if host_of[row] == number]), top_m)
        for number, (wall, top_m) in enumerate(zip(joined, tops_m, strict=True))
        if number not in host_of
    ]
    return [wall for wall, _ in kept], [top_m for _, top_m in kept]


def is_at_jamb(face: FaceInterval, jamb_m: FloatArray, into_m: FloatArray) -> bool:
    """Return whether a reveal is that of a jamb at a place (2,), which looks so (2,)."""
    return (
        float(face.line.normal @ into_m) > 0
        and abs(float((face.ends.mean(axis=0) - jamb_m) @ into_m)) <= END_M
    )


def list_jambs(wall: PlanWall) -> Iterator[tuple[Opening, FloatArray, FloatArray]]:
    """Yield the openings of a wall, each with either jamb (2,) and the way into it (2,) there."""
    for opening in wall.openings:
        for along_m, sign in ((opening.low_m, 1), (opening.high_m, -1)):
            jamb_m = wall.at(along_m)
            left = wall.normal_at(jamb_m)
            yield opening, jamb_m, sign * np.array([left[1], -left[0]])


def _thicken(wall: PlanWall, rays: RaySet, max_thickness_m: float) -> PlanWall:
    """Return a wall that was seen from one side as thick as its reveals are deep, with these."""
    if not np.isnan(wall.thickness_m) or wall.bend:
        return wall
    found = []
    for opening, jamb_m, into in list_jambs(wall):
        most_m = _DEEPEST_M if opening.kind in _OUTSIDE else max_thickness_m
        if reveal := _observe_reveal(wall, Line(jamb_m, into), rays, most_m):
            found.append(reveal)
    thickness_m = _agree_on_depth([reveal for reveal in found if reveal.is_whole])
    if np.isnan(thickness_m):
        return wall
    middle = Line(wall.line.centre - thickness_m / 2 * wall.line.normal, wall.line.normal)
    reveals = [reveal.face for reveal in found if reveal.depth_m <= thickness_m + END_M]
    return replace(wall, line=middle, thickness_m=thickness_m, reveals=reveals)


def _observe_reveal(wall: PlanWall, jamb: Line, rays: RaySet, most_m: float) -> _Reveal | None:
    """Return what returns show of a reveal that begins at the centre of its line, if they do.

    What is deeper than `most_m` is none.
    """
    behind = -float(np.sign(jamb.direction @ wall.line.normal))
    low_m, high_m = np.sort([0.0, behind * (most_m + _FRAME_M)]).tolist()
    observation = observe_face(rays, jamb, low_m, high_m, band_m=_FRAME_M)
    is_on_it = np.abs(observation.occupied_off_m) <= FACE_M
    depth_m = np.sort(behind * observation.occupied_m[is_on_it])
    # it goes on as long as it does not pause
    steps_m = np.diff(depth_m, prepend=0.0)
    pauses = np.flatnonzero(steps_m > END_M)
    own_m = depth_m[: pauses[0]] if len(pauses) else depth_m
    if len(own_m) < ENOUGH_RAYS:
        return None
    # the last few may be stray; where returns lie evenly, so much of the whole is before the rest
    inside = 1 - LOW_PERCENT / 100
    end_m = float(np.quantile(own_m, inside)) / inside
    before_m = behind * observation.occupied_m[observation.occupied_off_m > FACE_M]
    n_before = int((np.abs(before_m - end_m) <= END_M).sum())
    begin_m, end_at_m = np.sort([0.0, behind * end_m]).tolist()
    face = FaceInterval(_take_returns(observation, np.flatnonzero(is_on_it)), begin_m, end_at_m)
    n_last = int((own_m >= end_m - END_M).sum())
    behind_m = behind * observation.free_m - end_m
    n_passed = int(((behind_m > END_M) & (behind_m <= END_M + _FRAME_M)).sum())
    is_whole = (
        n_before < _HIDING_SHARE * n_last and face.n_scans >= FEW and FACE_M < end_m <= most_m
    )
    return _Reveal(face, end_m, is_whole, n_passed >= ENOUGH_RAYS)


def _take_returns(observation: FaceObservation, rows: IntArray) -> FaceObservation:
    """Return an observation with some of its returns."""
    names = ("occupied_m", "occupied_off_m", "occupied_z_m", "occupied_scan")
    return replace(observation, **{name: getattr(observation, name)[rows] for name in names})


def _agree_on_depth(reveals: Sequence[_Reveal]) -> float:
    """Return the depth that half of the returns of reveals lie at reveals of; NaN: not known.

    Of a single one behind which no ray goes on more may be hidden.
    """
    if not reveals:
        return np.nan
    depth_m = np.array([reveal.depth_m for reveal in reveals])
    order = np.argsort(depth_m)
    n_points = np.cumsum([reveals[row].face.n_points for row in order])
    middle_m = depth_m[order][np.searchsorted(n_points, n_points[-1] / 2)]
    agreeing = np.abs(depth_m - middle_m) <= END_M
    is_passed = any(reveals[row].is_passed for row in np.flatnonzero(agreeing).tolist())
    return float(middle_m) if is_passed or agreeing.sum() > 1 else np.nan


def _rejoin(before: Sequence[PlanWall], walls: Sequence[PlanWall]) -> Iterator[PlanWall]:
    """Yield walls whose lines have moved, with ends where the walls that they met are now."""
    spans_before, spans = (intersections.stack_spans(of) for of in (before, walls))
    for old, new in zip(before, walls, strict=True):
        met = intersections.find_crossings(old.line, spans_before, reach_m=END_M)
        now = intersections.find_crossings(new.line, spans, reach_m=np.inf)
        now_m = dict(zip(now.which.tolist(), now.place_m.tolist(), strict=True))
        ends_m = {}
        for name in ("low_m", "high_m"):
            off_m = np.abs(met.place_m - getattr(old, name))
            if off_m.min(initial=np.inf) <= END_M:
                nearest = int(off_m.argmin())
                by_m = now_m[int(met.which[nearest])] - float(met.place_m[nearest])
                ends_m[name] = getattr(old, name) + by_m
        moved = replace(new, **ends_m)
        # a curved wall ends beside its chord; a short one may lie in what is thick now
        yield new if new.bend or moved.length_m <= 0 else moved


def _find_hosts(walls: Sequence[PlanWall]) -> Iterator[tuple[int, int]]:
    """Yield the rows of walls that are reveals of another, each with that of the other."""
    spans = intersections.stack_spans(walls)
    for row, wall in enumerate(walls):
        if wall.bend or wall.openings or wall.length_m > _DEEPEST_M:
            continue
        met = intersections.find_crossings(wall.line, spans, reach_m=END_M).which.tolist()
        middle_m = wall.ends.mean(axis=0)
        hosts = [host for host in met if _is_reveal(walls[host], wall)]
        if hosts:
            yield row, min(hosts, key=lambda n: abs(float(walls[n].line.offset_m(middle_m))))


def _is_reveal(host: PlanWall, wall: PlanWall) -> bool:
    """Return whether a wall lies in another's thickness, and all its faces look into openings."""
    is_across = intersections.run_across(host.line, wall.line)
    if host.bend or np.isnan(host.thickness_m) or not is_across or not wall.members:
        return False
    off_m = np.abs(host.line.offset_m(wall.ends)).max()
    jambs = [(jamb_m, into) for _, jamb_m, into in list_jambs(host)]
    return bool(off_m <= host.half_m + END_M) and all(
        any(is_at_jamb(face, *jamb) for jamb in jambs) for face in wall.members
    )


def _with_reveals(wall: PlanWall, others: Sequence[PlanWall]) -> PlanWall:
    """Return a wall with the faces of others as its reveals, in place of those at the same jamb."""
    faces = [face for other in others for face in other.members]
    own = [
        reveal
        for reveal in wall.reveals
        if not any(is_at_jamb(face, reveal.ends.mean(axis=0), reveal.line.normal) for face in faces)
    ]
    return replace(wall, reveals=[*own, *faces])
