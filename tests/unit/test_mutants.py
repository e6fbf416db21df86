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
ANYWAY, OF_IT = "tests/test_a.py::test_anyway", "tests/test_a.py::test_of_it"


@pytest.mark.parametrize("told", [OF_IT, ""])
def test_a_test_counts_that_the_change_fails_alone(tmp_path, monkeypatch, told):
    def fail(root, words, marks):
        is_changed = (root / "a.py").read_text() != SOURCE
        failing = [ANYWAY, *([told] if told and is_changed else [])]
        asked = [name for name in failing if f"--deselect={name}" not in words]
        return next((name for name in asked if words[0] in (name, "tests")), "")

    monkeypatch.setattr(mutants, "_first_failure", fail)
    (tmp_path / "a.py").write_text(SOURCE)
    (mutant,) = (m for m in mutants.list_mutants("a.py", SOURCE) if ">=" in m.new)
    assert mutants.try_mutant(mutant, tmp_path, ["tests"], mutants.QUICK) == told
    assert (tmp_path / "a.py").read_text() == SOURCE


def test_the_test_that_fails_first_is_named(tmp_path):
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests/test_a.py").write_text("def test_of_it():\n    assert 1 > 2\n")
    (tmp_path / "pytest.ini").write_text("[pytest]\naddopts = -ra\n")
    assert mutants._first_failure(tmp_path, ["tests"], mutants.QUICK) == OF_IT


@pytest.mark.parametrize(
    ("words", "read"),
    [([], (60, 1, False)), (["6"], (6, 1, False)), (["--full", "6", "2"], (6, 2, True))],
)
def test_words_of_the_command(words, read):
    assert mutants.read_words(words) == read


@pytest.mark.parametrize("words", [["--help"], ["six"], ["1", "2", "3"]])
def test_wrong_words_end_in_a_line(words):
    with pytest.raises(SystemExit) as refused:
        mutants.read_words(words)
    assert words[-1] in refused.value.code
