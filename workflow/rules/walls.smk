# a plan is made of the walls of chosen scans; extractors are compared by those of all
if LABORATORY:

    rule extract_walls:
        """Find the wall segments that each scan shows."""
        input:
            scans="results/{dataset}/scans.parquet",
            registration="results/{dataset}/registration.parquet",
        output:
            walls="results/{dataset}/walls/{extractor}.parquet",
        log:
            "logs/{dataset}/extract_walls_{extractor}.log",
        benchmark:
            "benchmarks/{dataset}/extract_walls_{extractor}.tsv"
        threads: 2
        resources:
            mem_mb=grown(mem_mb=2000),
            runtime=grown(runtime=60),
        params:
            code=code_of("extract_walls"),
            settings=extractor_settings,
        script:
            "../../scripts/extract_walls.py"


rule extract_chosen_walls:
    """Find the wall segments of the scans that make the plan, as far as they are not known."""
    input:
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
        selection=plan_selection,
    output:
        # the stage takes from the old file what is still good in it
        segments=update("results/{dataset}/plan/segments.parquet"),
    log:
        "logs/{dataset}/extract_chosen_walls.log",
    benchmark:
        "benchmarks/{dataset}/extract_chosen_walls.tsv"
    threads: 2
    resources:
        mem_mb=grown(mem_mb=2000),
        runtime=grown(runtime=60),
    params:
        code=code_of("extract_chosen_walls"),
        extraction_code=code_of("extract_walls"),
        extractor=section("plan", "extractor"),
        settings=plan_extractor_settings,
        stop=section("selection", "stop"),
        # no input: the plan does not wait for the walls of all scans
        walls=plan_walls,
    script:
        "../../scripts/extract_chosen_walls.py"
