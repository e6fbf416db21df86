rule comparison:
    """Make the plans, and what they are compared with: all orderings, the walls of all scans."""
    input:
        product.of_all_datasets(product.results_of, product.comparison_of),
        product.results_of_building,


rule evaluate_walls:
    """Measure what the first scans of every ordering show against the true walls."""
    input:
        walls=all_walls,
        selections=all_selections,
        registration="results/{dataset}/registration.parquet",
        truth=product.true_faces,
        true_poses=product.true_poses,
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
        max_range_m=product.section("input", "max_range_m"),
        settings=product.section("evaluation"),
    script:
        "../../../scripts/thesis/stages/evaluate_walls.py"


rule tabulate_seconds:
    """State how long ordering and extraction take for the first scans."""
    input:
        walls="results/{dataset}/evaluation/walls.parquet",
        ordering=expand(
            "benchmarks/{{dataset}}/order_scans_{method}.tsv", method=product.METHODS
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
        "../../../scripts/thesis/stages/tabulate_seconds.py"


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
        method=product.section("plan", "method"),
        extractor=product.section("plan", "extractor"),
    script:
        "../../../scripts/thesis/stages/draw_evaluation.py"


rule draw_area:
    """Draw the covered area against the number of scans, for every ordering."""
    input:
        selections=all_selections,
        hulls="results/{dataset}/hulls.parquet",
    output:
        figure=report(
            "results/{dataset}/figures/area.svg",
            caption="../report/area.rst",
            category="{dataset}",
            labels={"figure": "3 covered area"},
        ),
    log:
        "logs/{dataset}/draw_area.log",
    benchmark:
        "benchmarks/{dataset}/draw_area.tsv"
    threads: 1
    resources:
        mem_mb=product.grown(mem_mb=1000),
        runtime=product.grown(runtime=10),
    params:
        code=code_of("draw_area"),
    script:
        "../../../scripts/thesis/stages/draw_area.py"


# a page of its own: a later run of the plan alone takes nothing from it
rule write_comparison:
    """Write the report once more, with the orderings, extractors and figures of the comparison."""
    input:
        **product.REPORT_TABLES,
        figures=product.figures_among(compared),
        evaluation=product.evaluated("plan", "walls"),
        results=product.files_beside(compared),
    output:
        page="results/{dataset}/comparison.html",
    log:
        "logs/{dataset}/write_comparison.log",
    benchmark:
        "benchmarks/{dataset}/write_comparison.tsv"
    threads: 1
    resources:
        mem_mb=product.grown(mem_mb=1500),
        runtime=product.grown(runtime=10),
    params:
        code=product.code_of("write_report"),
        settings=product.all_settings,
        storeys=product.storeys_beside,
        run_times=product.run_times(
            product.METHODS,
            product.EXTRACTORS,
            ["draw_area", "evaluate_walls", "tabulate_seconds", "draw_evaluation"],
        ),
    script:
        "../../../scripts/write_report.py"
