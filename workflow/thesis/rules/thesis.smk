rule thesis:
    """Repeat the experiments of the thesis."""
    input:
        "results/thesis/report.html",


rule measure_coverage:
    """Measure covered areas by number of clusters, and against what scans truly see."""
    input:
        scans="results/{dataset}/scans.parquet",
        hulls="results/{dataset}/hulls.parquet",
        registration="results/{dataset}/registration.parquet",
        truth=product.true_faces,
        true_poses=product.true_poses,
    output:
        clusters="results/{dataset}/thesis/clusters.parquet",
        areas="results/{dataset}/thesis/areas.parquet",
    log:
        "logs/{dataset}/measure_coverage.log",
    benchmark:
        "benchmarks/{dataset}/measure_coverage.tsv"
    threads: 2
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=code_of("measure_coverage"),
        n_clusters=product.section("thesis", "n_clusters"),
        hulls=product.setting(stage_settings.select_hulls),
        max_range_m=product.section("input", "max_range_m"),
    script:
        "../../../scripts/thesis/stages/measure_coverage.py"


rule measure_unevenness:
    """Measure what uneven sampling does to a random order and to the area-based one."""
    input:
        scans="results/{dataset}/scans.parquet",
        hulls="results/{dataset}/hulls.parquet",
        registration="results/{dataset}/registration.parquet",
        truth=product.true_faces,
        true_poses=product.true_poses,
    output:
        unevenness="results/{dataset}/thesis/unevenness.parquet",
    log:
        "logs/{dataset}/measure_unevenness.log",
    benchmark:
        "benchmarks/{dataset}/measure_unevenness.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=code_of("measure_unevenness"),
        hulls=product.setting(stage_settings.select_hulls),
        max_range_m=product.section("input", "max_range_m"),
        n_selected=stated_claims.Sizes.SUBSET,
    script:
        "../../../scripts/thesis/stages/measure_unevenness.py"


rule measure_premises:
    """Measure whether utilities are submodular and clusters of points are one wall each."""
    input:
        **SURVEYED,
    output:
        premises="results/{dataset}/thesis/premises.parquet",
    log:
        "logs/{dataset}/measure_premises.log",
    benchmark:
        "benchmarks/{dataset}/measure_premises.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=code_of("measure_premises"),
        extraction=product.setting(stage_settings.select_extractor, "cluster_ransac"),
        evaluation=evaluation_of_survey,
        n_added=stated_claims.Sizes.SUBSET,
    script:
        "../../../scripts/thesis/stages/measure_premises.py"


rule time_stages:
    """Time extraction scan by scan and selection by number of scans, with all cores to itself."""
    input:
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
        hulls="results/{dataset}/hulls.parquet",
        segments="results/{dataset}/walls/cluster_ransac.parquet",
    output:
        times="results/{dataset}/thesis/times.parquet",
    log:
        "logs/{dataset}/time_stages.log",
    benchmark:
        "benchmarks/{dataset}/time_stages.tsv"
    threads: product.all_cores
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=code_of("time_stages"),
        walls=product.setting(stage_settings.select_extractors, product.EXTRACTORS),
        hulls=product.setting(stage_settings.select_hull_sampling),
        n_clusters=product.section("thesis", "n_clusters"),
        timed_scans=product.section("thesis", "timed_scans"),
        merge=product.setting(stage_settings.select_merging),
        whole=is_drive,
    script:
        "../../../scripts/thesis/stages/time_stages.py"


rule measure_candidates:
    """Measure how many candidates RANSAC with removal of inliers finds for a wall."""
    input:
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
        truth=product.true_faces,
    output:
        candidates="results/{dataset}/thesis/candidates.parquet",
    log:
        "logs/{dataset}/measure_candidates.log",
    benchmark:
        "benchmarks/{dataset}/measure_candidates.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=code_of("measure_candidates"),
        walls=product.setting(
            stage_settings.select_extractor, "thesis_iterative_ransac"
        ),
        n_scans=8,
    script:
        "../../../scripts/thesis/stages/measure_candidates.py"


rule tabulate_steps:
    """Tabulate time, scans and data after each step."""
    input:
        recordings=product.recordings,
        true_poses=product.true_poses,
        registration="results/{dataset}/registration.parquet",
        scans="results/{dataset}/scans.parquet",
        hulls="results/{dataset}/hulls.parquet",
        selection="results/{dataset}/selection/cluster_hull.parquet",
        registering=[
            "benchmarks/{dataset}/interpolate_poses.tsv",
            "benchmarks/{dataset}/register_scans.tsv",
        ],
        hulling=["benchmarks/{dataset}/build_hulls.tsv"],
        ordering=["benchmarks/{dataset}/order_scans_cluster_hull.tsv"],
    output:
        steps="results/{dataset}/thesis/steps.parquet",
    log:
        "logs/{dataset}/tabulate_steps.log",
    benchmark:
        "benchmarks/{dataset}/tabulate_steps.tsv"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        code=code_of("tabulate_steps"),
        n_selected=stated_claims.Sizes.SUBSET,
    script:
        "../../../scripts/thesis/stages/tabulate_steps.py"


rule judge_claims:
    """Measure every claim of the thesis on every seed."""
    input:
        **evidence(),
    output:
        claims="results/thesis/claims.parquet",
    log:
        "logs/thesis/judge_claims.log",
    benchmark:
        "benchmarks/thesis/judge_claims.tsv"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        code=code_of("judge_claims"),
        rooms_seeds=seeds_of(experiments.ROOMS),
        drive_seeds=seeds_of(experiments.DRIVE),
    script:
        "../../../scripts/thesis/stages/judge_claims.py"


rule draw_thesis_rooms:
    """Draw the thesis's figures of the synthetic survey from the survey of the rooms."""
    input:
        **first_of(
            experiments.ROOMS,
            "scans",
            "registration",
            "hulls",
            "selection/cluster_hull",
            "selection/hull",
            "selection/sequential",
            "walls/cluster_ransac",
            "thesis/clusters",
        ),
        truth=THESIS[experiments.ROOMS][0].truth[0],
        true_poses=THESIS[experiments.ROOMS][0].truth[1],
        evaluated=of_kind(experiments.ROOMS, "evaluation/walls"),
    output:
        figures=figures_of(*ROOMS_FIGURES),
        orders="results/thesis/figures/orders.svg",
    log:
        "logs/thesis/draw_thesis_rooms.log",
    benchmark:
        "benchmarks/thesis/draw_thesis_rooms.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=code_of("draw_thesis_rooms"),
        bitmap_cell_m=THESIS[experiments.ROOMS][0].settings["evaluation"][
            "bitmap_cell_m"
        ],
        max_range_m=THESIS[experiments.ROOMS][0].settings["input"]["max_range_m"],
        extraction=stage_settings.select_extractor(
            THESIS[experiments.ROOMS][0].settings, "cluster_ransac"
        ),
    script:
        "../../../scripts/thesis/stages/draw_thesis_rooms.py"


rule draw_thesis_drive:
    """Draw the thesis's figures of the real survey from the drive."""
    input:
        **first_of(
            experiments.DRIVE,
            "scans",
            "registration",
            "selection/cluster_hull",
            "walls/cluster_ransac",
            "walls/iterative_ransac",
            "thesis/times",
        ),
    output:
        figures=figures_of(*DRIVE_FIGURES),
    log:
        "logs/thesis/draw_thesis_drive.log",
    benchmark:
        "benchmarks/thesis/draw_thesis_drive.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=code_of("draw_thesis_drive"),
    script:
        "../../../scripts/thesis/stages/draw_thesis_drive.py"


rule write_thesis:
    """Write the report of the experiments: figures, table 5.1 and claims beside the thesis's."""
    input:
        figures=figures_of(*ROOMS_FIGURES, *DRIVE_FIGURES),
        orders="results/thesis/figures/orders.svg",
        gates="results/thesis/figures/gates.svg",
        alignments="results/thesis/figures/alignments.svg",
        claims="results/thesis/claims.parquet",
        steps=of_kind(experiments.DRIVE, "thesis/steps")[:1],
        limited=of_kind(experiments.LIMITS, "thesis/steps")[:1],
        page=THESIS_PAGE,
    output:
        page="results/thesis/report.html",
    log:
        "logs/thesis/write_thesis.log",
    benchmark:
        "benchmarks/thesis/write_thesis.tsv"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        code=code_of("write_thesis"),
    script:
        "../../../scripts/thesis/stages/write_thesis.py"
