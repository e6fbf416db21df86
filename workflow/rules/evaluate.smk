rule evaluate_walls:
    """Measure what the first scans of every ordering show against the true walls."""
    input:
        walls=all_walls,
        selections=all_selections,
        registration="results/{dataset}/registration.parquet",
        truth=true_faces,
        true_poses=true_poses,
    output:
        walls="results/{dataset}/evaluation/walls.parquet",
        aligned="results/{dataset}/evaluation/walls_aligned.parquet",
        oracle="results/{dataset}/evaluation/oracle.parquet",
    log:
        "logs/{dataset}/evaluate_walls.log",
    benchmark:
        "benchmarks/{dataset}/evaluate_walls.tsv"
    threads: 1
    resources:
        mem_mb=2000,
        runtime=30,
    params:
        code=code_of("evaluate_walls"),
        max_range_m=section("input", "max_range_m"),
        settings=section("evaluation"),
    script:
        "../../scripts/evaluate_walls.py"


rule tabulate_seconds:
    """State how long ordering and extraction take for the first scans."""
    input:
        walls="results/{dataset}/evaluation/walls.parquet",
        ordering=expand(
            "benchmarks/{{dataset}}/order_scans_{method}.tsv", method=METHODS
        ),
        extraction=extraction_times,
    output:
        seconds="results/{dataset}/evaluation/seconds.parquet",
    log:
        "logs/{dataset}/tabulate_seconds.log",
    benchmark:
        "benchmarks/{dataset}/tabulate_seconds.tsv"
    threads: 1
    resources:
        mem_mb=500,
        runtime=5,
    params:
        code=code_of("tabulate_seconds"),
    script:
        "../../scripts/tabulate_seconds.py"


rule evaluate_plan:
    """Measure the plan against the true one."""
    input:
        faces=plan_table("faces"),
        walls=plan_table("walls"),
        openings=plan_table("openings"),
        rooms=plan_table("rooms"),
        furniture=plan_table("furniture"),
        free=plan_table("free"),
        evidence=plan_table("evidence"),
        poses="results/{dataset}/poses.parquet",
        registration="results/{dataset}/registration.parquet",
        truth=true_faces,
        true_poses=true_poses,
    output:
        plan="results/{dataset}/evaluation/plan.parquet",
    log:
        "logs/{dataset}/evaluate_plan.log",
    benchmark:
        "benchmarks/{dataset}/evaluate_plan.tsv"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        code=code_of("evaluate_plan"),
        max_range_m=section("input", "max_range_m"),
        settings=section("evaluation"),
    script:
        "../../scripts/evaluate_plan.py"


rule evaluate_poses:
    """Measure the registered poses against the true ones, before and after refinement."""
    input:
        poses="results/{dataset}/poses.parquet",
        registration="results/{dataset}/registration.parquet",
        true_poses=true_poses,
    output:
        poses="results/{dataset}/evaluation/poses.parquet",
    log:
        "logs/{dataset}/evaluate_poses.log",
    benchmark:
        "benchmarks/{dataset}/evaluate_poses.tsv"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        code=code_of("evaluate_poses"),
    script:
        "../../scripts/evaluate_poses.py"


rule draw_evaluation:
    """Draw completeness and bitmap metrics against the number of scans, for every ordering."""
    input:
        walls="results/{dataset}/evaluation/walls.parquet",
        aligned="results/{dataset}/evaluation/walls_aligned.parquet",
    output:
        figure=report(
            "results/{dataset}/figures/evaluation.svg",
            caption="../report/evaluation.rst",
            category="{dataset}",
            labels={"figure": "5 walls against the truth"},
        ),
        shares=report(
            "results/{dataset}/figures/oracle_shares.svg",
            caption="../report/oracle_shares.rst",
            category="{dataset}",
            labels={"figure": "6 orderings against the oracle"},
        ),
    log:
        "logs/{dataset}/draw_evaluation.log",
    benchmark:
        "benchmarks/{dataset}/draw_evaluation.tsv"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        code=code_of("draw_evaluation"),
        method=section("plan", "method"),
        extractor=section("plan", "extractor"),
    script:
        "../../scripts/draw_evaluation.py"
