# Long recordings: each stage that treats scans one by one is a job for each chunk of the scans, and one
# that joins their tables to the same bytes.


ruleorder: gather_chunks > observe_walls
ruleorder: gather_chunks > build_visibility
ruleorder: gather_chunks > build_hulls
ruleorder: gather_wall_chunks > extract_walls


use rule observe_walls as observe_walls_chunk with:
    output:
        observations=temp("results/{dataset}/observations_{chunk}.parquet"),
    log:
        "logs/{dataset}/observe_walls_{chunk}.log",
    benchmark:
        "benchmarks/{dataset}/observe_walls_{chunk}.tsv"


use rule build_visibility as build_visibility_chunk with:
    output:
        visibility=temp("results/{dataset}/visibility_{chunk}.parquet"),
    log:
        "logs/{dataset}/build_visibility_{chunk}.log",
    benchmark:
        "benchmarks/{dataset}/build_visibility_{chunk}.tsv"


use rule build_hulls as build_hulls_chunk with:
    output:
        hulls=temp("results/{dataset}/hulls_{chunk}.parquet"),
    log:
        "logs/{dataset}/build_hulls_{chunk}.log",
    benchmark:
        "benchmarks/{dataset}/build_hulls_{chunk}.tsv"


use rule extract_walls as extract_walls_chunk with:
    output:
        walls=temp("results/{dataset}/walls/{extractor}_{chunk}.parquet"),
    log:
        "logs/{dataset}/extract_walls_{extractor}_{chunk}.log",
    benchmark:
        "benchmarks/{dataset}/extract_walls_{extractor}_{chunk}.tsv"


def chunks_of_table(wildcards):
    """The tables of a dataset's chunks, in the order of their scans."""
    table = wildcards.get("table") or f"walls/{wildcards.extractor}"
    return [
        f"results/{wildcards.dataset}/{table}_{chunk}.parquet"
        for chunk in chunks_of(wildcards.dataset)
    ]


rule gather_chunks:
    """Join the tables of the chunks of a dataset's scans."""
    input:
        chunks=chunks_of_table,
        scans="results/{dataset}/scans.parquet",
    output:
        gathered="results/{dataset}/{table}.parquet",
    log:
        "logs/{dataset}/gather_chunks_{table}.log",
    benchmark:
        "benchmarks/{dataset}/gather_chunks_{table}.tsv"
    wildcard_constraints:
        dataset=match_names(CHUNKED),
        table="observations|visibility|hulls",
    threads: 1
    resources:
        mem_mb=grown(mem_mb=1500),
        runtime=grown(runtime=10),
    params:
        code=code_of("gather_chunks"),
    script:
        "../../scripts/gather_chunks.py"


use rule gather_chunks as gather_wall_chunks with:
    output:
        gathered="results/{dataset}/walls/{extractor}.parquet",
    log:
        "logs/{dataset}/gather_wall_chunks_{extractor}.log",
    benchmark:
        "benchmarks/{dataset}/gather_wall_chunks_{extractor}.tsv"
    wildcard_constraints:
        dataset=match_names(CHUNKED),
