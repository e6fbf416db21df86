"""Faces along curves and corners, by noisy points of several scans."""

from itertools import pairwise

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.plan.curves.arc_faces import observe_points
from scanplan.plan.curves.face_samples import sample_face
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.plan_wall import PlanWall

PITCH_M = 0.02


def circle_places(radius_m, begin_rad, end_rad, centre_m=(0.0, 0.0)):
    """Places (n, 2) along an arc, counter-clockwise."""
    at = np.linspace(begin_rad, end_rad, max(round(radius_m * (end_rad - begin_rad) / PITCH_M), 8))
    return np.asarray(centre_m) + radius_m * np.column_stack([np.cos(at), np.sin(at)])


def line_places(start_m, end_m):
    """Places (n, 2) along a straight line."""
    start_m, end_m = np.asarray(start_m, float), np.asarray(end_m, float)
    n = round(float(np.hypot(*(end_m - start_m))) / PITCH_M)
    return start_m + np.linspace(0, 1, n)[:, None] * (end_m - start_m)


def face(places_m, towards_m, rng, sigma_m=0.005, n_scans=4):
    """A face along the straight line that fits places best, seen from a place by some scans."""
    scan = np.repeat(np.arange(n_scans), len(places_m))
    xy_m = np.tile(places_m, (n_scans, 1))
    chord = places_m[-1] - places_m[0]
    normal = np.array([-chord[1], chord[0]]) / np.hypot(*chord)
    centre_m = places_m.mean(axis=0)
    normal *= np.sign((np.asarray(towards_m) - centre_m) @ normal)
    xy_m = xy_m + rng.normal(0.0, sigma_m, len(xy_m))[:, None] * normal
    line = Line(xy_m.mean(axis=0), normal)
    along_m, z_m = line.along_m(xy_m), np.full(len(xy_m), 1.2)
    seen = observe_points(line, xy_m, z_m, scan, planar=True)
    return FaceInterval(seen, float(along_m.min()), float(along_m.max()))


def arc_faces(radius_m, begin_rad, end_rad, n_faces, rng, *, inside=True, **noise):
    """Chords of an arc around the origin, seen from inside or from far outside."""
    breaks = np.linspace(begin_rad, end_rad, n_faces + 1)
    found = []
    for begin, end in pairwise(breaks):
        places_m = circle_places(radius_m, begin, end)
        towards_m = (0.0, 0.0) if inside else 3 * places_m[len(places_m) // 2]
        found.append(face(places_m, towards_m, rng, **noise))
    return found


def polygon_faces(corners_m, towards_m, rng, **noise):
    """Straight faces between corners, seen from a place."""
    pairs = pairwise(corners_m)
    return [face(line_places(*pair), towards_m, rng, **noise) for pair in pairs]


def samples(faces):
    """What is sampled of faces."""
    return [sample_face(of) for of in faces]


def single_walls(faces):
    """A wall of one side for each face."""
    return [
        PlanWall(of.line, of.low_m, of.high_m, np.nan, [of], [], p_wall=0.9, p_solid=0.9)
        for of in faces
    ]
