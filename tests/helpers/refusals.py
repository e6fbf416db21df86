"""What is said of input that cannot be used: a line that names a file, a value, a key, a remedy."""

import re
from contextlib import contextmanager

import pytest

from scanplan.errors import StageError


def refusal(read, place):
    """Return the line that reading a place ends in: it names the place and a remedy."""
    with pytest.raises(StageError) as caught:
        read(place)
    line = str(caught.value)
    assert str(place) in line and "\n" not in line and ";" in line
    return line


@contextmanager
def refused(*, file=(), value=(), key=(), remedy=()):
    """Hold that what is done ends in one line that names all of these; its prose is free.

    Parameters
    ----------
    file : str or tuple of str
        Names of files, or ends of their paths.
    value : object or tuple
        What was found, or the limit that it is beyond, with its noun where it is a number alone.
    key, remedy : str or tuple of str
        Keys of settings, options and columns; what to do, as a command or in two words.

    Yields
    ------
    ExceptionInfo
        Of the `StageError`.
    """
    with pytest.raises(StageError) as caught:
        yield caught
    assert "\n" not in str(caught.value)
    assert_told(str(caught.value), file=file, value=value, key=key, remedy=remedy)


def assert_told(text, *, file=(), value=(), key=(), remedy=()):
    """Hold that a line of a text names all of these, each as a whole; see `refused`."""
    named = [
        str(word)
        for words in (file, value, key, remedy)
        for word in (words if isinstance(words, tuple) else (words,))
    ]
    assert named, "nothing is asked for"
    patterns = [re.compile(rf"(?<!\w){re.escape(word)}(?!\w)") for word in named]
    lines = text.splitlines()
    assert any(all(pattern.search(line) for pattern in patterns) for line in lines), (named, text)
