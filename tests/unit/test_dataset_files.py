from pathlib import Path

import pytest

from helpers import odd_files
from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.project import dataset_files

METADATA = "rosbag2_bagfile_information:\n  version: 5\n"


def put(path, content="x"):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(content)
    return path


@pytest.mark.parametrize(
    ("given", "name"),
    [
        ("floor1", "floor1"),
        ("my survey (2)/", "my_survey__2_"),
        ("a/../b", "b"),
        ("rec.bag", "rec"),
        ("rec 1.db3", "rec_1"),
        ("1.2.mcap", "1.2"),
        ("not.a.recording", "not.a.recording"),
        ("surveys/ring.yaml", "ring"),
    ],
)
def test_name_of(given, name):
    assert dataset_files.dataset_name(given) == name


def test_name_of_a_folder_keeps_its_suffix(tmp_path):
    (tmp_path / "run.bag").mkdir()
    assert dataset_files.dataset_name(tmp_path / "run.bag") == "run.bag"


@pytest.mark.parametrize("given", ["/", ".hidden", "###", "日本"])
def test_name_of_refuses_what_leaves_no_name(given):
    with pytest.raises(StageError, match="rename"):
        dataset_files.dataset_name(given)


def test_finds_all_kinds_and_groups_them_back(tmp_path):
    wanted = [
        put(tmp_path / "a.bag"),
        put(tmp_path / "b.mcap"),
        put(tmp_path / "c.db3"),
        put(tmp_path / "run" / "metadata.yaml", METADATA),
        put(tmp_path / "run" / "run_0.db3.zstd"),
        put(tmp_path / "run" / "run_1.db3.zstd"),
        put(tmp_path / "bare" / "bare_0.db3"),
    ]
    for ignored in ("truth.geojson", "dataset.yaml", "map.pgm", ".x.bag", "notes/readme.txt"):
        put(tmp_path / ignored)
    files = dataset_files.find_files(tmp_path)
    assert files == sorted(map(str, wanted))
    expected = [tmp_path / name for name in ("a.bag", "b.mcap", "bare/bare_0.db3", "c.db3", "run")]
    assert dataset_files.group_recordings(files) == list(map(str, expected))
    assert dataset_files.group_recordings(files[::-1]) == dataset_files.group_recordings(files)


def test_a_rosbag2_folder_is_a_dataset_of_its_own(tmp_path):
    put(tmp_path / "metadata.yaml", METADATA), put(tmp_path / "x_0.mcap")
    files = dataset_files.find_files(tmp_path)
    assert len(files) == 2
    assert dataset_files.group_recordings(files) == [str(tmp_path)]


def test_a_bag_beside_a_rosbag2_recording_stays_a_recording(tmp_path):
    put(tmp_path / "metadata.yaml", METADATA), put(tmp_path / "x_0.mcap"), put(tmp_path / "y.bag")
    assert dataset_files.group_recordings(dataset_files.find_files(tmp_path)) == [
        str(tmp_path),
        str(tmp_path / "y.bag"),
    ]


def test_a_single_recording(tmp_path):
    bag = put(tmp_path / "a.bag")
    put(tmp_path / "other.bag")
    assert dataset_files.find_files(bag) == [str(bag)]


def test_paths_stay_as_they_were_given(tmp_path, monkeypatch):
    put(tmp_path / "d" / "a.bag")
    monkeypatch.chdir(tmp_path)
    assert dataset_files.find_files("d") == ["d/a.bag"]


def test_a_scan_folder(tmp_path):
    (
        put(tmp_path / "poses.tum"),
        put(tmp_path / "scans" / "2.PCD"),
        put(tmp_path / "scans" / "1.ply"),
    )
    put(tmp_path / "scans" / "readme.txt")
    files = dataset_files.find_files(tmp_path)
    assert [f.removeprefix(str(tmp_path)) for f in files] == [
        "/poses.tum",
        "/scans/1.ply",
        "/scans/2.PCD",
    ]
    assert dataset_files.is_scan_folder(files)
    assert not dataset_files.is_scan_folder(["a.bag"])


@pytest.mark.parametrize(
    ("clouds", "read"),
    [
        (["1.5.ply", "2.5.ply"], ["1.5.ply", "2.5.ply"]),
        (["scans/1.pcd", "map.ply"], ["scans/1.pcd"]),
    ],
    ids=["beside the poses", "a map beside scans"],
)
def test_clouds_with_poses(tmp_path, clouds, read):
    for name in [*clouds, "poses.tum"]:
        put(tmp_path / name)
    files = dataset_files.find_files(tmp_path)
    assert [str(Path(file).relative_to(tmp_path)) for file in files] == sorted([*read, "poses.tum"])
    assert dataset_files.is_scan_folder(files)


@pytest.mark.parametrize(
    "clouds",
    [["1700000000000000000.ply"], ["a.ply", "b.ply"], ["20240101.1.las", "20240101.2.las"]],
)
def test_clouds_without_poses_are_merged_ones(tmp_path, clouds):
    for name in clouds:
        put(tmp_path / name)
    assert dataset_files.is_merged_cloud(dataset_files.find_files(tmp_path))


@pytest.mark.parametrize(
    ("files", "told"),
    [
        ([], "accepted are .*bag"),
        (["readme.txt"], "accepted are .*bag"),
        (["a.bag.gz", "b.ZIP"], "unpack a.bag.gz, b.ZIP; accepted"),
        (["a.bag", "scans/1.pcd", "poses.tum"], "both"),
        (["scans/1.pcd"], "poses.tum"),
        (["1700000000000000000.ply", "1700000000100000000.ply"], "poses.tum"),
        (["a.bag", "1.pcd", "poses.tum"], "both"),
        (["poses.tum"], "no clouds"),
        (["x.bag.active", "y.bag"], "reindex"),
        (["run/metadata.yaml"], "no .db3 or .mcap"),
        (["run.db3", "run.db3-wal"], "wal_checkpoint"),
    ],
)
def test_refuses_in_one_line(tmp_path, files, told):
    for file in files:
        put(tmp_path / file, METADATA if file.endswith("yaml") else "x")
    with pytest.raises(StageError, match=told) as caught:
        dataset_files.find_files(tmp_path)
    assert str(tmp_path) in str(caught.value)


def test_an_empty_wal_is_no_harm(tmp_path):
    put(tmp_path / "run.db3"), put(tmp_path / "run.db3-wal", "")
    assert len(dataset_files.find_files(tmp_path)) == 1


@pytest.mark.parametrize("name", ["a.bag", "a.mcap", "a.db3"])
def test_refuses_empty_files(tmp_path, name):
    put(tmp_path / name, "")
    with pytest.raises(StageError, match="0 bytes"):
        dataset_files.find_files(tmp_path)


def test_refuses_what_is_missing_or_no_recording(tmp_path):
    with refused(file="nothing"):
        dataset_files.find_files(tmp_path / "nothing")
    with refused(file="a.txt", value="no recording"):
        dataset_files.find_files(put(tmp_path / "a.txt"))
    with refused(file="a.bag.active"):
        dataset_files.find_files(put(tmp_path / "a.bag.active"))


@pytest.mark.parametrize(
    "put_odd", [odd_files.put_pipe, odd_files.put_lost_link, odd_files.put_loop]
)
@pytest.mark.parametrize("name", ["b.bag", "b.mcap", "b.db3", "run/b_0.db3"])
def test_a_recording_that_is_no_file_is_not_lost_beside_others(tmp_path, put_odd, name):
    put(tmp_path / "a.bag")
    put(tmp_path / "run/metadata.yaml", METADATA), put(tmp_path / "run/a_0.mcap")
    put_odd(tmp_path / name)
    with refused(file=name, remedy=("copy it", "remove it")):
        dataset_files.find_files(tmp_path)


@pytest.mark.parametrize("name", ["scans/2.pcd", "poses.tum"])
def test_a_cloud_or_poses_that_are_no_file_are_told(tmp_path, name):
    put(tmp_path / "scans/1.pcd")
    put(tmp_path / "poses.tum")
    (tmp_path / name).unlink(missing_ok=True)
    odd_files.put_lost_link(tmp_path / name)
    with pytest.raises(StageError):
        dataset_files.find_files(tmp_path)


@pytest.mark.parametrize("name", ["run\n2.bag", "\x1b[31mrun.bag", "a\u202eb.bag", "run\udcff.bag"])
def test_a_recording_whose_name_cannot_be_shown_is_refused(tmp_path, name):
    put(tmp_path / name)
    with refused(remedy="rename it"):
        dataset_files.find_files(tmp_path)


def test_a_survey_file_is_told_from_a_folder(tmp_path):
    (tmp_path / "run.yaml").mkdir()
    assert dataset_files.is_survey_file("a.yaml") and dataset_files.is_survey_file("a.yml")
    assert not dataset_files.is_survey_file(
        tmp_path / "run.yaml"
    ) and not dataset_files.is_survey_file("a.bag")


@pytest.mark.parametrize("name", ["<script>run.bag", "a<b>/run.bag"])
def test_a_name_that_snakemake_takes_for_a_placeholder_is_refused(tmp_path, name):
    put(tmp_path / name)
    with refused(value="Snakemake", remedy="rename it"):
        dataset_files.find_files((tmp_path / name).parent)


@pytest.mark.parametrize("name", ["{x}.bag", "run}.bag", "a{0}b/run.bag"])
def test_a_name_with_braces_is_refused(tmp_path, name):
    put(tmp_path / name)
    with refused(value="Snakemake", remedy="rename it"):
        dataset_files.find_files((tmp_path / name).parent)


def test_a_name_that_is_no_text_is_refused_and_shown_as_text(tmp_path):
    put(tmp_path / "run\udcff.bag")
    with refused(remedy="rename it") as caught:
        dataset_files.find_files(tmp_path)
    assert "run\\udcff.bag" in str(caught.value)
    str(caught.value).encode()


def test_signs_alone_are_no_placeholder(tmp_path):
    put(tmp_path / "a<b.bag")
    put(tmp_path / "<B>.bag")
    assert len(dataset_files.find_files(tmp_path)) == 2


@pytest.mark.parametrize(
    ("name", "is_taken"), [("x" * 19, True), ("x" * 20, False), ("ab" * 30, False)]
)
def test_names_that_snakemake_takes_for_endless_are_refused(name, is_taken):
    if is_taken:
        assert dataset_files.dataset_name(name) == name
        return
    with refused(value="repeats itself"):
        dataset_files.dataset_name(name)
