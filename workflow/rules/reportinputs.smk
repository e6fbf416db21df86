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


def page_files(*names):
    """Files that a page is made from: templates, style and script."""
    folder = f"{workflow.basedir}/workflow/report/page"
    return [os.path.relpath(f"{folder}/{name}") for name in names]


REPORT_PAGE = page_files("page.html.j2", "tables.html.j2", "page.css", "page.js")
THESIS_PAGE = [
    *page_files("thesis.html.j2", "thesis.css"),
    os.path.relpath(f"{workflow.basedir}/config/deviations.md"),
]


def report_results(wildcards):
    """The tables and plans whose sizes the report states."""
    return [
        file
        for file in results_of(wildcards.dataset)
        if not file.endswith((".html", ".svg"))
    ]
