"""The lists of settings and the manual's tables say what the schema says."""

import re

import pytest
import yaml

from helpers.default_settings import SCHEMA, SETTINGS
from scanplan.project import settings_files
from scanplan.project.settings import merge_settings
from scanplan.project.settings_check import check_settings, iterate_leaves
from scanplan.project.settings_schema import is_section, iterate_keys
from scanplan.project.yaml_file import read_yaml

REMEDY = "is out of step with the schema; run `make settings`"
FILES = ("config.yaml", "advanced.yaml", "simulate.yaml")
TOY = {
    "properties": {
        "a": {"default": None, "type": ["string", "null"], "description": "a name. Or none"},
        "b": {
            "description": "a section",
            "properties": {
                "c_m": {
                    "default": 0.5,
                    "type": "number",
                    "exclusiveMinimum": 0,
                    "maximum": 2,
                    "x-unit": "m",
                    "description": "a length",
                },
                "d": {"default": "x", "enum": ["x", "y"], "description": "a choice"},
            },
        },
    }
}


@pytest.mark.parametrize("name", FILES)
def test_the_lists_are_in_step_with_the_schema(project_root, name):
    expected = settings_files.format_settings_files(SCHEMA)[name]
    assert (project_root / "config" / name).read_text() == expected, f"config/{name} {REMEDY}"


def test_the_manual_is_in_step_with_the_schema(project_root):
    manual = (project_root / "config/settings.md").read_text()
    assert settings_files.fill_manual(manual, SCHEMA) == manual, f"config/settings.md {REMEDY}"


def test_the_manual_has_a_table_of_every_section_that_a_plan_depends_on(project_root):
    found = [key for key, node in SCHEMA["properties"].items() if is_section(node)]
    sections = [key for key in found if key not in settings_files.LABORATORY]
    tuned = [f"advanced.{key}" for key in SCHEMA["properties"]["advanced"]["properties"]]
    sections.remove("advanced")
    manual = (project_root / "config/settings.md").read_text()
    tables = re.findall(r"(?m)^<!-- settings (\S+) -->$", manual)
    assert sorted(tables) == sorted(["general", *sections, *tuned])


def test_the_lists_have_every_key_once_with_its_default(project_root):
    listed = [dict(iterate_leaves(read_yaml(project_root / "config" / name))) for name in FILES]
    together = {key: value for values in listed for key, value in values.items()}
    assert sum(map(len, listed)) == len(together)
    assert together == dict(iterate_leaves(SETTINGS))


def test_what_a_user_names_stands_first(project_root):
    listed = [key for key, _ in iterate_leaves(read_yaml(project_root / "config/config.yaml"))]
    names = ("project", "storey", "author", "organisation", "dxf_unit", "formats", "site.crs")
    named = {f"plan.export.{name}" for name in (*names, "assumed_thickness_m", "cloud.scans")}
    assert named <= set(listed[:25])


@pytest.mark.parametrize("name", FILES)
def test_every_list_can_be_given_as_settings(project_root, name):
    values = read_yaml(project_root / "config" / name)
    check_settings(merge_settings(SETTINGS, values), SCHEMA, name)


def test_a_key_is_listed_with_its_meaning_unit_and_range():
    lines = settings_files._format_file("A head.", TOY["properties"]).splitlines()
    assert lines[0] == "# A head."
    assert lines[2:] == [
        "",
        "# a name",
        "a: null",
        "",
        "# a section",
        "b:",
        "  # a length [m, above 0, to 2]",
        "  c_m: 0.5",
        "  # a choice [x, y]",
        "  d: x",
    ]


def test_a_list_has_a_keys_first_sentence_and_that_of_the_laboratory_all():
    node = {"default": 1, "type": "integer", "description": "a number. Or more"}
    assert settings_files._format_node("a", node, "") == ["# a number", "a: 1"]
    whole = settings_files._format_node("a", node, "", is_whole=True)
    assert whole == ["# a number. Or more", "a: 1"]


def test_a_table_is_written_between_its_marks_and_nothing_else_changes():
    manual = "before\n<!-- settings b -->\nold\n<!-- end -->\nafter\n"
    lines = settings_files.fill_manual(manual, TOY).splitlines()
    assert lines[:2] == ["before", "<!-- settings b -->"] and lines[-2:] == [
        "<!-- end -->",
        "after",
    ]
    assert lines[4:-2] == [
        "| `c_m` | 0.5 | m, above 0, to 2 | a length |",
        "| `d` | x | x, y | a choice |",
    ]


def test_writing_again_changes_nothing(project_root, tmp_path):
    for name in (*settings_files._SCHEMAS, "config/settings.md"):
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).write_text((project_root / name).read_text())
    settings_files.write_settings_files(tmp_path)
    for name in ("settings.md", *FILES):
        assert (tmp_path / "config" / name).read_text() == (
            project_root / "config" / name
        ).read_text()


def test_every_key_has_a_default_that_fits_and_a_meaning():
    check_settings(SETTINGS, SCHEMA, "defaults")
    for key, node in iterate_keys(SCHEMA):
        assert node["description"] and "|" not in node["description"], key
        assert not node["description"].endswith("."), key


def test_every_unit_is_that_of_the_keys_name():
    units = {
        "_m": "m",
        "_deg": "deg",
        "_s": "s",
        "_m2": "m2",
        "_hz": "Hz",
        "_m_s": "m/s",
        "_deg_s": "deg/s",
        "_deg_per_m": "deg/m",
        "_per_m": "per m",
        "_per_min": "per minute",
    }
    for key, node in iterate_keys(SCHEMA):
        fitting = [unit for ending, unit in units.items() if key.endswith(ending)]
        if fitting and not key.endswith("timed_scans"):
            # the longest ending says it
            assert node.get("x-unit") == max(fitting, key=len), key


def test_no_key_of_the_schema_stands_twice(project_root):
    """YAML takes the last of two, and what the first says is gone."""

    class Strict(yaml.SafeLoader):
        pass

    def make_mapping(loader, node):
        keys = [loader.construct_object(key) for key, _ in node.value]
        assert len(keys) == len(set(keys)), node.start_mark
        return yaml.SafeLoader.construct_mapping(loader, node, deep=True)

    Strict.add_constructor("tag:yaml.org,2002:map", make_mapping)
    for path in settings_files._SCHEMAS:
        yaml.load((project_root / path).read_text(), Strict)
