"""Carry out what a person says of the plan: names, corrections, additions, a place on Earth."""

import json
from collections.abc import Mapping

from scanplan.plan import planning
from scanplan.plan.corrections import applying, georeference, rows
from scanplan.project import corrections_file
from scanplan.stage import log
from scanplan.store import schemas, tables
from scanplan.types import FilePath


def correct_plan(
    corrections: FilePath, plan: Mapping[str, FilePath], outputs: Mapping[str, FilePath]
) -> None:
    """Write the tables of the corrected plan.

    Parameters
    ----------
    corrections : path-like
        corrections.yaml or corrections.geojson of the dataset's folder.
    plan : dict of str to path-like
        The tables of plan/ by the names in `planning.TABLES`.
    outputs : dict of str to path-like
        plan/corrected/<name>.parquet, to write: the same tables; where there are reference points
        `free` states where the plan lies on Earth.
    """
    said = corrections_file.read_corrections(corrections)
    found = {
        name: tables.read_table(plan[name], schema, allow_empty=True)
        for name, schema in planning.TABLES.items()
    }
    changed = rows.rows_of_plan(found)
    outcome = applying.apply_corrections(changed, said)
    for line in (*outcome.unmatched, *outcome.told):
        log.log_warning(f"correct_plan: {line}")
    points = [correction for correction in said if correction.element == "reference_point"]
    checks = [correction for correction in said if correction.element == "check_point"]
    reference = georeference.fit_reference(points, checks)
    notes = tables.read_notes(plan["free"], schemas.FREE)
    notes |= {"n_corrections": str(outcome.n_applied)}
    unmatched = [line.removeprefix(f"{corrections}: ") for line in outcome.unmatched]
    notes |= {"unmatched_corrections": json.dumps(unmatched)} if unmatched else {}
    placed = ""
    if reference is not None:
        notes |= {"georeference": georeference.format_reference(reference)}
        placed = f"; {len(points)} reference points agree within {reference.residual_m:.2f} m"
    made = found | rows.columns_of_plan(changed)
    for name, schema in planning.TABLES.items():
        own = notes if name == "free" else None
        tables.write_table(outputs[name], schema, made[name], allow_empty=True, notes=own)
    log.log_line(
        f"correct_plan: {outcome.n_applied} of {len(said) - len(points) - len(checks)} corrections"
        f" applied{placed}"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        correct_plan(
            snakemake.input.corrections,
            {name: snakemake.input[name] for name in planning.TABLES},
            dict(snakemake.output.items()),
        )
