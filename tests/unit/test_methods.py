from dataclasses import fields

from scanplan.project import dataset
from scanplan.project.settings import read_yaml
from scanplan.selection import methods, orderings, wall_cells


def test_the_schema_allows_the_methods_there_are(project_root):
    schema = read_yaml(project_root / "workflow/schemas/config.schema.yaml")
    assert (
        dataset.list_choices(schema, "plan", "method")
        == list(methods.METHODS)
        == list(orderings.METHODS)
    )


def test_every_method_has_its_tables_and_its_settings():
    assert set(methods.SETTINGS) == set(methods.TABLES) == set(methods.METHODS)
    assert [m for m in methods.METHODS if "seed" in methods.SETTINGS[m]] == ["random"]


def test_every_method_is_in_the_manual(project_root):
    manual = (project_root / "config/README.md").read_text()
    assert [m for m in methods.METHODS if f"\n| `{m}` |" not in manual] == []


def test_the_limits_of_walls_are_the_extractors_and_all_that_cells_need(project_root):
    settings = read_yaml(project_root / "config/config.yaml")
    needed = {field.name for field in fields(wall_cells.WallCellSettings)}
    assert needed == {*methods.WALL_LIMITS, *settings["selection"]["wall_length"]}
    assert set(methods.WALL_LIMITS) <= set(settings["walls"]["cluster_ransac"])
