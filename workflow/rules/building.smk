rule assemble_building:
    """Put the plans of all storeys into one model and one drawing."""
    input:
        ifc=of_storeys("plan/plan.ifc"),
        dxf=of_storeys("plan/plan.dxf"),
        free=of_storeys("plan/free.parquet"),
    output:
        ifc=f"results/{BUILDING.name}/building.ifc",
        dxf=f"results/{BUILDING.name}/building.dxf",
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
    script:
        "../../scripts/assemble_building.py"
