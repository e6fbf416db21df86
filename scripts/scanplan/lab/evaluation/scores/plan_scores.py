"""All scores of a plan against a scene."""

from collections.abc import Mapping

import numpy as np

from scanplan.lab.evaluation.scores import (
    arc_scores,
    column_scores,
    drawn_plan,
    flag_scores,
    leaf_scores,
    opening_scores,
    room_scores,
    sight,
    thickness_scores,
    wall_scores,
)
from scanplan.lab.evaluation.scores.scene import Scene
from scanplan.lab.evaluation.scores.score import Score, join_scores
from scanplan.types import Columns, FloatArray


def score_plan(
    drawn: Mapping[str, Columns],
    motion: FloatArray,
    truth: Scene,
    known_sight: sight.Sight | None = None,
    *,
    confidence: Columns | None = None,
    height_m: float = np.nan,
) -> Score:
    """Score a plan.

    Parameters
    ----------
    drawn : dict of str to dict
        The plan's tables, see `drawn_plan.place_plan`.
    motion : (4, 4) float
        Level rigid motion from the plan's frame to the truth's.
    known_sight : sight.Sight, optional
        What the survey could see; by default all.
    confidence : dict of str to (n,) array, optional
        As of `schemas.CONFIDENCE`.
    height_m : float
        The height of the storey, which rooms have that state none of their own.

    Returns
    -------
    score.Score
        The measures of `wall_scores`, `leaf_scores`, `opening_scores`, `column_scores`,
        `arc_scores`, `room_scores`, `thickness_scores` and `flag_scores`. Of a scene that is a part
        of a floor those alone that do not ask what is false.
    """
    plan = drawn_plan.place_plan(drawn, motion, confidence, height_m)
    known = sight.see_all(truth) if known_sight is None else known_sight
    scores = [
        wall_scores.score_walls(plan, truth, known),
        opening_scores.score_openings(plan, truth, known),
        room_scores.score_rooms(
            plan.rooms,
            truth,
            number=plan.room,
            height_m=plan.room_height_m,
            rating=plan.rating("rooms"),
        ),
    ]
    if truth.is_whole:
        scores += [
            leaf_scores.score_leaves(plan, truth, known),
            column_scores.score_columns(plan, truth, known),
            arc_scores.score_arcs(plan, truth, known),
            thickness_scores.score_thickness(plan, truth),
        ]
    score = join_scores(scores)
    return Score(score.measures | flag_scores.score_flags(score.elements), score.elements)
