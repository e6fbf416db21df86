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
            receiver=words_of_receiver,
        script:
            "../../scripts/compare_surveys.py"

    rule annotate_changes:
        """Write a copy of the later survey's building model that says what changed."""
        input:
            table="results/{dataset}/changes/{earlier}/changes.parquet",
            ids="results/{dataset}/plan/ids.parquet",
            earlier=ids_of_earlier,
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

    rule grow_plan:
        """Make one plan of all surveys of a floor up to this one, and tell what each contributed."""
        input:
            unpack(plans_until),
        output:
            **model_of_all(),
            table="results/{dataset}/grown/grown.parquet",
            csv="results/{dataset}/grown/grown.csv",
            geojson="results/{dataset}/grown/grown.geojson",
            svg="results/{dataset}/grown/grown.svg",
            pdf="results/{dataset}/grown/grown.pdf",
            png="results/{dataset}/grown/grown.png",
            dxf="results/{dataset}/grown/grown.dxf",
            summary="results/{dataset}/grown/grown.txt",
        log:
            "logs/{dataset}/grow_plan.log",
        benchmark:
            "benchmarks/{dataset}/grow_plan.tsv"
        wildcard_constraints:
            dataset=match_names(list(GIVEN)[1:]),
        threads: 2
        resources:
            mem_mb=grown(mem_mb=4000),
            runtime=grown(runtime=60),
        params:
            code=code_of("grow_plan"),
            names=lambda wildcards: surveys_until(wildcards.dataset),
            settings=all_settings,
            receiver=words_of_receiver,
        script:
            "../../scripts/grow_plan.py"


rule changes:
    """Tell what changed from each given dataset to the next, surveys of one floor in their order."""
    input:
        changes_of_datasets,


rule grown:
    """Make one plan of all given surveys of a floor, in their order, and tell what changed."""
    input:
        grown_datasets,


rule floors:
    """Tell of all floors over time: areas, doors, and what changed from each survey to the next."""
    input:
        unpack(tables_of_floors),
        # which the table leads to
        beside=pages_of_floors,
        page=FLOORS_PAGE,
    output:
        csv="results/floors.csv",
        page="results/floors.html",
    log:
        "logs/list_floors.log",
    benchmark:
        "benchmarks/list_floors.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=code_of("list_floors"),
        surveys=lambda wildcards: surveys_of_floors(),
    script:
        "../../scripts/list_floors.py"
