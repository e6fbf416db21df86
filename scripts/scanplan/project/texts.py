"""Words that a person gives or reads: which characters they may have, and how many in a line.

Standard library only: this runs while the workflow is being parsed.
"""

import os
import re
import textwrap

from scanplan.errors import StageError
from scanplan.plain_types import FilePath

LONGEST_NAME = 80
"""Characters of a name: more than fit into any drawing's label."""
CONSOLE_WIDTH = 100
"""Columns of a line on the console: as many as the code's, half of a wide screen."""
_LEAST_SAID = 20
"""Characters of what a line says that stay however little room there is."""
_CLAUSE_END = re.compile(r";? \(|[;,:] ")
_LONGEST_PATH = 4095
"""Bytes of a path that Linux takes; a Mac takes 1,023."""
_LONGEST_PART = 255
"""Bytes of a name in a folder, on all file systems in use."""
_UNFIT = re.compile(
    # controls, among them line breaks, and what ends a line or a paragraph elsewhere
    "[\x00-\x1f\x7f-\x9f\u2028\u2029"
    # what lets the rest of a line be read backwards
    "\u202a-\u202e\u2066-\u2069"
    # halves of characters, and the code points that are none
    "\ud800-\udfff\ufdd0-\ufdef"
    + "".join(
        f"{chr(plane + 0xFFFE)}{chr(plane + 0xFFFF)}" for plane in range(0, 0x110000, 0x10000)
    )
    + "]"
)


def fold_line(line: str, *, indent: int = 4, width: int = CONSOLE_WIDTH) -> list[str]:
    """Return a line as lines that fit, broken between words; a longer word stays whole.

    Parameters
    ----------
    indent : int
        Spaces that all but the first line begin with.
    width : int
        Characters.
    """
    if len(line) <= width:
        return [line]
    return textwrap.wrap(
        line,
        width,
        subsequent_indent=" " * indent,
        break_long_words=False,
        break_on_hyphens=False,
    )


def cut_line(text: str, width: int) -> str:
    """Return a text, or as many of its first clauses as fit, with `…` for the rest.

    Parameters
    ----------
    width : int
        Characters; a width below 20 counts as 20.
    """
    room = max(width, _LEAST_SAID)
    if len(text) <= room:
        return text
    ends = [found.start() for found in _CLAUSE_END.finditer(text[: room - 1])]
    whole = [end for end in ends if text[:end].count("(") == text[:end].count(")")]
    if whole:
        return f"{text[: whole[-1]]} …"
    words, space, _ = text[: room - 1].rpartition(" ")
    return f"{words} …" if space else f"{text[: room - 1]}…"


def find_unfit(text: str) -> str | None:
    """Return the first character that a line of text has no place for; None without.

    Line breaks, control characters, marks that turn the direction of reading, halves of surrogate
    pairs, and code points that are no characters, such as U+FFFF.
    """
    found = _UNFIT.search(text)
    return found[0] if found else None


def join_pairs(text: str) -> str:
    r"""Return a text in which a character written as JSON writes it, `\ud83c\udfe0`, is one.

    Raises
    ------
    ValueError
        If half of such a pair stands alone.
    """
    return text.encode("utf-16", "surrogatepass").decode("utf-16")


def explain_unfit(text: str) -> str | None:
    """Return why a text can stand in no line of a drawing, with the remedy; None where it can."""
    if unfit := find_unfit(text):
        return f"has {unfit!r}; leave out line breaks, control characters and what is no character"
    if not any(c.isprintable() and not c.isspace() for c in text):
        return "shows nothing; write letters, or leave it out"
    return None


def check_text(place: str, value: object, longest: int = LONGEST_NAME) -> str:
    """Return a line of text that a person gave, without the space around it.

    Parameters
    ----------
    place : str
        What the message begins with: the file and the key.
    longest : int
        Characters.

    Raises
    ------
    StageError
        If it is no text, has too many characters, or is one that `explain_unfit` explains.
    """
    limit = f"expected text of 1 to {longest} characters"
    if not isinstance(value, str):
        raise StageError(f"{place} is {value!r}, {limit}; put it in quotes")
    text = value.strip()
    if len(text) > longest:
        raise StageError(f"{place} has {len(text)} characters, {limit}; write fewer")
    if fault := explain_unfit(text):
        raise StageError(f"{place} {fault}")
    return text


def check_path(path: FilePath) -> None:
    """Refuse a path that no file system takes, or that cannot be shown in a line.

    Raises
    ------
    StageError
    """
    text = os.fspath(path)
    if unfit := find_unfit(text):
        raise StageError(f"{_shorten(text)}: has {unfit!r} in its name; rename it")
    parts = text.split("/")
    longest = max(parts, key=len)
    for what, said, limit in (("name", longest, _LONGEST_PART), ("path", text, _LONGEST_PATH)):
        n_bytes = len(os.fsencode(said))
        if n_bytes > limit:
            fault = f"is a {what} of {n_bytes} bytes, at most {limit} can be read"
            raise StageError(f"{_shorten(text)}: {fault}; give a shorter one")


def _shorten(text: str) -> str:
    return text if len(text) <= 100 else f"{text[:60]}...{text[-30:]}"
