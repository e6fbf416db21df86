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


rule compare_surveys:
    """Tell what changed on a floor between an earlier survey of it and a later one."""
    input:
        **plan_of("a"),
        **plan_of("b"),
        page=CHANGES_PAGE,
    output:
        table="results/{dataset}/changes/{earlier}/changes.parquet",
        geojson="results/{dataset}/changes/{earlier}/changes.geojson",
        svg="results/{dataset}/changes/{earlier}/changes.svg",
        pdf="results/{dataset}/changes/{earlier}/changes.pdf",
        png="results/{dataset}/changes/{earlier}/changes.png",
        dxf="results/{dataset}/changes/{earlier}/changes.dxf",
        page="results/{dataset}/changes/{earlier}/changes.html",
        summary="results/{dataset}/changes/{earlier}/changes.txt",
    log:
        "logs/{dataset}/compare_surveys_{earlier}.log",
    benchmark:
        "benchmarks/{dataset}/compare_surveys_{earlier}.tsv"
    wildcard_constraints:
        earlier=match_names(DATASETS),
    threads: 1
    resources:
        mem_mb=grown(mem_mb=3000),
        runtime=grown(runtime=20),
    params:
        code=code_of("compare_surveys"),
        settings=setting(stage_settings.select_drawing),
    script:
        "../../scripts/compare_surveys.py"


def changes_of_datasets(wildcards):
    """What changed in every given dataset since the one that is given before it."""
    pairs = or_end(pair_surveys, list(GIVEN))
    return [
        f"results/{later}/changes/{earlier}/changes.{suffix}"
        for earlier, later in pairs
        for suffix in CHANGES
    ]


rule changes:
    """Tell what changed from each given dataset to the next, surveys of one floor in their order."""
    input:
        changes_of_datasets,
