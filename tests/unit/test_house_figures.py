"""What the figures of the house count."""

import ast

import pytest

import house_figures
from house_figures import Module

TEXT = '''"""A module."""

_REACH_M = 0.3  # beyond it noise is larger
_LOW, _HIGH = 1, 2
# half of a door
_HALF_M: float = 1.9 / 2
NAMES = ("one", "two")
_SIZES = (1, 2)
_ANGLE = np.deg2rad(5)
FEW = 3
"""One or two may be stray."""


def typed(a: int, *, b: str = "x") -> int:
    """Return a."""
    return a


def untyped(a):
    return a


def _private(a):
    return a


class Shown:
    def method(self) -> None: ...

    def other(self, a): ...
'''


@pytest.fixture
def module(tmp_path):
    (tmp_path / "scanplan/plan").mkdir(parents=True)
    (tmp_path / "scanplan/plan/walls.py").write_text(TEXT)
    (module,) = house_figures.read_modules(tmp_path)
    return module


def test_numeric_constants_and_their_reasons(module):
    constants = list(house_figures.find_numeric_constants(module))
    assert [count for _, count in constants] == [1, 2, 1, 1, 1, 1]
    reasons = [house_figures.has_reason(module, statement) for statement, _ in constants]
    assert reasons == [True, False, True, False, False, True]


def test_public_functions_and_their_types(module):
    public = list(house_figures.find_public_functions(module))
    assert [function.name for function in public] == ["typed", "untyped", "method", "other"]
    assert [house_figures.is_annotated(function) for function in public] == [True, False] * 2
    assert house_figures.find_unannotated([module])[0].endswith("walls.py:19 untyped")
    assert house_figures.count_lines(public[0]) == 2


def test_names_that_two_modules_share(module):
    other = Module(module.path.with_name("rooms.py"), [], ast.parse("def typed(): ..."))
    found = house_figures.find_duplicate_names([module, other])
    assert found == ["typed (rooms)", "typed (walls)"]
    assert house_figures.count_package_modules([module, other]) == {"scanplan/plan": 2}


def test_long_lines(module):
    assert house_figures.find_long_lines([module]) == []
    long = Module(module.path, ["#" * 101], ast.parse(""))
    assert len(house_figures.find_long_lines([long])) == 1


def test_keys_with_values(tmp_path):
    (tmp_path / "config.yaml").write_text("a: {b: 1, c: {d: [1, 2]}}\ne: null\nf: {}\n")
    assert house_figures.count_keys(tmp_path / "config.yaml") == 4


def test_this_project_and_the_table():
    figures = house_figures.count_house(house_figures.ROOT)
    table = house_figures.format_figures({"before": figures, "after": figures})
    assert figures.files > 100 and "basedpyright" not in table
    assert len({line.split()[-1] == line.split()[-2] for line in table.splitlines()[1:]}) == 1
