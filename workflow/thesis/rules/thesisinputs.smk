# what the claims are measured on: table of the results by the name that the measures know it by
ROOMS_TABLES = {
    "walls": "evaluation/walls",
    "hull": "selection/hull",
    "cluster_hull": "selection/cluster_hull",
    "clusters": "thesis/clusters",
    "areas": "thesis/areas",
    "unevenness": "thesis/unevenness",
    "premises": "thesis/premises",
    "times": "thesis/times",
}
DRIVE_TABLES = {
    "walls": "evaluation/walls",
    "candidates": "thesis/candidates",
    "times": "thesis/times",
    "poses": "evaluation/poses",
    "steps": "thesis/steps",
}


def of_kind(kind, table):
    """A table of every survey of a kind, by seed."""
    return [f"results/{survey.name}/{table}.parquet" for survey in THESIS[kind]]


def evidence():
    """All tables that the claims are measured on."""
    files = {
        f"rooms_{name}": of_kind(experiments.ROOMS, table)
        for name, table in ROOMS_TABLES.items()
    }
    files |= {
        f"drive_{name}": of_kind(experiments.DRIVE, table)
        for name, table in DRIVE_TABLES.items()
    }
    return files | {"limits_steps": of_kind(experiments.LIMITS, "thesis/steps")}


def seeds_of(kind):
    """The seeds that the surveys of a kind are simulated with."""
    return [survey.settings["simulate"]["seed"] for survey in THESIS[kind]]


def is_drive(wildcards):
    """A param function: whether the job's survey is a drive, of which more is claimed of run times."""
    return wildcards.dataset in [drive.name for drive in THESIS[experiments.DRIVE]]


def first_of(kind, *files):
    """Files of the first survey of a kind, by their stems."""
    name = THESIS[kind][0].name
    return {os.path.basename(file): f"results/{name}/{file}.parquet" for file in files}


def figures_of(*numbers):
    """Our figures of these numbers."""
    return [
        f"results/thesis/figures/{figure.file}"
        for figure in shown_figures.FIGURES
        if figure.number in numbers
    ]


ROOMS_FIGURES = [
    "3.1",
    "3.2",
    "3.3",
    "4.1",
    "5.1",
    "5.2",
    "5.3",
    "5.4",
    "5.5",
    "5.6",
    "5.7",
]
DRIVE_FIGURES = ["5.8", "5.9", "5.10", "5.11", "5.12"]


THESIS_PAGE = [
    *page_files("thesis.html.j2", "thesis.css"),
    *product.page_files("deviations.md", folder="config"),
]
