rule simulate_survey:
    """Drive a simulated rover through a building and record it."""
    input:
        building=building,
    output:
        **survey_files("bag"),
    log:
        "logs/{dataset}/simulate_survey.log",
    benchmark:
        "benchmarks/{dataset}/simulate_survey.tsv"
    wildcard_constraints:
        dataset=simulated_as("bag"),
    threads: 2
    resources:
        mem_mb=grown(mem_mb=1000),
        runtime=grown(runtime=30),
    params:
        code=code_of("simulate_survey"),
        settings=setting(stage_settings.select_simulation),
    script:
        "../../scripts/simulate_survey.py"


if "db3" in RECORDED_AS:

    use rule simulate_survey as simulate_survey_db3 with:
        output:
            **survey_files("db3"),
        wildcard_constraints:
            dataset=simulated_as("db3"),


if "mcap" in RECORDED_AS:

    use rule simulate_survey as simulate_survey_mcap with:
        output:
            **survey_files("mcap"),
        wildcard_constraints:
            dataset=simulated_as("mcap"),
