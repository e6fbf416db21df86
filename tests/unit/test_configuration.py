"""Settings are merged in order and every fault names itself."""

import copy

import pytest

from scanplan import configuration
from scanplan.errors import StageError


@pytest.fixture
def defaults(project_root):
    return configuration.read_yaml(project_root / "config/config.yaml")


@pytest.fixture
def schema(project_root):
    return configuration.read_yaml(project_root / "workflow/schemas/config.schema.yaml")


def test_the_defaults_fit_the_schema(defaults, schema):
    configuration.check(defaults, schema, "config.yaml")


def test_the_thesis_preset_fits_the_schema(defaults, schema, project_root):
    preset = configuration.read_yaml(project_root / "config/thesis.yaml")
    configuration.check(configuration.merged(defaults, preset), schema, "thesis.yaml")


def test_every_key_is_required_described_and_closed(schema):
    def walk(node, where):
        assert node.get("description"), where
        if node.get("type") == "object":
            assert node["additionalProperties"] is False and set(node["required"]) == set(node["properties"]), where
            for key, child in node["properties"].items():
                walk(child, f"{where}.{key}")

    for key, child in schema["properties"].items():
        walk(child, key)


def test_every_key_is_in_the_manual(schema, project_root):
    manual = (project_root / "config/README.md").read_text()

    def keys(node):
        for key, child in node.get("properties", {}).items():
            yield key
            yield from keys(child)

    missing = [key for key in keys(schema) if f"`{key}`" not in manual]
    assert missing == []


def test_the_command_line_wins_over_the_dataset_over_the_defaults(defaults, schema, tmp_path):
    own = tmp_path / "dataset.yaml"
    own.write_text("poses: {keep_every: 2, max_gap_s: 9.0}\n")
    before = copy.deepcopy(defaults)
    settings = configuration.for_dataset(defaults, own, {"poses": {"keep_every": 3}}, schema)
    assert settings["poses"]["keep_every"] == 3 and settings["poses"]["max_gap_s"] == 9.0
    assert settings["hulls"] == defaults["hulls"] and defaults == before


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("poses: {keep_every: 0}", "poses.keep_every: 0 is less than the minimum of 1"),
        ("poses: {keep_evry: 2}", "poses: unknown key keep_evry; known are keep_every"),
        ("poses: {keep_every: two}", "poses.keep_every: 'two' is not of type 'integer'"),
        ("poses: {max_gap_s: .nan}", "poses.max_gap_s: nan"),
        ("pose: {}", "settings: unknown key pose"),
        ("[1, 2]", "holds list"),
        ("1: 2", "settings: unknown key 1"),
        ("hulls: {n_clusters: 10.0}", "hulls.n_clusters: 10.0 is not of type 'integer'"),
        ("input: {min_range_m: 5.0, max_range_m: 2.0}", "input.max_range_m: 2.0 is below input.min_range_m (5.0)"),
        ("plan: {merge: {tolerance_m: 0.5}}", "plan.merge.merge_distance_m: 0.1 is below plan.merge.tolerance_m (0.5)"),
        ("a: [", "is not valid YAML"),
        ("dataset: other", "given on the command line"),
        ("plan: {method: best}", "plan.method: 'best' is not one of"),
        ("hulls: !!python/object/apply:os.system ['true']", "is not valid YAML"),
    ],
)
def test_a_fault_names_file_key_value_and_limit(defaults, schema, tmp_path, text, said):
    own = tmp_path / "dataset.yaml"
    own.write_text(text)
    with pytest.raises(StageError) as caught:
        configuration.for_dataset(defaults, own, {}, schema)
    assert said in str(caught.value) and str(own) in str(caught.value) and "\n" not in str(caught.value)


def test_text_for_a_number_on_the_command_line_is_explained(defaults, schema):
    with pytest.raises(StageError, match="--configfile"):
        configuration.for_dataset(defaults, None, {"poses": {"keep_every": "2"}}, schema)
