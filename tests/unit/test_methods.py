from dataclasses import fields

import pytest

from scanplan.project import dataset
from scanplan.project.settings import read_yaml
from scanplan.selection import methods, objectives, orderings, wall_cells


def test_the_schema_allows_the_methods_there_are(project_root):
    schema = read_yaml(project_root / "workflow/schemas/config.schema.yaml")
    assert (
        dataset.list_choices(schema, "plan", "method")
        == list(methods.METHODS)
        == list(orderings.METHODS)
    )


@pytest.mark.parametrize("name", methods.METHODS)
def test_every_method_has_one_function_a_label_and_a_colour_of_its_own(name):
    method = methods.METHODS[name]
    assert (method.objective is None) != (method.order is None)
    if method.objective:
        assert callable(getattr(objectives, method.objective))
    assert [m.label for m in methods.METHODS.values()].count(method.label) == 1
    assert [m.colour for m in methods.METHODS.values()].count(method.colour) == 1


def test_what_methods_need():
    needed = {name: method.settings for name, method in methods.METHODS.items()}
    assert [name for name, settings in needed.items() if "seed" in settings] == ["random"]
    assert methods.METHODS[methods.AREA_METHOD].is_area


def test_every_method_is_in_the_manual(project_root):
    manual = (project_root / "config/README.md").read_text()
    assert [m for m in methods.METHODS if f"\n| `{m}` |" not in manual] == []


def test_the_limits_of_walls_are_the_extractors_and_all_that_cells_need(project_root):
    settings = read_yaml(project_root / "config/config.yaml")
    needed = {field.name for field in fields(wall_cells.WallCellSettings)}
    assert needed == {*methods.WALL_LIMITS, *settings["selection"]["wall_length"]}
    assert set(methods.WALL_LIMITS) <= set(settings["walls"]["cluster_ransac"])
