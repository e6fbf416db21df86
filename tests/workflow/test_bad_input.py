"""Bad input ends in one clear line, a status that is not zero, and an empty results folder."""

import os
import shutil

import numpy as np
import pytest

from helpers import bag_making
from helpers.project_copy import Project
from helpers.refusals import assert_told

pytestmark = pytest.mark.workflow


@pytest.fixture(scope="module")
def copied(project_root, tmp_path_factory):
    return Project(project_root, tmp_path_factory.mktemp("bad input"))


@pytest.fixture
def project(copied):
    """The copy, from which all that a test has made goes."""
    before = set(copied.folder.iterdir())
    yield copied
    for path in set(copied.folder.iterdir()) - before:
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink()


@pytest.fixture
def tmp_path(project):
    return project.folder


def ends_with_one_line(project, dataset, *said, left=()):
    result = project.run("--config", f'dataset="{dataset}"')
    output = result.stdout + result.stderr
    lines = [line for line in output.splitlines() if line.startswith("scanplan: ")]
    assert result.returncode != 0
    assert len(lines) == 1 and output.splitlines()[-1] == lines[0], output
    assert all(part in lines[0] for part in said), lines[0]
    assert "Traceback" not in output
    results = project.folder / "results"
    assert sorted(p.name for p in results.rglob("*") if not p.is_dir()) == sorted(left)
    assert results.exists() == bool(left)


def test_missing_folder(project):
    ends_with_one_line(project, "nowhere", "nowhere", "does not exist")


def test_empty_folder(project, tmp_path):
    (tmp_path / "empty").mkdir()
    ends_with_one_line(project, "empty", "empty", ".bag")


def test_a_wrong_key_in_dataset_yaml(project, tmp_path):
    (tmp_path / "survey").mkdir()
    (tmp_path / "survey/dataset.yaml").write_text("poses: {keep_evry: 2}")
    ends_with_one_line(project, "survey", "dataset.yaml", "keep_evry")


def test_nothing_of_what_is_given_steers_the_terminal(project, tmp_path):
    (tmp_path / "floors.tsv").write_text("path\n\x1b[31mred\n")
    ends_with_one_line(project, "floors.tsv", r"\x1b[31mred: has '\x1b' in its name; rename it")


@pytest.mark.parametrize(
    ("target", "said"),
    [
        ("plan.method=hull", 'write --config \'plan={"method": "hull"}\''),
        ("results/intel/plan/plan.svg", "no dataset intel is given, only demo"),
    ],
)
def test_what_is_no_target_is_told_with_what_to_write(project, target, said):
    result = project.run(target)
    assert result.returncode != 0 and "Traceback" not in result.stderr
    assert result.stderr.splitlines()[-1].startswith(f"scanplan: {target}: ")
    assert said in result.stderr and "MissingRule" not in result.stderr


def test_an_old_name_is_refused_with_the_new_one(project, tmp_path):
    (tmp_path / "survey").mkdir()
    (tmp_path / "survey/dataset.yaml").write_text("walls: {cluster_ransac: {min_height_m: 1.0}}")
    said = "walls.cluster_ransac.min_height_m is now walls.min_height_m"
    ends_with_one_line(project, "survey", "survey/dataset.yaml: ", said)


def test_a_way_through_a_wall_names_the_file_and_its_key(project, tmp_path):
    (tmp_path / "walk.yaml").write_text(
        "simulate: {building: tiny_office, site: {waypoints_m: [[0.7, 0.9], [3.0, 1.7]]}}"
    )
    said = (
        "walk.yaml: simulate.site.waypoints_m: ",
        "tiny_office.geojson",
        "waypoint 1 (3, 1.7)",
        "move it",
    )
    ends_with_one_line(project, "walk.yaml", *said)


def test_a_setting_out_of_range_names_the_config_file(project, tmp_path):
    (tmp_path / "mine.yaml").write_text("poses: {keep_every: 0}")
    result = project.run("--configfile", "mine.yaml")
    (line,) = [line for line in result.stderr.splitlines() if line.startswith("scanplan: ")]
    assert result.returncode != 0 and "mine.yaml: poses.keep_every: 0" in line


def test_results_of_another_dataset_of_the_name_are_kept(project, tmp_path):
    entries = list(bag_making.survey(bag_making.Maker()))
    for place in ("a", "b"):
        (tmp_path / place).mkdir()
        written(tmp_path / place / "floor", entries)
    poses = "results/floor/poses.parquet"
    assert project.run(poses, "--config", "dataset=a/floor").returncode == 0
    ends_with_one_line(
        project,
        "b/floor",
        "made of a/floor",
        "replace=floor",
        left=["motion.parquet", "poses.parquet", "source.txt"],
    )
    other = project.run(poses, "--config", "dataset=b/floor", "replace=floor")
    assert other.returncode == 0 and (tmp_path / "results/floor/source.txt").read_text().startswith(
        "b/floor\n"
    )


def test_a_truth_that_is_not_used_is_told(project, tmp_path):
    name = written(tmp_path / "half", list(bag_making.survey(bag_making.Maker())))
    (tmp_path / name / "truth.geojson").touch()
    result = project.run("--dry-run", "--quiet", "--config", f"dataset={name}")
    assert result.returncode == 0
    assert_told(result.stderr, file=("half/truth.geojson", "truth_poses.tum"))


def written(folder, entries):
    bag_making.Maker().write(folder / "run", entries)
    return folder.name


def test_a_bag_without_clouds(project, tmp_path):
    entries = [e for e in bag_making.survey(bag_making.Maker()) if e[0] == "/amcl_pose"]
    ends_with_one_line(
        project,
        written(tmp_path / "poses_only", entries),
        "run.bag",
        "no cloud topic",
        "/amcl_pose",
    )


def test_a_bag_of_2_d_scans_without_poses(project, tmp_path):
    maker = bag_making.Maker()
    entries = []
    for i in range(5):
        t_ns = bag_making.START_NS + i * 10**8
        entries.append(("/scan", t_ns, maker.laser(t_ns, np.full(360, 3.0))))
    name = written(tmp_path / "scans_only", entries)
    ends_with_one_line(project, name, "run.bag", "no pose", "/scan", "slam_toolbox")


def test_evaluation_without_truth(project, tmp_path):
    name = written(tmp_path / "untrue", list(bag_making.survey(bag_making.Maker())))
    for table in ("walls", "poses"):
        result = project.run(
            f"results/untrue/evaluation/{table}.parquet", "--config", f"dataset={name}"
        )
        output = result.stdout + result.stderr
        assert result.returncode != 0 and "Traceback" not in output
        (line,) = [line for line in output.splitlines() if line.startswith("scanplan: ")]
        assert_told(line, file="untrue", value="no truth")
    assert output.splitlines()[-1] == line


def test_settings_that_unfit_the_thesiss_surveys_matter_to_them_alone(project, tmp_path):
    name = written(tmp_path / "own", list(bag_making.survey(bag_making.Maker())))
    settings = ("--config", f"dataset={name}", "simulate={building: nowhere}")
    other = project.run("--dry-run", "all", *settings)
    assert other.returncode == 0, other.stderr
    result = project.run("--dry-run", "thesis", *settings)
    assert result.returncode != 0
    assert_told(result.stderr, key="simulate.building", value="nowhere")


def test_two_cloud_topics(project, tmp_path):
    entries = bag_making.survey(bag_making.Maker())
    entries += [("/rear", e[1], e[2]) for e in entries if e[0] == "/points"]
    entries.sort(key=lambda entry: entry[1])
    ends_with_one_line(
        project, written(tmp_path / "two", entries), "/points", "/rear", "input.cloud_topic"
    )


def test_poses_of_another_time(project, tmp_path):
    maker = bag_making.Maker()
    entries = [e for e in bag_making.survey(maker) if e[0] == "/points"]
    entries += [
        e
        for e in bag_making.survey(maker, start_ns=bag_making.START_NS + 10**15)
        if e[0] == "/amcl_pose"
    ]
    ends_with_one_line(project, written(tmp_path / "elsewhen", entries), "run.bag", "one clock")


def test_clouds_of_nothing(project, tmp_path):
    maker = bag_making.Maker()
    entries = [
        (
            e[0],
            e[1],
            maker.cloud(e[1], np.full((4, 3), np.nan, np.float32)) if e[0] == "/points" else e[2],
        )
        for e in bag_making.survey(maker)
    ]
    said = "run.bag", "too_few_points", "input.min_range_m"
    ends_with_one_line(
        project,
        written(tmp_path / "blind", entries),
        *said,
        left=["motion.parquet", "poses.parquet", "source.txt"],
    )


def test_a_truncated_bag(project, tmp_path):
    name = written(tmp_path / "cut", bag_making.survey(bag_making.Maker()))
    bag = tmp_path / "cut/run.bag"
    bag.write_bytes(bag.read_bytes()[:-100])
    ends_with_one_line(project, name, "run.bag", "rosbag reindex")


def test_what_is_whole_of_a_truncated_bag_is_read_where_that_is_asked_for(project, tmp_path):
    name = written(tmp_path / "cut", bag_making.survey(bag_making.Maker(), n_scans=20))
    bag = tmp_path / "cut/run.bag"
    bag.write_bytes(bag.read_bytes()[: bag.stat().st_size // 2])
    (tmp_path / "cut/dataset.yaml").write_text("input: {salvage: true}")
    result = project.run("results/cut/poses.parquet", "--config", f"dataset={name}")
    assert result.returncode == 0, result.stderr
    assert_told(result.stderr, file="cut/run.bag", value="damaged recording")


def test_settings_that_are_code_are_refused_before_they_are_executed(project, tmp_path):
    (tmp_path / "evil.yaml").write_text(
        "\"__use\\u005fyte__\": true\n__definitions__: [\"open('executed', 'w')\"]\n"
    )
    result = project.run("--dry-run", "--configfile", "tests/data/tiny.yaml", "evil.yaml")
    assert result.returncode == 1 and not (tmp_path / "executed").exists()
    last = result.stderr.splitlines()[-1]
    assert_told(last, file="evil.yaml", key="__use_yte__", remedy="drop it")


def test_a_recording_that_an_older_one_replaced_is_read_anew(project, tmp_path):
    maker = bag_making.Maker()
    name = written(tmp_path / "floor", list(bag_making.survey(maker)))
    other = maker.write(tmp_path / "other", bag_making.survey(maker, first=50))
    os.utime(other, (10**9, 10**9))
    poses = "results/floor/poses.parquet"
    given = (poses, "--config", f"dataset={name}")
    assert project.run(*given).returncode == 0
    before = (tmp_path / poses).read_bytes()
    assert "Nothing to be done" in project.run(*given).stderr
    shutil.copy2(other, tmp_path / name / "run.bag")
    assert project.run(*given).returncode == 0
    assert (tmp_path / poses).read_bytes() != before


def test_a_name_of_digits_wants_a_list(project, tmp_path):
    name = written(tmp_path / "2018_1", list(bag_making.survey(bag_making.Maker())))
    bare = project.run("--dry-run", "--config", f'dataset="{name}"')
    assert "--config 'dataset=[\"NAME\"]'" in bare.stderr.splitlines()[-1]
    listed = project.run("--dry-run", "--quiet", "--config", f'dataset=["{name}"]')
    assert listed.returncode == 0, listed.stderr


def test_results_behind_a_link_keep_what_was_there(project, tmp_path):
    name = written(tmp_path / "cut", bag_making.survey(bag_making.Maker()))
    bag = tmp_path / "cut/run.bag"
    bag.write_bytes(bag.read_bytes()[:-100])
    (tmp_path / "outside/empty").mkdir(parents=True)
    (tmp_path / "results").mkdir()
    (tmp_path / "results/cut").symlink_to("../outside")
    result = project.run("--config", f"dataset={name}")
    assert result.stderr.splitlines()[-1].startswith("scanplan: interpolate_poses: cut/run.bag: ")
    assert [path.name for path in (tmp_path / "outside").iterdir()] == ["empty"]


@pytest.mark.parametrize("place", ["results", "logs", "results/d", "results/d/source.txt"])
def test_what_stands_in_the_way_of_results_is_told(project, tmp_path, place):
    name = written(tmp_path / "d", list(bag_making.survey(bag_making.Maker())))
    (tmp_path / place).parent.mkdir(parents=True, exist_ok=True)
    if place.endswith(".txt"):
        (tmp_path / place).mkdir()
    else:
        (tmp_path / place).touch()
    result = project.run("--config", f"dataset={name}")
    assert result.returncode == 1 and "Traceback" not in result.stderr
    assert result.stderr.splitlines()[-1].startswith(f"scanplan: {place}: cannot be written (")


@pytest.mark.parametrize("folder", ["<script>x", "x" * 60])
def test_a_name_that_snakemake_cannot_take_is_told(project, tmp_path, folder):
    name = written(tmp_path / folder, list(bag_making.survey(bag_making.Maker())))
    ends_with_one_line(project, name, folder, "Snakemake", "rename it")


@pytest.mark.recordings
@pytest.mark.parametrize(
    ("name", "said"), [("amcl_mcap", "no cloud topic"), ("broken", "bad_index.bag")]
)
def test_recordings_that_cannot_be_used(project, recordings_dir, name, said):
    ends_with_one_line(project, recordings_dir / name, said)
