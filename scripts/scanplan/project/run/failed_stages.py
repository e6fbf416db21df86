"""Stages that failed the last time: Snakemake forgets them, and what they lacked looks finished.

Where a stage fails its files are removed, with what is known of how they were made. What an earlier
run has made of them, by other settings maybe, is there, and as files between are allowed to be gone
nothing would be to be done. A stage whose log does not end well counts as one that was cut short.
"""

from collections.abc import Awaitable, Callable, Iterable
from pathlib import Path
from typing import Any

_STAGE_DONE = " stage done"


def redo_failed(persistence: Any) -> None:
    """Have a class of Snakemake's, which knows what was cut short, know stages that failed, too.

    Parameters
    ----------
    persistence : type
        With a method `incomplete` that returns those files of a job that are.
    """
    persistence.incomplete = _with_failed(persistence.incomplete)


def has_failed(logs: Iterable[str]) -> bool:
    """Return whether a stage has not ended its log well, or has none though others have.

    A log is removed when its stage is about to begin.
    """
    files = [Path(log) for log in logs]
    return any(file.parent.is_dir() and not ends_well(file) for file in files)


def ends_well(log: Path) -> bool:
    """Return whether a log is there, and is of a stage that did not fail."""
    return log.is_file() and log.read_text(errors="replace").rstrip().endswith(_STAGE_DONE)


def _with_failed(
    known: Callable[[Any, Any], Awaitable[list[Any]]],
) -> Callable[[Any, Any], Awaitable[list[Any]]]:
    async def incomplete(self: Any, job: Any) -> list[Any]:
        found = await known(self, job)
        if found or not has_failed(job.log):
            return found
        return [file for file in job.output if not Path(file).exists()]

    return incomplete
