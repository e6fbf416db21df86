rule assemble_building:
    """Put the plans of all storeys into one model, one drawing and one set of sheets."""
    input:
        ifc=of_storeys("plan/plan.ifc"),
        faces=tables_of_storeys("faces"),
        walls=tables_of_storeys("walls"),
        openings=tables_of_storeys("openings"),
        rooms=tables_of_storeys("rooms"),
        evidence=tables_of_storeys("evidence"),
        free=tables_of_storeys("free"),
        confidence=of_storeys("plan/confidence.parquet"),
    output:
        ifc=f"results/{BUILDING.name}/building.ifc",
        dxf=f"results/{BUILDING.name}/building.dxf",
        pdf=f"results/{BUILDING.name}/building.pdf",
    log:
        f"logs/{BUILDING.name}/assemble_building.log",
    benchmark:
        f"benchmarks/{BUILDING.name}/assemble_building.tsv"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=code_of("assemble_building"),
        name=BUILDING.name,
        storeys=[vars(storey) for storey in BUILDING.storeys],
        settings=[
            stage_settings.select_drawing(DATASETS[storey.dataset].settings)
            for storey in BUILDING.storeys
        ],
        receivers=[
            words_file.read_receiver(
                DATASETS[storey.dataset].settings["plan"]["export"]
            )
            for storey in BUILDING.storeys
        ],
    script:
        "../../scripts/assemble_building.py"
