"""The surfaces of a plan by the model: walls with what their lines' labels show, and leaves."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from scanplan.plan.model import glass_views, line_ends, line_labels, things, wall_labels
from scanplan.plan.model.designed_walls import DesignedWalls
from scanplan.plan.model.roofs import Roof, find_roof
from scanplan.plan.model.surface_counts import COLUMN_M
from scanplan.plan.model.surface_features import Features, Surroundings
from scanplan.plan.model.wall_labels import LabelEvidence, label_wall, part_wall
from scanplan.plan.plan_wall import Nearly, PlanWall
from scanplan.rays.ray_set import RaySet
from scanplan.types import FloatArray


@dataclass(frozen=True, eq=False)
class LabelledSurfaces:
    """What stands.

    Attributes
    ----------
    walls : list of plan_wall.PlanWall
        With openings and their kinds.
    tops_m : list of float
        How high each wall ends; NaN: at the ceiling, or not known.
    leaves_m : list of (2, 2) float64
        The surfaces of open leaves, from end to end.
    nearly : list of plan_wall.Nearly
        What is likelier something else: surfaces that may be walls, and openings of walls.
    roof : roofs.Roof
    """

    walls: list[PlanWall]
    tops_m: list[float]
    leaves_m: list[FloatArray]
    nearly: list[Nearly]
    roof: Roof


def label_surfaces(
    walls: Sequence[PlanWall], evidence: LabelEvidence, *, max_door_m: float
) -> LabelledSurfaces:
    """Label walls along their lines, and tell walls from leaves, furniture and what is outside.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
        Faces in pairs; what is open of them is found anew.
    max_door_m : float
        Walls go on for a door as wide to the next one.
    """
    facades = line_ends.find_facades(walls)
    walls = [part for wall, at in zip(walls, facades, strict=True) for part in part_wall(wall, at)]
    parts = [found for wall in walls for found in label_wall(wall, evidence)]
    roof = find_roof([part for part, _ in parts], evidence.rays)
    surroundings = Surroundings([part for part, _ in parts], evidence.floor)
    found = observe_surfaces(surroundings, evidence.rays, roof)
    designed = _weigh_designed([part for part, _ in parts], evidence.designed)
    p = things.weigh_things(found, designed, surroundings.corners)
    kinds = things.choose_kinds(p)
    weighed = list(zip(parts, kinds, p[:, things.WALL].tolist(), strict=True))
    kept = [
        (replace(part, p_wall=p_wall), top_m)
        for (part, top_m), kind, p_wall in weighed
        if kind == things.WALL
    ]
    nearly = [
        Nearly("wall", part.ends, p_wall)
        for (part, _), kind, p_wall in weighed
        if kind != things.WALL and p_wall >= line_labels.NEARLY
    ]
    kept = list(_label_among(kept, evidence, max_door_m))
    return LabelledSurfaces(
        walls=[wall for wall, _ in kept],
        # that nothing was seen above what was seen from one side alone shows no end
        tops_m=[top_m if wall.right else math.nan for wall, top_m in kept],
        leaves_m=[part.ends for (part, _), kind, _ in weighed if kind == things.LEAF],
        nearly=[*nearly, *(near for wall, _ in kept for near in wall.nearly)],
        roof=roof,
    )


def _label_among(
    parts: Sequence[tuple[PlanWall, float]],
    evidence: LabelEvidence,
    max_door_m: float,
) -> Iterator[tuple[PlanWall, float]]:
    """Yield walls and their tops, those labelled anew that others are ahead of or cross."""
    walls = [wall for wall, _ in parts]
    longer = line_ends.lengthen_walls(walls, max_door_m)
    crossed = line_ends.find_corridors(walls)
    for (wall, top_m), whole, crossed_m in zip(parts, longer, crossed, strict=True):
        is_open = len(crossed_m) > 1 and wall.openings
        if math.isnan(top_m) and (whole.length_m > wall.length_m or is_open):
            yield from label_wall(wall, evidence, longer=whole, crossed_m=crossed_m)
        else:
            yield wall, top_m


def _weigh_designed(parts: Sequence[PlanWall], designed: DesignedWalls | None) -> FloatArray | None:
    if designed is None:
        return None
    places_m = [np.arange(part.low_m, part.high_m, COLUMN_M) for part in parts]
    weights = [designed.weigh_wall(of.line, at) for of, at in zip(parts, places_m, strict=True)]
    return np.array(weights, float)


def observe_surfaces(surroundings: Surroundings, rays: RaySet, roof: Roof) -> list[Features]:
    """Return the features of parts of walls, whose openings are known."""
    parts = surroundings.walls
    counts = [wall_labels.count_wall(part, rays) for part in parts]
    through_glass = glass_views.find_glass_shares(parts, rays)
    return surroundings.observe(counts, through_glass, roof.roofed)
