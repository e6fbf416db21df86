"""A process that has read the libraries already: to whoever starts it, it is Python."""

import os
import subprocess
import sys
import tempfile

import pytest

from helpers.project_copy import run_python
from helpers.warm_python import serve_python

BODY = """
import os, sys
print(__name__, sys.argv, sys.path[:2], os.getcwd(), os.environ.get("GIVEN"), sys.stdin.read())
print("told", file=sys.stderr)
"""
ENDS = {
    "as it should": ("", 0),
    "with a status": ("sys.exit(3)", 3),
    "with words": ("sys.exit('scanplan: no')", 1),
    "with a fault": ("{}[0]", 1),
    "killed": ("sys.stdout.flush(); os.kill(os.getpid(), 9)", -9),
}
COMMANDS = {
    "script": ("code/script.py", "a word"),
    "module": ("-m", "script", "a word"),
    "module of no folder": ("-P", "-m", "script", "a word"),
    "code": ("-c", BODY, "a word"),
}


def both(folder, command):
    """Return what Python said and how it ended, and what the other one did."""
    env = {**os.environ, "PYTHONPATH": str(folder / "code"), "GIVEN": "an = sign"}
    given = {"cwd": folder, "env": env, "capture_output": True, "text": True, "input": "asked"}
    with tempfile.TemporaryDirectory() as place, serve_python(place) as python:
        runs = [subprocess.run([one, *command], **given) for one in (sys.executable, python)]
    return [(run.returncode, run.stdout, run.stderr.splitlines()[-1:]) for run in runs]


@pytest.mark.parametrize("command", COMMANDS.values(), ids=COMMANDS)
def test_what_it_runs_finds_what_it_would_find_in_python(tmp_path, command):
    (tmp_path / "code").mkdir()
    (tmp_path / "code/script.py").write_text(BODY)
    plain, warm = both(tmp_path, command)
    assert plain == warm and "an = sign" in warm[1] and warm[2] == ["told"]


@pytest.mark.parametrize(("end", "status"), ENDS.values(), ids=ENDS)
def test_it_ends_as_python_does(tmp_path, end, status):
    (tmp_path / "code").mkdir()
    (tmp_path / "code/script.py").write_text(BODY + end)
    plain, warm = both(tmp_path, ("code/script.py",))
    assert plain == warm and warm[0] == status


def test_what_it_starts_as_itself_has_read_the_libraries_too(tmp_path):
    (tmp_path / "inner.py").write_text("import sys; print('numpy' in sys.modules)")
    start = "import subprocess, sys; subprocess.run([sys.executable, 'inner.py'])"
    (tmp_path / "outer.py").write_text(start)
    run = run_python(tmp_path, ["outer.py"], dict(os.environ))
    assert run.stdout == "True\n" and run.stderr == ""


def test_the_code_of_the_tests_is_not_found(tmp_path):
    (tmp_path / "script.py").write_text("import scanplan")
    run = run_python(tmp_path, ["script.py"], dict(os.environ))
    assert run.returncode == 1 and "No module named 'scanplan'" in run.stderr
