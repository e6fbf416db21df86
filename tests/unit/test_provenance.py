"""Results keep the place of the dataset that they were made of."""

import os
from pathlib import Path

import pytest

from helpers.refusals import refused
from scanplan.project import provenance


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def made(name, path):
    """Results of a dataset."""
    provenance.begin_results(name, provenance.identify_source(path))
    Path("results", name, "poses.parquet").touch()


def test_another_dataset_of_the_name_is_refused():
    made("x", "a/x")
    with refused(file=("results/x", "a/x", "b/x"), remedy=("replace=x", "REPLACE=x")):
        provenance.check_sources(
            {"y": provenance.identify_source("b/y"), "x": provenance.identify_source("b/x")}
        )
    provenance.check_sources({"x": provenance.identify_source("./a/../a/x")})
    provenance.check_sources({"x": provenance.identify_source("b/x")}, "x")
    provenance.check_sources({"x": provenance.identify_source("b/x")}, ["x"])


def test_the_demo_is_a_dataset_of_its_own():
    made("demo", None)
    provenance.check_sources({"demo": provenance.identify_source(None)})
    with refused(file="my/demo", value="simulated demo"):
        provenance.check_sources({"demo": provenance.identify_source("my/demo")})


def test_only_what_is_there_can_be_replaced():
    with refused(key="replace", value=("z", "x, y")):
        provenance.check_sources({"x": "a/x", "y": "a/y"}, "z")


def test_results_of_nobody_knows_what_and_no_results_are_in_nobodys_way():
    Path("results/old").mkdir(parents=True)
    Path("results/old/poses.parquet").touch()
    provenance.begin_results("begun", "a/begun")
    provenance.check_sources({"old": "a/old", "begun": "b/begun", "new": "a/new"})


def test_a_note_without_results_goes():
    made("x", "a/x")
    provenance.begin_results("begun", "a/begun")
    Path("results/begun/plan/empty").mkdir(parents=True)
    provenance.check_sources({"begun": "b/begun"})
    for name in ("x", "begun", "never"):
        provenance.discard_lone_note(name)
    assert Path("results/x/source.txt").read_text() == "a/x\n"
    assert not Path("results/begun").exists() and not Path("results/never").exists()


def test_links_are_followed_and_a_moved_project_keeps_its_results(tmp_path):
    outside = tmp_path / "elsewhere"
    (tmp_path / "project/floor").mkdir(parents=True)
    outside.mkdir()
    (tmp_path / "project/link").symlink_to(outside)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path / "project")
        assert (
            provenance.identify_source(tmp_path / "project/floor")
            == provenance.identify_source("floor")
            == "floor"
        )
        assert provenance.identify_source("link") == str(outside)


def test_until_a_whole_run_has_ended_results_are_of_both():
    made("x", "a/x")
    made("x", "b/x")
    assert Path("results/x/source.txt").read_text() == "b/x\na/x\n"
    for known in ("a/x", "b/x"):
        provenance.check_sources({"x": known})
    provenance.end_results("x", "b/x")
    provenance.check_sources({"x": "b/x"})
    with refused(file=("b/x", "a/x")):
        provenance.check_sources({"x": "a/x"})


def test_a_recording_in_the_place_of_another_is_told_by_its_bytes(tmp_path):
    def digest(content, name="run.bag"):
        Path(name).write_bytes(content)
        os.utime(name, ns=(5, 5))
        provenance.digest_recordings.cache_clear()
        return provenance.digest_recordings((name,))

    middle = bytes(100_000)
    whole = digest(b"head" + middle + b"tail")
    assert digest(b"head" + middle + b"tail") == whole
    others = [b"Head" + middle + b"tail", b"head" + middle + b"Tail", b"head" + middle + b"0tail"]
    assert len({whole, *map(digest, others)}) == 4
    assert digest(b"head" + middle + b"tail", "other.bag") != whole
    assert digest(b"") != digest(b"x")


def test_a_note_that_is_no_text_is_told_with_what_to_do():
    made("x", "a/x")
    Path("results/x/source.txt").write_bytes(b"\xff\xfe a")
    with refused(file="results/x/source.txt", remedy="move results/x"):
        provenance.check_sources({"x": "a/x"})


def test_a_recording_that_is_gone_has_no_digest():
    with refused(file="a/run.bag", value="No such"):
        provenance.digest_recordings(("a/run.bag",))
