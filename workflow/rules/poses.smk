rule interpolate_poses:
    """Give every candidate scan the pose its sensor had at that moment, and tell how it moved."""
    input:
        recordings=recordings,
    output:
        poses="results/{dataset}/poses.parquet",
        motion="results/{dataset}/motion.parquet",
    log:
        "logs/{dataset}/interpolate_poses.log",
    benchmark:
        "benchmarks/{dataset}/interpolate_poses.tsv"
    threads: 1
    resources:
        mem_mb=grown(mem_mb=1500),
        runtime=grown(runtime=60),
    params:
        code=code_of("interpolate_poses"),
        content=content_of_recordings,
        reading=setting(stage_settings.select_topics),
        settings=section("poses"),
    script:
        "../../scripts/interpolate_poses.py"
