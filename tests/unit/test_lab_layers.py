"""Imports within `lab` go one way, and nothing that a user's recording runs imports it."""

import ast

import pytest

BELOW = {
    "buildings": set(),
    "evaluation": set(),
    "simulation": {"buildings", "evaluation"},
}


def lab_imports(path):
    """The packages of the laboratory that a module imports from."""
    nodes = ast.walk(ast.parse(path.read_text()))
    modules = [n.module for n in nodes if isinstance(n, ast.ImportFrom) and n.module]
    parts = [module.split(".") for module in modules if module.startswith("scanplan.lab.")]
    return {names[2] for names in parts}


@pytest.mark.parametrize("package", BELOW)
def test_a_package_imports_those_below_it_alone(project_root, package):
    for path in (project_root / "scripts/scanplan/lab" / package).glob("*.py"):
        assert lab_imports(path) <= BELOW[package] | {package, "random_streams"}, path.name


def test_nothing_outside_imports_it(project_root):
    scanplan = project_root / "scripts/scanplan"
    outside = [path for path in scanplan.rglob("*.py") if scanplan / "lab" not in path.parents]
    assert len(outside) > 100
    assert not [path.name for path in outside if "scanplan.lab" in path.read_text()]


def test_of_the_products_stages_only_those_of_a_survey_with_a_truth_import_it(project_root):
    stages = list((project_root / "scripts").glob("*.py"))
    users = {path.stem for path in stages if "scanplan.lab" in path.read_text()}
    assert users == {"simulate_survey", "evaluate_plan", "evaluate_poses"}
