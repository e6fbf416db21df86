"""What pages and docstrings show of Python says what it says."""

import doctest
import importlib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = ROOT / "scripts"
SHOWING = sorted(p for p in SCRIPTS.rglob("*.py") if ">>> " in p.read_text("utf-8"))


def test_the_example_of_the_readme_makes_a_plan(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    failed, tried = doctest.testfile(str(ROOT / "README.md"), module_relative=False)
    assert (failed, tried >= 8) == (0, True)
    assert (tmp_path / "room.dxf").stat().st_size > 0


@pytest.mark.parametrize("path", SHOWING, ids=lambda path: path.stem)
def test_examples_of_docstrings_hold(path):
    name = ".".join(path.relative_to(SCRIPTS).with_suffix("").parts)
    failed, tried = doctest.testmod(importlib.import_module(name))
    assert (failed, tried > 0) == (0, True)
