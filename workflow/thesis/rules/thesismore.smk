rule thesis_more:
    """Make the experiments that go beyond the thesis's own."""
    input:
        "results/thesis/more.html",


rule choose_by_confidence:
    """Order scans by the confidence of the walls of those chosen before, and measure what they find."""
    input:
        observations="results/{dataset}/observations.parquet",
        walls="results/{dataset}/walls/cluster_ransac.parquet",
        registration="results/{dataset}/registration.parquet",
        truth=product.true_faces,
        true_poses=product.true_poses,
    output:
        confidence="results/{dataset}/thesis/confidence.parquet",
    log:
        "logs/{dataset}/choose_by_confidence.log",
    benchmark:
        "benchmarks/{dataset}/choose_by_confidence.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=code_of("choose_by_confidence"),
        cells=product.section("selection", "wall_length"),
        sigma_m=product.section("plan", "merge", "tolerance_m"),
        max_range_m=product.section("input", "max_range_m"),
        evaluation=product.section("evaluation"),
    script:
        "../../../scripts/thesis/stages/choose_by_confidence.py"


rule measure_surrogates:
    """Measure how well what orders maximise stands for the walls found."""
    input:
        **SURVEYED,
        observations="results/{dataset}/observations.parquet",
        visibility="results/{dataset}/visibility.parquet",
        hulls="results/{dataset}/hulls.parquet",
    output:
        surrogates="results/{dataset}/thesis/surrogates.parquet",
    log:
        "logs/{dataset}/measure_surrogates.log",
    benchmark:
        "benchmarks/{dataset}/measure_surrogates.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=code_of("measure_surrogates"),
        evaluation=evaluation_of_survey,
        n_added=stated_claims.Sizes.SUBSET,
        seed=product.section("seed"),
    script:
        "../../../scripts/thesis/stages/measure_surrogates.py"


rule compare_budgets:
    """Compare whole scans with all scans thinned, at the same number of points."""
    input:
        **SURVEYED,
        **orders_by("wall_length", "cluster_hull", "every_nth"),
    output:
        budgets="results/{dataset}/thesis/budgets.parquet",
    log:
        "logs/{dataset}/compare_budgets.log",
    benchmark:
        "benchmarks/{dataset}/compare_budgets.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=code_of("compare_budgets"),
        evaluation=evaluation_of_survey,
        extraction=product.setting(stage_settings.select_extractor, "cluster_ransac"),
        # few, as the thesis's subset, and ever twice as many
        sizes=[5, 10, 20, 40],
        seed=product.section("seed"),
    script:
        "../../../scripts/thesis/stages/compare_budgets.py"


rule time_to_quality:
    """Time how long it takes to a good plan, selection included, with all cores to itself."""
    input:
        **SURVEYED,
        recorded=[
            "benchmarks/{dataset}/interpolate_poses.tsv",
            "benchmarks/{dataset}/register_scans.tsv",
        ],
    output:
        times="results/{dataset}/thesis/quality_times.parquet",
    log:
        "logs/{dataset}/time_to_quality.log",
    benchmark:
        "benchmarks/{dataset}/time_to_quality.tsv"
    threads: product.all_cores
    resources:
        mem_mb=2500,
        runtime=30,
    params:
        code=code_of("time_to_quality"),
        evaluation=evaluation_of_survey,
        settings=settings_of_search("extraction", "plan", "cells", "hulls"),
        # a plan of the rooms is good with some twenty scans at best
        sizes=[10, 20, 30, 40, 60, 80, 120],
    script:
        "../../../scripts/thesis/stages/time_to_quality.py"


rule count_room_scans:
    """Count the scans that floors drawn at random need, by their number of rooms."""
    output:
        floors="results/thesis/floors_{floor_seed}.parquet",
    log:
        "logs/thesis/count_room_scans_{floor_seed}.log",
    benchmark:
        "benchmarks/thesis/count_room_scans_{floor_seed}.tsv"
    wildcard_constraints:
        floor_seed=r"\d+",
    threads: 1
    resources:
        mem_mb=2500,
        runtime=60,
    params:
        code=code_of("count_room_scans"),
        n_rooms=thesis_setting("n_rooms"),
        settings=settings_of_search("simulation", "extraction", "cells"),
    script:
        "../../../scripts/thesis/stages/count_room_scans.py"


rule measure_outliers:
    """Measure what stray returns, glass and people do to what scans cover, and to orders by it."""
    input:
        **SURVEYED,
    output:
        outliers="results/{dataset}/thesis/outliers.parquet",
    log:
        "logs/{dataset}/measure_outliers.log",
    benchmark:
        "benchmarks/{dataset}/measure_outliers.tsv"
    threads: 1
    resources:
        mem_mb=2500,
        runtime=30,
    params:
        code=code_of("measure_outliers"),
        evaluation=evaluation_of_survey,
        settings=settings_of_search("hulls", "visibility", "cells"),
        shares=product.section("thesis", "outlier_shares"),
        n_scans=product.section("thesis", "timed_scans"),
        n_selected=stated_claims.Sizes.SUBSET,
        seed=product.section("seed"),
    script:
        "../../../scripts/thesis/stages/measure_outliers.py"


rule measure_registrability:
    """Measure whether chosen scans could be registered on their own."""
    input:
        **SURVEYED,
        **orders_by("wall_length", "cluster_hull", "every_nth", "distance"),
    output:
        registrability="results/{dataset}/thesis/registrability.parquet",
    log:
        "logs/{dataset}/measure_registrability.log",
    benchmark:
        "benchmarks/{dataset}/measure_registrability.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=code_of("measure_registrability"),
        evaluation=evaluation_of_survey,
        registration=product.section("registration"),
        sizes=[10, 20, 40, 80, 160],
        seed=product.section("seed"),
    script:
        "../../../scripts/thesis/stages/measure_registrability.py"


rule choose_live:
    """Choose scans as if the recording played, and measure what they find."""
    input:
        **SURVEYED,
        **orders_by("wall_length", "every_nth", "distance"),
        observations="results/{dataset}/observations.parquet",
    output:
        chosen="results/{dataset}/thesis/live_choice.parquet",
    log:
        "logs/{dataset}/choose_live.log",
    benchmark:
        "benchmarks/{dataset}/choose_live.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=code_of("choose_live"),
        evaluation=evaluation_of_survey,
        # from nearly all scans to a seventh of them
        shares=[0.05, 0.1, 0.2, 0.3, 0.5],
        playing=product.section("selection", "playing"),
    script:
        "../../../scripts/thesis/stages/choose_live.py"


rule measure_sensitivity:
    """Judge claims with the numbers that the thesis does not state halved and doubled."""
    input:
        **SURVEYED,
    output:
        sensitivity="results/{dataset}/thesis/sensitivity.parquet",
    log:
        "logs/{dataset}/measure_sensitivity.log",
    benchmark:
        "benchmarks/{dataset}/measure_sensitivity.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=code_of("measure_sensitivity"),
        evaluation=evaluation_of_survey,
        extraction=product.setting(stage_settings.select_extractor, "cluster_ransac"),
        hulls=product.setting(stage_settings.select_hulls),
        factors=[0.5, 1.0, 2.0],
    script:
        "../../../scripts/thesis/stages/measure_sensitivity.py"


rule write_thesis_more:
    """Write the page of the experiments that go beyond the thesis's own."""
    input:
        **{
            name: of_kind(experiments.ROOMS, f"thesis/{name}")[surveys]
            for name, surveys in FURTHER_EXPERIMENTS.items()
        },
        evaluated=of_kind(experiments.ROOMS, "evaluation/walls"),
        chosen=of_kind(experiments.ROOMS, "thesis/confidence"),
        surrogates=of_kind(experiments.ROOMS, "thesis/surrogates"),
        floors=expand(
            "results/thesis/floors_{floor_seed}.parquet",
            floor_seed=thesis_setting("floor_seeds"),
        ),
        page=page_files("thesis_more.html.j2", "thesis.css"),
    output:
        page="results/thesis/more.html",
    log:
        "logs/thesis/write_thesis_more.log",
    benchmark:
        "benchmarks/thesis/write_thesis_more.tsv"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        code=code_of("write_thesis_more"),
    script:
        "../../../scripts/thesis/stages/write_thesis_more.py"
