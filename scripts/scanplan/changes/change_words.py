"""A change in words, as sheets and pages state it."""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from scanplan.changes.verdicts import LIKELY, Change


class ChangeWords(NamedTuple):
    """The cells of a row.

    Attributes
    ----------
    element : str
        Its kind, with a question mark where that is doubtful, and its numbers in either plan.
    verdict : str
        With a question mark where it is doubtful.
    by : str
        How far, with the standard deviation where one is known.
    p : str
    """

    element: str
    verdict: str
    by: str
    p: str


def say_change(
    whole: Sequence[Change], per_m: float = 100.0, say: Callable[[str], str] = str
) -> ChangeWords:
    """Return in words what became of a whole, by its longest part.

    Parameters
    ----------
    whole : sequence of Change
        Its parts, the longest first, see `wholes.list_wholes`.
    per_m : float
        Units that lengths are in, a metre.
    say : callable
        Puts words and numbers into another language.

    >>> import shapely
    >>> line = shapely.LineString([(0, 0), (1, 0)])
    >>> say_change([Change("opening", 3, 4, "moved", 0.8, line, "door", shift_m=0.1, sigma_m=0.01)])
    ChangeWords(element='door a3/b4', verdict='moved?', by='10.0 ± 1.0', p='0.80')
    """
    change = whole[0]
    numbers = [("a", [of.number_a for of in whole]), ("b", [of.number_b for of in whole])]
    number = "/".join(
        survey + "+".join(map(str, sorted({n for n in of_survey if n >= 0})))
        for survey, of_survey in numbers
        if max(of_survey) >= 0
    )
    kind = change.kind_a or change.kind_b or change.table
    by = ""
    if math.isfinite(change.shift_m):
        lengths_m = (abs(change.shift_m), change.sigma_m)
        by = " ± ".join(say(f"{per_m * m:.1f}") for m in lengths_m if math.isfinite(m))
    verdict = f"{say(change.verdict)}{'?' if change.is_doubtful else ''}"
    # that it has changed is sure, what it is is not
    of_kind = "?" if change.is_change and change.p < LIKELY else ""
    return ChangeWords(f"{say(kind)}{of_kind} {number}", verdict, by, say(f"{change.p:.2f}"))
