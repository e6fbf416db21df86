"""Stages that failed are cut short: what was made of their files before is made anew."""

import asyncio
from types import SimpleNamespace

import pytest

from scanplan.project.run import failed_stages


class Persistence:
    """As Snakemake's: knows of nothing that it was cut short."""

    async def incomplete(self, job):
        return list(job.known)


@pytest.mark.parametrize(
    ("log", "has_failed"),
    [
        ("INFO a: read\nINFO stage done\n", False),
        ("INFO a: read\nINFO stage failed\n", True),
        ("INFO a: rea", True),
        ("", True),
        (None, True),
    ],
)
def test_a_stage_is_redone_that_did_not_end_well(tmp_path, monkeypatch, log, has_failed):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "logs/d").mkdir(parents=True)
    if log is not None:
        (tmp_path / "logs/d/a.log").write_text(log)
    (tmp_path / "there").touch()
    kind = type("Kind", (Persistence,), {})
    failed_stages.redo_failed(kind)
    job = SimpleNamespace(log=["logs/d/a.log"], output=["there", "gone"], known=[])
    assert asyncio.run(kind().incomplete(job)) == (["gone"] if has_failed else [])
    job.known = ["cut short"]
    assert asyncio.run(kind().incomplete(job)) == ["cut short"]


def test_of_a_dataset_without_any_log_nothing_failed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert not failed_stages.has_failed(["logs/d/a.log"])
