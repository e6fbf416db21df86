"""Results keep the place of the dataset that they were made of."""

from pathlib import Path

import pytest

from scanplan import madefrom
from scanplan.errors import StageError


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def made(name, path):
    """Results of a dataset."""
    madefrom.begin(name, madefrom.source(path))
    Path("results", name, "poses.parquet").touch()


def test_another_dataset_of_the_name_is_refused():
    made("x", "a/x")
    with pytest.raises(StageError, match=r"results/x: was made of a/x, not of b/x; .*replace=x.*REPLACE=x"):
        madefrom.check({"y": madefrom.source("b/y"), "x": madefrom.source("b/x")})
    madefrom.check({"x": madefrom.source("./a/../a/x")})
    madefrom.check({"x": madefrom.source("b/x")}, "x")
    madefrom.check({"x": madefrom.source("b/x")}, ["x"])


def test_the_demo_is_a_dataset_of_its_own():
    made("demo", None)
    madefrom.check({"demo": madefrom.source(None)})
    with pytest.raises(StageError, match="the simulated demo, not of my/demo"):
        madefrom.check({"demo": madefrom.source("my/demo")})


def test_only_what_is_there_can_be_replaced():
    with pytest.raises(StageError, match="replace: z is no dataset of this run; it has x, y"):
        madefrom.check({"x": "a/x", "y": "a/y"}, "z")


def test_results_of_nobody_knows_what_and_no_results_are_in_nobodys_way():
    Path("results/old").mkdir(parents=True)
    Path("results/old/poses.parquet").touch()
    madefrom.begin("begun", "a/begun")
    madefrom.check({"old": "a/old", "begun": "b/begun", "new": "a/new"})


def test_a_note_without_results_goes():
    made("x", "a/x")
    madefrom.begin("begun", "a/begun")
    Path("results/begun/plan/empty").mkdir(parents=True)
    madefrom.check({"begun": "b/begun"})
    for name in ("x", "begun", "never"):
        madefrom.discard_lone(name)
    assert Path("results/x/source.txt").read_text() == "a/x\n"
    assert not Path("results/begun").exists() and not Path("results/never").exists()


def test_links_are_followed_and_a_moved_project_keeps_its_results(tmp_path):
    outside = tmp_path / "elsewhere"
    (tmp_path / "project/floor").mkdir(parents=True)
    outside.mkdir()
    (tmp_path / "project/link").symlink_to(outside)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path / "project")
        assert madefrom.source(tmp_path / "project/floor") == madefrom.source("floor") == "floor"
        assert madefrom.source("link") == str(outside)


def test_until_a_whole_run_has_ended_results_are_of_both():
    made("x", "a/x")
    made("x", "b/x")
    assert Path("results/x/source.txt").read_text() == "b/x\na/x\n"
    for known in ("a/x", "b/x"):
        madefrom.check({"x": known})
    madefrom.end("x", "b/x")
    madefrom.check({"x": "b/x"})
    with pytest.raises(StageError, match="was made of b/x, not of a/x"):
        madefrom.check({"x": "a/x"})
