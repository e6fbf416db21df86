import gc
import io
import os
import sys
from contextlib import redirect_stderr
from functools import cache
from pathlib import Path

from snakemake.exceptions import WorkflowError

# what the laboratory's workflow hands in, which surveys more than the user's datasets
LABORATORY = None
OUTERMOST = workflow.modifier
if not OUTERMOST.is_main_snakefile():
    LABORATORY = config.pop("laboratory", None)
    # a run of it is like one of ours
    OUTERMOST = OUTERMOST.parent_modifier if LABORATORY else OUTERMOST
# of another workflow, whose run, console and lock are not ours
IS_MODULE = not OUTERMOST.is_main_snakefile()
if not IS_MODULE:
    # all objects of a graph of jobs stay: to look for garbage among them after every 700 new ones
    # takes a sixth of a start
    gc.set_threshold(100_000)
# of a plan of two threads an eighth of the memory: each would keep for itself what it has freed
os.environ.setdefault("MALLOC_ARENA_MAX", "1")
# a scan's arrays take up to some megabytes: what they leave is for those of the next scan, and not
# given back to the system, which would clear and map every page of it anew
os.environ.setdefault("MALLOC_MMAP_THRESHOLD_", str(8 * 2**20))
os.environ.setdefault("MALLOC_TRIM_THRESHOLD_", str(32 * 2**20))
# stages share out their cores themselves: a product of matrices would keep a second one waiting for
# more, and its sums would depend on how many there are
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

sys.path.insert(0, f"{PROJECT}/scripts")
from scanplan.errors import StageError
from scanplan.project import (
    building_file,
    catalogue_file,
    export_formats,
    stage_settings,
    tolerance_file,
    words_file,
)
from scanplan.project.code_files import digest_helpers
from scanplan.project.dataset import (
    CHANGES,
    GROWN,
    describe_dataset,
    find_truth,
    list_comparison,
    list_deviations,
    list_floors,
    list_replaced_models,
    list_results,
    name_datasets,
    pair_surveys,
    survey_files,
)
from scanplan.project.dataset_files import RESERVED, is_of_stations
from scanplan.project.design_file import choose_design
from scanplan.project.name_pattern import match_names
from scanplan.project.provenance import (
    begin_results,
    check_sources,
    digest_recordings,
    discard_lone_note,
    end_results,
)
from scanplan.project.run import optional_stages
from scanplan.project.run.foreign_settings import keep_figures_ours
from scanplan.project.run.terminal import tell
from scanplan.project.run_note import write_note
from scanplan.project.settings import (
    KnownSettings,
    Layer,
    locate_fault,
    read_defaults,
    settings_of_dataset,
    settings_of_run,
)
from scanplan.project.settings_check import COMMAND_LINE, MODULE
from scanplan.project.settings_schema import list_choices, read_schema, type_texts
from scanplan.project.targets import check_targets
from scanplan.project.yaml_file import read_yaml
from scanplan.selection import methods
from scanplan.surroundings import is_unheard, shorten_traces

if not IS_MODULE:
    keep_figures_ours(os.environ)
SCHEMAS = ["schemas", "thesis"] if LABORATORY else ["schemas"]
SCHEMA = read_schema(
    *(f"{PROJECT}/workflow/{folder}/config.schema.yaml" for folder in SCHEMAS)
)
METHODS = list_choices(SCHEMA, "plan", "method")
EXTRACTORS = list_choices(SCHEMA, "plan", "extractor")


def or_end(function, *arguments):
    """Call a function; a fault of the user's data or settings ends the run in one line."""
    try:
        return function(*arguments)
    except StageError as error:
        if IS_MODULE:
            raise WorkflowError(f"scanplan: {error}") from None
        tell(f"scanplan: {error}")
        raise SystemExit(1)


def given_settings():
    """What the command line says, file by file, and last what is not in a file; or what a module is given."""
    if IS_MODULE:
        return [Layer(MODULE, dict(config))]
    files = map(os.path.relpath, workflow.config_settings.configfiles)
    layers = [Layer(file, read_yaml(file)) for file in files]
    alone = Layer(
        COMMAND_LINE, type_texts(dict(workflow.config_settings.config), SCHEMA)
    )
    return [*layers, alone]


KNOWN = KnownSettings(
    defaults=or_end(read_defaults, f"{PROJECT}/config/config.yaml", SCHEMA),
    given=or_end(given_settings),
    schema=SCHEMA,
)
RUN = or_end(settings_of_run, *KNOWN)


def given_datasets():
    """The datasets that the user gave, by name; the simulated demo where none is given."""
    drawings = f"{PROJECT}/config/buildings"
    usual = settings_of_dataset(*KNOWN)
    return {
        name: describe_dataset(name, path, KNOWN, drawings=drawings, usual=usual)
        for name, path in name_datasets(RUN["dataset"]).items()
    }


def further_surveys():
    """The surveys of the laboratory, by kind."""
    return LABORATORY.list_wanted(
        sys.argv[1:], config=f"{PROJECT}/config", **KNOWN._asdict()
    )


def given_targets():
    """The targets that the command names, which Snakemake does not tell before all is parsed."""
    command = sys.modules.get("snakemake.cli")
    if command is None:
        return []
    try:
        # what is no command of Snakemake's is another program's
        with redirect_stderr(io.StringIO()):
            parsed, _ = command.get_argument_parser().parse_known_args(sys.argv[1:])
    except SystemExit:
        return []
    return parsed.targets


GIVEN = or_end(given_datasets)
# two or more datasets in a folder with building.yaml are storeys of one building
NAMED = name_datasets(RUN["dataset"])
BUILDING = or_end(building_file.find_building, NAMED)
# a building's model is put together of theirs
NO_MODEL = [
    storey.dataset
    for storey in (BUILDING.storeys if BUILDING else ())
    if "ifc" not in GIVEN[storey.dataset].settings["plan"]["export"]["formats"]
]
SURVEYS = or_end(further_surveys) if LABORATORY else {}
# a job's own process finds the note that its run has made
if workflow.is_main_process and not IS_MODULE:
    for note in (note for found in GIVEN.values() for note in found.notes):
        tell(f"scanplan: {note}")
    for note in building_file.list_overlooked(NAMED):
        tell(f"scanplan: {note}")
    for note in BUILDING.note_unaligned() if BUILDING else []:
        tell(f"scanplan: {note}")
    for note in export_formats.tell_lacking():
        tell(f"scanplan: {note}")
    if NO_MODEL:
        lacking = f"plan.export.formats of {', '.join(NO_MODEL)} lacks ifc"
        tell(f"scanplan: {BUILDING.name}: not made, as {lacking}")
    or_end(
        check_sources,
        {name: found.source for name, found in GIVEN.items()},
        RUN["replace"] or [],
    )
# jobs are worked out for what is asked for; these are all that could be
DATASETS = GIVEN | {found.name: found for kind in SURVEYS.values() for found in kind}
if workflow.is_main_process and not IS_MODULE:
    others = [*DATASETS, RESERVED, *([BUILDING.name] if BUILDING else [])]
    laboratory = os.path.relpath(f"{PROJECT}/workflow/thesis/Snakefile")
    or_end(
        check_targets,
        given_targets(),
        list(GIVEN),
        others,
        None if LABORATORY else laboratory,
    )


# how the simulated datasets are recorded: those alone have rules
RECORDED_AS = {
    dataset.settings["simulate"]["recording"]
    for dataset in DATASETS.values()
    if dataset.building
}


def simulated_as(suffix):
    """Names of the simulated datasets whose recording has a suffix."""
    return match_names(
        name
        for name, dataset in DATASETS.items()
        if dataset.building and dataset.settings["simulate"]["recording"] == suffix
    )


def code_of(script):
    """A param function: a digest of the helpers that a script imports; an edit reruns what uses them."""

    def digest(wildcards):
        # looked up for the jobs of a run alone: every job parses the whole workflow anew
        return digest_helpers(f"{PROJECT}/scripts/{script}.py")

    return digest


# what a stage needs more for each gigabyte recorded, with as much again to spare: a pass through a
# gigabyte takes seconds and a map of it some megabytes, a drawing of the map some hundred
NEEDED_PER_GB = {"runtime": 5, "mem_mb": 100}


@cache
def size_gb(file):
    """Gigabytes of a file; every job of its dataset asks."""
    return os.path.getsize(file) / 1e9


def recorded_gb(name):
    """Gigabytes recorded of a dataset; none of a recording that is made in a run."""
    dataset = DATASETS[name]
    try:
        return 0 if dataset.building else sum(map(size_gb, dataset.recordings))
    except FileNotFoundError:
        # made in this run, for another dataset
        return 0


def n_chunks(name):
    """Into how many jobs a stage is divided that treats scans one by one."""
    chunk_gb = DATASETS[name].settings["advanced"]["jobs"]["chunk_gb"]
    return or_end(stage_settings.count_chunks, name, recorded_gb(name), chunk_gb)


def chunks_of(name):
    """The chunks of a dataset's scans, as their files' names say them."""
    count = n_chunks(name)
    return [f"{number}-of-{count}" for number in range(1, count + 1)]


def timed(stage, name):
    """The names of a stage's measured times: one for each chunk of scans where there are several."""
    chunks = chunks_of(name)
    return [stage] if len(chunks) == 1 else [f"{stage}_{chunk}" for chunk in chunks]


def grown(**least):
    """A resource function: what a stage asks of a cluster, more for long recordings and at every further attempt."""
    ((resource, amount),) = least.items()

    def amount_of(wildcards, attempt):
        n_jobs = n_chunks(wildcards.dataset) if "chunk" in wildcards.keys() else 1
        gb = recorded_gb(wildcards.dataset) / n_jobs
        return int((amount + NEEDED_PER_GB[resource] * gb) * attempt)

    return amount_of


def all_cores(wildcards):
    """All cores of this machine's run; where an executor is told none, as many as the other stages use at most."""
    return workflow.resource_settings.cores or 2


def is_one_sequence(name):
    """Whether a dataset's scans are registered by the frames before them, all one after the other."""
    settings = DATASETS[name].settings
    registration = stage_settings.select_section(settings, "registration")
    return registration["compare_with"] == "frames"


def registering_threads(wildcards):
    """Batches share two cores; frames that go by those before them are one sequence, on one core."""
    return 1 if is_one_sequence(wildcards.dataset) else 2


def setting(select, *arguments):
    """A param function: what one of `stage_settings` selects from the settings of the job's dataset."""

    def look_up(wildcards):
        return select(DATASETS[wildcards.dataset].settings, *arguments)

    return look_up


def section(*keys):
    """A param function that looks a section up, or one key of it, in the settings of the job's dataset."""
    return setting(stage_settings.select_section, *keys)


def extractor_settings(wildcards):
    """Settings of the job's wall extractor."""
    return stage_settings.select_extractor(
        DATASETS[wildcards.dataset].settings, wildcards.extractor
    )


def order_tables(wildcards):
    """The tables that the job's method needs, by name."""
    tables = tables_to_order(wildcards.dataset, wildcards.method)
    return {table: f"results/{wildcards.dataset}/{table}.parquet" for table in tables}


def tables_to_order(name, method):
    """What a method needs to order a dataset's scans beside these; the hulls where areas decide."""
    stop = DATASETS[name].settings["selection"]["stop"]
    by_area = methods.METHODS[method].needs_hulls or stop["min_gain_m2"] is not None
    return (*methods.METHODS[method].tables, *(["hulls"] if by_area else []))


def is_ordered_by(table):
    """Whether a plan's scans are ordered by a table, or all orderings are compared: else no rule makes it."""
    return LABORATORY or any(
        table in tables_to_order(name, found.settings["plan"]["method"])
        for name, found in DATASETS.items()
    )


def order_settings(wildcards):
    """Settings of the job's ordering, by name: a change of one reruns the orderings that depend on it."""
    return stage_settings.select_order(
        DATASETS[wildcards.dataset].settings,
        methods.METHODS[wildcards.method].settings,
    )


def ordering_threads(wildcards):
    """The plan's own ordering, a second's work, keeps what can wait from beginning beside it.

    The extraction that follows would wait for a core.
    """
    return 2 if wildcards.method == plan_method(wildcards) else 1


def of_dataset(dataset, files):
    """A dataset's recordings or truth: results of a simulated one, else files of the user, whom no module's prefix concerns."""
    return list(files) if dataset.building else list(map(local, files))


def recordings(wildcards):
    """Files that hold a dataset's clouds and poses."""
    dataset = DATASETS[wildcards.dataset]
    return of_dataset(dataset, dataset.recordings)


def recordings_of_stations(wildcards):
    """The same of stations, nothing of others."""
    files = recordings(wildcards)
    return files if is_of_stations(files) else []


def content_of_recordings(wildcards):
    """A param function: what tells recordings from others in their place, older ones too."""
    dataset = DATASETS[wildcards.dataset]
    # a simulated one is made in the run, of what its rule names
    if dataset.building:
        return ""
    # so are those of the thesis; Snakemake asks again once they are there
    for file in dataset.recordings:
        Path(file).stat()
    return or_end(digest_recordings, dataset.recordings)


def true_faces(wildcards):
    """The true walls of a dataset."""
    dataset = DATASETS[wildcards.dataset]
    return of_dataset(dataset, or_end(find_truth, dataset))[0]


def true_poses(wildcards):
    """The true sensor poses of a dataset."""
    dataset = DATASETS[wildcards.dataset]
    return of_dataset(dataset, or_end(find_truth, dataset))[1]


def plan_method(wildcards):
    """What orders the scans whose first make the plan."""
    return DATASETS[wildcards.dataset].settings["plan"]["method"]


def plan_selection(wildcards):
    """The ordering whose first scans make the plan."""
    return f"results/{wildcards.dataset}/selection/{plan_method(wildcards)}.parquet"


def plan_table(table):
    """An input function: a table of the plan, the corrected one where the dataset has corrections."""

    def path(wildcards):
        return plan_table_of(wildcards.dataset, table)

    return path


def plan_table_of(dataset, table):
    """Likewise of one dataset."""
    folder = "plan" if DATASETS[dataset].corrections is None else "plan/corrected"
    return f"results/{dataset}/{folder}/{table}.parquet"


def corrections(wildcards):
    """The file of what a person says of a dataset's plan, where there is one."""
    file = DATASETS[wildcards.dataset].corrections
    return local(file) if file else []


def design_as_prior(wildcards):
    """The design that the plan of the job's dataset is likelier to be as, where it is told to be."""
    found = DATASETS[wildcards.dataset]
    if not found.settings["plan"]["design"]["prior"]:
        return []
    return or_end(choose_design, wildcards.dataset, found.designs)


def plan_extractor_settings(wildcards):
    """Settings of the extractor whose walls make the plan."""
    settings = DATASETS[wildcards.dataset].settings
    return stage_settings.select_extractor(settings, settings["plan"]["extractor"])


def plan_walls(wildcards):
    """The walls of all scans by the extractor whose walls make the plan."""
    extractor = DATASETS[wildcards.dataset].settings["plan"]["extractor"]
    return f"results/{wildcards.dataset}/walls/{extractor}.parquet"


def compared_extractors(name):
    """Extractors that a dataset's evaluation compares: ours, and that of its plan."""
    chosen = DATASETS[name].settings["plan"]["extractor"]
    return [e for e in EXTRACTORS if e == chosen or not e.startswith("thesis_")]


def building(wildcards):
    """The file of the building that a dataset is simulated in."""
    return local(DATASETS[wildcards.dataset].building)


def formats_of(name):
    """The formats whose files `export_files` writes of a dataset."""
    chosen = DATASETS[name].settings["plan"]["export"]["formats"]
    return tuple(format for format in export_formats.FILES if format in chosen)


def chosen_formats():
    """The choices of formats of all datasets, each once."""
    return [f for f in dict.fromkeys(map(formats_of, DATASETS)) if f]


def exported_as(formats):
    """Names of the datasets that are exported in just these formats."""
    return match_names(name for name in DATASETS if formats_of(name) == formats)


def exported_files(formats):
    """The files of some formats, by what they are."""
    files = export_formats.list_files(formats)
    return {what: f"results/{{dataset}}/{file}" for what, file in files.items()}


def files_unasked_for(wildcards):
    """The files of formats that are not chosen for the job's dataset."""
    chosen = DATASETS[wildcards.dataset].settings["plan"]["export"]["formats"]
    files = export_formats.list_replaced(chosen)
    return [f"results/{wildcards.dataset}/{file}" for file in files]


def nominal_sizes(wildcards):
    """What the catalogue of the job's dataset holds: a size that changes reruns the drawing."""
    settings = DATASETS[wildcards.dataset].settings
    return catalogue_file.read_catalogue(settings["plan"]["export"]["catalogue"])


def limits_of_design(wildcards):
    """What the table of tolerances of the job's dataset holds: a limit that changes reruns what it judges."""
    settings = DATASETS[wildcards.dataset].settings
    return tolerance_file.read_tolerances(settings["plan"]["design"]["tolerances"])


def words_of_receiver(wildcards):
    """The words and names of layers of the job's dataset, likewise."""
    return words_file.read_receiver(
        DATASETS[wildcards.dataset].settings["plan"]["export"]
    )


def words_of_dataset(wildcards):
    """The words alone, of a stage that names no layers."""
    settings = DATASETS[wildcards.dataset].settings
    return words_file.read_words(settings["plan"]["export"]["language"])


def source_of_results(wildcards):
    """What the results of the job's dataset are made of."""
    return DATASETS[wildcards.dataset].source


def all_settings(wildcards):
    """All settings of the job's dataset but the laboratory's own: a report has none of them."""
    settings = DATASETS[wildcards.dataset].settings
    return {key: value for key, value in settings.items() if key != "thesis"}


# datasets and optional stages that have failed in this run, and those that cannot do without them
LACKING = optional_stages.list_lacking(optional_stages.read_left_out())


def is_lacking(file):
    """Whether a file is not to be had in this run, as its stage failed or lacks one that did."""
    for stage in workflow.rules if LACKING else ():
        found = [match for output in stage.output if (match := output.match(file))]
        failed = {(m["dataset"], Path(log).stem) for m in found for log in stage.log}
        if failed & LACKING:
            return True
    return False


def kept(files):
    """Those of some files that are to be had in this run."""
    return [file for file in files if not is_lacking(file)]


def if_kept(file):
    """An input function: a file of the job's dataset; none where its stage failed."""

    def path(wildcards):
        path = file.format(**wildcards)
        return [] if is_lacking(path) else path

    return path


def results_of(name):
    """The plan of one dataset, and all that it is made of."""
    return kept(list_results(DATASETS[name]))


def comparison_of(name):
    """What one dataset's plan is compared with: all orderings, and the walls of all scans."""
    return kept(list_comparison(DATASETS[name], METHODS, compared_extractors(name)))


def all_of(name):
    """All results of one dataset, whether they are to be had in this run or not."""
    dataset = DATASETS[name]
    return list_results(dataset) + list_comparison(
        dataset, METHODS, compared_extractors(name)
    )


def results_of_building(wildcards):
    """The files of all storeys together; none where a storey lacks what they are made of."""
    files = BUILDING.list_results() if BUILDING else []
    storeys = [storey.dataset for storey in BUILDING.storeys] if BUILDING else []
    made_of = [
        f"results/{storey}/plan/{file}"
        for storey in storeys
        for file in ("plan.ifc", "confidence.parquet")
    ]
    return files if not NO_MODEL and kept(made_of) == made_of else []


def of_storeys(file):
    """A result of every storey of the building, from the lowest up."""
    return [f"results/{storey.dataset}/{file}" for storey in BUILDING.storeys]


def tables_of_storeys(table):
    """Likewise a table of their plans."""
    return [plan_table_of(storey.dataset, table) for storey in BUILDING.storeys]


def of_all_datasets(*kinds):
    """An input function: files of all given datasets, worked out where they are asked for alone."""

    def files(wildcards):
        return [file for files_of in kinds for name in GIVEN for file in files_of(name)]

    return files


def storeys_beside(wildcards):
    """Names and datasets of the storeys of the job's building, from the lowest up; none where it is of none."""
    storeys = BUILDING.storeys if BUILDING else ()
    is_storey = wildcards.dataset in [storey.dataset for storey in storeys]
    return [(s.name, s.dataset) for s in storeys] if is_storey else []


# only those of which a stage is divided have rules for chunks
CHUNKED = [name for name in GIVEN if n_chunks(name) > 1]
# a salvaged recording's clouds have no numbers before all of them were read
REGISTERED_IN_CHUNKS = [
    name
    for name in CHUNKED
    if not is_one_sequence(name) and not GIVEN[name].settings["input"]["salvage"]
]


wildcard_constraints:
    chunk=r"\d+-of-\d+",
    dataset=match_names(DATASETS),
    method=match_names(METHODS),
    extractor=match_names(EXTRACTORS),
