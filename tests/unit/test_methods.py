from dataclasses import MISSING, fields

import pytest

from helpers.default_settings import SCHEMA, SETTINGS
from scanplan.project.settings_schema import list_choices
from scanplan.project.stage_settings import select_wall_cells
from scanplan.selection import methods, objectives, orderings, wall_cells


def test_the_schema_allows_the_methods_there_are():
    assert (
        list_choices(SCHEMA, "plan", "method") == list(methods.METHODS) == list(orderings.METHODS)
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
    manual = (project_root / "config/method.md").read_text()
    assert [m for m in methods.METHODS if f"\n| `{m}` |" not in manual] == []


def test_cells_need_the_limits_of_walls_and_their_own():
    all_fields = fields(wall_cells.WallCellSettings)
    needed = {field.name for field in all_fields if field.default is MISSING}
    assert needed == set(select_wall_cells(SETTINGS, methods.WALL_LIMITS))
