"""A stage that fails under changed settings: the same command makes all that it changes anew."""

import pytest

from helpers.project_copy import Project

pytestmark = pytest.mark.workflow

BEGINS = "with log.log_to_file(snakemake.log[0]):\n"
# as the system ends one where memory is not enough, before or after it has said a word
ENDS = [
    "raise RuntimeError('on purpose')",
    "import os, signal; os.kill(os.getpid(), signal.SIGKILL)",
]
CHANGED = ["--config", "advanced={selection: {wall_length: {cell_m: 0.6}}}"]
TARGET = "results/demo/selection/wall_length.parquet"


@pytest.fixture(scope="module")
def project(planned, tmp_path_factory):
    project = Project(planned, tmp_path_factory.mktemp("failed"), made=True)
    made = project.run(TARGET, *CHANGED)
    assert made.returncode == 0, made.stderr
    return project


@pytest.mark.parametrize("does", ENDS)
def test_what_was_made_before_is_not_taken_for_what_is_asked(project, does):
    """`observe_walls` alone reads how large cells are; the ordering is made of what it finds."""
    target = project.folder / TARGET
    made = project.run(TARGET, *CHANGED)
    assert made.returncode == 0, made.stderr
    before = target.read_bytes()
    script = project.folder / "scripts/observe_walls.py"
    whole = script.read_text()
    script.write_text(whole.replace(BEGINS, f"{BEGINS}        {does}\n"))
    failed = project.run(TARGET)
    script.write_text(whole)
    assert failed.returncode == 1 and "scanplan: observe_walls: " in failed.stderr
    assert not (project.folder / "results/demo/observations.parquet").exists()
    again = project.run(TARGET)
    assert again.returncode == 0, again.stderr
    after = target.read_bytes()
    forced = project.run(TARGET, "--forcerun", "observe_walls")
    assert forced.returncode == 0, forced.stderr
    assert after == target.read_bytes() != before
    assert project.would_run(TARGET) == set()
