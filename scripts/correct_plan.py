"""Carry out what a person says of the plan: names, corrections, additions, a place on Earth."""

import json
from collections.abc import Mapping, Sequence

import numpy as np

from scanplan.plan import planning, taped_lengths
from scanplan.plan.corrections import applying, georeference, rows
from scanplan.project import corrections_file
from scanplan.project.corrections_file import Correction
from scanplan.stage import log
from scanplan.store import schemas, tables
from scanplan.types import Columns, FilePath


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
    notes = tables.read_notes(plan["free"], schemas.FREE)
    changed = rows.rows_of_plan(found, _find_floor_m(notes, found["walls"]))
    outcome = applying.apply_corrections(changed, said)
    for line in (*outcome.unmatched, *outcome.told):
        log.log_warning(f"correct_plan: {line}")
    points = [correction for correction in said if correction.element == "reference_point"]
    checks = [correction for correction in said if correction.element == "check_point"]
    reference = georeference.fit_reference(points, checks)
    notes |= {"n_corrections": str(outcome.n_applied)}
    unmatched = [line.removeprefix(f"{corrections}: ") for line in outcome.unmatched]
    notes |= {"unmatched_corrections": json.dumps(unmatched)} if unmatched else {}
    notes |= _state_people(said)
    placed = ""
    if reference is not None:
        notes |= {"georeference": georeference.format_reference(reference)}
        placed = f"; {len(points)} reference points agree within {reference.residual_m:.2f} m"
    if outcome.lengths_m:
        scale, sigma = taped_lengths.fit_scale(outcome.lengths_m)
        notes |= {"lengths": json.dumps(outcome.lengths_m)}
        by_tape = f"{100 * (scale - 1):+.2f} % longer, within {100 * sigma:.2f} %"
        n_lengths = len(outcome.lengths_m)
        log.log_line(f"correct_plan: {n_lengths} taped lengths would have the plan {by_tape}")
    made = found | rows.columns_of_plan(changed)
    for name, schema in planning.TABLES.items():
        own = notes if name == "free" else None
        tables.write_table(outputs[name], schema, made[name], allow_empty=True, notes=own)
    log.log_line(
        f"correct_plan: {outcome.n_applied} of {len(said) - len(points) - len(checks)} corrections"
        f" applied{placed}"
    )


def _find_floor_m(notes: Mapping[str, str], walls: Columns) -> float:
    """Return how high the floor is in the map frame, by the lowest of walls where it is unseen."""
    floor_m = float(notes.get("floor_z_m") or "nan")
    lows_m = walls["z_min_m"][np.isfinite(walls["z_min_m"])]
    if np.isfinite(floor_m) or len(lows_m) == 0:
        return float(np.nan_to_num(floor_m))
    return float(lows_m.min())


def _state_people(said: Sequence[Correction]) -> dict[str, str]:
    """Return as a note who corrected a plan, and on which day last; none where it is not known."""
    people = list(dict.fromkeys(correction.by for correction in said if correction.by))
    last = max((correction.when for correction in said), default="")[:10]
    told = ", ".join(filter(None, [*people, last]))
    return {"corrected_by": told} if told else {}


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        correct_plan(
            snakemake.input.corrections,
            {name: snakemake.input[name] for name in planning.TABLES},
            dict(snakemake.output.items()),
        )
