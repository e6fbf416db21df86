"""What the elements of models are shown in."""

from collections.abc import Mapping

from scanplan.types import Columns

COLOURS: Mapping[str, str] = {
    "wall": "#d9d4ccff",
    "column": "#d9d4ccff",
    "inferred wall": "#b3c7e0ff",
    "to verify": "#f29933ff",
    "furniture": "#b8a58aff",
    "door": "#996b42ff",
    "window": "#8cc7e666",
    "glass": "#8cc7e666",
    "slab": "#9e9e9eff",
    "ceiling": "#edede64d",
    "space": "#99d99926",
}
"""Red, green, blue and opacity by what is shown, as in CSS."""


def read_colour(name: str) -> tuple[float, float, float, float]:
    """Return red, green, blue and opacity, each 0 to 1, of a colour of `COLOURS`."""
    red, green, blue, opacity = bytes.fromhex(COLOURS[name].removeprefix("#"))
    return red / 255, green / 255, blue / 255, opacity / 255


def colour_of(columns: Columns, row: int, usual: str) -> str:
    """Return the colour of an element: its usual one, or that of what is to be verified."""
    is_doubtful = "verify" in columns and bool(columns["verify"][row])
    return "to verify" if is_doubtful else usual
