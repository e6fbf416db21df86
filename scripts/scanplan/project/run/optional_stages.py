"""Stages that a plan does without: where one fails, the run goes on, and ends with its fault.

A run that has ended for such faults alone begins anew as the same process, with the same command,
and leaves out what those stages would make. Its own processes learn that from the environment. The
next run, which knows nothing of it, tries them again, and makes anew what lacked their files.
"""

import os
import sys
from collections.abc import Collection, Iterable
from pathlib import Path

from scanplan.errors import StageError
from scanplan.project.run import failed_stages

_LEFT_OUT = "SCANPLAN_LEFT_OUT"

NEEDED_BY: dict[str, tuple[str, ...]] = {
    "measure_crispness": (),
    # nothing says what is to be settled
    "validate_plan": ("plan_next_visit",),
    "plan_next_visit": (),
    "draw_figures": (),
    "export_plan": (),
    "export_presentation": (),
    "export_files": (),
    "export_cloud": (),
    "evaluate_poses": (),
    "evaluate_plan": (),
    "draw_area": (),
    "evaluate_walls": ("tabulate_seconds", "draw_evaluation"),
    "tabulate_seconds": ("draw_evaluation",),
    "draw_evaluation": (),
}
"""Optional stages, as their logs are called, and those that cannot do without what each makes."""


def read_left_out() -> frozenset[tuple[str, str]]:
    """Return the datasets and optional stages that failed in this run so far."""
    words = (word.partition("/") for word in os.environ.get(_LEFT_OUT, "").split())
    # whoever sets it by hand may mean anything
    return frozenset((dataset, stage) for dataset, _, stage in words if stage in NEEDED_BY)


def check_left_out() -> None:
    """Refuse a note of failed stages that no run has left in its own environment.

    Raises
    ------
    StageError
    """
    for dataset, stage in read_left_out():
        log = Path("logs", dataset, f"{stage}.log")
        if not (log.is_file() and failed_stages.has_failed([str(log)])):
            raise StageError(
                f"{_LEFT_OUT}: names {dataset}/{stage}, which has not failed; only a run sets this"
                " variable: unset it"
            )


def list_lacking(failed: Iterable[tuple[str, str]]) -> set[tuple[str, str]]:
    """Return failed stages of datasets, and those that cannot do without them."""
    lacking = set(failed)
    return lacking | {(dataset, other) for dataset, stage in lacking for other in NEEDED_BY[stage]}


def begin_without(failed: Collection[tuple[str, str]]) -> None:
    """Begin the run anew, in the place of this process, without some stages; does not return."""
    words = sorted(f"{dataset}/{stage}" for dataset, stage in failed)
    os.environ[_LEFT_OUT] = " ".join(words)
    for dataset, _ in failed:
        # it tells of the fault; and a run that had nothing to do would end as if there were none
        Path("results", dataset, "summary.txt").unlink(missing_ok=True)
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])
