"""What the measures of a plan against the truth mean, in words."""

import re

_AT = re.compile(r"_0(\d\d)m$")
_WORDS = {
    "n_scans": "scans that the plan is made of",
    "length_m": "length of all faces of the plan, metres",
    "false_negative": "share of the bitmap's cells where a true face is not drawn (thesis, 5.1),"
    " mean over where in a cell the grid begins",
    "correct_match": "share of the bitmap's cells that agree, likewise",
    "false_positive": "share of the bitmap's cells where a face is drawn and none is, likewise",
    "literal_false_negative": "share of the cells missed in the one grid that begins at the map's"
    " origin",
    "literal_correct_match": "share of the cells of that grid that agree",
    "literal_false_positive": "share of the cells of that grid where none is",
    "completeness": "share of the true faces' length that is drawn",
    "correctness": "share of the drawn faces' length that is true",
    "f1": "harmonic mean of completeness and correctness",
    "visible_completeness": "share of the length drawn, of the true faces that any scan of the"
    " survey could see",
    "visible_correctness": "share of the drawn faces' length that is at true faces that any scan"
    " could see",
    "visible_f1": "harmonic mean of the two for what could be seen",
    "seen_completeness": "share of the length drawn, of the true faces that the chosen scans could"
    " see",
    "observed_correctness": "correctness of what was observed, without what is inferred",
    "observed_visible_completeness": "visible completeness by what was observed, without what is"
    " inferred",
    "n_walls": "faces of the plan",
    "walls_per_true_wall": "faces of the plan per true face that has any: 1 is best",
    "redundancy": "drawn length per true length found: 1 is best",
    "missed_not_seen": "share of the visible length missed as no chosen scan could see it",
    "missed_misplaced": "missed, but drawn within 0.30 m",
    "missed_misextracted": "missed, the rest",
    "n_plan_walls": "walls of the plan",
    "plan_walls_per_true_wall": "walls of the plan per true wall that has any: 1 is best",
    "n_thickness": "walls whose thickness is known and can be compared",
    "thickness_error_m": "error of their thickness, median, metres",
    "worst_thickness_error_m": "of the wall whose thickness is most wrong, metres",
    "n_doors_true": "doors and passages of rooms that were entered",
    "n_doors_found": "of these drawn within 0.35 m",
    "n_doors_drawn": "doors and passages drawn",
    "door_recall": "share of the true ones found",
    "door_precision": "share of the drawn ones that are true",
    "door_width_error_m": "error of their width, median, metres",
    "door_width_right": "share of them with a width right within 0.10 m",
    "n_windows_true": "windows of walls that the survey could see, below and beside them",
    "n_windows_found": "of these drawn within 0.35 m",
    "n_windows_drawn": "windows drawn",
    "window_recall": "share of the true ones found",
    "window_precision": "share of the drawn ones that are true",
    "window_width_error_m": "error of their width, median, metres",
    "window_width_right": "share of them with a width right within 0.10 m",
    "n_rooms_true": "rooms that were entered",
    "n_rooms_found": "of these found: intersection over union (IoU) above one half",
    "n_rooms_false": "drawn rooms that are none",
    "room_iou": "IoU of the rooms that were entered, mean",
    "least_room_iou": "IoU of the worst of them",
}


def measure_meaning(column: str) -> str:
    """Return what a column of `schemas.PLAN_EVALUATION` means; nothing of one that is not known.

    Returns
    -------
    str
    """
    tolerance = _AT.search(column)
    meaning = _WORDS.get(_AT.sub("", column), "")
    return f"{meaning}, within 0.{tolerance[1]} m" if tolerance and meaning else meaning
