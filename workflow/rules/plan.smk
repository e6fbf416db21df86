rule assemble_plan:
    """Make faces, walls, openings and rooms of the first scans of an ordering."""
    input:
        walls="results/{dataset}/plan/segments.parquet",
        selection=plan_selection,
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
        design=design_as_prior,
    output:
        faces="results/{dataset}/plan/faces.parquet",
        walls="results/{dataset}/plan/walls.parquet",
        openings="results/{dataset}/plan/openings.parquet",
        rooms="results/{dataset}/plan/rooms.parquet",
        evidence="results/{dataset}/plan/evidence.parquet",
        free="results/{dataset}/plan/free.parquet",
        furniture="results/{dataset}/plan/furniture.parquet",
    log:
        "logs/{dataset}/assemble_plan.log",
    benchmark:
        "benchmarks/{dataset}/assemble_plan.tsv"
    threads: 2
    resources:
        mem_mb=grown(mem_mb=2000),
        runtime=grown(runtime=20),
    params:
        code=code_of("assemble_plan"),
        stop=section("selection", "stop"),
        settings=setting(stage_settings.select_plan),
        storey=section("plan", "design", "storey"),
    script:
        "../../scripts/assemble_plan.py"


if any(found.corrections for found in DATASETS.values()):

    rule correct_plan:
        """Carry out what a person says of the plan in the dataset's folder."""
        input:
            corrections=corrections,
            faces="results/{dataset}/plan/faces.parquet",
            walls="results/{dataset}/plan/walls.parquet",
            openings="results/{dataset}/plan/openings.parquet",
            rooms="results/{dataset}/plan/rooms.parquet",
            evidence="results/{dataset}/plan/evidence.parquet",
            free="results/{dataset}/plan/free.parquet",
            furniture="results/{dataset}/plan/furniture.parquet",
        output:
            faces="results/{dataset}/plan/corrected/faces.parquet",
            walls="results/{dataset}/plan/corrected/walls.parquet",
            openings="results/{dataset}/plan/corrected/openings.parquet",
            rooms="results/{dataset}/plan/corrected/rooms.parquet",
            evidence="results/{dataset}/plan/corrected/evidence.parquet",
            free="results/{dataset}/plan/corrected/free.parquet",
            furniture="results/{dataset}/plan/corrected/furniture.parquet",
        log:
            "logs/{dataset}/correct_plan.log",
        benchmark:
            "benchmarks/{dataset}/correct_plan.tsv"
        threads: 1
        resources:
            mem_mb=1000,
            runtime=5,
        params:
            code=code_of("correct_plan"),
        script:
            "../../scripts/correct_plan.py"


rule validate_plan:
    """Measure how well the plan predicts rays of scans it was not made of; rate its elements."""
    input:
        faces=plan_table("faces"),
        walls=plan_table("walls"),
        openings=plan_table("openings"),
        rooms=plan_table("rooms"),
        free=plan_table("free"),
        selection=plan_selection,
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
    output:
        elements="results/{dataset}/plan/validation.parquet",
        rays="results/{dataset}/plan/validation_rays.parquet",
        confidence="results/{dataset}/plan/confidence.parquet",
    log:
        "logs/{dataset}/validate_plan.log",
    benchmark:
        "benchmarks/{dataset}/validate_plan.tsv"
    threads: 1
    resources:
        mem_mb=grown(mem_mb=2000),
        runtime=grown(runtime=10),
    params:
        code=code_of("validate_plan"),
        stop=section("selection", "stop"),
        settings=setting(stage_settings.select_validation),
    script:
        "../../scripts/validate_plan.py"


rule plan_next_visit:
    """Plan from where a second visit would settle what the plan leaves open."""
    input:
        faces=plan_table("faces"),
        walls=plan_table("walls"),
        openings=plan_table("openings"),
        rooms=plan_table("rooms"),
        free=plan_table("free"),
        confidence="results/{dataset}/plan/confidence.parquet",
        selection=plan_selection,
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
    output:
        questions="results/{dataset}/plan/questions.parquet",
        standpoints="results/{dataset}/plan/standpoints.parquet",
        geojson="results/{dataset}/plan/next_visit.geojson",
    log:
        "logs/{dataset}/plan_next_visit.log",
    benchmark:
        "benchmarks/{dataset}/plan_next_visit.tsv"
    threads: 1
    resources:
        mem_mb=grown(mem_mb=1000),
        runtime=grown(runtime=5),
    params:
        code=code_of("plan_next_visit"),
        stop=section("selection", "stop"),
        settings=setting(stage_settings.select_visit),
        site=section("plan", "export", "site"),
    script:
        "../../scripts/plan_next_visit.py"


rule export_plan:
    """Write the plan as GeoJSON, DXF, SVG, PDF, PNG and as a map for nav2."""
    input:
        faces=plan_table("faces"),
        walls=plan_table("walls"),
        openings=plan_table("openings"),
        rooms=plan_table("rooms"),
        evidence=plan_table("evidence"),
        free=plan_table("free"),
        furniture=plan_table("furniture"),
        confidence=if_kept("results/{dataset}/plan/confidence.parquet"),
    output:
        geojson="results/{dataset}/plan/plan.geojson",
        dxf="results/{dataset}/plan/plan.dxf",
        svg=report(
            "results/{dataset}/plan/plan.svg",
            caption="../report/plan.rst",
            category="{dataset}",
            labels={"figure": "1 floor plan"},
        ),
        pdf="results/{dataset}/plan/plan.pdf",
        png="results/{dataset}/plan/plan.png",
        pgm="results/{dataset}/plan/map.pgm",
        yaml="results/{dataset}/plan/map.yaml",
    log:
        "logs/{dataset}/export_plan.log",
    benchmark:
        "benchmarks/{dataset}/export_plan.tsv"
    # of what waits for the rated plan it takes longest, and the report waits for it
    priority: 1
    threads: 1
    resources:
        mem_mb=grown(mem_mb=1500),
        runtime=grown(runtime=10),
    params:
        code=code_of("export_plan"),
        settings=setting(stage_settings.select_drawing),
        receiver=words_of_receiver,
    script:
        "../../scripts/export_plan.py"


rule export_presentation:
    """Write the plan as a regular drawing with solid walls, and what was changed for it."""
    input:
        faces=plan_table("faces"),
        walls=plan_table("walls"),
        openings=plan_table("openings"),
        rooms=plan_table("rooms"),
        evidence=plan_table("evidence"),
        free=plan_table("free"),
        furniture=plan_table("furniture"),
        confidence=if_kept("results/{dataset}/plan/confidence.parquet"),
    output:
        svg="results/{dataset}/plan/presentation.svg",
        pdf="results/{dataset}/plan/presentation.pdf",
        tiles="results/{dataset}/plan/presentation_a3.pdf",
        png="results/{dataset}/plan/presentation.png",
        dxf="results/{dataset}/plan/presentation.dxf",
        walls="results/{dataset}/plan/presentation.parquet",
    log:
        "logs/{dataset}/export_presentation.log",
    benchmark:
        "benchmarks/{dataset}/export_presentation.tsv"
    priority: 1
    threads: 1
    resources:
        mem_mb=grown(mem_mb=1500),
        runtime=grown(runtime=10),
    params:
        code=code_of("export_presentation"),
        settings=setting(stage_settings.select_presentation),
        receiver=words_of_receiver,
        catalogue=nominal_sizes,
    script:
        "../../scripts/export_presentation.py"


# a rule for every choice of formats, as the files of a rule are the same for all datasets
for number, formats in enumerate(chosen_formats()):

    rule:
        """Write the plan and the sensor's way as files for other programs, with ids that stay."""
        name:
            f"export_files_{number}" if number else "export_files"
        input:
            faces=plan_table("faces"),
            walls=plan_table("walls"),
            openings=plan_table("openings"),
            rooms=plan_table("rooms"),
            free=plan_table("free"),
            furniture=plan_table("furniture"),
            confidence=if_kept("results/{dataset}/plan/confidence.parquet"),
            registration="results/{dataset}/registration.parquet",
            poses="results/{dataset}/poses.parquet",
        output:
            **exported_files(formats),
            ids="results/{dataset}/plan/ids.parquet",
            # the stage takes from the old file what was known, wherever the plan's have gone
            known=update("results/{dataset}/known_elements.parquet"),
        log:
            "logs/{dataset}/export_files.log",
        benchmark:
            "benchmarks/{dataset}/export_files.tsv"
        wildcard_constraints:
            dataset=exported_as(formats),
        threads: 1
        resources:
            mem_mb=grown(mem_mb=1500),
            runtime=grown(runtime=10),
        params:
            code=code_of("export_files"),
            source=source_of_results,
            # of an earlier choice, they would stay as they are while the plan changes
            unwanted=files_unasked_for,
            settings=setting(stage_settings.select_files),
            catalogue=nominal_sizes,
            words=words_of_dataset,
        script:
            "../../scripts/export_files.py"


rule export_cloud:
    """Write the registered points as a LAZ file, and a picture of them from above."""
    input:
        # of stations: they have colours
        recordings=recordings_of_stations,
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
        selection=plan_selection,
        # where reference points place it
        free=plan_table("free"),
    output:
        cloud="results/{dataset}/cloud.laz",
        picture="results/{dataset}/cloud.png",
    log:
        "logs/{dataset}/export_cloud.log",
    benchmark:
        "benchmarks/{dataset}/export_cloud.tsv"
    threads: 1
    resources:
        mem_mb=grown(mem_mb=2000),
        runtime=grown(runtime=60),
    params:
        code=code_of("export_cloud"),
        reading=section("input"),
        stop=section("selection", "stop"),
        settings=setting(stage_settings.select_cloud),
    script:
        "../../scripts/export_cloud.py"
