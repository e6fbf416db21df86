rule order_scans:
    """Order the scans by how much each adds to the covered area."""
    input:
        hulls="results/{dataset}/hulls.parquet",
        code=code_of("order_scans"),
    output:
        selection="results/{dataset}/selection/{method}.parquet",
    log:
        "logs/{dataset}/order_scans_{method}.log",
    benchmark:
        "benchmarks/{dataset}/order_scans_{method}.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        seed=setting("selection", "seed"),
    script:
        "../../scripts/order_scans.py"
