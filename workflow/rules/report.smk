rule draw_figures:
    """Draw the registration, the scans and their selection, the walls over points, the validation, deviations."""
    input:
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
        edges="results/{dataset}/edges.parquet",
        crispness=if_kept("results/{dataset}/crispness.parquet"),
        selection=plan_selection,
        faces=plan_table("faces"),
        free=plan_table("free"),
        elements=if_kept("results/{dataset}/plan/validation.parquet"),
        rays=if_kept("results/{dataset}/plan/validation_rays.parquet"),
    output:
        registration=report(
            "results/{dataset}/figures/registration.svg",
            caption="../report/registration.rst",
            category="{dataset}",
            labels={"figure": "7 registration"},
        ),
        scans=report(
            "results/{dataset}/figures/scans.svg",
            caption="../report/scans.rst",
            category="{dataset}",
            labels={"figure": "2 scans and selection"},
        ),
        walls=report(
            "results/{dataset}/figures/walls.svg",
            caption="../report/walls.rst",
            category="{dataset}",
            labels={"figure": "4 walls over points"},
        ),
        validation=report(
            "results/{dataset}/figures/validation.svg",
            caption="../report/validation.rst",
            category="{dataset}",
            labels={"figure": "8 prediction of other scans"},
        ),
        deviation=report(
            "results/{dataset}/figures/deviation.svg",
            caption="../report/deviation.rst",
            category="{dataset}",
            labels={"figure": "9 points against the plan"},
        ),
    log:
        "logs/{dataset}/draw_figures.log",
    benchmark:
        "benchmarks/{dataset}/draw_figures.tsv"
    threads: 1
    resources:
        mem_mb=grown(mem_mb=1500),
        runtime=grown(runtime=10),
    params:
        code=code_of("draw_figures"),
        stop=section("selection", "stop"),
    script:
        "../../scripts/draw_figures.py"


# what a report is made of, with a comparison or without
REPORT_TABLES = {
    "faces": plan_table("faces"),
    "walls": plan_table("walls"),
    "openings": plan_table("openings"),
    "rooms": plan_table("rooms"),
    "free": plan_table("free"),
    "furniture": plan_table("furniture"),
    "evidence": plan_table("evidence"),
    "validation": if_kept("results/{dataset}/plan/validation.parquet"),
    "questions": if_kept("results/{dataset}/plan/questions.parquet"),
    "standpoints": if_kept("results/{dataset}/plan/standpoints.parquet"),
    "scans": "results/{dataset}/scans.parquet",
    "confidence": if_kept("results/{dataset}/plan/confidence.parquet"),
    "selection": plan_selection,
    "segments": "results/{dataset}/plan/segments.parquet",
    "poses": "results/{dataset}/poses.parquet",
    "registration": "results/{dataset}/registration.parquet",
    "recordings": recordings,
    "corrections": corrections,
    "page": REPORT_PAGE,
}


rule write_report:
    """Write the report: one page that opens offline."""
    input:
        **REPORT_TABLES,
        figures=figures_among(results_of),
        evaluation=evaluated("plan"),
        results=files_beside(results_of),
    output:
        page="results/{dataset}/report.html",
        summary="results/{dataset}/summary.txt",
    log:
        "logs/{dataset}/write_report.log",
    benchmark:
        "benchmarks/{dataset}/write_report.tsv"
    threads: 1
    resources:
        mem_mb=grown(mem_mb=1500),
        runtime=grown(runtime=10),
    params:
        code=code_of("write_report"),
        settings=all_settings,
        storeys=storeys_beside,
        run_times=run_times([]),
    script:
        "../../scripts/write_report.py"
