rule extract_walls:
    """Find the wall segments that each scan shows."""
    input:
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
        code=code_of("extract_walls"),
    output:
        walls="results/{dataset}/walls/{extractor}.parquet",
    log:
        "logs/{dataset}/extract_walls_{extractor}.log",
    benchmark:
        "benchmarks/{dataset}/extract_walls_{extractor}.tsv"
    threads: 2
    resources:
        mem_mb=2000,
        runtime=60,
    params:
        settings=extractor_settings,
    script:
        "../../scripts/extract_walls.py"
