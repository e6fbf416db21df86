"""Lines on the user's screen: some that stay, and at their end some that are written over in place.

No heavy imports: this is part of the run itself.
"""

import os
import shutil
import sys
from collections.abc import Sequence
from typing import TextIO

from scanplan.errors import show_controls
from scanplan.project.texts import CONSOLE_WIDTH, fold_line

_ERASE_BELOW = "\x1b[J"


def tell(text: str) -> None:
    """Write lines on the error output, none of whose characters steers a terminal.

    On a screen they are folded; in a file each stays one line, which programs find.
    """
    lines = [show_controls(line) for line in text.split("\n")]
    if sys.stderr.isatty():
        lines = [part for line in lines for part in fold_line(line)]
    print(*lines, sep="\n", file=sys.stderr)


class Terminal:
    """A screen, or a file where lines can only be added.

    No mode of the terminal is changed, so that a killed run leaves nothing to be mended.

    Attributes
    ----------
    in_place : bool
        Whether lines can be written over.
    """

    def __init__(self, stream: TextIO) -> None:
        self.in_place = stream.isatty() and os.environ.get("TERM", "dumb") != "dumb"
        self._stream = stream
        self._live: Sequence[str] = ()

    def say(self, line: str) -> None:
        """Write a line that stays, above those that are in place, folded."""
        width = min(CONSOLE_WIDTH, self._columns() - 1) if self.in_place else CONSOLE_WIDTH
        self._add(fold_line(show_controls(line), width=width))

    def refuse(self, line: str) -> None:
        """Write a line that says why a run ends: in a file one line, which programs find."""
        if self.in_place:
            self.say(line)
        else:
            self._add([show_controls(line)])

    def _add(self, lines: Sequence[str]) -> None:
        self._write(self._erase() + "\n".join(lines) + "\n" + self._draw())

    def show(self, lines: Sequence[str]) -> None:
        """Write lines in the place of those that were shown last; nothing where that cannot be."""
        if self.in_place and (lines or self._live):
            erased = self._erase()
            self._live = lines
            self._write(erased + self._draw())

    def _erase(self) -> str:
        return f"\x1b[{len(self._live)}A\r{_ERASE_BELOW}" if self._live else ""

    def _draw(self) -> str:
        return "".join(f"{self._fit(line)}\n" for line in self._live)

    def _fit(self, line: str) -> str:
        """Return a line that does not wrap: one more row would be one that nobody erases."""
        line = show_controls(line)
        if not self.in_place:
            return line
        width = self._columns() - 1
        return line if len(line) <= width else f"{line[: width - 1]}…"

    @staticmethod
    def _columns() -> int:
        return shutil.get_terminal_size().columns

    def _write(self, text: str) -> None:
        self._stream.write(text)
        self._stream.flush()
