"""Faces of a curved wall: short chords of its circle, with the points that show them."""

import itertools
import math
from collections.abc import Iterator, Sequence

import numpy as np

from scanplan.geometry import arcs
from scanplan.geometry.intervals import find_gaps
from scanplan.geometry.lines import Line
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.plan_wall import PlanWall
from scanplan.rays.face_observation import FaceObservation
from scanplan.types import FloatArray, IntArray


def cut_faces(
    faces: Sequence[FaceInterval], arc_m: FloatArray, centre_m: FloatArray, *, faces_centre: bool
) -> list[FaceInterval]:
    """Return the chords along an arc where faces along lines of their own were seen.

    Each has the points that these faces have there, once: faces may overlap.

    Parameters
    ----------
    faces : sequence of intervals.FaceInterval
        On its circle.
    arc_m : (n, 2) float
        Places along the arc, see `arcs.trace_arc`, counter-clockwise around the centre.
    centre_m : (2,) float
    faces_centre : bool
        Whether they face the centre, or away from it.
    """
    if not faces:
        return []
    first = arc_m[0] - centre_m
    spans = np.array([np.sort(arcs.turn_rad(face.ends - centre_m, first)) for face in faces])
    xy_m, z_m, scan = _gather_points(faces)
    at_rad = arcs.turn_rad(xy_m - centre_m, first)
    edges = arcs.turn_rad(arc_m - centre_m, first)
    edges[0] = 0.0
    cut: list[FaceInterval] = []
    for number, (begin, end) in enumerate(np.column_stack([edges[:-1], edges[1:]]).tolist()):
        corners_m = arc_m[number : number + 2]
        line = _draw_line(corners_m if not faces_centre else corners_m[::-1])
        inside = np.flatnonzero((at_rad >= begin) & (at_rad <= end))
        observation = observe_points(
            line, xy_m[inside], z_m[inside], scan[inside], planar=faces[0].observation.planar
        )
        for span in _covered(spans, begin, end):
            share = (span - begin) / (end - begin)
            ends_m = corners_m[0] + share[:, None] * (corners_m[1] - corners_m[0])
            low_m, high_m = np.sort(line.along_m(ends_m)).tolist()
            face = FaceInterval(observation, low_m, high_m)
            if face.n_points:
                cut.append(face)
    return cut


def infer_bent_faces(wall: PlanWall) -> Iterator[tuple[Line, tuple[float, float], bool]]:
    """Yield line, extent and side (left) of the faces to infer of a curved wall.

    Of a side of known thickness all that was not seen, openings aside; else gaps taken for wall.
    """
    sides = [(wall.left, wall.half_m)]
    sides += [] if math.isnan(wall.thickness_m) else [(wall.right, -wall.half_m)]
    ways_m = [(gap.low_m, gap.high_m) for gap in wall.openings if not gap.is_above_wall]
    for side, off_m in sides:
        seen_m = [wall.reach_m(face.ends) for face in side]
        known_m = np.array([*seen_m, *ways_m]).reshape(-1, 2)
        whole_m = [(wall.low_m, wall.high_m)]
        if math.isnan(wall.thickness_m):
            whole_m = [(gap.low_m, gap.high_m) for gap in wall.closed]
        for low_m, high_m in whole_m:
            bare_m = find_gaps(known_m, low_m, high_m) if len(known_m) else [(low_m, high_m)]
            for begin_m, end_m in bare_m:
                if end_m - begin_m < SHORTEST_M:
                    continue
                corners_m = wall.trace(float(begin_m), float(end_m), off_m)
                for ends_m in itertools.pairwise(corners_m if off_m >= 0 else corners_m[::-1]):
                    line = _draw_line(np.array(ends_m[::-1]))
                    reach_m = np.sort(line.along_m(np.array(ends_m))).tolist()
                    yield line, (reach_m[0], reach_m[1]), off_m >= 0


def _gather_points(
    faces: Sequence[FaceInterval],
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Return places (n, 2), heights (n,) and scans (n,) of the points of faces, each once."""
    xy_m = [
        face.line.at(face.observation.occupied_m[face.points])
        + face.observation.occupied_off_m[face.points, None] * face.line.normal
        for face in faces
    ]
    z_m = [face.observation.occupied_z_m[face.points] for face in faces]
    scan = np.concatenate([face.observation.occupied_scan[face.points] for face in faces])
    places = np.column_stack([np.concatenate(xy_m), np.concatenate(z_m)])
    # of two lines a point has two roundings
    same = np.column_stack([np.rint(places / arcs.SAGITTA_M), scan])
    _, once = np.unique(same, axis=0, return_index=True)
    return places[once, :2], places[once, 2], scan[once]


def _draw_line(ends_m: FloatArray) -> Line:
    """Return the line through two places, its normal on the right of the way between them."""
    direction = ends_m[1] - ends_m[0]
    direction /= np.hypot(*direction)
    return Line(ends_m.mean(axis=0), np.array([direction[1], -direction[0]]))


def observe_points(
    line: Line, xy_m: FloatArray, z_m: FloatArray, scan: IntArray, *, planar: bool
) -> FaceObservation:
    """Return points (n, 2), their heights and scans as what was observed of a line, and no more."""
    along_m = line.along_m(xy_m)
    order = np.argsort(along_m, kind="stable")
    nothing = np.empty(0)
    return FaceObservation(
        line=line,
        occupied_m=along_m[order],
        occupied_off_m=line.offset_m(xy_m)[order],
        occupied_z_m=z_m[order],
        occupied_scan=scan[order],
        free_m=nothing,
        free_z_m=nothing,
        low_m=nothing,
        low_z_m=nothing,
        planar=planar,
    )


def _covered(spans: FloatArray, begin: float, end: float) -> Iterator[FloatArray]:
    """Yield what spans (n, 2) cover between two places."""
    bare = find_gaps(spans, begin, end)
    yield from find_gaps(bare, begin, end) if len(bare) else [np.array([begin, end])]
