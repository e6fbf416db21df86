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
    *("page.js", "edits.js", "shapes.js", "areas.js", "drawn_edits.js"),
    *("tools.js", "returns.js", "choices.js"),
    *("elements.js", "saying.js", "solid_edits.js", "solid.js", "three.js"),
    *("faults.js", "seen.js", "walk.js", "save.js"),
)
CHANGES_PAGE = page_files("changes.html.j2", "changes.css", "page.css")
FLOORS_PAGE = page_files("floors.html.j2", "overview.css")


def plan_of(survey):
    """What a plan is compared by, of the dataset that a wildcard names, prefixed by the survey's letter."""
    wildcard = {"a": "earlier", "b": "dataset"}[survey]

    def file(part):
        return lambda wildcards: survey_files_of(getattr(wildcards, wildcard))[part]

    return {f"{survey}_{part}": file(part) for part in COMPARED}


COMPARED = (
    *("faces", "walls", "openings", "rooms", "free", "furniture", "evidence"),
    *("confidence", "scans", "registration"),
)


def survey_files_of(dataset):
    """The tables of a dataset that it is compared with others by."""
    files = {part: plan_table_of(dataset, part) for part in COMPARED[:7]}
    confidence = f"results/{dataset}/plan/confidence.parquet"
    # a path, as a list of one is none to who reads it
    files["confidence"] = [] if is_lacking(confidence) else confidence
    for part in ("scans", "registration"):
        files[part] = f"results/{dataset}/{part}.parquet"
    return files


def ids_of_earlier(wildcards):
    """The ids of the earlier survey's elements; none where no files with ids are made of it."""
    earlier = wildcards.earlier
    return f"results/{earlier}/plan/ids.parquet" if formats_of(earlier) else []


def surveys_until(dataset):
    """The datasets that are given before one, the earliest first, and itself."""
    names = list(GIVEN)
    return names[: names.index(dataset) + 1]


def plans_until(wildcards):
    """What the plans of all surveys are joined by, each prefixed by the number of its survey."""
    return {
        f"s{row}_{part}": file
        for row, dataset in enumerate(surveys_until(wildcards.dataset))
        for part, file in survey_files_of(dataset).items()
    }


def grown_datasets(wildcards):
    """The plan of all given surveys of a floor, and what changed from each to the next."""
    files = changes_of_datasets(wildcards)
    latest = list(GIVEN)[-1]
    suffixes = (*GROWN, *model_of_all())
    return [f"results/{latest}/grown/grown.{suffix}" for suffix in suffixes] + files


def model_of_all():
    """The building model of the plan of all given surveys, where each of them has one."""
    has_model = all(
        "ifc" in of.settings["plan"]["export"]["formats"] for of in GIVEN.values()
    )
    return {"ifc": "results/{dataset}/grown/grown.ifc"} if has_model else {}


def changes_of_datasets(wildcards):
    """What changed in every given dataset since the one that is given before it."""
    pairs = or_end(pair_surveys, list(GIVEN))
    return [
        f"results/{later}/changes/{earlier}/changes.{suffix}"
        for earlier, later in pairs
        for suffix in (*CHANGES, *with_model(later))
    ]


def surveys_of_floors():
    """The floors of the given surveys: floor, survey, and the one before it of the same floor."""
    floors = or_end(list_floors, RUN["dataset"])
    return [
        {"floor": floor, "survey": survey, "earlier": earlier}
        for floor, surveys in floors.items()
        for earlier, survey in zip(["", *surveys], surveys)
    ]


def pages_of_floors(wildcards):
    """The pages of what changed on every floor, to which the table leads, and the reports."""
    pages = []
    for of in surveys_of_floors():
        pages += [
            f"results/{of['survey']}/{file}"
            for file in ("report.html", "plan/plan.svg")
        ]
        if of["earlier"]:
            pages.append(f"results/{of['survey']}/changes/{of['earlier']}/changes.html")
    return pages


def tables_of_floors(wildcards):
    """What is told of every floor at every survey, each prefixed by the number of its row."""
    files = {}
    for row, of in enumerate(surveys_of_floors()):
        known = survey_files_of(of["survey"])
        files |= {f"s{row}_{part}": known[part] for part in COMPARED[:8]}
        if of["earlier"]:
            place = f"results/{of['survey']}/changes/{of['earlier']}/changes.parquet"
            files[f"s{row}_changes"] = place
    return files


def with_model(dataset):
    """The suffix of what a dataset's building model says, where it has one."""
    formats = DATASETS[dataset].settings["plan"]["export"]["formats"]
    return ("ifc",) if "ifc" in formats else ()


def design_of(wildcards):
    """The design that the job's dataset is held against."""
    return or_end(choose_design, wildcards.dataset, DATASETS[wildcards.dataset].designs)


def models_of_earlier_design(wildcards):
    """What is left where the job's dataset was held against a building model before, and is no more."""
    return or_end(list_replaced_models, DATASETS[wildcards.dataset])


def deviations_of_datasets(wildcards):
    """How every given dataset differs from its design."""
    return [file for of in GIVEN.values() for file in or_end(list_deviations, of)]
