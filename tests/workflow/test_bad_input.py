"""Bad input ends in one clear line, a status that is not zero, and an empty results folder."""

import pytest

from projectcopy import Project

pytestmark = pytest.mark.workflow


@pytest.fixture
def project(project_root, tmp_path):
    return Project(project_root, tmp_path)


def ends_with_one_line(project, dataset, *said):
    result = project.run("--config", f'dataset="{dataset}"')
    output = result.stdout + result.stderr
    lines = [line for line in output.splitlines() if all(part in line for part in said)]
    assert result.returncode != 0
    assert len(lines) >= 1, output
    assert "Traceback" not in output
    assert not (project.folder / "results").exists()


def test_missing_folder(project):
    ends_with_one_line(project, "nowhere", "nowhere", "does not exist")


def test_empty_folder(project, tmp_path):
    (tmp_path / "empty").mkdir()
    ends_with_one_line(project, "empty", "empty", ".bag")


def test_a_wrong_key_in_dataset_yaml(project, tmp_path):
    (tmp_path / "survey").mkdir()
    (tmp_path / "survey/dataset.yaml").write_text("poses: {keep_evry: 2}")
    ends_with_one_line(project, "survey", "dataset.yaml", "keep_evry")


@pytest.mark.recordings
@pytest.mark.parametrize(("name", "said"), [("amcl_mcap", "cloud"), ("broken", "bad_index.bag")])
def test_recordings_that_cannot_be_used(project, recordings_dir, name, said):
    ends_with_one_line(project, recordings_dir / name, said)
