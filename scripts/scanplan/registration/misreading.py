"""Misread poses or clouds: the reading that fits, and the remedy."""

from typing import NamedTuple


class Misreading(NamedTuple):
    """Cause and remedy, as the sentence of the witness `misread` has them."""

    cause: str
    remedy: str


UNTRIED = Misreading(
    "the clock of the poses, the mounting (input.base_from_sensor) or the unit of ranges may be"
    " wrong",
    "check them",
)
"""Where no reading was tried."""
NONE_MEETS = Misreading(
    "no other unit, clock, mounting or order of the poses lets neighbours meet clearly better, so"
    " the poses themselves err from place to place, or the mounting by a few degrees",
    "record a localiser that keeps to its map, or drive more slowly; calibrate the mounting; of a"
    " drive that was put together make each part a dataset of its own",
)
"""Where all were, and scans meet in none."""
