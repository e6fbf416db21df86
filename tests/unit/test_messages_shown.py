"""Whatever a message is made of, nothing in it steers a terminal."""

import io

from hypothesis import given
from hypothesis import strategies as st

from scanplan.errors import StageError, show_controls
from scanplan.project.run.terminal import Terminal, tell


@given(st.text())
def test_nothing_in_a_message_steers_a_terminal(text):
    assert str(StageError(text)).isprintable()
    assert show_controls(text).isprintable()
    stream = io.StringIO()
    Terminal(stream).say(text)
    assert all(line.isprintable() for line in stream.getvalue().split("\n"))


def test_controls_are_shown_as_escapes_and_all_else_as_it_is():
    assert show_controls("a\x1b[31m\x07ü\u202e🏠\udcff") == r"a\x1b[31m\x07ü\u202e🏠\udcff"


def test_lines_that_end_a_run_stay_lines(capsys):
    tell("plan of \x1b[2Jd\n  a table")
    assert capsys.readouterr().err == "plan of \\x1b[2Jd\n  a table\n"
