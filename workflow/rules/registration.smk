rule register_scans:
    """Keep the scans that fit their predecessors, registered in one map."""
    input:
        recordings=recordings,
        poses="results/{dataset}/poses.parquet",
        motion="results/{dataset}/motion.parquet",
    output:
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
        edges="results/{dataset}/edges.parquet",
    log:
        "logs/{dataset}/register_scans.log",
    benchmark:
        "benchmarks/{dataset}/register_scans.tsv"
    threads: registering_threads
    resources:
        mem_mb=grown(mem_mb=1500),
        runtime=grown(runtime=120),
    params:
        code=code_of("register_scans"),
        content=content_of_recordings,
        reading=section("input"),
        settings=section("registration"),
    script:
        "../../scripts/register_scans.py"
