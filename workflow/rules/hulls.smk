if is_ordered_by("hulls"):

    rule build_hulls:
        """Cluster every scan and put a convex hull around each cluster."""
        input:
            scans="results/{dataset}/scans.parquet",
            registration="results/{dataset}/registration.parquet",
        output:
            hulls="results/{dataset}/hulls.parquet",
        log:
            "logs/{dataset}/build_hulls.log",
        benchmark:
            "benchmarks/{dataset}/build_hulls.tsv"
        threads: 2
        resources:
            mem_mb=grown(mem_mb=1500),
            runtime=grown(runtime=30),
        params:
            code=code_of("build_hulls"),
            settings=setting(stage_settings.select_hulls),
        script:
            "../../scripts/build_hulls.py"
