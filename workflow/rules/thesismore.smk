rule thesis_more:
    """Make the experiments that go beyond the thesis's own."""
    input:
        "results/thesis/more.html",


rule choose_by_confidence:
    """Order scans by the confidence of the walls of those chosen before, and measure what they find."""
    input:
        observations="results/{dataset}/observations.parquet",
        walls="results/{dataset}/walls/cluster_ransac.parquet",
        registration="results/{dataset}/registration.parquet",
        truth=true_faces,
        true_poses=true_poses,
    output:
        confidence="results/{dataset}/thesis/confidence.parquet",
    log:
        "logs/{dataset}/choose_by_confidence.log",
    benchmark:
        "benchmarks/{dataset}/choose_by_confidence.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=code_of("choose_by_confidence"),
        cells=section("selection", "wall_length"),
        sigma_m=section("plan", "merge", "tolerance_m"),
        max_range_m=section("input", "max_range_m"),
        evaluation=section("evaluation"),
    script:
        "../../scripts/choose_by_confidence.py"


rule measure_surrogates:
    """Measure how well what orders maximise stands for the walls found."""
    input:
        observations="results/{dataset}/observations.parquet",
        visibility="results/{dataset}/visibility.parquet",
        hulls="results/{dataset}/hulls.parquet",
        walls="results/{dataset}/walls/cluster_ransac.parquet",
        registration="results/{dataset}/registration.parquet",
        truth=true_faces,
        true_poses=true_poses,
    output:
        surrogates="results/{dataset}/thesis/surrogates.parquet",
    log:
        "logs/{dataset}/measure_surrogates.log",
    benchmark:
        "benchmarks/{dataset}/measure_surrogates.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=code_of("measure_surrogates"),
        max_range_m=section("input", "max_range_m"),
        evaluation=section("evaluation"),
        n_added=stated_claims.Sizes.SUBSET,
        seed=section("seed"),
    script:
        "../../scripts/measure_surrogates.py"


rule write_thesis_more:
    """Write the page of the experiments that go beyond the thesis's own."""
    input:
        evaluated=of_kind(experiments.ROOMS, "evaluation/walls"),
        chosen=of_kind(experiments.ROOMS, "thesis/confidence"),
        surrogates=of_kind(experiments.ROOMS, "thesis/surrogates"),
        page=page_files("thesis_more.html.j2", "thesis.css"),
    output:
        page="results/thesis/more.html",
    log:
        "logs/thesis/write_thesis_more.log",
    benchmark:
        "benchmarks/thesis/write_thesis_more.tsv"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        code=code_of("write_thesis_more"),
    script:
        "../../scripts/write_thesis_more.py"
