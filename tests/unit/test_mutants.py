"""Mutants change one place that runs, and are told by the tests that fail of them alone."""

import ast

import pytest

import mutants

TEXT = '''"""Text with 1 number."""

WIDTH_M = 0.5


def widen(a: "int < 3", b=2):
    """Return 7."""
    for one in zip(a, b, strict=True):
        assert min(one) < b and not a, f"{one < 2}"
    return -a + b


if __name__ == "__main__":
    widen(8, 9)
'''


def test_every_place_that_runs_has_a_mutant_and_no_other():
    found = mutants.list_mutants("a.py", TEXT)
    assert [(one.line, one.old, one.new) for one in found] == [
        (3, "0.5", "(1.0)"),
        (6, "2", "(3)"),
        (9, "min(one)", "(max(one))"),
        (9, "min(one) < b", "(min(one) <= b)"),
        (9, "min(one) < b and not a", "(min(one) < b or not a)"),
        (9, "not a", "(a)"),
        (10, "-a", "(a)"),
        (10, "-a + b", "(-a - b)"),
    ]


def test_a_mutant_changes_its_place_alone_and_can_be_read():
    text = '"""Größe."""\n' + TEXT
    for mutant in mutants.list_mutants("a.py", text):
        changed = mutant.apply(text)
        assert changed != text and changed.count("\n") == text.count("\n")
        ast.parse(changed)


def test_the_same_seed_draws_the_same_places(tmp_path):
    (tmp_path / "scripts").mkdir()
    (tmp_path / "scripts/a.py").write_text(TEXT)
    drawn = mutants.choose_mutants(tmp_path, 3, 1)
    assert drawn == mutants.choose_mutants(tmp_path, 3, 1)
    assert len({(one.begin, one.new) for one in drawn}) == 3


SOURCE = "def is_wide(a):\n    return a > 1\n"
TEST = """import sys
sys.path.insert(0, "scripts")
from a import is_wide

def test_fails_anyway():
    assert not is_wide(1) and False

def test_of_it():
    assert {assertion}
"""


@pytest.mark.parametrize(
    ("assertion", "told"), [("not is_wide(1)", "tests/test_a.py::test_of_it"), ("is_wide(2)", "")]
)
def test_a_test_counts_that_the_change_fails_alone(tmp_path, assertion, told):
    for name, text in {"scripts/a.py": SOURCE, "tests/test_a.py": TEST}.items():
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text(text.replace("{assertion}", assertion))
    (mutant,) = (m for m in mutants.list_mutants("scripts/a.py", SOURCE) if ">=" in m.new)
    assert mutants.try_mutant(mutant, tmp_path, ["tests/test_a.py"], mutants.QUICK) == told
    assert (tmp_path / "scripts/a.py").read_text() == SOURCE
