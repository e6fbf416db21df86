"""Walls as the labels of their lines have them: openings, parts that end low, ends."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry.intervals import find_gaps
from scanplan.plan import wall_pairs
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.model import line_ends, line_labels, opening_edges, priors, surface_counts
from scanplan.plan.model.designed_walls import DesignedWalls
from scanplan.plan.model.line_labels import Stretch
from scanplan.plan.model.surface_counts import AT_M, COLUMN_M, Side, SurfaceCounts
from scanplan.plan.openings import CLOSED, Opening
from scanplan.plan.plan_wall import Nearly, PlanWall
from scanplan.plan.tolerances import END_M
from scanplan.rays.face_observation import FaceObservation
from scanplan.rays.ray_set import RaySet
from scanplan.types import FloatArray

DEEP_M = 0.4
"""Behind a face whose other side nobody saw: as thick as most facades."""


def count_wall(wall: PlanWall, rays: RaySet) -> SurfaceCounts:
    """Return what rays say of a wall from its one end to the other, from all its sides."""
    return surface_counts.count_ends(
        rays, wall.line, wall.low_m, wall.high_m, list(_list_sides(wall))
    )


@dataclass(frozen=True, eq=False)
class LabelEvidence:
    """What walls are labelled by.

    Attributes
    ----------
    rays : ray_set.RaySet
    track_m : (k, 2) float64
        Where the sensor was, one place after the other.
    max_opening_m : float
        What is open for longer parts a wall in two.
    designed : DesignedWalls, optional
        What makes labels, and walls, likelier.
    floor : shapely geometry
        That was seen free; by default none is known.
    """

    rays: RaySet
    track_m: FloatArray
    max_opening_m: float
    designed: DesignedWalls | None = None
    floor: BaseGeometry = field(default_factory=Polygon)


def label_wall(
    wall: PlanWall,
    evidence: LabelEvidence,
    *,
    longer: PlanWall | None = None,
    crossed_m: FloatArray = line_labels.NOWHERE_M,
) -> Iterator[tuple[PlanWall, float]]:
    """Yield the parts of a wall, and how high each ends (NaN: at the ceiling, or not known).

    Parameters
    ----------
    wall : plan_wall.PlanWall
        Its openings are found anew.
    longer : plan_wall.PlanWall, optional
        The same as far as it may go on, see `line_ends.lengthen_walls`.
    crossed_m : (n, 2) float64, optional
        From where to where other walls cross it: what is open from one to another parts it, too.
    """
    rays, designed = evidence.rays, evidence.designed
    whole = longer or wall
    counts = surface_counts.add_passages(count_wall(whole, rays), wall.line, rays, evidence.track_m)
    goes_on = (whole.low_m < wall.low_m, whole.high_m > wall.high_m)
    stretches = line_labels.label_line(
        counts,
        line=priors.INNER if wall.right else priors.OUTER,
        goes_on=goes_on,
        crossed_m=crossed_m,
        known=designed and designed.weigh_labels(wall.line, counts.middles_m),
    )
    stretches[-1] = replace(stretches[-1], high_m=whole.high_m)
    stretches = line_ends.end_where_seen(stretches, wall.low_m, wall.high_m)
    for run in _part_runs(stretches, evidence.max_opening_m, crossed_m):
        part = _clip_wall(wall, run[0].low_m, run[-1].high_m)
        if part.members and part.length_m >= END_M:
            top_m = run[0].lintel_m if run[0].kind == "low" else np.nan
            opened = _open_wall(part, wall, run)
            is_whole = len(part.members) == len(wall.members)
            yield opened if is_whole else wall_pairs.refit_wall(opened), top_m


def part_wall(wall: PlanWall, places_m: FloatArray) -> Iterator[PlanWall]:
    """Yield the parts of a wall between places (n,) along it, in order."""
    if not len(places_m):
        yield wall
        return
    for low_m, high_m in pairwise([wall.low_m, *places_m.tolist(), wall.high_m]):
        part = _clip_wall(wall, low_m, high_m)
        if part.members:
            yield wall_pairs.refit_wall(part)


def _list_sides(wall: PlanWall) -> Iterator[Side]:
    """Yield the lines of a wall's faces, each where it is the nearest of its side."""
    deep_m = (DEEP_M if np.isnan(wall.thickness_m) else wall.thickness_m) + AT_M
    for members in (wall.left, wall.right):
        spans_m = np.sort([wall.line.along_m(face.ends) for face in members], axis=-1)
        order = np.argsort(spans_m.reshape(-1, 2)[:, 0]).tolist()
        between_m = [(spans_m[a, 1] + spans_m[b, 0]) / 2 for a, b in pairwise(order)]
        own: dict[FaceObservation, list[tuple[float, float]]] = {}
        for row, span_m in zip(order, pairwise([-np.inf, *between_m, np.inf]), strict=False):
            own.setdefault(members[row].observation, []).append(span_m)
        for observation, asked_m in own.items():
            yield Side(observation.line, deep_m, np.array(asked_m))


def _part_runs(
    stretches: Sequence[Stretch], max_opening_m: float, crossed_m: FloatArray
) -> Iterator[list[Stretch]]:
    """Yield what is one wall: parted at what ends low, and where it is open for long.

    Or open from one wall that crosses it to another.
    """
    run: list[Stretch] = []
    for stretch in stretches:
        ends_m = np.array([stretch.low_m, stretch.high_m])
        is_corridor = line_labels.is_between(ends_m, crossed_m).all()
        is_long = stretch.length_m > max_opening_m
        is_apart = stretch.kind == "open" and (is_long or is_corridor or not run)
        if not is_apart and stretch.kind != "low":
            run.append(stretch)
            continue
        if run:
            yield _without_open_end(run)
            run = []
        if stretch.kind == "low":
            yield [stretch]
    if run:
        yield _without_open_end(run)


def _without_open_end(run: list[Stretch]) -> list[Stretch]:
    return run[:-1] if len(run) > 1 and run[-1].kind == "open" else run


def _clip_wall(wall: PlanWall, low_m: float, high_m: float) -> PlanWall:
    """Return a wall between two places along it, with what of its faces lies there."""
    left, right = (
        [part for face in side for part in _clip_face(wall, face, low_m, high_m)]
        for side in (wall.left, wall.right)
    )
    return replace(wall, low_m=low_m, high_m=high_m, left=left, right=right)


def _clip_face(
    wall: PlanWall, face: FaceInterval, low_m: float, high_m: float
) -> list[FaceInterval]:
    begin_m, end_m = np.sort(face.line.along_m(wall.line.at(np.array([low_m, high_m]))))
    return _part_face(face, max(face.low_m, float(begin_m)), min(face.high_m, float(end_m)))


def _part_face(face: FaceInterval, low_m: float, high_m: float) -> list[FaceInterval]:
    """Return a part of a face, if it is as long as a column and some point shows it."""
    if high_m - low_m < COLUMN_M:
        return []
    part = replace(face, low_m=low_m, high_m=high_m)
    return [part] if part.n_points else []


def _open_wall(part: PlanWall, wall: PlanWall, run: Sequence[Stretch]) -> PlanWall:
    """Return a part of a wall with its openings, its faces cut where these reach the floor."""
    openings = [
        opening_edges.measure_opening(wall, stretch)
        for stretch in run
        if opening_edges.is_opening(stretch)
    ]
    opened = replace(
        part,
        openings=openings,
        closed=_list_hidden(part, openings),
        p_solid=_find_p_solid(run),
        nearly=[
            Nearly(
                "door" if of.kind == "shut" else of.kind,
                wall.line.at(np.array([of.low_m, of.high_m])),
                of.p,
            )
            for stretch in run
            for of in stretch.nearly
        ],
    )
    ways = [opening for opening in openings if not opening.is_above_wall]
    left, right = (
        [piece for face in side for piece in _cut_face(part, face, ways)]
        for side in (part.left, part.right)
    )
    # what is nothing but openings has no face left, and is drawn by what is seen in them
    return replace(opened, left=left, right=right) if left or right else opened


def _find_p_solid(run: Sequence[Stretch]) -> float:
    """Return how probable what is no opening of a run is, in the mean of its length."""
    solid = [stretch for stretch in run if not opening_edges.is_opening(stretch)]
    whole_m = sum(stretch.length_m for stretch in solid)
    return sum(stretch.p * stretch.length_m for stretch in solid) / whole_m if solid else np.nan


def _cut_face(wall: PlanWall, face: FaceInterval, ways: Sequence[Opening]) -> list[FaceInterval]:
    """Return what is left of a face beside ways through its wall."""
    ends_m = [wall.line.at(np.array([way.low_m, way.high_m])) for way in ways]
    taken_m = np.array([np.sort(face.line.along_m(of)) for of in ends_m]).reshape(-1, 2)
    if not len(taken_m):
        return [face]
    rest_m = find_gaps(taken_m, face.low_m, face.high_m)
    return [part for span_m in rest_m.tolist() for part in _part_face(face, *span_m)]


def _list_hidden(wall: PlanWall, openings: Sequence[Opening]) -> list[Opening]:
    """Return the pauses of a wall's faces that are no openings: nobody saw it there."""
    spans_m: list[FloatArray] = [np.sort(wall.line.along_m(face.ends)) for face in wall.members]
    spans_m += [np.array([opening.low_m, opening.high_m]) for opening in openings]
    return [
        Opening(low_m, high_m, CLOSED, 0, np.nan, np.nan, below_wall=False)
        for low_m, high_m in find_gaps(np.array(spans_m)).tolist()
        if high_m - low_m > COLUMN_M
    ]
