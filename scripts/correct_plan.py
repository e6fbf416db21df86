"""Carry out what a person says of the plan: names, corrections, additions, a place on Earth."""

import json
from collections.abc import Mapping, Sequence

import numpy as np

from scanplan.plan import planning, survey_scale
from scanplan.plan.corrections import applying, georeference, rows
from scanplan.plan.survey_scale import state_scale
from scanplan.project import corrections_file
from scanplan.project.corrections_file import LENGTH, Correction
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
    floor_m = _find_floor_m(notes, found["walls"])
    changed = rows.rows_of_plan(found, floor_m)
    outcome = applying.apply_corrections(changed, said)
    points = [correction for correction in said if correction.element == "reference_point"]
    checks = [correction for correction in said if correction.element == "check_point"]
    scale = survey_scale.fit_scale(outcome.lengths_m, georeference.read_points(points))
    factor = survey_scale.find_factor(scale)
    if factor != 1.0:
        # sizes are those of a tape, and the plan is in metres of the map
        changed = rows.rows_of_plan(found, floor_m)
        outcome = applying.apply_corrections(changed, [c.divide_sizes(factor) for c in said])
    taped = [correction for correction in said if correction.element == LENGTH]
    off = _list_off(taped, outcome.lengths_m, factor)
    for line in (*outcome.unmatched, *outcome.told, *off):
        log.log_warning(f"correct_plan: {line}")
    reference = georeference.fit_reference(points, checks, factor)
    notes |= {"n_corrections": str(outcome.n_applied)}
    unmatched = [line.removeprefix(f"{corrections}: ") for line in outcome.unmatched]
    notes |= {"unmatched_corrections": json.dumps(unmatched)} if unmatched else {}
    notes |= {"opened": json.dumps(outcome.opened)} if outcome.opened else {}
    notes |= _state_people(said)
    placed = ""
    if reference is not None:
        notes |= {"georeference": georeference.format_reference(reference)}
        for line in reference.faults:
            log.log_warning(f"correct_plan: {corrections}: {line}")
        placed = f"; {len(points)} reference points agree within {reference.residual_m:.2f} m"
        if reference.fits_mirrored:
            fault = "no residual shows exchanged axes, as all points lie on one line"
            log.log_warning(f"correct_plan: {fault}; add a check_point off it")
    notes |= {"lengths": json.dumps(outcome.lengths_m)} if outcome.lengths_m else {}
    if scale is not None:
        notes |= {"scale": json.dumps(vars(scale))}
        log.log_line(f"correct_plan: {state_scale(scale)}")
    made = found | rows.columns_of_plan(changed)
    for name, schema in planning.TABLES.items():
        own = notes if name == "free" else None
        tables.write_table(outputs[name], schema, made[name], allow_empty=True, notes=own)
    log.log_line(
        f"correct_plan: {outcome.n_applied} of {len(said) - len(points) - len(checks)} corrections"
        f" applied{placed}"
    )


def _list_off(
    taped: Sequence[Correction], lengths_m: Sequence[Sequence[float]], factor: float
) -> list[str]:
    """Return a line on each taped length that the plan does not have, at its scale."""
    told = []
    for correction, (drawn_m, taped_m, sigma_m) in zip(taped, lengths_m, strict=True):
        off = (factor * drawn_m - taped_m) / sigma_m
        if abs(off) > survey_scale.SIGNIFICANT:
            by = f"{factor * drawn_m:.3f} m are drawn where {taped_m:.3f} m were taped"
            remedy = "tape it again, or move the wall that is wrong"
            told.append(f"{correction.entry}: {by}, {abs(off):.1f} sigma apart; {remedy}")
    return told


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
