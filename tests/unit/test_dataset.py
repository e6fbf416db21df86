"""Which datasets a run has, and which files belong to each."""

import functools

import pytest

from helpers.default_settings import SCHEMA, SETTINGS
from scanplan.errors import StageError
from scanplan.project import dataset, settings
from scanplan.project.settings_schema import list_choices


@pytest.fixture
def known():
    return settings.KnownSettings(SETTINGS, [], SCHEMA)


@pytest.fixture
def describe(known, project_root):
    drawings = project_root / "config/buildings"
    return functools.partial(dataset.describe_dataset, known=known, drawings=drawings)


def survey_file(folder, text="simulate: {building: tiny_office}"):
    path = folder / "tiny.yaml"
    path.write_text(text)
    return path


def test_names_come_in_the_order_given():
    assert dataset.name_datasets(["b.bag", "x/a", "s/c.yaml"]) == {
        "b": "b.bag",
        "a": "x/a",
        "c": "s/c.yaml",
    }
    assert dataset.name_datasets("x/a") == {"a": "x/a"}
    assert dataset.name_datasets(None) == {"demo": None}


def test_two_of_one_name_are_refused():
    with pytest.raises(StageError, match=r"y/a\.bag: .*x/a"):
        dataset.name_datasets(["x/a", "y/a.bag"])


def test_one_given_twice_is_told_so():
    with pytest.raises(StageError, match=r"x/\./a: .*x/a; leave"):
        dataset.name_datasets(["x/a", "x/./a"])


def test_the_place_of_the_thesis_is_taken():
    with pytest.raises(StageError, match="thesis"):
        dataset.name_datasets("surveys/thesis")


def test_the_demo_is_simulated_with_the_defaults(describe):
    found = describe("demo", None)
    assert found.building.endswith("config/buildings/demo_office.geojson")
    assert found.recordings == ("results/demo/survey/survey.bag",)
    assert found.truth == (
        "results/demo/survey/truth.geojson",
        "results/demo/survey/truth_poses.tum",
    )
    assert found.settings["simulate"] == SETTINGS["simulate"]


def test_a_file_describes_a_simulated_survey(describe, tmp_path):
    path = survey_file(
        tmp_path, "simulate: {building: tiny_office, recording: mcap}\nhulls: {n_clusters: 3}"
    )
    found = describe("tiny", path)
    assert found.recordings == ("results/tiny/survey/survey.mcap",)
    assert found.building.endswith("tiny_office.geojson")
    assert found.settings["hulls"]["n_clusters"] == 3
    assert found.settings["simulate"]["seed"] == SETTINGS["simulate"]["seed"]


def test_the_command_line_wins_over_the_file(known, describe, tmp_path):
    given = known._replace(given=[settings.Layer("--config", {"simulate": {"seed": 9}})])
    assert describe("t", survey_file(tmp_path), known=given).settings["simulate"]["seed"] == 9


def test_a_building_may_be_any_file(describe, tmp_path):
    model = tmp_path / "house.ifc"
    model.touch()
    path = survey_file(tmp_path, f"simulate: {{building: {model}}}")
    assert describe("t", path).building == str(model)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "simulate: {building: palace}",
            "palace is neither a file nor a drawing of ours .*tiny_office",
        ),
        ("simulate: {speed: 1}", "unknown key speed"),
        (
            "rosbag2_bagfile_information: {version: 5}",
            "describes a rosbag2 recording; give its folder",
        ),
    ],
)
def test_a_wrong_file_is_refused_in_one_line(describe, tmp_path, text, said):
    with pytest.raises(StageError, match=said) as caught:
        describe("t", survey_file(tmp_path, text))
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_refused(describe, tmp_path):
    with pytest.raises(StageError, match=r"none\.yaml: "):
        describe("none", tmp_path / "none.yaml")


def test_several_designs_in_a_folder_stop_no_plan(describe, tmp_path):
    (tmp_path / "survey.bag").write_bytes(b"#ROSBAG V2.0")
    for design in ("a.dxf", "b.ifc"):
        (tmp_path / design).write_text("")
    found = describe("a", tmp_path)
    assert dataset.list_results(found) and len(found.designs) == 2


def test_a_folder_brings_its_settings_and_its_truth(describe, tmp_path):
    (tmp_path / "a.bag").write_text("x")
    (tmp_path / "dataset.yaml").write_text("poses: {keep_every: 2}")
    found = describe("a", tmp_path)
    assert (found.recordings, found.truth, found.building) == (
        (str(tmp_path / "a.bag"),),
        None,
        None,
    )
    assert found.settings["poses"]["keep_every"] == 2
    half = tmp_path / "truth.geojson"
    half.touch()
    found = describe("a", tmp_path)
    assert found.truth is None and f"{half}: " in found.notes[0]
    found = describe("a", tmp_path / "a.bag")
    assert (
        found.settings["poses"]["keep_every"] == 5
        and "dataset.yaml and truth.geojson" in found.notes[0]
    )
    half.unlink()
    for name in ("truth.geojson", "truth_poses.tum"):
        (tmp_path / name).touch()
    found = describe("a", tmp_path)
    assert found.notes == () and found.source == str(tmp_path)
    assert found.truth == (str(tmp_path / "truth.geojson"), str(tmp_path / "truth_poses.tum"))


def test_evaluation_is_a_result_where_there_is_a_truth():
    settings = {"plan": {"method": "own", "export": {"formats": ["ifc"]}}}
    plain = dataset.Dataset("a", settings, ("a.bag",))
    known_truth = dataset.Dataset("a", settings, ("a.bag",), ("t", "p"))
    files = dataset.list_results(plain)
    assert {"results/a/selection/own.parquet", "results/a/plan/plan.ifc"} <= set(files)
    assert "results/a/plan/plan.gpkg" not in files
    assert not any(f.startswith(("results/a/walls", "results/a/evaluation")) for f in files)
    more = set(dataset.list_results(known_truth)) - set(files)
    assert more == {f"results/a/evaluation/{table}.parquet" for table in ("plan", "poses")}


def test_a_comparison_adds_the_other_orderings_and_the_walls_of_all_scans():
    settings = {"plan": {"method": "own", "export": {"formats": ["ifc"]}}}
    plain = dataset.Dataset("a", settings, ("a.bag",))
    known_truth = dataset.Dataset("a", settings, ("a.bag",), ("t", "p"))
    files = dataset.list_comparison(plain, ["hull", "own"], ["ransac"])
    assert {"results/a/selection/hull.parquet", "results/a/walls/ransac.parquet"} <= set(files)
    assert not set(files) & set(dataset.list_results(plain))
    more = set(dataset.list_comparison(known_truth, ["hull", "own"], ["ransac"])) - set(files)
    assert {file.split("/")[2] for file in more} == {"evaluation", "figures"}
    assert "results/a/figures/oracle_shares.svg" in more


@pytest.mark.parametrize("name", ["ring_rooms", "ring_hallways"])
def test_the_surveys_that_are_shipped_fit_the_schema(describe, project_root, name):
    found = describe(name, project_root / f"config/surveys/{name}.yaml")
    assert found.settings["simulate"]["building"] == "ring_office"


def test_choices_are_what_the_schema_allows():
    assert list_choices(SCHEMA, "plan", "extractor") == [
        "cluster_ransac",
        "iterative_ransac",
        "thesis_cluster_ransac",
        "thesis_iterative_ransac",
    ]


def test_settings_of_a_recording_are_no_survey(tmp_path, describe):
    with pytest.raises(StageError, match=r"tiny\.yaml: .*`simulate`.*CONFIG"):
        describe("t", survey_file(tmp_path, "poses: {keep_every: 1}"))
