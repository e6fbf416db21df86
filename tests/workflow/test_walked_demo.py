"""The demo's plan, mended by somebody who has its page and nothing else."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from helpers.pages import needs_browser
from helpers.warm_python import serve_python

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))
import walk_bench

pytestmark = [pytest.mark.workflow, needs_browser]
COMMAND = """
import sys
sys.executable = sys.argv.pop()
from scanplan.project.run import command
sys.exit(command.main())
"""


@pytest.fixture(scope="module")
def walked(project_root, tmp_path_factory):
    """The demo with its drawings alone, and what somebody did who answers what is drawn wrong."""
    folder = tmp_path_factory.mktemp("walk")
    (folder / "few.yaml").write_text("plan:\n  export:\n    formats: []\n")
    given = ("demo", "--cores", "1", "--configfile", "few.yaml")
    with tempfile.TemporaryDirectory() as place, serve_python(place) as python:
        planned = subprocess.run(
            [sys.executable, "-c", COMMAND, *given, python],
            cwd=folder, env={**os.environ, "PYTHONPATH": str(project_root / "scripts")},
            capture_output=True, text=True,
        )  # fmt: skip
    assert planned.returncode == 0, planned.stderr
    # what is missing is not drawn: a line takes as long as three answers
    return walk_bench.walk_floor(folder / "results/demo", minutes=0)


def test_all_that_is_drawn_wrong_is_mended(walked):
    assert walked.before["all_n_wrong"] >= 1
    assert walked.after["all_n_wrong"] == 0 and walked.unfit == []


def test_nothing_that_was_right_is_lost(walked):
    # a hundredth of the walls: what a piece of furniture that was drawn as wall stood before
    for name in ("floorsp_room_f1", "room_iou", "wall_completeness_010"):
        assert walked.after[name] >= walked.before[name] - 0.01


def test_it_takes_a_few_acts_and_two_minutes(walked):
    assert len(walked.entries) <= 15 and walked.acts.count("K") <= 50
    assert walk_bench.time_acts(walked.acts) < 120
