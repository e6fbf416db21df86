"""A run begins where it can write, and with files that are not dated in the future."""

import errno
import os
import time
from pathlib import Path

import pytest

from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.project.run import run_places


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("place", ["results", "logs", ".snakemake", "results/d", "benchmarks/d"])
def test_a_file_or_a_dangling_link_in_the_place_of_a_folder_is_told(place):
    Path(place).parent.mkdir(exist_ok=True)
    run_places.check_places(["d"])
    Path(place).write_text("in the way")
    with refused(file=place, remedy="move away"):
        run_places.check_places(["d"])
    Path(place).unlink()
    Path(place).symlink_to("nowhere")
    with refused(file=place):
        run_places.check_places(["d"])
    Path(place).unlink()
    Path(place).mkdir()
    run_places.check_places(["d"])
    assert list(Path(place).iterdir()) == []


def test_a_link_that_leads_nowhere_is_told(tmp_path):
    (tmp_path / "results/d").mkdir(parents=True)
    (tmp_path / "results/d/scans.parquet").symlink_to("nowhere")
    with refused(file="results/d/scans.parquet", value="a link"):
        run_places.check_places(["d"])


@pytest.mark.parametrize("call", ["unlink", "chmod"])
def test_a_place_where_nothing_can_be_removed_or_permitted_is_told(monkeypatch, call):
    def refuse(path, *_, **__):
        raise PermissionError(errno.EPERM, "refused", str(path))

    monkeypatch.setattr(f"os.{call}", refuse)
    Path("results").mkdir()
    with refused(value="Operation not permitted"):
        run_places.check_places([])


@pytest.mark.parametrize("path", ["results/d/plan/walls.parquet", "d/run.bag"])
@pytest.mark.parametrize("ahead_s", [86_400.0, 2e10])
def test_a_file_dated_in_the_future_is_told_with_both_times(path, ahead_s):
    Path(path).parent.mkdir(parents=True)
    Path(path).touch()
    run_places.check_dates(["d"], ["d/run.bag", "d/gone.bag"])
    os.utime(path, (0, time.time() + ahead_s))
    with pytest.raises(StageError, match=f"^{path}: is dated .* clock says .* run `touch` on what"):
        run_places.check_dates(["d"], ["d/run.bag"])


def test_all_files_dated_in_the_future_are_counted():
    Path("results/d").mkdir(parents=True)
    for name in ("a", "b", "c"):
        Path("results/d", name).touch()
        os.utime(Path("results/d", name), (0, 5e9))
    with refused(value=(2128, "2 others")):
        run_places.check_dates(["d"], [])
