"""The demo's plan is mended on its page by somebody who knows the office and has nothing else."""

import pytest

from benchmarks import walk_bench
from helpers.pages import needs_browser
from helpers.project_copy import Project

pytestmark = [pytest.mark.workflow, needs_browser]


def test_the_demo_is_mended_by_its_page_alone(project_root, tmp_path):
    project = Project(project_root, tmp_path)
    # the command asks for the settings that a checkout has
    settings = "config/config.yaml"
    made = project.run("--configfile", settings)
    assert made.returncode == 0, made.stdout + made.stderr
    results = project.folder / "results/demo"
    walked = walk_bench.walk_floor(results)
    # what somebody can see to be wrong is right afterwards, in less than ten minutes
    assert walked.before["all_n_wrong"] > 0 and walked.after["all_n_wrong"] == 0
    assert walked.after["wall_completeness_010"] >= walked.before["wall_completeness_010"]
    assert walked.hand_s + walked.machine_s < 600
    assert 0 < len(walked.entries) <= walked.acts.count("K")
