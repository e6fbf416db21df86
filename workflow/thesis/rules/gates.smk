rule sweep_gates:
    """Pass a drive through the gates of the thesis's algorithm 3 at several fitness distances."""
    input:
        recordings=product.recordings,
        poses="results/{dataset}/poses.parquet",
        true_poses=product.true_poses,
    output:
        gates="results/{dataset}/thesis/gates.parquet",
        alignments="results/{dataset}/thesis/alignments.parquet",
    log:
        "logs/{dataset}/sweep_gates.log",
    benchmark:
        "benchmarks/{dataset}/sweep_gates.tsv"
    threads: 1
    resources:
        mem_mb=2000,
        runtime=60,
    params:
        code=code_of("sweep_gates"),
        reading=product.section("input"),
        settings=product.section("registration"),
    script:
        "../../../scripts/thesis/stages/sweep_gates.py"


rule draw_gates:
    """Draw what survives algorithm 3's gates on the first drive, and what fitness rewards."""
    input:
        gates=of_kind(experiments.LIMITS, "thesis/gates")[0],
        alignments=of_kind(experiments.LIMITS, "thesis/alignments")[0],
    output:
        gates="results/thesis/figures/gates.svg",
        alignments="results/thesis/figures/alignments.svg",
    log:
        "logs/thesis/draw_gates.log",
    benchmark:
        "benchmarks/thesis/draw_gates.tsv"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        code=code_of("draw_gates"),
    script:
        "../../../scripts/thesis/stages/draw_gates.py"
