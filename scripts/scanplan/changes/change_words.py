"""A change in words, as sheets and pages state it."""

import math
from typing import NamedTuple

from scanplan.changes.verdicts import CHANGES, STATES, Change


class ChangeWords(NamedTuple):
    """The cells of a row.

    Attributes
    ----------
    element : str
        Its kind, and its number in either plan.
    verdict : str
        With a question mark where it is doubtful.
    by_cm : str
        How far, with the standard deviation where one is known.
    p : str
    """

    element: str
    verdict: str
    by_cm: str
    p: str


def say_change(change: Change) -> ChangeWords:
    """Return a change in words.

    >>> import shapely
    >>> line = shapely.LineString([(0, 0), (1, 0)])
    >>> say_change(Change("opening", 3, 4, "moved", 0.8, line, "door", shift_m=-0.1, sigma_m=0.01))
    ChangeWords(element='door a3/b4', verdict='moved?', by_cm='10.0 ± 1.0', p='0.80')
    """
    numbers = [("a", change.number_a), ("b", change.number_b)]
    number = "/".join(f"{survey}{n}" for survey, n in numbers if n >= 0)
    kind = change.kind_a or change.kind_b or change.table
    is_doubtful = change.verdict in (*CHANGES, *STATES) and not change.is_told
    by_cm = ""
    if math.isfinite(change.shift_m):
        sigma = f" ± {100 * change.sigma_m:.1f}" if math.isfinite(change.sigma_m) else ""
        by_cm = f"{100 * abs(change.shift_m):.1f}{sigma}"
    verdict = f"{change.verdict}{'?' if is_doubtful else ''}"
    return ChangeWords(f"{kind} {number}", verdict, by_cm, f"{change.p:.2f}")
