"""The one exception whose message is for the user, and what more than one place tells."""

MORE_MEMORY = (
    "close other programs, use fewer cores, or allow more (`ulimit -v`, `mem_mb` of a job)"
)
"""What to do where memory is not enough."""
# what the loader of libraries, the system, Python and Arrow say where address space ends
_WANT_OF_MEMORY = (
    "failed to map segment",
    "Cannot allocate memory",
    "can't start new thread",
    "Failed to launch worker thread",
)
MOST_NAMED = 8
"""Things in one line: nobody reads a longer one."""


EXTRAS = {
    "ifcopenshell": "ifc",
    "pye57": "e57",
    "defusedxml": "e57",
    "open3d": "simulate",
    "trimesh": "simulate",
    "sklearn": "thesis",
    "pandas": "thesis",
    "kiss_icp": "kiss-icp",
}
"""Libraries that no plan of bags needs, and the extra of the wheel that each comes with."""


def name_extra(library: str) -> str:
    """Return what to do where a library of `EXTRAS` is not installed."""
    return f"{library} is not installed: pip install 'scanplan[{EXTRAS[library]}]'"


def show_controls(text: str) -> str:
    """Return a text of visible characters alone: others, which may steer a terminal, as escapes."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)


class StageError(Exception):
    """Wrong data or settings, in one line: the file, the value found, the limit and the remedy.

    A stage that raises it ends without traceback and without output. A wrong call (a programmer's
    mistake) is a `ValueError` instead.
    """

    def __init__(self, message: object) -> None:
        line = show_controls(" ".join(str(message).split()))
        # a value may be a page long: what is before and behind it says more
        super().__init__(line if len(line) <= 1200 else f"{line[:800]} ... {line[-300:]}")


def lacks_memory(error: BaseException) -> bool:
    """Return whether memory ended, by the kind of an error or by its words."""
    return isinstance(error, MemoryError) or any(words in str(error) for words in _WANT_OF_MEMORY)
