"""What a command asks of benchmarks is refused in one line where it makes no sense."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))

import run


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (["realistic", "--help"], "--help"),
        (["-h"], "-h"),
        (["guard", "HEAD", "/tmp/after", "-n"], "-n"),
        (["realistic"], "realistic"),
        (["compare", "before", "after", "more"], "compare"),
        (["no_such_bench"], "no_such_bench"),
    ],
)
def test_words_that_no_benchmark_takes_make_nothing(words, named, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as refused:
        run.run_named(words)
    assert named in refused.value.code and "\n" not in refused.value.code
    assert list(tmp_path.iterdir()) == []


def test_words_that_fit_are_handed_on(monkeypatch):
    asked = []
    monkeypatch.setitem(run.APART, "compare", lambda before, after: asked.append((before, after)))
    run.run_named(["compare", "a", "b"])
    assert asked == [("a", "b")]
