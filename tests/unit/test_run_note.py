"""How results were made, as a note beside them."""

from pathlib import Path

from scanplan.project.run_note import RunNote, read_note, write_note
from scanplan.project.settings import Layer

GIVEN = [
    Layer("a.yaml", {"plan": {"method": "x", "extractor": "y"}, "dataset": ["b"]}),
    Layer("the command line", {"plan": {"method": "z"}, "replace": ["b"]}),
]


def test_later_settings_win_and_what_is_run_is_no_setting(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("results/b").mkdir(parents=True)
    Path("results/b/source.txt").write_text("floors/b\n")
    write_note("b", "floors/b", ["floors/a", "floors/b"], GIVEN)
    found = read_note(Path("results/b"))
    settings = {"plan": {"method": "z", "extractor": "y"}}
    assert found == RunNote("floors/b", ["floors/a", "floors/b"], settings)
    write_note("b", "floors/b", ["floors/c"], [])
    assert read_note(Path("results/b")) == RunNote("floors/b", [], {})


def test_results_of_an_older_release_have_no_settings(tmp_path):
    (tmp_path / "source.txt").write_text("the simulated demo\n")
    assert read_note(tmp_path) == RunNote(None, [], {})
