def report_figures(wildcards):
    """The figures of a dataset, those of the evaluation last."""
    return [
        file
        for file in results_of(wildcards.dataset)
        if file.startswith(f"results/{wildcards.dataset}/figures")
        and file.endswith(".svg")
    ]


def report_evaluation(wildcards):
    """The measured walls and plan of a dataset, if its truth is known."""
    known = DATASETS[wildcards.dataset].truth
    tables = ["walls", "plan"] if known else []
    return [
        f"results/{wildcards.dataset}/evaluation/{table}.parquet" for table in tables
    ]


def report_page(wildcards):
    """HTML, style and script that the report is made from."""
    return [
        os.path.relpath(f"{workflow.basedir}/workflow/report/page/page.{suffix}")
        for suffix in ("html", "css", "js")
    ]


def report_results(wildcards):
    """The tables and plans whose sizes the report states."""
    return [
        file
        for file in results_of(wildcards.dataset)
        if not file.endswith((".html", ".svg"))
    ]
