rule observe_walls:
    """Measure how much wall every scan shows, and where, without extracting walls."""
    input:
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
    output:
        observations="results/{dataset}/observations.parquet",
    log:
        "logs/{dataset}/observe_walls.log",
    benchmark:
        "benchmarks/{dataset}/observe_walls.tsv"
    threads: 2
    resources:
        mem_mb=grown(mem_mb=2000),
        runtime=grown(runtime=30),
    params:
        code=code_of("observe_walls"),
        settings=setting(stage_settings.select_wall_cells, methods.WALL_LIMITS),
    script:
        "../../scripts/observe_walls.py"


if is_ordered_by("visibility"):

    rule build_visibility:
        """Draw the free space that every scan looked through."""
        input:
            scans="results/{dataset}/scans.parquet",
            registration="results/{dataset}/registration.parquet",
        output:
            visibility="results/{dataset}/visibility.parquet",
        log:
            "logs/{dataset}/build_visibility.log",
        benchmark:
            "benchmarks/{dataset}/build_visibility.tsv"
        threads: 2
        resources:
            mem_mb=grown(mem_mb=1500),
            runtime=grown(runtime=30),
        params:
            code=code_of("build_visibility"),
            settings=setting(stage_settings.select_visibility),
        script:
            "../../scripts/build_visibility.py"


rule order_scans:
    """Order the scans by how much each adds to what those before it show."""
    input:
        unpack(order_tables),
        scans="results/{dataset}/scans.parquet",
    output:
        selection="results/{dataset}/selection/{method}.parquet",
    log:
        "logs/{dataset}/order_scans_{method}.log",
    benchmark:
        "benchmarks/{dataset}/order_scans_{method}.tsv"
    threads: ordering_threads
    resources:
        mem_mb=grown(mem_mb=1500),
        runtime=grown(runtime=30),
    params:
        code=code_of("order_scans"),
        settings=order_settings,
    script:
        "../../scripts/order_scans.py"
