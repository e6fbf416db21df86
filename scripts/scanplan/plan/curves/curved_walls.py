"""Curved walls in one piece, in place of the straight ones that are chords of them."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from scanplan.plan.curves import circle_search
from scanplan.plan.curves.face_samples import sample_face
from scanplan.plan.curves.ring import Ring
from scanplan.plan.openings import OpeningSettings
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import CORNER_M
from scanplan.plan.wall_pairs import PairSettings
from scanplan.rays.face_observation import RaySettings
from scanplan.rays.ray_set import RaySet

Walls = tuple[list[PlanWall], list[float]]
"""Walls, and how high each ends."""


def bend_walls(
    walls: Sequence[PlanWall],
    tops_m: Sequence[float],
    rays: RaySet,
    *,
    pairing: PairSettings,
    opening: OpeningSettings,
    reading: RaySettings,
) -> Walls:
    """Return walls with curved ones in place of their chords, straight ones first.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
    tops_m : sequence of float
        How high each ends; NaN: at the ceiling, or not known.
    rays : ray_set.RaySet
    pairing : wall_pairs.PairSettings
    opening : openings.OpeningSettings
    reading : face_observation.RaySettings
    """
    samples = [
        sample
        for wall in walls
        for face in wall.members
        if (sample := sample_face(face)) is not None
    ]
    curves = circle_search.find_curves(
        samples,
        max_gap_m=opening.max_opening_m,
        thickness_m=(pairing.min_thickness_m, pairing.max_thickness_m),
    )
    if not curves:
        return list(walls), list(tops_m)
    taken = np.zeros(len(walls), bool)
    bent: list[tuple[PlanWall, float]] = []
    for curve in curves:
        ring = Ring(curve, [samples[row].face for row in curve.rows], curve.side)
        is_chord = ring.find_chords(walls) & ~taken
        taken |= is_chord
        chords = list(itertools.compress(walls, is_chord))
        if not chords:  # surer curves have all walls that it shows a side of
            continue
        top_m = _usual_top_m(chords, list(itertools.compress(tops_m, is_chord)))
        drawn = ring.add_faces(chords).draw_walls(chords, rays, opening, reading)
        bent += [(wall, top_m) for wall in drawn]
    straight = [(w, t) for w, t, is_bent in zip(walls, tops_m, taken, strict=True) if not is_bent]
    met = _meet([wall for wall, _ in straight], [wall for wall, _ in bent])
    return met, [top_m for _, top_m in [*straight, *bent]]


def _usual_top_m(chords: Sequence[PlanWall], tops_m: Sequence[float]) -> float:
    """Return how high most length of chords ends."""
    ordered = sorted(zip(tops_m, chords, strict=True), key=lambda of: (math.isnan(of[0]), of[0]))
    reach_m = np.cumsum([wall.length_m for _, wall in ordered])
    return ordered[int(np.searchsorted(reach_m, reach_m[-1] / 2))][0]


def _meet(straight: Sequence[PlanWall], bent: Sequence[PlanWall]) -> list[PlanWall]:
    """Return walls that end in the middle of a curved one that they meet, and curved ones."""
    met = []
    for wall in straight:
        moved = {}
        for name in ("low_m", "high_m"):
            end_m = getattr(wall, name)
            crossed_m = [m for other in bent for m in other.cross_bend(wall.line)]
            near_m = [m for m in crossed_m if abs(m - end_m) <= CORNER_M + wall.half_m]
            moved[name] = min(near_m, key=lambda m: (abs(m - end_m), m), default=end_m)
        is_long = moved["high_m"] - moved["low_m"] > wall.length_m / 2
        met.append(replace(wall, **moved) if is_long else wall)
    return [*met, *bent]
