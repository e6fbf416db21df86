"""What is doubtful of a plan as questions, to a person who stands there with the drawing."""

import re
from typing import Protocol

import numpy as np

from scanplan.plan.floorplan import OPENINGS, FloorPlan
from scanplan.types import FloatArray

NEARLY = "nearly"
"""What is asked of something that is not drawn."""
_SIDES = ("right", "top", "left", "bottom")
_SIDE, _OUTSIDE, _DRAWN = "at the {} of {}", "outside the known rooms", " as drawn"
_NAMED = re.compile(r"\{(\w+)\}")  # places of questions
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


class Wording(Protocol):
    """How English words are said to a reader, as `locale.Locale` does."""

    def say(self, text: str) -> str:
        """Return a text in the reader's language."""
        ...

    def title(self, text: str) -> str:
        """Return it likewise, with a capital at its beginning."""
        ...

    def fill(self, phrase: str, *words: str) -> str:
        """Return a phrase likewise, its places `{}` filled with words as they are."""
        ...

    def measure(self, length_m: float, decimals: int = 2) -> str:
        """Return a length with its unit."""
        ...


class _English:
    def say(self, text: str) -> str:
        return text

    def title(self, text: str) -> str:
        return text[:1].upper() + text[1:]

    def fill(self, phrase: str, *words: str) -> str:
        return phrase.format(*words)

    def measure(self, length_m: float, decimals: int = 2) -> str:
        return f"{length_m:.{decimals}f} m"


PLAIN: Wording = _English()
"""As the report has it: English, in metres."""


def list_phrases() -> list[str]:
    """Return what questions are made of, as `Wording.fill` takes it."""
    nouns = {*_NOUNS.values(), "wall"}
    sizes = [f", {{}} {far}{drawn}" for far in ("wide", "long") for drawn in ("", _DRAWN)]
    sides = [_SIDE.format(side, "{}") for side in _SIDES]
    asked = [_NAMED.sub("{}", words) for words in (*_QUESTIONS.values(), *_OTHERS.values())]
    return [*sorted(nouns), *sizes, _OUTSIDE, *sides, *asked]


def ask(noun: str, about: str, size_m: float, where: str, wording: Wording = PLAIN) -> str:
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
    far = "wide" if noun in OPENINGS else "long"
    size = f", {{}} {far}{'' if about == NEARLY else _DRAWN}"
    known = {
        "noun": wording.say(_NOUNS.get(noun, noun)),
        "where": where,
        "size": "" if np.isnan(size_m) else wording.fill(size, wording.measure(size_m, 1)),
    }
    return wording.fill(_NAMED.sub("{}", words), *(known[name] for name in _NAMED.findall(words)))


def say_where(
    plan: FloorPlan, room: int, place_m: FloatArray | None, wording: Wording = PLAIN
) -> str:
    """Return where a place (2,) is, as the map lies, in words.

    Parameters
    ----------
    room : int
        Row of the room that it is at; -1 of none.
    place_m : (2,) float64 or None
        None stands for the room itself.
    """
    if room < 0:
        return wording.say(_OUTSIDE)
    name = plan.room_labels[room]
    if place_m is None:
        return name
    middle_m = np.array([plan.rooms["x_m"][room], plan.rooms["y_m"][room]])
    x_m, y_m = place_m - middle_m
    quarter = round(float(np.arctan2(y_m, x_m)) / (np.pi / 2))
    return wording.fill(_SIDE.format(_SIDES[quarter % 4], "{}"), name)
