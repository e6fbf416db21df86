rule assemble_plan:
    """Make faces, walls, openings and rooms of the first scans of an ordering."""
    input:
        walls="results/{dataset}/plan/segments.parquet",
        selection=plan_selection,
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
    output:
        faces="results/{dataset}/plan/faces.parquet",
        walls="results/{dataset}/plan/walls.parquet",
        openings="results/{dataset}/plan/openings.parquet",
        rooms="results/{dataset}/plan/rooms.parquet",
        evidence="results/{dataset}/plan/evidence.parquet",
        free="results/{dataset}/plan/free.parquet",
    log:
        "logs/{dataset}/assemble_plan.log",
    benchmark:
        "benchmarks/{dataset}/assemble_plan.tsv"
    threads: 1
    resources:
        mem_mb=2000,
        runtime=20,
    params:
        code=code_of("assemble_plan"),
        stop=section("selection", "stop"),
        settings=setting(stage_settings.select_plan),
    script:
        "../../scripts/assemble_plan.py"


rule validate_plan:
    """Measure how well the plan predicts rays of scans that it was not made of."""
    input:
        faces="results/{dataset}/plan/faces.parquet",
        walls="results/{dataset}/plan/walls.parquet",
        openings="results/{dataset}/plan/openings.parquet",
        rooms="results/{dataset}/plan/rooms.parquet",
        free="results/{dataset}/plan/free.parquet",
        selection=plan_selection,
        scans="results/{dataset}/scans.parquet",
        registration="results/{dataset}/registration.parquet",
    output:
        elements="results/{dataset}/plan/validation.parquet",
        rays="results/{dataset}/plan/validation_rays.parquet",
    log:
        "logs/{dataset}/validate_plan.log",
    benchmark:
        "benchmarks/{dataset}/validate_plan.tsv"
    threads: 1
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        code=code_of("validate_plan"),
        stop=section("selection", "stop"),
        settings=setting(stage_settings.select_validation),
    script:
        "../../scripts/validate_plan.py"


rule rate_plan:
    """Say how likely each element of the plan exists as it is drawn."""
    input:
        faces="results/{dataset}/plan/faces.parquet",
        walls="results/{dataset}/plan/walls.parquet",
        openings="results/{dataset}/plan/openings.parquet",
        rooms="results/{dataset}/plan/rooms.parquet",
        free="results/{dataset}/plan/free.parquet",
        validation="results/{dataset}/plan/validation.parquet",
    output:
        confidence="results/{dataset}/plan/confidence.parquet",
    log:
        "logs/{dataset}/rate_plan.log",
    benchmark:
        "benchmarks/{dataset}/rate_plan.tsv"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=5,
    params:
        code=code_of("rate_plan"),
    script:
        "../../scripts/rate_plan.py"


rule export_plan:
    """Write the plan as GeoJSON, DXF, SVG, PDF, IFC and as a map for nav2."""
    input:
        faces="results/{dataset}/plan/faces.parquet",
        walls="results/{dataset}/plan/walls.parquet",
        openings="results/{dataset}/plan/openings.parquet",
        rooms="results/{dataset}/plan/rooms.parquet",
        evidence="results/{dataset}/plan/evidence.parquet",
        free="results/{dataset}/plan/free.parquet",
        confidence="results/{dataset}/plan/confidence.parquet",
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
        ifc="results/{dataset}/plan/plan.ifc",
        pgm="results/{dataset}/plan/map.pgm",
        yaml="results/{dataset}/plan/map.yaml",
    log:
        "logs/{dataset}/export_plan.log",
    benchmark:
        "benchmarks/{dataset}/export_plan.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=code_of("export_plan"),
        settings=section("plan", "export"),
    script:
        "../../scripts/export_plan.py"
