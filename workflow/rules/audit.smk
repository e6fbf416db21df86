rule measure_crispness:
    """Measure how thick the walls of the merged map are."""
    input:
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
        poses="results/{dataset}/poses.parquet",
    output:
        crispness="results/{dataset}/crispness.parquet",
    log:
        "logs/{dataset}/measure_crispness.log",
    benchmark:
        "benchmarks/{dataset}/measure_crispness.tsv"
    # the plan does not wait for it: on two cores it goes beside the plan's validation
    priority: -1
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=code_of("measure_crispness"),
        settings=setting(stage_settings.select_crispness),
    script:
        "../../scripts/measure_crispness.py"
