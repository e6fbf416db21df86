"""Settings are merged in order and every fault names itself."""

import copy

import pytest
from snakemake.common.configfile import load_configfile

from helpers.default_settings import SCHEMA, SETTINGS
from helpers.refusals import assert_told, refused
from scanplan.errors import StageError
from scanplan.project.settings import (
    Layer,
    end_on_faulty_settings,
    find_origin,
    locate_fault,
    merge_settings,
    read_defaults,
    read_own_layers,
    settings_of_dataset,
    settings_of_run,
)
from scanplan.project.settings_check import COMMAND_LINE, check_settings
from scanplan.project.settings_schema import iterate_keys, type_texts
from scanplan.project.yaml_file import read_yaml


@pytest.fixture
def defaults():
    return SETTINGS


@pytest.fixture
def schema():
    return SCHEMA


def test_the_file_of_the_user_is_laid_over_the_defaults(schema, tmp_path):
    path = tmp_path / "config.yaml"
    path.write_text("poses: {keep_every: 7}")
    found = read_defaults(path, schema)
    assert found == merge_settings(SETTINGS, {"poses": {"keep_every": 7}})
    path.write_text("poses: {keep_every: 0}")
    with pytest.raises(StageError, match=r"^config/config\.yaml: poses\.keep_every: 0 is less"):
        read_defaults(path, schema)


def test_the_thesis_preset_fits_the_schema(defaults, schema, project_root):
    preset = read_yaml(project_root / "config/thesis.yaml")
    check_settings(merge_settings(defaults, preset), schema, "thesis.yaml")


def test_a_list_that_users_copy_from_is_as_the_defaults(defaults, schema, project_root):
    assert read_defaults(project_root / "config/config.yaml", schema) == defaults


def test_the_command_line_wins_over_the_dataset_over_the_defaults(defaults, schema, tmp_path):
    own = tmp_path / "dataset.yaml"
    own.write_text("poses: {keep_every: 2, max_gap_s: 9.0}\n")
    before = copy.deepcopy(defaults)
    layers = [*read_own_layers(own), Layer("other.yaml", {"poses": {"keep_every": 4}})]
    layers += [Layer(COMMAND_LINE, {"poses": {"keep_every": 3}})]
    settings = settings_of_dataset(defaults, layers, schema)
    assert settings["poses"]["keep_every"] == 3 and settings["poses"]["max_gap_s"] == 9.0
    assert settings["hulls"] == defaults["hulls"] and defaults == before


def test_files_that_a_dataset_names_may_lie_in_its_folder(defaults, schema, tmp_path):
    own = tmp_path / "dataset.yaml"
    own.write_text("plan: {export: {catalogue: ours.yaml, language: de, layers: elsewhere.yaml}}\n")
    (tmp_path / "ours.yaml").touch()
    export = settings_of_dataset(defaults, read_own_layers(own), schema)["plan"]["export"]
    assert export["catalogue"] == str(tmp_path / "ours.yaml")
    assert (export["language"], export["layers"]) == ("de", "elsewhere.yaml")
    # what other files say, and the command line, is of the command's folder
    given = [Layer("other.yaml", {"plan": {"export": {"catalogue": "ours.yaml"}}})]
    export = settings_of_dataset(defaults, given, schema)["plan"]["export"]
    assert export["catalogue"] == "ours.yaml"


def test_what_a_run_is_of_is_no_setting_of_its_results(defaults, schema):
    layers = [
        Layer("a.yaml", {"dataset": "a", "replace": "a"}),
        Layer(COMMAND_LINE, {"dataset": ["a", "b"]}),
    ]
    assert not {"dataset", "replace"} & set(settings_of_dataset(defaults, layers, schema))
    assert settings_of_run(defaults, layers, schema) == {"dataset": ["a", "b"], "replace": "a"}
    assert settings_of_run(defaults, [], schema) == {"dataset": None, "replace": None}


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ([], r"is \[\], expected: folder"),
        (None, "dataset: is empty; name a folder"),
        (12, r"--config 'dataset=\[\"NAME\"\]'"),
    ],
)
def test_a_dataset_that_is_none(defaults, schema, given, said):
    with pytest.raises(StageError, match=said):
        settings_of_run(defaults, [Layer(COMMAND_LINE, {"dataset": given})], schema)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("poses: {keep_every: 0}", "poses.keep_every: 0 is less than the minimum of 1"),
        ("poses: {keep_every: 1:30}", "`1:30` would be read as minutes, to the base of 60"),
        (
            "poses: {keep_evry: 2}",
            "poses: unknown key keep_evry (did you mean keep_every?); known ",
        ),
        (
            "poses.keep_every: 2",
            "unknown key poses.keep_every (write `poses:`, and indented below it `keep_every:`)",
        ),
        (
            "selection: {stop: {area_share: '0,95'}}",
            "selection.stop.area_share: is '0,95', expected: auto or a share",
        ),
        ("poses: {keep_every: two}", "poses.keep_every: 'two' is not of type 'integer'"),
        ("poses: {max_gap_s: .nan}", "poses.max_gap_s: nan"),
        ("pose: {}", "settings: unknown key pose"),
        ("[1, 2]", "holds list"),
        ("1: 2", "settings: unknown key 1"),
        ("hulls: {n_clusters: 10.0}", "hulls.n_clusters: 10.0 is not of type 'integer'"),
        (
            "input: {min_range_m: 5.0, max_range_m: 2.0}",
            "input.max_range_m: 2.0 must be above input.min_range_m (5.0)",
        ),
        (
            "input: {max_range_m: 0.1}",
            "input.max_range_m: 0.1 must be above input.min_range_m (0.1)",
        ),
        (
            "advanced: {hulls: {sample_size: 9}}",
            "advanced.hulls.sample_size: 9 must not be below hulls.n_clusters (10)",
        ),
        (
            "plan: {merge: {tolerance_m: 0.5}}",
            "plan.merge.merge_distance_m: 0.1 must not be below plan.merge.tolerance_m (0.5)",
        ),
        (
            "building: {door_height_m: 0.9}",
            "building.door_height_m: 0.9 must not be below building.wall_height_m (1.0)",
        ),
        (
            "advanced: {walls: {hang_height_m: 2.1}}",
            "old keys: advanced.walls.hang_height_m is gone (labels of lines and surfaces decide"
            " now what is a wall)",
        ),
        (
            "walls: {iterative_ransac: {door_height_m: 2.0, max_planes: 9}}",
            "old keys: walls.iterative_ransac.door_height_m is now building.door_height_m,"
            " walls.iterative_ransac.max_planes is gone (no survey needed another value than its"
            " default)",
        ),
        (
            "advanced: {registration: {icp_distances_m: [0.1, 0.3]}}",
            "advanced.registration.icp_distances_m: [0.1, 0.3] must not rise",
        ),
        ("a: [", "is not valid YAML (line 1, column 5: "),
        ("poses:\n\tkeep_every: 1", "is not valid YAML (line 2, column 1: "),
        (
            "plan: {method: hull}\nplan: {}",
            "is not valid YAML (line 2, column 1: duplicate key `plan`",
        ),
        (
            "poses: {keep_every: 010}",
            "column 21: `010` would be read to the base of 8, leave the 0",
        ),
        ("simulate: {seed: 2024-02-30}", "line 1, column 18: `2024-02-30` is no timestamp"),
        ("poses: {keep_every: !!int two}", "line 1, column 21: `two` is no int"),
        ("poses: !!map two", "is not valid YAML (line 1, column 8: expected a mapping"),
        (f"poses: {'[' * 3000}", "is nested too deeply"),
        (
            "advanced: {registration: {icp_distances_m: [.nan]}}",
            "advanced.registration.icp_distances_m: [nan] is no finite number",
        ),
        ("simulate: {site: {waypoints_m: [[0, .inf], [1, 1]]}}", "inf is greater than the maximum"),
        ("replace: other", "given on the command line"),
        ("dataset: other", "given on the command line"),
        ("plan: {method: best}", "plan.method: 'best' is not one of"),
        ("hulls: !!python/object/apply:os.system ['true']", "is not valid YAML"),
        ("__use_yte__: true\nposes: {keep_every: 3}", "__use_yte__: has Snakemake execute"),
        ("a: &k {b: 1}\nc: *k", "line 2, column 4: an alias stands for other values"),
        ("a: {<<: {b: 1}}", "line 1, column 5: `<<` stands for other values"),
    ],
)
def test_a_fault_names_file_key_value_and_limit(defaults, schema, tmp_path, text, said):
    own = tmp_path / "dataset.yaml"
    own.write_text(text)
    with pytest.raises(StageError) as caught:
        settings_of_dataset(defaults, read_own_layers(own), schema)
    assert (
        said in str(caught.value)
        and str(own) in str(caught.value)
        and "\n" not in str(caught.value)
    )


@pytest.mark.parametrize(
    ("given", "read"),
    [
        ({"poses": {"keep_every": "2"}}, {"poses": {"keep_every": 2}}),
        ({"poses": {"max_gap_s": "0.5"}}, {"poses": {"max_gap_s": 0.5}}),
        ({"poses": {"max_gap_s": "3"}}, {"poses": {"max_gap_s": 3}}),
        ({"input": {"salvage": "true"}}, {"input": {"salvage": True}}),
        ({"input": {"cloud_topic": "null"}}, {"input": {"cloud_topic": None}}),
        ({"input": {"cloud_topic": "12"}}, {"input": {"cloud_topic": "12"}}),
        (
            {"input": {"base_from_sensor": ["0", "0", "1.5", "0", "0", "90"]}},
            {"input": {"base_from_sensor": [0, 0, 1.5, 0, 0, 90]}},
        ),
        ({"dataset": ["1", "b"], "seed": 3}, {"dataset": ["1", "b"], "seed": 3}),
        ({"poses": {"keep_every": "1:30"}}, {"poses": {"keep_every": "1:30"}}),
        ({"poses": {"keep_every": "two"}}, {"poses": {"keep_every": "two"}}),
        ({"poses": {"unknown": "2"}, "other": "x"}, {"poses": {"unknown": "2"}, "other": "x"}),
    ],
)
def test_text_on_the_command_line_is_what_a_file_would_give(given, read, schema):
    assert type_texts(given, schema) == read


EXPORT = "plan: {export: %s}"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (EXPORT % f"{{author: {'a' * 201}}}", "export.author: has 201 characters, at most 200"),
        (EXPORT % f"{{project: {'a' * 10**5}}}", "has 100000 characters, at most 200; write fewer"),
        (EXPORT % '{author: "a\\nb"}', r"export.author: has '\n'; leave out line breaks"),
        (EXPORT % '{organisation: "a\\uffff"}', r"has '\uffff'; leave out"),
        (EXPORT % '{storey: "\\ud83c"}', r"`\ud83c` has half of a character"),
        (EXPORT % "{site: {crs: EPSG:0}}", "site.crs: is 'EPSG:0': expected a code of 1024"),
        (EXPORT % f"{{site: {{crs: EPSG:{'9' * 20}}}}}", "expected a code of 1024 to 32767"),
        (EXPORT % "{site: {crs: EPSG:4326}}", "is a system in degrees; give a projected one"),
        (EXPORT % "{site: {east_m: 1.0e+300}}", "site.east_m: 1e+300 is greater than the maximum"),
        (EXPORT % "{site: {height_m: -1.0e+9}}", "is less than the minimum of -10000"),
        (f"input: {{base_frame: {'a' * 201}}}", "input.base_frame: has 201 characters"),
        ("seed: 18446744073709551616", "seed: 18446744073709551616 is greater than the maximum"),
        (f"thesis: {{seeds: {[*range(101)]}}}", "has 101 entries, at most 100"),
        ("advanced: {jobs: {chunk_gb: 1.0e-300}}", "chunk_gb: 1e-300 is less than the minimum"),
        (f"simulate: {{building: {'a' * 5000}}}", "is a name of 5000 bytes, at most 255"),
        ('simulate: {building: "a\\0b"}', r"has '\x00' in its name; rename it"),
        ("\n".join(f"k{i}: 1" for i in range(20_000)), "unknown key k0, k1, k10, k100, k1000"),
    ],
)
def test_what_is_written_has_limits(defaults, schema, tmp_path, text, said):
    own = tmp_path / "dataset.yaml"
    own.write_text(text)
    with pytest.raises(StageError) as caught:
        settings_of_dataset(defaults, read_own_layers(own), schema)
    assert said in str(caught.value) and str(own) in str(caught.value)


def test_every_value_has_limits(schema):
    """Of numbers at both ends, of texts and lists in their length."""

    def unbounded(node):
        kinds = [node, *node.get("anyOf", []), *node.get("oneOf", [])]
        for kind in kinds:
            types = kind.get("type", ())
            types = {types} if isinstance(types, str) else set(types)
            ends = {"minimum", "exclusiveMinimum"}, {"maximum", "exclusiveMaximum"}
            if types & {"number", "integer"} and not all(end & kind.keys() for end in ends):
                yield "number"
            is_short = {"enum", "maxLength"} & kind.keys() or kind.get("format") in ("path", "crs")
            if "string" in types and not is_short and not kind.get("pattern", "").endswith("$"):
                yield "text"
            if "array" in types:
                yield from unbounded(kind["items"])
                if "maxItems" not in kind and not kind.get("uniqueItems"):
                    yield "list"

    found = {key: list(unbounded(node)) for key, node in iterate_keys(schema)}
    of_paths = ("dataset", "replace")  # each is held against the file system, or a run's names
    assert {key for key, faults in found.items() if faults} <= set(of_paths)


def test_a_pair_on_the_command_line_is_one_character(schema):
    given = {"plan": {"export": {"author": "\ud83c\udfe0", "storey": "\ud83c"}}}
    read = type_texts(given, schema)["plan"]["export"]
    assert read == {"author": "🏠", "storey": "\ud83c"}
    with pytest.raises(StageError, match=r"storey: has '.ud83c'; leave out"):
        check_settings({"plan": {"export": read}}, schema, COMMAND_LINE)


def test_text_for_a_number_is_refused(defaults, schema):
    given = Layer(COMMAND_LINE, type_texts({"poses": {"keep_every": "two"}}, schema))
    with refused(key="poses.keep_every"):
        settings_of_dataset(defaults, [given], schema)


def limits_in_pairs(node, where=""):
    """Keys of the schema that are the least and the most of the same."""
    for key, child in node.get("properties", {}).items():
        yield from limits_in_pairs(child, f"{where}{key}.")
        if key.startswith("min_") and f"max_{key[4:]}" in node["properties"]:
            yield f"{where}{key}", f"{where}max_{key[4:]}"


def with_value(key, value):
    for part in reversed(key.split(".")):
        value = {part: value}
    return value


def test_no_least_may_reach_its_most(defaults, schema):
    pairs = list(limits_in_pairs(schema))
    assert len(pairs) >= 4
    for least, most in pairs:
        both = merge_settings(with_value(least, 0.75), with_value(most, 0.75))
        with pytest.raises(StageError) as caught:
            settings_of_dataset(defaults, [Layer("a.yaml", both)], schema)
        assert_told(str(caught.value), file="a.yaml", value=("0.75", f"{least} (0.75"), key=most)


def test_limits_may_cross_in_a_file_that_another_mends(defaults, schema):
    layers = [
        Layer("a.yaml", {"input": {"min_range_m": 5.0}}),
        Layer("b.yaml", {"input": {"max_range_m": 2.0}}),
    ]
    with pytest.raises(StageError, match=r"b\.yaml: input\.max_range_m"):
        settings_of_dataset(defaults, layers, schema)
    layers.append(Layer("c.yaml", {"input": {"min_range_m": 1.0}}))
    assert settings_of_dataset(defaults, layers, schema)["input"]["min_range_m"] == 1.0


def test_a_fault_is_told_in_the_name_of_its_own_file(defaults, schema):
    layers = [
        Layer("a.yaml", {"poses": {"keep_every": 2}}),
        Layer("b.yaml", {"poses": {"keep_every": 0}}),
    ]
    with pytest.raises(StageError, match=r"^b\.yaml: poses\.keep_every: 0"):
        settings_of_dataset(defaults, layers, schema)


def test_where_a_setting_comes_from():
    layers = [
        Layer("a.yaml", {"plan": {"method": "hull", "pair": {"offset_m": 0.1}}}),
        Layer("b.yaml", {"poses": {}}),
    ]
    assert find_origin(layers, "plan.method") == "a.yaml"
    assert find_origin(layers, "plan.pair") == find_origin(layers, "plan") == "a.yaml"
    assert find_origin(layers, "plan.pair.offset_m", "poses.keep_every") == "a.yaml"
    assert find_origin(layers, "plan.meth") is find_origin(layers, "poses.keep_every") is None


def test_a_stages_fault_is_told_with_the_file_that_gives_its_setting():
    layers = [
        Layer("a.yaml", {"simulate": {"site": {"start_m": [1, 2]}, "errors": {"glass_pass": 1}}})
    ]
    assert (
        locate_fault("simulate.site.start_m: off", layers) == "a.yaml: simulate.site.start_m: off"
    )
    assert locate_fault("simulate.errors: too much", layers) == "a.yaml: simulate.errors: too much"
    for other in (
        "simulate.site.clearance_m: wide",
        "run.bag: no cloud topic",
        "simulate",
        "a fault",
    ):
        assert locate_fault(other, layers) == other


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (None, "does not exist"),
        (b"# nothing yet", "holds no settings"),
        (b"a: [", "is not valid YAML (line 1"),
        (b"\xff\xfe\x00", "is no text in UTF-8 (byte 1)"),
        (b"only words", "holds str"),
        (b"poses: {keep_evry: 2}", "unknown key keep_evry"),
        (b"hulls: {seed: 2}", "hulls.seed is now seed"),
        (b'"__use\\u005fyte__": true', "has Snakemake execute what the file says"),
    ],
)
def test_a_file_for_the_command_line_is_checked_first(tmp_path, content, said):
    path = tmp_path / "my.yaml"
    if content is not None:
        path.write_bytes(content)
    for given in (["--configfile", "a.yaml", str(path)], [f"--configfiles={path}"]):
        (tmp_path / "a.yaml").write_text("poses: {keep_every: 3}")
        arguments = ["snakemake", "--cores", "2", *given, "--config", "dataset=d"]
        with pytest.MonkeyPatch.context() as patch, pytest.raises(SystemExit) as end:
            patch.chdir(tmp_path)
            end_on_faulty_settings(arguments)
        assert str(end.value).startswith(f"scanplan: {path}: ") and said in str(end.value)
    path.write_text("poses: {keep_every: 2}")
    end_on_faulty_settings(["snakemake", "--configfile", str(path), "--config", "dataset=d"])


@pytest.mark.parametrize("option", ["--config", "-C"])
def test_a_key_of_more_words_is_refused_with_what_to_write(option):
    with pytest.raises(SystemExit) as end:
        end_on_faulty_settings(["snakemake", option, "dataset=d", "plan.rooms.min_area_m2=2", "-n"])
    assert_told(str(end.value), key="plan.rooms.min_area_m2")
    assert "--config 'plan={rooms: {min_area_m2: 2}}'" in str(end.value)
    end_on_faulty_settings(["snakemake", option, "dataset=d", "plan={rooms: {}}", "-n", "a.b"])


def test_a_bomb_of_merge_keys_is_refused_at_once(tmp_path):
    levels = ["k0: &k0 {a: 1}"]
    copies = (", ".join([f"*k{i}"] * 9) for i in range(30))
    levels += [f"k{i + 1}: &k{i + 1} {{<<: [{copied}]}}" for i, copied in enumerate(copies)]
    path = tmp_path / "dataset.yaml"
    path.write_text("\n".join(levels))
    with refused(file="dataset.yaml", remedy="write them"):
        read_own_layers(path)


@pytest.mark.parametrize("n_digits", [300, 9000])
def test_a_number_of_many_digits_is_not_shown_whole(tmp_path, defaults, schema, n_digits):
    path = tmp_path / "a.yaml"
    path.write_text(f"poses: {{keep_every: {'9' * n_digits}}}")
    with pytest.raises(StageError) as refused:
        settings_of_dataset(defaults, [Layer("a.yaml", read_yaml(path))], schema)
    assert len(str(refused.value).replace(str(path), "")) < 300


@pytest.mark.parametrize(
    ("text", "value"),
    [("yes", True), ("0x10", 16), ("1e3", "1e3"), ("0.5", 0.5), ("null", None)],
)
def test_scalars_are_read_as_snakemake_reads_them(tmp_path, text, value):
    """By YAML 1.1; a file that both read means the same to both."""
    path = tmp_path / "a.yaml"
    path.write_text(f"a: {text}")
    assert read_yaml(path) == load_configfile(str(path)) == {"a": value}


def test_a_file_of_settings_that_must_be_there_is_asked_for(tmp_path):
    assert read_own_layers(tmp_path / "none.yaml") == []
    with pytest.raises(StageError, match=r"none\.yaml"):
        read_own_layers(tmp_path / "none.yaml", may_lack=False)
