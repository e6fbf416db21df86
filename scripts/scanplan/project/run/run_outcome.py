"""The lines that end a run, for the user: where the results lie, or what went wrong."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from scanplan.errors import MORE_MEMORY
from scanplan.interrupts import INTERRUPTED
from scanplan.project import provenance
from scanplan.project.run import failed_stages, memory_kills, optional_stages
from scanplan.project.run.run_lock import FolderRun
from scanplan.project.run.slurm_jobs import LOGS as JOB_LOGS
from scanplan.project.settings import Layer, locate_fault
from scanplan.stage import bytecode
from scanplan.store import atomic

_MADE_WITHOUT = "all that does not need it is made; the same command tries it again"
_OUTSIDE = "was ended from outside"


def describe_results(name: str) -> str:
    """Return the lines that say what was found of a dataset, and where its files lie."""
    folder = f"results/{name}"
    summary = Path(folder, "summary.txt")
    found = summary.read_text(encoding="utf-8") if summary.exists() else ""
    compared = f"{folder}/comparison.html"
    beside = f", {compared}" if Path(compared).exists() else ""
    drawn = f"{folder}/plan/plan.pdf"
    where = f"{drawn} (also .svg, .dxf, .geojson, map.pgm)"
    regular = f"{folder}/plan/presentation.pdf"
    shown = f"to show  {regular} (also .svg, .png, .dxf)\n" if Path(regular).exists() else ""
    return (
        f"\n{name}\n{found}"
        f"plan     {where if Path(drawn).exists() else f'{folder}/plan, not drawn'}\n{shown}"
        f"report   {folder}/report.html{beside}"
    )


def describe_failure(
    run: FolderRun, layers: Mapping[str, Sequence[Layer]], causes: Sequence[str] | None = None
) -> list[str]:
    """Return the lines that say why a run failed: a line a stage, and one if it was interrupted.

    Parameters
    ----------
    layers : dict of str to list of settings.Layer
        By name, the settings of all datasets whose stages could have run.
    causes : sequence of str, optional
        On a cluster, what it says of stages that it ended itself; to them that looks like an
        interrupt.
    """
    lines = [line for name in layers for line in list_faults(name, run, layers[name])]
    if causes is not None:
        # what it says is nearer to the truth than that a log just ends
        lines = [line for line in lines if _OUTSIDE not in line]
    faults = [line for line in lines if not line.endswith(INTERRUPTED)]
    told = [*faults, *(causes or ())]
    if bytecode.remove_cut_files():
        told.append(bytecode.CUT_SHORT)
    # what fails on a cluster takes the other stages of its job along
    if run.interrupted or (causes is None and len(faults) < len(lines)):
        return [*told, f"the run {INTERRUPTED}"]
    if causes is not None and not told:
        return [f"the cluster ended stages without a word; their jobs' logs are in {JOB_LOGS}"]
    return told


def list_failed(name: str, run: FolderRun) -> list[str]:
    """Return the stages of a dataset that failed in this run, as their logs are called."""
    return [log.stem for log, _ in _read_failed(name, run)]


def _read_failed(name: str, run: FolderRun) -> Iterator[tuple[Path, list[str]]]:
    """Iterate over the logs, and their lines, of a dataset's stages that failed in this run."""
    failed = {stage for dataset, stage in optional_stages.read_left_out() if dataset == name}
    for log in sorted(Path("logs", name).glob("*.log")):
        is_of_run = log.stem in failed or run.has_written(log)
        if is_of_run and not failed_stages.ends_well(log):
            yield log, log.read_text(errors="replace").splitlines()


def list_faults(name: str, run: FolderRun, layers: Sequence[Layer]) -> Iterator[str]:
    """Iterate over the last errors of a dataset's stages that failed in this run.

    Parameters
    ----------
    layers : sequence of settings.Layer
        The settings of the dataset.
    """
    for log, lines in _read_failed(name, run):
        left_out = (name, log.stem) in optional_stages.read_left_out()
        rest = f"; {_MADE_WITHOUT}" if left_out else ""
        errors = [line.split(" ERROR ", 1)[1] for line in lines if " ERROR " in line]
        if errors:
            stage, _, fault = errors[-1].partition(": ")
            yield f"{stage}: {locate_fault(fault, layers)}{rest}"
        elif not run.interrupted:
            yield f"{log.stem}: {_explain_end(run)}; its log is {log}{rest}"


def _explain_end(run: FolderRun) -> str:
    """Return why a stage ended that has said nothing, as far as the system tells."""
    peak = f"the largest process so far had {memory_kills.measure_peak_mb():,} MB"
    lower = f"{MORE_MEMORY}, or take fewer scans (poses.keep_every)"
    if memory_kills.count_memory_kills() > run.memory_kills:
        return f"{_OUTSIDE} by the system, for want of memory ({peak}): {lower}"
    return (
        f"{_OUTSIDE}, perhaps for want of memory ({peak}) or of space on the disk; if of memory,"
        f" {lower}"
    )


def remove_unfinished(names: Iterable[str]) -> None:
    """Remove what stages that were killed left below results: temporary files, empty folders."""
    for name in names:
        atomic.remove_leftovers(Path("results", name))
        provenance.remove_empty_folders(name)
    with suppress(OSError):
        Path("results").rmdir()
