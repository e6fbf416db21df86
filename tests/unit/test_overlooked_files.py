"""Files that seem to belong to a dataset and are not read: each is told, with the remedy."""

import pytest

from helpers.refusals import assert_told
from scanplan.project import dataset_files, overlooked_files

METADATA = "rosbag2_bagfile_information:\n  version: 5\n"


def put(path, content="x"):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(content)
    return path


def test_nothing_of_a_whole_dataset_is_overlooked(tmp_path):
    for name in ("a.bag", "dataset.yaml", "truth.geojson", "truth_poses.tum", "notes.yaml"):
        put(tmp_path / name)
    assert overlooked_files.list_overlooked(tmp_path) == []
    assert overlooked_files.list_overlooked(put(tmp_path / "alone" / "a.bag")) == []


def test_what_stands_beside_a_single_recording_is_told(tmp_path):
    bag = put(tmp_path / "a.bag")
    (
        put(tmp_path / "truth.geojson"),
        put(tmp_path / "truth_poses.tum"),
        put(tmp_path / "dataset.yaml"),
    )
    (note,) = overlooked_files.list_overlooked(bag)
    assert_told(note, file=("dataset.yaml", "truth.geojson", "truth_poses.tum"))
    assert_told(note, remedy=f"folder {tmp_path}")
    put(tmp_path / "run" / "metadata.yaml", METADATA), put(tmp_path / "run" / "x_0.mcap")
    (note,) = overlooked_files.list_overlooked(tmp_path / "run")
    assert_told(note, value="run alone")


@pytest.mark.parametrize(("there", "missing"), [(0, 1), (1, 0)])
def test_half_a_truth_is_told(tmp_path, there, missing):
    put(tmp_path / "a.bag")
    put(tmp_path / dataset_files.TRUTH_FILES[there])
    (note,) = overlooked_files.list_overlooked(tmp_path)
    is_there, is_missing = (dataset_files.TRUTH_FILES[place] for place in (there, missing))
    assert_told(note, file=tmp_path / is_there, value=f"{is_missing} is missing")


@pytest.mark.parametrize(
    ("name", "read"),
    [
        *((name, "settings of a dataset are read from dataset.yaml") for name in (
            "dataset.yml", "Dataset.yaml", "dataset.yaml.txt", "dataset.json")),
        *((name, "corrections are read from corrections.yaml or corrections.geojson") for name in (
            "corrections.yml", "Corrections.yaml", "corrections.json", "CORRECTIONS.GEOJSON",
            "corrections.yaml.txt")),
        *((name, "the truth is read from truth.geojson or truth_poses.tum") for name in (
            "Truth.geojson", "truth.json", "truth_poses.tum.txt")),
    ],
)  # fmt: skip
def test_files_of_nearly_a_name_that_is_read_are_told(tmp_path, name, read):
    put(tmp_path / "a.bag")
    put(tmp_path / name)
    (note,) = overlooked_files.list_overlooked(tmp_path)
    assert_told(note, file=(tmp_path, name), remedy=(read, "rename it"))


def test_links_and_folders_of_nearly_a_name_are_told(tmp_path):
    put(tmp_path / "a.bag")
    (tmp_path / "corrections.yml").symlink_to("nowhere")
    (tmp_path / "dataset.yml").mkdir()
    settings, corrections = overlooked_files.list_overlooked(tmp_path)
    assert_told(settings, file="dataset.yml")
    assert_told(corrections, file="corrections.yml")
