# where Snakemake looks first; the workflow itself lies where its catalogue looks for it
include: "workflow/Snakefile"


# an included file's default target holds within that file alone
workflow.default_target = "all"
