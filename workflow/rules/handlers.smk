import logging
import os
from pathlib import Path

from snakemake.exceptions import LockException
from snakemake.settings.enums import Quietness
from scanplan.interrupts import end_work
from snakemake.persistence import PersistenceBase
from scanplan.project.run import (
    console,
    failed_stages,
    foreign_settings,
    run_lock,
    run_outcome,
    run_places,
    slurm_jobs,
)

THIS_RUN = run_lock.FolderRun()
CONSOLE = console.open_console(GIVEN)
# Slurm's jobs of earlier runs in this folder
OLDER_JOBS = []


def is_on_slurm():
    """Whether the stages of this run are jobs of Slurm."""
    plugin = workflow.executor_plugin
    return plugin is not None and plugin.name == "slurm"


def free_rate_of_jobs():
    """Let this machine's jobs begin as soon as cores are free, unless the command limits how many may.

    Snakemake counts those of the last second by timers, the last of which its process waits for at
    its end: about a second of every run.
    """
    limit = workflow.scheduling_settings.max_jobs_per_timespan
    is_usual = limit is not None and (limit.max_jobs, limit.timespan) == (100, 1)
    if workflow.local_exec and is_usual:
        workflow.scheduler.job_rate_limiter = None


def end_older_jobs():
    """Leave no job of a killed run at work beside those of this one."""
    ended = slurm_jobs.end_older_jobs(Path.cwd())
    OLDER_JOBS.extend(job.number for job in slurm_jobs.list_jobs(Path.cwd()))
    if ended:
        tell(
            f"scanplan: Slurm jobs {', '.join(ended)} of an earlier run were cancelled; this one goes on"
        )


def causes_in_slurm():
    """Why jobs of this run ended, as far as Slurm knows; None where it is not what runs them."""
    if not is_on_slurm():
        return None
    jobs = or_end(slurm_jobs.list_jobs, Path.cwd())
    if {job.number for job in jobs} <= set(OLDER_JOBS):
        asked = workflow.resource_settings.default_resources.get("slurm_partition")
        # as it was given: its value is one of a rule
        return [slurm_jobs.explain_refusal(asked and str(asked.raw))]
    return list(slurm_jobs.explain_ends(jobs, OLDER_JOBS))


def has_files_here():
    """Whether results and logs are files of this folder, not objects of a storage."""
    return workflow.storage_settings.default_storage_provider is None


def is_to_be_told():
    """Whether this process shows its run in lines of our own, and not in Snakemake's."""
    output = workflow.output_settings
    quiet = output.quiet or ()
    wanted = Quietness.RULES in quiet and not output.verbose
    # our lines are read from the stages' logs
    is_shown = wanted and has_files_here() and not output.dryrun
    return workflow.is_main_process and is_shown and not IS_MODULE


def comparison_is_up_to_date():
    """Whether all of the given datasets' results that there are were asked for in this run."""
    there = any(os.path.exists(file) for name in GIVEN for file in comparison_of(name))
    return "comparison" in workflow.dag_settings.targets or not there


def is_whole():
    """Whether the run is to make all of the plan, or of the comparison."""
    asked = workflow.dag_settings
    return not asked.until and set(asked.targets) <= {"all", "comparison"}


def tell_results():
    """Say what was made of the given datasets, and where it is."""
    if not has_files_here():
        return
    targets = workflow.dag_settings.targets
    pages = LABORATORY.PAGES if LABORATORY else {}
    for target in sorted(pages.keys() & set(targets)):
        tell(f"\nreport:  {pages[target]}")
    if is_whole():
        for name in GIVEN:
            tell(run_outcome.describe_results(name))


def sources_of_given():
    """The files that the given datasets' results are made of, as far as a user gave them."""
    for dataset in GIVEN.values():
        yield from () if dataset.building else dataset.recordings
        yield from filter(None, [dataset.corrections, dataset.building])


# before the jobs are worked out: while another run is at work, files come and go
if workflow.is_main_process and not IS_MODULE:
    or_end(optional_stages.check_left_out)
    or_end(run_places.check_places, GIVEN)
    or_end(run_places.check_dates, GIVEN, sources_of_given())
    or_end(foreign_settings.check_foreign_settings, os.environ)
    or_end(run_lock.lock_folder).close()
    run_lock.release_results(
        or_end(
            run_lock.lock_results, [n for n in GIVEN if os.path.isdir(f"results/{n}")]
        )
    )
if not IS_MODULE:
    shorten_traces(is_begun=True)
    failed_stages.redo_failed(PersistenceBase)
    run_lock.tell_locked(PersistenceBase, LockException, or_end)
if is_to_be_told():
    CONSOLE.take_over(logging.getLogger("snakemake.logging"), tell_results)
    CONSOLE.tell_assumed(
        {
            name: stage_settings.select_assumed(found.settings)
            for name, found in GIVEN.items()
        }
    )


def benchmarks_of(name):
    """What Snakemake measured of a dataset's stages, but of those that are gone."""
    patterns = [rule.benchmark for rule in workflow.rules if rule.benchmark]
    files = sorted(map(str, Path("benchmarks", name).glob("*.tsv")))
    return [file for file in files if any(p.match(file) for p in patterns)]


def tell_overview():
    """Put what became of many datasets into one table and one page, failed ones among them."""
    if len(GIVEN) < 2 or not is_whole() or not has_files_here():
        return
    # takes a second to import, and is needed at the end alone
    from scanplan.report import overview

    faults = {
        name: list(run_outcome.list_faults(name, THIS_RUN, dataset.layers))
        for name, dataset in GIVEN.items()
    }
    pages = page_files("overview.html.j2", "overview.css")
    sources = {os.path.basename(page): Path(page).read_text() for page in pages}
    table, page = or_end(
        overview.write_overview,
        overview.gather_overview(
            "results",
            faults,
            {name: benchmarks_of(name) for name in GIVEN},
            [
                name
                for name, dataset in GIVEN.items()
                if dataset.corrections is not None
            ],
        ),
        "results",
        sources,
    )
    tell(f"\nall      {page} (also {table})")


def tell_failure():
    """Say why stages failed."""
    layers = {name: dataset.layers for name, dataset in DATASETS.items()}
    layers[RESERVED] = ()
    run_outcome.remove_unfinished(layers)
    for line in run_outcome.describe_failure(THIS_RUN, layers, causes_in_slurm()):
        tell(f"scanplan: {line}")


def go_on_without_optional():
    """Begin the run anew without stages that failed, if a plan does without all of them."""
    if not is_whole() or THIS_RUN.interrupted or "snakemake.cli" not in sys.modules:
        return
    failed = {
        (name, stage)
        for name in [*DATASETS, RESERVED]
        for stage in run_outcome.list_failed(name, THIS_RUN)
    }
    optional = {found for found in failed if found[1] in optional_stages.NEEDED_BY}
    may_go_on = optional == failed or workflow.execution_settings.keep_going
    if may_go_on and optional > optional_stages.read_left_out():
        optional_stages.begin_without(optional)


onstart:
    or_end(THIS_RUN.begin, GIVEN)
    free_rate_of_jobs()
    if is_on_slurm():
        or_end(end_older_jobs)
    for name, dataset in GIVEN.items():
        or_end(begin_results, name, dataset.source)
        # made of what is lacking now, it would seem to be of this plan
        for file in filter(is_lacking, all_of(name)):
            Path(file).unlink(missing_ok=True)


onsuccess:
    CONSOLE.end()
    for name in GIVEN:
        discard_lone_note(name)
    if is_whole() and not LACKING and comparison_is_up_to_date():
        for name, dataset in GIVEN.items():
            or_end(end_results, name, dataset.source)
    if is_whole() and has_files_here():
        storeys = BUILDING.storeys if BUILDING else ()
        together = [GIVEN[storey.dataset].source for storey in storeys]
        for name, dataset in GIVEN.items():
            or_end(write_note, name, dataset.source, together, KNOWN.given)
    tell_results()
    tell_overview()
    if optional_stages.read_left_out():
        tell_failure()
        raise SystemExit(1)
    end_work()
    tell(f"took     {THIS_RUN.elapsed()}")
    if is_unheard():
        raise SystemExit(1)


onerror:
    CONSOLE.end()
    go_on_without_optional()
    for name in GIVEN:
        discard_lone_note(name)
    tell_failure()
    tell_overview()
    # whatever Snakemake would add says less
    raise SystemExit(THIS_RUN.exit_status)
