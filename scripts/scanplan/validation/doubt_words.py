"""What is doubtful of a plan as questions, to a person who stands there with the drawing."""

import numpy as np

from scanplan.plan.floorplan import OPENINGS, FloorPlan
from scanplan.types import FloatArray

NEARLY = "nearly"
"""What is asked of something that is not drawn."""
_SIDES = ("right", "top", "left", "bottom")
_NOUNS = OPENINGS | {"face": "side of a wall"}
# a question by what it is of, and what of that is doubtful; of others by the latter alone
_QUESTIONS = {
    ("wall", "kind"): "Is it a wall {where}{size}, or a cupboard, a rack or an open door?",
    ("room", "existence"): "Is {where} one room, as it is drawn?",
    ("room", "outline"): "Where does {where} end?",
    ("room", ""): "Is {where} as it is drawn?",
    ("gap", "kind"): "What is it that is open {where}{size}?",
}
_OTHERS = {
    "existence": "Is there a {noun} {where}{size}?",
    "kind": "Is it a {noun} {where}{size}?",
    "place": "Is the {noun} {where}{size} where it is drawn?",
    "end": "Where does the wall end {where}{size}?",
    "width": "How wide is the {noun} {where}{size}?",
    NEARLY: "Perhaps a {noun} {where}{size}?",
    "": "Is the {noun} {where}{size} as it is drawn?",
}


def ask(noun: str, about: str, size_m: float, where: str) -> str:
    """Return a question.

    Parameters
    ----------
    noun : str
        A type of opening, wall, face or room.
    about : str
        As in `schemas.CONFIDENCE`; empty where no stage said so.
    size_m : float
        How long or wide it is drawn, NaN of a room.
    where : str
        As `say_where` returns it.
    """
    words = _QUESTIONS.get((noun, about), _OTHERS.get(about, _OTHERS[""]))
    measured = "wide" if noun in OPENINGS else "long"
    drawn = "" if about == NEARLY else " as drawn"
    size = "" if np.isnan(size_m) else f", {size_m:.1f} m {measured}{drawn}"
    return words.format(noun=_NOUNS.get(noun, noun), where=where, size=size)


def say_where(plan: FloorPlan, room: int, place_m: FloatArray | None) -> str:
    """Return where a place (2,) is, as the map lies, in words.

    Parameters
    ----------
    room : int
        Row of the room that it is at; -1 of none.
    place_m : (2,) float64 or None
        None stands for the room itself.
    """
    if room < 0:
        return "outside the known rooms"
    name = plan.room_labels[room]
    if place_m is None:
        return name
    middle_m = np.array([plan.rooms["x_m"][room], plan.rooms["y_m"][room]])
    x_m, y_m = place_m - middle_m
    quarter = round(float(np.arctan2(y_m, x_m)) / (np.pi / 2))
    return f"at the {_SIDES[quarter % 4]} of {name}"
