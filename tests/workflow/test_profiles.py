"""The groups of the profile for Slurm, without a Slurm."""

import re

import pytest
import yaml

from helpers.project_copy import Project

pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("module")]


@pytest.mark.parametrize("target", ["all", "comparison"])
def test_stages_of_one_group_need_none_of_a_later_one(project_root, tmp_path, target):
    profile = (project_root / "workflow/profiles/slurm/config.yaml").read_text()
    groups = yaml.safe_load(profile)["groups"]
    project = Project(project_root, tmp_path)
    given = ["--groups", *(f"{rule}={group}" for rule, group in groups.items())]
    planned = project.run("--dry-run", *given, "--", target)
    assert planned.returncode == 0, planned.stdout
    counted = re.findall(r"^(\w+) +\d+$", planned.stdout + planned.stderr, re.MULTILINE)
    rules = set(counted) - {target, "total"}
    assert rules and rules <= set(groups), rules - set(groups)
