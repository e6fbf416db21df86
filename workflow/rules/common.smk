import os
import re
import sys
from pathlib import Path

sys.path.insert(0, f"{workflow.basedir}/scripts")
from scanplan import configuration, datasets, sources
from scanplan.errors import StageError

DEMO = "demo"
METHODS = ["cluster_hull", "hull", "random", "sequential"]
EXTRACTORS = ["cluster_ransac", "iterative_ransac"]
FIGURES = ["scans", "area", "walls"]
EVALUATION = [
    "evaluation/walls.parquet",
    "evaluation/walls_aligned.parquet",
    "evaluation/oracle.parquet",
    "evaluation/poses.parquet",
    "figures/evaluation.svg",
]
PLANS = ["plan.geojson", "plan.svg", "plan.dxf"]


def given_datasets():
    """Dataset folders by results name, as the user gave them; the simulated demo where none is given."""
    given = config.get("dataset")
    if given is None:
        return {DEMO: None}
    named = {}
    for path in given if isinstance(given, list) else [given]:
        name = datasets.name_of(str(path))
        if name in named:
            raise StageError(
                f"{path}: its results would be called {name} like those of {named[name]}; rename one"
            )
        named[name] = str(path)
    return named


def settings_of(path):
    """Checked settings of one dataset: defaults, its dataset.yaml, then what the command line gave."""
    base = Path(workflow.basedir)
    schema = configuration.read_yaml(base / "workflow/schemas/config.schema.yaml")
    defaults = configuration.read_yaml(base / "config/config.yaml")
    own = None if path is None else Path(path) / "dataset.yaml"
    return configuration.for_dataset(
        defaults, own, workflow.config_settings.overwrite_config, schema
    )


def or_end(function, *arguments):
    """Call a function; a fault of the user's data or settings ends the run in one line."""
    try:
        return function(*arguments)
    except StageError as error:
        print(f"scanplan: {error}", file=sys.stderr)
        raise SystemExit(1)


DATASETS = or_end(given_datasets)
SETTINGS = {name: or_end(settings_of, path) for name, path in DATASETS.items()}
SIMULATED = (
    f"survey.{SETTINGS[DEMO]['simulate']['recording']}"
    if DEMO in SETTINGS
    else "survey.bag"
)
RECORDINGS = {
    name: (
        [f"results/{name}/survey/{SIMULATED}"]
        if path is None
        else or_end(datasets.find_files, path)
    )
    for name, path in DATASETS.items()
}


def truth_of(name, path):
    """True walls and true sensor poses of a dataset, or None where they are not known."""
    if path is None:
        folder = f"results/{name}/survey"
        return [f"{folder}/truth.geojson", f"{folder}/truth_poses.tum"]
    files = [Path(path) / "truth.geojson", Path(path) / "truth_poses.tum"]
    return list(map(str, files)) if all(file.is_file() for file in files) else None


TRUTHS = {name: truth_of(name, path) for name, path in DATASETS.items()}


def code_of(script):
    """Helper files that a script imports: as inputs they make an edit rerun the stages that use them."""
    files = sources.helpers_of(f"{workflow.basedir}/scripts/{script}.py")
    return [os.path.relpath(file) for file in files]


def setting(section, *keys):
    """A param function that looks a section, or one key of it, up in the settings of the job's dataset."""

    def look_up(wildcards):
        value = SETTINGS[wildcards.dataset][section]
        for key in keys:
            value = value[key]
        return value

    return look_up


def topics_and_frames(wildcards):
    """Settings of the input that poses depend on: all but the ranges."""
    reading = SETTINGS[wildcards.dataset]["input"]
    return {
        key: value for key, value in reading.items() if not key.endswith("_range_m")
    }


def extractor_settings(wildcards):
    """Settings of the job's wall extractor."""
    return SETTINGS[wildcards.dataset]["walls"][wildcards.extractor]


def recordings(wildcards):
    """Files that hold a dataset's clouds and poses."""
    return RECORDINGS[wildcards.dataset]


def true_faces(wildcards):
    """The true walls of a dataset."""
    return TRUTHS[wildcards.dataset][0]


def true_poses(wildcards):
    """The true sensor poses of a dataset."""
    return TRUTHS[wildcards.dataset][1]


def plan_selection(wildcards):
    """The ordering whose first scans make the plan."""
    return f"results/{wildcards.dataset}/selection/{SETTINGS[wildcards.dataset]['plan']['method']}.parquet"


def plan_walls(wildcards):
    """The walls that make the plan."""
    return f"results/{wildcards.dataset}/walls/{SETTINGS[wildcards.dataset]['plan']['extractor']}.parquet"


def all_selections(wildcards):
    """Orderings of all methods of one dataset."""
    return [
        f"results/{wildcards.dataset}/selection/{method}.parquet" for method in METHODS
    ]


def all_walls(wildcards):
    """Walls by all extractors of one dataset."""
    return [
        f"results/{wildcards.dataset}/walls/{extractor}.parquet"
        for extractor in EXTRACTORS
    ]


def building(wildcards):
    """The file of the building that the demo is simulated in: a path, or the name of a drawing of ours."""
    named = SETTINGS[DEMO]["simulate"]["building"]
    drawing = f"{workflow.basedir}/config/buildings/{named}.geojson"
    return os.path.relpath(drawing) if Path(drawing).exists() else named


def simulated_survey(wildcards):
    """Settings of the simulated rover."""
    return {
        key: value
        for key, value in SETTINGS[DEMO]["simulate"].items()
        if key not in ("building", "recording")
    }


def results_of(name):
    """Everything the workflow makes of one dataset."""
    files = [
        "poses.parquet",
        "registration.parquet",
        "edges.parquet",
        "scans.parquet",
        "hulls.parquet",
        "plan/faces.parquet",
    ]
    files += [f"selection/{method}.parquet" for method in METHODS]
    files += [f"walls/{extractor}.parquet" for extractor in EXTRACTORS]
    files += [f"plan/{plan}" for plan in PLANS]
    files += [f"figures/{figure}.svg" for figure in FIGURES]
    files += EVALUATION if TRUTHS[name] else []
    return [f"results/{name}/{file}" for file in files]


def all_results():
    """Everything the workflow makes of the given datasets."""
    return [file for name in DATASETS for file in results_of(name)]


wildcard_constraints:
    dataset="|".join(map(re.escape, DATASETS)),
    method="|".join(METHODS),
    extractor="|".join(EXTRACTORS),
