import logging
import os

from snakemake.settings.enums import Quietness
from scanplan.project import console, run_lock, run_outcome

THIS_RUN = run_lock.FolderRun()
CONSOLE = console.open_console(GIVEN)


def is_to_be_told():
    """Whether this process shows its run in lines of our own, and not in Snakemake's."""
    output = workflow.output_settings
    quiet = output.quiet or ()
    wanted = Quietness.RULES in quiet and not output.verbose
    return workflow.is_main_process and wanted and not output.dryrun


def comparison_is_up_to_date():
    """Whether all of the given datasets' results that there are were asked for in this run."""
    there = any(map(os.path.exists, of_all_datasets(comparison_of)))
    return "comparison" in workflow.dag_settings.targets or not there


def tell_results():
    """Say what was made of the given datasets, and where it is."""
    targets = workflow.dag_settings.targets
    pages = {"thesis": "report", "thesis_more": "more"}
    for target in sorted(pages.keys() & set(targets)):
        print(f"\nreport:  results/{RESERVED}/{pages[target]}.html", file=sys.stderr)
    if not workflow.dag_settings.until and set(targets) <= {"all", "comparison"}:
        for name in GIVEN:
            print(run_outcome.describe_results(name), file=sys.stderr)


# before the jobs are worked out: while another run is at work, files come and go
if workflow.is_main_process:
    or_end(run_lock.check_places, GIVEN)
    or_end(run_lock.lock_folder).close()
if is_to_be_told():
    CONSOLE.take_over(logging.getLogger("snakemake.logging"), tell_results)


onstart:
    or_end(THIS_RUN.begin)
    for name, dataset in GIVEN.items():
        or_end(begin_results, name, dataset.source)


onsuccess:
    CONSOLE.end()
    for name in GIVEN:
        discard_lone_note(name)
    targets = workflow.dag_settings.targets
    is_whole = not workflow.dag_settings.until and set(targets) <= {
        "all",
        "comparison",
    }
    if is_whole and comparison_is_up_to_date():
        for name, dataset in GIVEN.items():
            or_end(end_results, name, dataset.source)
    tell_results()
    print(f"took     {THIS_RUN.elapsed()}", file=sys.stderr)


onerror:
    CONSOLE.end()
    for name in GIVEN:
        discard_lone_note(name)
    layers = {name: dataset.layers for name, dataset in DATASETS.items()}
    layers[RESERVED] = ()
    run_outcome.remove_unfinished(layers)
    for line in run_outcome.describe_failure(THIS_RUN, layers):
        print(f"scanplan: {line}", file=sys.stderr)
    # whatever Snakemake would add says less
    raise SystemExit(1)
