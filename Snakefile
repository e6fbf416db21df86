from snakemake.utils import min_version

min_version("9.20")


configfile: f"{workflow.basedir}/config/config.yaml"


container: "workflow/envs/scanplan.sif"


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/handlers.smk"
include: "workflow/rules/simulate.smk"
include: "workflow/rules/poses.smk"
include: "workflow/rules/registration.smk"
include: "workflow/rules/audit.smk"
include: "workflow/rules/hulls.smk"
include: "workflow/rules/selection.smk"
include: "workflow/rules/walls.smk"
include: "workflow/rules/plan.smk"
include: "workflow/rules/selectedbag.smk"
include: "workflow/rules/evaluate.smk"
include: "workflow/rules/reportinputs.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/evidence.smk"


if BUILDING:

    include: "workflow/rules/building.smk"


if THESIS:

    include: "workflow/rules/thesis.smk"
    include: "workflow/rules/gates.smk"


rule all:
    default_target: True
    input:
        of_all_datasets(results_of),
        BUILDING.list_results() if BUILDING else [],


rule comparison:
    input:
        of_all_datasets(results_of),
        BUILDING.list_results() if BUILDING else [],
        of_all_datasets(comparison_of),
