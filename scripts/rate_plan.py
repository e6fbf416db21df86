"""Say how likely each element of the plan exists as it is drawn, and why not."""

from collections.abc import Mapping

import numpy as np

from scanplan.plan import floorplan
from scanplan.stage import log
from scanplan.store import schemas, tables
from scanplan.types import FilePath
from scanplan.validation import confidence


def rate_plan(plan: Mapping[str, FilePath], validation: FilePath, output: FilePath) -> None:
    """Write the table of confidence of a plan; no truth is asked.

    Parameters
    ----------
    plan : dict of str to path-like
        `faces`, `walls`, `openings`, `rooms` and `free` of plan/.
    validation : path-like
        plan/validation.parquet.
    output : path-like
        plan/confidence.parquet, to write.
    """
    drawn = floorplan.read_floorplan(plan)
    elements = tables.read_table(validation, schemas.VALIDATION)
    rated = confidence.rate_elements(drawn, elements)
    tables.write_table(output, schemas.CONFIDENCE, rated)
    counts = [
        f"{np.sum(rated['verify'][rated['table'] == table])}"
        f" of {np.sum(rated['table'] == table)} {table}"
        for table in floorplan.NUMBERS
    ]
    is_rated = np.isfinite(rated["p_true"]).any()
    words = "" if is_rated else "; not rated, as no heights above the floor are known"
    log.log_line(f"rate_plan: to verify on site: {', '.join(counts)}{words}")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        rate_plan(
            dict(snakemake.input.items()),
            snakemake.input.validation,
            snakemake.output.confidence,
        )
