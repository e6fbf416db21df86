def figures_among(files_of):
    """An input function: the figures among the results of the job's dataset."""

    def figures(wildcards):
        folder = f"results/{wildcards.dataset}/figures/"
        return [f for f in files_of(wildcards.dataset) if f.startswith(folder)]

    return figures


def files_beside(files_of):
    """An input function: the tables and plans among the results, which a report links and sizes."""

    def beside(wildcards):
        folder = f"results/{wildcards.dataset}/figures/"
        files = files_of(wildcards.dataset)
        return [
            f
            for f in files
            if not f.startswith(folder) and not f.endswith((".html", ".txt"))
        ]

    return beside


def evaluated(*tables):
    """An input function: tables of the evaluation of the job's dataset, if its truth is known."""

    def known(wildcards):
        folder = f"results/{wildcards.dataset}/evaluation"
        if DATASETS[wildcards.dataset].truth is None:
            return []
        return kept(f"{folder}/{table}.parquet" for table in tables)

    return known


# which stage makes the tables that orderings need
TABLE_STAGES = {"observations": "observe_walls", "visibility": "build_visibility"}


# a param is no input or output: what a module's prefix makes of its paths is asked for
placed = workflow.modifier.path_modifier.modify


def run_times(orderings, extractors=(), comparing=()):
    """A param function: Snakemake's measurements of the stages of a report, in their order."""

    def measured(wildcards):
        of_plan = plan_method(wildcards)
        ordered = [m for m in METHODS if m in orderings or m == of_plan]
        tables = {table for m in ordered for table in methods.METHODS[m].tables}
        stages = [
            *("simulate_survey", "interpolate_poses", "register_scans"),
            *("measure_crispness", "build_hulls"),
            *(stage for table, stage in TABLE_STAGES.items() if table in tables),
            *(f"order_scans_{method}" for method in ordered),
            "extract_chosen_walls",
            *(f"extract_walls_{extractor}" for extractor in extractors),
            *("assemble_plan", "correct_plan", "validate_plan", "plan_next_visit"),
            *("export_plan", "export_files", "export_cloud", "evaluate_poses"),
            *("evaluate_plan", "draw_figures"),
            *comparing,
        ]
        # those that are there are shown
        names = [
            name
            for stage in stages
            for name in dict.fromkeys([stage, *timed(stage, wildcards.dataset)])
        ]
        return [placed(f"benchmarks/{wildcards.dataset}/{name}.tsv") for name in names]

    return measured


def page_files(*names, folder="workflow/report/page"):
    """Files that a page is made from: templates, style and script."""
    return [local(os.path.relpath(f"{PROJECT}/{folder}/{name}")) for name in names]


REPORT_PAGE = page_files(
    *("page.html.j2", "tables.html.j2", "page.css", "edit.css"),
    *("page.js", "edits.js", "drawn_edits.js", "tools.js", "choices.js"),
    *("elements.js", "saying.js", "walk.js", "save.js"),
)
CHANGES_PAGE = page_files("changes.html.j2", "changes.css", "page.css")


def plan_of(survey):
    """What a plan is compared by, of the dataset that a wildcard names, prefixed by the survey's letter."""
    wildcard = {"a": "earlier", "b": "dataset"}[survey]

    def of(path):
        return lambda wildcards: path(getattr(wildcards, wildcard))

    def table(name):
        return of(lambda dataset: plan_table_of(dataset, name))

    plan = ("faces", "walls", "openings", "rooms", "free", "furniture", "evidence")
    files = {name: table(name) for name in plan}
    files["confidence"] = of(
        lambda dataset: kept([f"results/{dataset}/plan/confidence.parquet"])
    )
    files["scans"] = of(lambda dataset: f"results/{dataset}/scans.parquet")
    files["registration"] = of(
        lambda dataset: f"results/{dataset}/registration.parquet"
    )
    return {f"{survey}_{name}": file for name, file in files.items()}


def changes_of_datasets(wildcards):
    """What changed in every given dataset since the one that is given before it."""
    pairs = or_end(pair_surveys, list(GIVEN))
    return [
        f"results/{later}/changes/{earlier}/changes.{suffix}"
        for earlier, later in pairs
        for suffix in (*CHANGES, *with_model(later))
    ]


def with_model(dataset):
    """The suffix of what a dataset's building model says, where it has one."""
    formats = DATASETS[dataset].settings["plan"]["export"]["formats"]
    return ("ifc",) if "ifc" in formats else ()


def design_of(wildcards):
    """The design that the job's dataset is held against."""
    return or_end(choose_design, wildcards.dataset, DATASETS[wildcards.dataset].designs)


def deviations_of_datasets(wildcards):
    """How every given dataset differs from its design."""
    return [file for of in GIVEN.values() for file in or_end(list_deviations, of)]
