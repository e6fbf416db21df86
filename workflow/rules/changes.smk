# what changed is between two surveys
if len(GIVEN) > 1:

    rule compare_surveys:
        """Tell what changed on a floor between an earlier survey of it and a later one."""
        input:
            **plan_of("a"),
            **plan_of("b"),
            page=CHANGES_PAGE,
        output:
            table="results/{dataset}/changes/{earlier}/changes.parquet",
            geojson="results/{dataset}/changes/{earlier}/changes.geojson",
            svg="results/{dataset}/changes/{earlier}/changes.svg",
            pdf="results/{dataset}/changes/{earlier}/changes.pdf",
            png="results/{dataset}/changes/{earlier}/changes.png",
            dxf="results/{dataset}/changes/{earlier}/changes.dxf",
            page="results/{dataset}/changes/{earlier}/changes.html",
            summary="results/{dataset}/changes/{earlier}/changes.txt",
        log:
            "logs/{dataset}/compare_surveys_{earlier}.log",
        benchmark:
            "benchmarks/{dataset}/compare_surveys_{earlier}.tsv"
        wildcard_constraints:
            earlier=match_names(DATASETS),
        threads: 1
        resources:
            mem_mb=grown(mem_mb=3000),
            runtime=grown(runtime=20),
        params:
            code=code_of("compare_surveys"),
            settings=setting(stage_settings.select_drawing),
        script:
            "../../scripts/compare_surveys.py"

    rule annotate_changes:
        """Write a copy of the later survey's building model that says what changed."""
        input:
            table="results/{dataset}/changes/{earlier}/changes.parquet",
            ids="results/{dataset}/plan/ids.parquet",
            model="results/{dataset}/plan/plan.ifc",
        output:
            annotated="results/{dataset}/changes/{earlier}/changes.ifc",
        log:
            "logs/{dataset}/annotate_changes_{earlier}.log",
        benchmark:
            "benchmarks/{dataset}/annotate_changes_{earlier}.tsv"
        wildcard_constraints:
            earlier=match_names(DATASETS),
        threads: 1
        resources:
            mem_mb=grown(mem_mb=2000),
            runtime=grown(runtime=10),
        params:
            code=code_of("annotate_changes"),
        script:
            "../../scripts/annotate_changes.py"


rule changes:
    """Tell what changed from each given dataset to the next, surveys of one floor in their order."""
    input:
        changes_of_datasets,
