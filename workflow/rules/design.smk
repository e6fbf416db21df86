if any(found.designs for found in DATASETS.values()):

    rule compare_design:
        """Tell how what was built differs from its design."""
        input:
            **plan_of("b"),
            design=design_of,
        output:
            table="results/{dataset}/design/deviations.parquet",
            csv="results/{dataset}/design/deviations.csv",
            geojson="results/{dataset}/design/deviations.geojson",
            svg="results/{dataset}/design/deviations.svg",
            pdf="results/{dataset}/design/deviations.pdf",
            png="results/{dataset}/design/deviations.png",
            summary="results/{dataset}/design/deviations.txt",
        log:
            "logs/{dataset}/compare_design.log",
        benchmark:
            "benchmarks/{dataset}/compare_design.tsv"
        threads: 1
        resources:
            mem_mb=grown(mem_mb=3000),
            runtime=grown(runtime=20),
        params:
            code=code_of("compare_design"),
            settings=setting(stage_settings.select_design),
            words=words_of_dataset,
            limits=limits_of_design,
            # of an earlier design, they would tell of that one
            unwanted=models_of_earlier_design,
        script:
            "../../scripts/compare_design.py"

    rule annotate_design:
        """Write a copy of a design that says how it was built, and topics for what differs."""
        input:
            table="results/{dataset}/design/deviations.parquet",
            design=design_of,
            evidence=lambda wildcards: plan_table_of(wildcards.dataset, "evidence"),
        output:
            model="results/{dataset}/design/as_built.ifc",
            topics="results/{dataset}/design/deviations.bcf",
        log:
            "logs/{dataset}/annotate_design.log",
        benchmark:
            "benchmarks/{dataset}/annotate_design.tsv"
        threads: 1
        resources:
            mem_mb=grown(mem_mb=2000),
            runtime=grown(runtime=10),
        params:
            code=code_of("annotate_design"),
            words=words_of_dataset,
        script:
            "../../scripts/annotate_design.py"


rule design:
    """Tell how every given dataset differs from its design."""
    input:
        deviations_of_datasets,
