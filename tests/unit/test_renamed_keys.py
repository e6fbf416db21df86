"""Keys of earlier versions are refused with what they are called now."""

import pytest

from helpers.default_settings import SCHEMA, SETTINGS
from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.project import renamed_keys
from scanplan.project.settings import SCHEMA_FILE, Layer, merge_settings, settings_of_dataset
from scanplan.project.settings_check import check_settings, iterate_leaves
from scanplan.project.settings_schema import iterate_keys, read_schema
from scanplan.project.yaml_file import read_yaml

KNOWN = {key for key, _ in iterate_keys(SCHEMA)}


@pytest.fixture
def old_keys(project_root):
    """All keys of the version that had 205 of them, and their defaults."""
    return dict(iterate_leaves(read_yaml(project_root / "tests/data/config_of_205_keys.yaml")))


def nested(key, value):
    for part in reversed(key.split(".")):
        value = {part: value}
    return value


def test_every_new_name_is_a_key_and_no_old_one_is():
    assert set(renamed_keys.RENAMED.values()) <= KNOWN
    assert not KNOWN & {*renamed_keys.RENAMED, *renamed_keys.DROPPED}


def test_every_old_key_is_known_or_explained(old_keys):
    assert len(old_keys) == 205
    for key, value in old_keys.items():
        if key in KNOWN:
            continue
        with pytest.raises(StageError) as caught:
            settings_of_dataset(SETTINGS, [Layer("a.yaml", nested(key, value))], SCHEMA)
        said = str(caught.value)
        assert said.startswith(f"a.yaml: old keys: {key} is ") and "\n" not in said


def test_every_old_key_is_explained_by_a_name_that_is_known(old_keys):
    for key in old_keys.keys() - KNOWN:
        said = renamed_keys.explain_old_keys([key], KNOWN)
        new = said.removeprefix(f"old keys: {key} is now ")
        assert new in KNOWN or said.startswith(f"old keys: {key} is gone (")


@pytest.mark.parametrize(
    ("old", "told"),
    [
        ("walls.cluster_ransac.min_height_m", "is now walls.min_height_m"),
        ("walls.iterative_ransac.door_height_m", "is now building.door_height_m"),
        ("registration.voxel_m", "is now advanced.registration.voxel_m"),
        ("advanced.plan.export.site.crs", "is now plan.export.site.crs"),
        (
            "advanced.registration.graph.loop_radius_m",
            "is gone (no survey needed another value than its default)",
        ),
        ("hulls.seed", "is now seed"),
        ("plan.right_angles.sigmas", "is gone (faces are drawn as turned as their points are)"),
    ],
)
def test_one_line_says_the_new_name(old, told):
    assert renamed_keys.explain_old_keys([old], KNOWN) == f"old keys: {old} {told}"


def test_the_laboratorys_keys_are_none_of_the_product():
    product = read_schema(SCHEMA_FILE)
    with refused(key="thesis.seeds"):
        check_settings({"thesis": {"seeds": [1]}}, product, "a.yaml")
    assert {key for key in KNOWN if key.startswith("thesis.")} == KNOWN - {
        key for key, _ in iterate_keys(product)
    }


def test_several_old_keys_are_told_at_once_but_no_endless_list(project_root):
    values = read_yaml(project_root / "tests/data/config_of_205_keys.yaml")
    values = {key: section for key, section in values.items() if isinstance(section, dict)}
    with pytest.raises(StageError) as caught:
        settings_of_dataset(SETTINGS, [Layer("a.yaml", values)], SCHEMA)
    said = str(caught.value)
    assert said.count(" is now ") + said.count(" is gone ") == 8 and " more; " in said


def test_unknown_keys_and_known_ones_are_not_explained():
    assert renamed_keys.explain_old_keys(["poses.keep_evry", "poses.keep_every"], KNOWN) is None


def test_the_presets_that_are_shipped_have_no_old_key(project_root):
    config = project_root / "config"
    presets = {*config.glob("*.yaml"), *config.glob("surveys/*.yaml")}
    assert len(presets) > 2
    for path in presets - {config / "catalogue.yaml"}:
        merged = merge_settings(SETTINGS, read_yaml(path))
        assert {key for key, _ in iterate_leaves(merged)} == KNOWN, path
