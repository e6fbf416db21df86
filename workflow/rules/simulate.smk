rule simulate_survey:
    """Drive a simulated rover through the demo office and record it."""
    input:
        building=building,
        code=code_of("simulate_survey"),
    output:
        recording=f"results/{{dataset}}/survey/{SIMULATED}",
        truth="results/{dataset}/survey/truth.geojson",
        true_poses="results/{dataset}/survey/truth_poses.tum",
        true_trajectory="results/{dataset}/survey/truth_trajectory.tum",
    log:
        "logs/{dataset}/simulate_survey.log",
    benchmark:
        "benchmarks/{dataset}/simulate_survey.tsv"
    wildcard_constraints:
        dataset=DEMO,
    threads: 1
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings=simulated_survey,
    script:
        "../../scripts/simulate_survey.py"
