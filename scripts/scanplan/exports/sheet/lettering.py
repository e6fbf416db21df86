"""Text on a sheet: how wide it is, and which characters it may have."""

from bisect import bisect_right
from collections.abc import Callable, Iterable
from functools import lru_cache

import numpy as np
import shapely
from matplotlib.font_manager import FontProperties, findfont, get_font
from matplotlib.textpath import TextToPath

from scanplan.exports.sheet.marks import Word
from scanplan.types import FloatArray

FONT = "DejaVu Sans"
"""Of SVG, PDF and PNG: it comes with matplotlib, so that widths are the same everywhere."""
_CAPITALS = 0.729  # height of the font's capitals as a share of its size, from its tables
_SIGNS = "_-"  # a name without spaces is broken behind them
POINTS_PER_MM = 72 / 25.4  # points and millimetres of an inch
CLEAR = 0.35  # of a capital's height: kept free around words, less than the gap between lines


def font_size_mm(capitals_mm: float) -> float:
    """Return the font's size for a height of capitals."""
    return capitals_mm / _CAPITALS


@lru_cache(maxsize=4096)
def measure_width_mm(text: str, capitals_mm: float) -> float:
    """Return the length of a line of text on paper."""
    size = font_size_mm(capitals_mm) * POINTS_PER_MM
    width, _, _ = TextToPath().get_text_width_height_descent(
        text, FontProperties(family=FONT, size=size), ismath=False
    )
    return float(width) / POINTS_PER_MM


def list_unknown(texts: Iterable[str]) -> list[str]:
    """Return the characters that the font has no letter for: PDF and PNG show a box for each."""
    known = get_font(findfont(FontProperties(family=FONT))).get_charmap()
    return sorted({c for text in texts for c in text if ord(c) not in known})


def clean_text(text: str) -> str:
    """Return a text as one line without control characters.

    Names come from folders and settings: whatever they hold ends up as letters, and not as markup
    or as a new line of a file.
    """
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def shorten_text(text: str, capitals_mm: float, width_mm: float) -> str:
    """Return a clean text, cut off with an ellipsis where it is longer than a width."""
    text = clean_text(text)
    n_fit = _count_fitting(len(text), lambda n: text[:n], capitals_mm, width_mm)
    if n_fit == len(text):
        return text
    n_kept = _count_fitting(n_fit, lambda n: f"{text[:n]}…", capitals_mm, width_mm)
    return f"{text[:n_kept].rstrip()}…"


def wrap_text(text: str, capitals_mm: float, width_mm: float) -> list[str]:
    """Return a clean text on one line, or broken between words on two; what is over is cut off.

    A name without spaces is broken behind one of its signs.
    """
    text = clean_text(text)
    n_fit = _count_fitting(len(text), lambda n: text[:n], capitals_mm, width_mm)
    if n_fit == len(text):
        return [text]
    first = text[: n_fit + 1].rpartition(" ")[0] or text[: _find_sign(text[:n_fit])]
    rest = text[len(first) :]
    return [*filter(None, [first]), shorten_text(rest, capitals_mm, width_mm)]


def _find_sign(text: str) -> int:
    """Return how many letters a text has up to its last sign; 0 without any."""
    return max(text.rfind(sign) + 1 for sign in _SIGNS)


def wrap_lines(text: str, capitals_mm: float, width_mm: float) -> list[str]:
    """Return a text as lines broken between words; a longer word is cut off."""
    lines: list[str] = []
    for word in clean_text(text).split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and measure_width_mm(longer, capitals_mm) <= width_mm:
            lines[-1] = longer
        else:
            lines.append(shorten_text(word, capitals_mm, width_mm))
    return lines


def _count_fitting(
    n_letters: int, take_first: Callable[[int], str], capitals_mm: float, width_mm: float
) -> int:
    """Return how many of the first letters a width holds; no text with more of them is shorter.

    Nothing is measured that is more than twice as long: a letter takes ten microseconds.
    """

    def measure_mm(n: int) -> float:
        return measure_width_mm(take_first(n), capitals_mm)

    tried = (*(2**power for power in range(n_letters.bit_length())), n_letters)
    too_many = next((n for n in tried if measure_mm(n) > width_mm), None)
    if too_many is None:
        return n_letters
    return bisect_right(range(1, too_many), width_mm, key=measure_mm)


def word_box(word: Word, clear: float = 0.0) -> shapely.Polygon:
    """Return the rectangle of a word on paper, with a share of its capitals' height around."""
    length = measure_width_mm(word.text, word.size_mm)
    around = clear * word.size_mm
    x0, x1 = -word.align * length - around, (1 - word.align) * length + around
    y = word.size_mm / 2 + around
    corners = np.array([[x0, -y], [x1, -y], [x1, y], [x0, y]])
    return shapely.Polygon(word.place + corners @ rotation(word.turn_deg).T)


def rotation(turn_deg: float) -> FloatArray:
    """Return the matrix (2, 2) that turns counterclockwise."""
    cos, sin = np.cos(np.radians(turn_deg)), np.sin(np.radians(turn_deg))
    return np.array([[cos, -sin], [sin, cos]])
