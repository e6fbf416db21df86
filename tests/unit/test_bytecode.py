"""Compiled files that a full disk cut short are removed, and whole ones kept."""

import importlib.util
import py_compile
import subprocess
import sys
from pathlib import Path

import pytest

from scanplan.stage import bytecode

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


@pytest.fixture
def compiled(tmp_path):
    """Two compiled modules, one of them cut short."""
    paths = {}
    for name in ("whole", "cut"):
        source = tmp_path / f"package/{name}.py"
        source.parent.mkdir(exist_ok=True)
        source.write_text("NUMBERS = [1, 2, 3]\n")
        py_compile.compile(str(source))
        paths[name] = Path(importlib.util.cache_from_source(str(source)))
    paths["cut"].write_bytes(paths["cut"].read_bytes()[:40])
    return paths


def test_only_what_is_cut_short_is_removed(compiled, tmp_path):
    assert bytecode.remove_cut_files(tmp_path) == 1
    assert compiled["whole"].exists() and not compiled["cut"].exists()
    assert bytecode.remove_cut_files(tmp_path) == 0


def test_a_stage_that_meets_one_says_what_to_do(compiled, tmp_path):
    command = [sys.executable, "-c", STAGE]
    environment = {"PYTHONPATH": f"{SCRIPTS}:{tmp_path / 'package'}"}
    for said in (bytecode.CUT_SHORT, ""):
        run = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True)
        assert (run.returncode != 0) == bool(said)
        assert said in run.stderr and "Traceback" not in run.stderr


STAGE = """
from pathlib import Path
from scanplan.stage import bytecode, log
find = bytecode.remove_cut_files
bytecode.remove_cut_files = lambda: find(Path("package"))
with log.log_to_file("logs/stage.log"):
    import cut
"""
