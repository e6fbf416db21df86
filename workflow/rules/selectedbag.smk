rule write_selected_bag:
    """Write the scans that make the plan as a recording of their own, and settings to read it with."""
    input:
        recordings=recordings,
        selection=plan_selection,
        registration="results/{dataset}/registration.parquet",
    output:
        recording="results/{dataset}/selected.{suffix}",
        settings="results/{dataset}/selected.{suffix}.yaml",
    log:
        "logs/{dataset}/write_selected_bag_{suffix}.log",
    benchmark:
        "benchmarks/{dataset}/write_selected_bag_{suffix}.tsv"
    wildcard_constraints:
        suffix="bag|mcap|db3",
    threads: 1
    resources:
        mem_mb=1500,
        runtime=60,
    params:
        code=code_of("write_selected_bag"),
        content=content_of_recordings,
        reading=section("input"),
        stop=section("selection", "stop"),
    script:
        "../../scripts/write_selected_bag.py"


rule write_reduced_bag:
    """Write a recording reduced while it is read to the scans that show new wall, and settings to read it with."""
    input:
        recordings=recordings,
    output:
        recording="results/{dataset}/reduced.{suffix}",
        settings="results/{dataset}/reduced.{suffix}.yaml",
    log:
        "logs/{dataset}/write_reduced_bag_{suffix}.log",
    benchmark:
        "benchmarks/{dataset}/write_reduced_bag_{suffix}.tsv"
    wildcard_constraints:
        suffix="bag|mcap|db3",
    threads: 1
    resources:
        mem_mb=1500,
        runtime=60,
    params:
        code=code_of("write_reduced_bag"),
        content=content_of_recordings,
        reading=section("input"),
        poses=section("poses"),
        cells=setting(stage_settings.select_wall_cells, methods.WALL_LIMITS),
        playing=section("selection", "playing"),
    script:
        "../../scripts/write_reduced_bag.py"
