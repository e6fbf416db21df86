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
