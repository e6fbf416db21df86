# Long recordings: registration's batches, and each stage that treats scans one by one, are a job for each
# chunk of the scans, and one that joins what they made to the same bytes.


ruleorder: gather_chunks > observe_walls
ruleorder: gather_scan_chunks > register_scans


rule register_scans_chunk:
    """Register a chunk of a long recording's scans, each after its predecessors."""
    input:
        recordings=recordings,
        poses="results/{dataset}/poses.parquet",
        motion="results/{dataset}/motion.parquet",
    output:
        candidates=temp("results/{dataset}/candidates_{chunk}.parquet"),
        constraints=temp("results/{dataset}/constraints_{chunk}.parquet"),
        points=temp("results/{dataset}/points_{chunk}.parquet"),
        thinned=temp("results/{dataset}/thinned_{chunk}.parquet"),
    log:
        "logs/{dataset}/register_scans_{chunk}.log",
    benchmark:
        "benchmarks/{dataset}/register_scans_{chunk}.tsv"
    threads: registering_threads
    resources:
        mem_mb=grown(mem_mb=1500),
        runtime=grown(runtime=120),
    params:
        code=code_of("register_scans_chunk"),
        content=content_of_recordings,
        reading=section("input"),
        settings=section("registration"),
    script:
        "../../scripts/register_scans_chunk.py"


def chunk_files(what):
    """An input function: files of one kind of all chunks of a dataset, in their order."""

    def files(wildcards):
        folder = f"results/{wildcards.dataset}"
        return [
            f"{folder}/{what}_{chunk}.parquet" for chunk in chunks_of(wildcards.dataset)
        ]

    return files


use rule register_scans as gather_scan_chunks with:
    input:
        recordings=recordings,
        poses="results/{dataset}/poses.parquet",
        motion="results/{dataset}/motion.parquet",
        candidates=chunk_files("candidates"),
        constraints=chunk_files("constraints"),
        points=chunk_files("points"),
        thinned=chunk_files("thinned"),
    wildcard_constraints:
        dataset=match_names(REGISTERED_IN_CHUNKS),


use rule observe_walls as observe_walls_chunk with:
    output:
        observations=temp("results/{dataset}/observations_{chunk}.parquet"),
    log:
        "logs/{dataset}/observe_walls_{chunk}.log",
    benchmark:
        "benchmarks/{dataset}/observe_walls_{chunk}.tsv"


if is_ordered_by("visibility"):

    ruleorder: gather_chunks > build_visibility

    use rule build_visibility as build_visibility_chunk with:
        output:
            visibility=temp("results/{dataset}/visibility_{chunk}.parquet"),
        log:
            "logs/{dataset}/build_visibility_{chunk}.log",
        benchmark:
            "benchmarks/{dataset}/build_visibility_{chunk}.tsv"


if is_ordered_by("hulls"):

    ruleorder: gather_chunks > build_hulls

    use rule build_hulls as build_hulls_chunk with:
        output:
            hulls=temp("results/{dataset}/hulls_{chunk}.parquet"),
        log:
            "logs/{dataset}/build_hulls_{chunk}.log",
        benchmark:
            "benchmarks/{dataset}/build_hulls_{chunk}.tsv"


def chunks_of_table(wildcards):
    """The tables of a dataset's chunks, in the order of their scans."""
    return chunk_files(wildcards.get("table") or f"walls/{wildcards.extractor}")(
        wildcards
    )


rule gather_chunks:
    """Join the tables of the chunks of a dataset's scans."""
    input:
        chunks=chunks_of_table,
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
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


if LABORATORY:

    ruleorder: gather_wall_chunks > extract_walls

    use rule extract_walls as extract_walls_chunk with:
        output:
            walls=temp("results/{dataset}/walls/{extractor}_{chunk}.parquet"),
        log:
            "logs/{dataset}/extract_walls_{extractor}_{chunk}.log",
        benchmark:
            "benchmarks/{dataset}/extract_walls_{extractor}_{chunk}.tsv"

    use rule gather_chunks as gather_wall_chunks with:
        output:
            gathered="results/{dataset}/walls/{extractor}.parquet",
        log:
            "logs/{dataset}/gather_wall_chunks_{extractor}.log",
        benchmark:
            "benchmarks/{dataset}/gather_wall_chunks_{extractor}.tsv"
        wildcard_constraints:
            dataset=match_names(CHUNKED),
