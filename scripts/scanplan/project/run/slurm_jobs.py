"""Jobs of this folder in Slurm: those that outlived their run, and why some of them ended.

Snakemake's executor plugin submits jobs and asks whether they are at work; it knows nothing of
those of a run that was killed, and of one that ended it says no more than that it failed. Asked is
`squeue`, which every Slurm has; accounting, which not every one keeps, is not needed.
"""

import importlib.util
import re
import shutil
import subprocess
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from scanplan.errors import StageError

LOCK = "environment-slurm.lock"
PLUGIN = "snakemake_executor_plugin_slurm"
LOGS = Path(".snakemake/slurm_logs")
"""Where the plugin has jobs write what they say beside the stages' own logs."""
SNAKEMAKE_LOGS = Path(".snakemake/log")

_FIELDS = ("%i", "%T", "%r", "%l", "%m", "%k", "%Z")
_SEPARATOR = "|"
_AT_WORK = ("PENDING", "CONFIGURING", "RUNNING", "COMPLETING", "SUSPENDED", "REQUEUED")
_CAUSES = {
    "TIMEOUT": "ran into its time limit of {limit}; raise it with --set-resources RULE:runtime=MIN",
    "OUT_OF_MEMORY": "ran out of its {memory} of memory; raise it with --set-resources"
    " RULE:mem_mb=MB",
    "NODE_FAIL": "was lost with its node; the same command goes on from here",
    "BOOT_FAIL": "was lost with its node; the same command goes on from here",
    "PREEMPTED": "gave way to other jobs; the same command goes on from here",
    "CANCELLED": "was cancelled; the same command goes on from here",
    "DEADLINE": "could not end before its deadline",
}
_NO_MEMORY = re.compile("exceeded memory limit|oom.kill", re.IGNORECASE)
_PATIENCE_S = 60.0  # a node kills what does not end by itself after half of it (KillWait)


@dataclass(frozen=True)
class SlurmJob:
    """A job as `squeue` shows it.

    Attributes
    ----------
    number : str
        Slurm's id.
    state, reason : str
        `RUNNING`, `TIMEOUT` ...; Slurm's reason for it.
    limit, memory : str
        Time limit and least memory that it asked for, as Slurm writes them.
    what : str
        Rule or group and wildcards, as the plugin's comment has them.
    folder : Path
        Where it was submitted from.
    """

    number: str
    state: str
    reason: str
    limit: str
    memory: str
    what: str
    folder: Path

    @property
    def is_at_work(self) -> bool:
        """Whether it waits, runs or is being ended."""
        return self.state in _AT_WORK

    def explain_end(self) -> str | None:
        """Return why it ended before its work was done; None where Slurm does not know."""
        if cause := _CAUSES.get(self.state):
            return cause.format(limit=self.limit, memory=self.memory)
        return None


def find_status_command() -> str:
    """Return the command that the plugin is to ask for states: `sacct` needs accounting.

    Raises
    ------
    SystemExit
        If the plugin or Slurm itself is missing.
    """
    if importlib.util.find_spec(PLUGIN) is None:
        raise SystemExit(
            f"scanplan: the profile for Slurm needs {PLUGIN.replace('_', '-')}; install it with:"
            f" pip install --no-deps --require-hashes -r {LOCK}"
        )
    if shutil.which("sbatch") is None:
        raise SystemExit(
            "scanplan: the profile for Slurm needs its commands, and there is no sbatch; run it on"
            " a login node of the cluster, or leave the profile out"
        )
    kept = _ask("scontrol", "show", "config").partition("AccountingStorageType")[2]
    is_kept = "none" not in kept.partition("\n")[0]
    return "sacct" if is_kept else "squeue"


def list_jobs(folder: Path) -> list[SlurmJob]:
    """Return this user's jobs of a folder, oldest first, also those that ended a short time ago.

    Raises
    ------
    StageError
        If Slurm does not answer.
    """
    try:
        lines = _ask(
            "squeue", "--me", "--noheader", "--states=all", f"--format={_SEPARATOR.join(_FIELDS)}"
        ).splitlines()
    except SystemExit as error:
        raise StageError(str(error).removeprefix("scanplan: ")) from None
    jobs = map(_parse_job, lines)
    here = [job for job in jobs if job is not None and job.folder == folder]
    return sorted(here, key=lambda job: int(job.number.partition("_")[0]))


def _parse_job(line: str) -> SlurmJob | None:
    # a folder's name may hold the separator, nothing before it may
    parts = line.split(_SEPARATOR, len(_FIELDS) - 1)
    if len(parts) < len(_FIELDS):
        return None
    return SlurmJob(*parts[:-1], folder=Path(parts[-1]))


def end_older_jobs(folder: Path) -> list[str]:
    """Cancel the jobs that an earlier run of a folder left in Slurm, and wait until they are gone.

    The folder's lock is held: no other run of this host is at work here.

    Returns
    -------
    list of str
        The ids of the jobs.

    Raises
    ------
    StageError
        If they do not end.
    """
    older = [job.number for job in list_jobs(folder) if job.is_at_work]
    if not older:
        return []
    _ask("scancel", *older)
    until_s = time.monotonic() + _PATIENCE_S
    while left := [job.number for job in list_jobs(folder) if job.is_at_work]:
        if time.monotonic() > until_s:
            raise StageError(
                f"{folder}: jobs {', '.join(left)} of an earlier run do not end in Slurm; wait"
                " until squeue no longer shows them, then give the same command"
            )
        time.sleep(1)
    return older


def explain_ends(jobs: Sequence[SlurmJob], known: Sequence[str]) -> Iterator[str]:
    """Iterate over lines that say why jobs ended before their work was done.

    Parameters
    ----------
    known : sequence of str
        Ids of jobs of earlier runs, which are left out.
    """
    # of what was tried again the last end counts
    latest = {job.what: job for job in jobs if job.number not in known}
    for job in latest.values():
        if cause := job.explain_end() or _read_cause(job):
            what = re.sub(r"^rule_", "", job.what).replace("_wildcards_", " ")
            yield f"{what}: its Slurm job {job.number} {cause}; its log is {_find_log(job)}"


def explain_refusal(partition: str | None = None) -> str:
    """Return what Slurm says where it took none of a run's jobs."""
    where = () if partition is None else (f"--partition={partition}",)
    try:
        _ask("sbatch", "--test-only", *where, "--wrap=true")
    except SystemExit as error:
        said = str(error).removeprefix("scanplan: ").partition(";")[0]
        return f"{said}; name another with --default-resources slurm_partition=NAME"
    return f"Slurm took no job; what it said is in the newest log of {SNAKEMAKE_LOGS}"


def _read_cause(job: SlurmJob) -> str | None:
    """Return why a job failed by its log: without cgroups Slurm itself calls it a failure."""
    log = _find_log(job)
    if (
        job.state == "FAILED"
        and log.is_file()
        and _NO_MEMORY.search(log.read_text("utf-8", "replace"))
    ):
        return _CAUSES["OUT_OF_MEMORY"].format(memory=job.memory)
    return None


def _find_log(job: SlurmJob) -> Path:
    found = next(LOGS.rglob(f"{job.number}.log"), None)
    return found or LOGS


def _ask(*command: str, timeout_s: float = 30.0) -> str:
    """Return what a command says; a controller that answers later is down."""
    try:
        return subprocess.run(
            command, check=True, capture_output=True, text=True, timeout=timeout_s
        ).stdout
    except (OSError, subprocess.SubprocessError) as error:
        said = (getattr(error, "stderr", None) or str(error)).strip().splitlines()
        raise SystemExit(
            f"scanplan: {command[0]}: {said[-1] if said else 'failed'}; is Slurm's controller at"
            " work (sinfo)?"
        ) from None
