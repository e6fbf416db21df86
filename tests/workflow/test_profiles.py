"""The groups of the profile for Slurm, without a Slurm."""

import re

import pytest
import yaml

from helpers.project_copy import Project

pytestmark = pytest.mark.workflow


@pytest.fixture
def groups(project_root):
    profile = (project_root / "workflow/profiles/slurm/config.yaml").read_text()
    return yaml.safe_load(profile)["groups"]


def planned_rules(project, groups, *arguments):
    """Rules whose jobs a run in these groups would have."""
    given = ["--groups", *(f"{rule}={group}" for rule, group in groups.items())]
    planned = project.run("--dry-run", *given, *arguments)
    assert planned.returncode == 0, planned.stdout
    counted = re.findall(r"^(\w+) +\d+$", planned.stdout + planned.stderr, re.MULTILINE)
    return set(counted) - {"all", "comparison", "total"}


@pytest.mark.parametrize("target", ["all", "comparison"])
def test_stages_of_one_group_need_none_of_a_later_one(project_root, tmp_path, groups, target):
    project = Project(project_root, tmp_path)
    rules = planned_rules(project, groups, "--", target)
    assert rules and rules <= set(groups), rules - set(groups)


def test_chunks_of_a_long_recording_are_jobs_of_their_own(project_root, tmp_path, groups):
    project = Project(project_root, tmp_path)
    (tmp_path / "long").mkdir()
    (tmp_path / "long/drive.bag").write_bytes(bytes(3000))
    (tmp_path / "long/dataset.yaml").write_text("advanced: {jobs: {chunk_gb: 1.0e-6}}")
    rules = planned_rules(project, groups, "--config", "dataset=long", "--", "comparison")
    alone = rules - set(groups)
    stages = ("register_scans", "observe_walls", "build_visibility", "build_hulls", "extract_walls")
    # what joins chunks of registration lies between the groups
    assert alone == {*(f"{stage}_chunk" for stage in stages), "gather_scan_chunks"}
    assert not rules & set(stages)


def test_what_cannot_be_cut_is_registered_in_one_job(project_root, tmp_path, groups):
    project = Project(project_root, tmp_path)
    whole = {
        "salvaged": "input: {salvage: true}\nadvanced: {jobs: {chunk_gb: 1.0e-6}}",
        "frames": "advanced: {registration: {compare_with: frames}, jobs: {chunk_gb: 1.0e-6}}",
    }
    for name, settings in whole.items():
        (tmp_path / name).mkdir()
        (tmp_path / name / "drive.bag").write_bytes(bytes(3000))
        (tmp_path / name / "dataset.yaml").write_text(settings)
    given = f"dataset=[{', '.join(whole)}]"
    rules = planned_rules(project, groups, "--config", given, "--", "all")
    assert {"observe_walls_chunk", "register_scans"} <= rules
    assert not rules & {"register_scans_chunk", "gather_scan_chunks"}
