from dataclasses import fields

from helpers.default_settings import SCHEMA, SETTINGS
from scanplan.project.settings_schema import list_choices
from scanplan.project.stage_settings import select_wall_cells
from scanplan.selection import methods, orderings, wall_cells


def test_the_schema_allows_the_methods_there_are():
    assert (
        list_choices(SCHEMA, "plan", "method") == list(methods.METHODS) == list(orderings.METHODS)
    )


def test_every_method_has_its_tables_and_its_settings():
    assert set(methods.SETTINGS) == set(methods.TABLES) == set(methods.METHODS)
    assert [m for m in methods.METHODS if "seed" in methods.SETTINGS[m]] == ["random"]


def test_every_method_is_in_the_manual(project_root):
    manual = (project_root / "config/README.md").read_text()
    assert [m for m in methods.METHODS if f"\n| `{m}` |" not in manual] == []


def test_cells_need_the_limits_of_walls_and_their_own():
    needed = {field.name for field in fields(wall_cells.WallCellSettings)}
    assert needed == set(select_wall_cells(SETTINGS, methods.WALL_LIMITS))
