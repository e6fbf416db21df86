"""A floor plan read from the tables of a dataset's results."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from scanplan.plan.floorplan import NUMBERS, FloorPlan, GeoReference, make_floorplan
from scanplan.plan.plan_wall import Nearly
from scanplan.plan.survey_scale import SurveyScale
from scanplan.store import schemas, tables
from scanplan.store.doubts import NO_DOUBT, Doubts, read_doubts
from scanplan.types import Columns, FilePath

UNRATED = "not rated, as the stage that rates it failed"
"""Why an element is doubtful where none could be rated."""
# what was not seen is rated by none
_UNSEEN: dict[str, float | str] = {
    "p_true": 0.0,
    "verify": True,
    "about": "existence",
    "doubt": "not seen",
    "needs_person": False,
}


def read_floorplan(files: Mapping[str, FilePath], name: str = "", **assumed_m: float) -> FloorPlan:
    """Read a plan from its tables.

    Parameters
    ----------
    files : dict of str to path-like
        `faces`, `walls`, `openings`, `rooms` and `free` of plan/, where they are wanted `furniture`
        and `confidence`, an empty list where the stage that makes it failed; `free` states the
        heights of floor and ceiling, and doubts, to which `confidence` adds.
    name : str
    **assumed_m
        What `FloorPlan` assumes, where it is not the default.

    Raises
    ------
    StageError
        If one is missing, damaged, or there is no face.
    """

    def read(table: str, schema: schemas.Schema) -> Columns:
        return tables.read_table(files[table], schema, allow_empty=table != "faces")

    notes = tables.read_notes(files["free"], schemas.FREE)
    floor_z_m, ceiling_z_m = (
        float(notes.get(note) or "nan") for note in ("floor_z_m", "ceiling_z_m")
    )
    parts = {
        "faces": read("faces", schemas.FACES),
        "walls": read("walls", schemas.PLAN_WALLS),
        "openings": read("openings", schemas.OPENINGS),
        "rooms": read("rooms", schemas.ROOMS),
        "free": read("free", schemas.FREE),
    }
    doubted = read_doubts(files["free"], schemas.FREE)
    if "confidence" in files:
        rated, otherwise, doubts = _read_rated(files["confidence"])
        doubted = doubted.join(doubts)
        parts = {
            table: _join_confidence(table, columns, rated, otherwise)
            for table, columns in parts.items()
        }
    wanted: dict[str, Columns] = {}
    if "furniture" in files:
        wanted["furniture"] = read("furniture", schemas.FURNITURE)
    reference = notes.get("georeference")
    return make_floorplan(
        parts,
        floor_z_m,
        ceiling_z_m,
        name,
        **wanted,
        georeference=GeoReference(**json.loads(reference)) if reference else None,
        n_corrections=int(notes.get("n_corrections", 0)),
        unmatched_corrections=json.loads(notes.get("unmatched_corrections", "[]")),
        opened_by_hand=json.loads(notes.get("opened", "[]")),
        corrected_by=notes.get("corrected_by", ""),
        taped_m=json.loads(notes.get("lengths", "[]")),
        scale=read_scale(notes),
        doubted=doubted,
        nearly=[
            Nearly(of["kind"], np.array(of["ends_m"]), of["p"])
            for of in json.loads(notes.get("nearly", "[]"))
        ],
        **assumed_m,
    )


def join_rated(plan: FloorPlan, rated: Columns) -> FloorPlan:
    """Return a plan whose walls, openings and rooms have the columns of `schemas.CONFIDENCE`."""
    parts = {
        table: _join_confidence(table, getattr(plan, table), rated, _UNSEEN) for table in NUMBERS
    }
    return replace(plan, **parts)


def read_scale(notes: Mapping[str, str]) -> SurveyScale | None:
    """Return what the notes of `schemas.FREE` say of a survey's scale; None where nothing."""
    return SurveyScale(**json.loads(notes["scale"])) if "scale" in notes else None


def format_nearly(nearly: Sequence[Nearly]) -> str:
    """Return what was nearly drawn as the note `nearly` of `schemas.FREE`, to the millimetre."""
    rows = [
        {"kind": of.kind, "ends_m": np.round(of.ends_m, 3).tolist(), "p": round(of.p, 3)}
        for of in nearly
    ]
    return json.dumps(rows)


def _read_rated(
    path: FilePath | Sequence[FilePath],
) -> tuple[Columns, Mapping[str, float | str], Doubts]:
    """Return `schemas.CONFIDENCE`, what holds of an element without a row there, and doubts.

    Where the stage that rates the plan failed, the workflow gives an empty list.
    """
    if isinstance(path, str | Path):
        rated = tables.read_table(path, schemas.CONFIDENCE, allow_empty=True)
        return rated, _UNSEEN, read_doubts(path, schemas.CONFIDENCE)
    unrated = _UNSEEN | {"p_true": np.nan, "doubt": UNRATED}
    return tables.no_rows(schemas.CONFIDENCE), unrated, NO_DOUBT


def _join_confidence(
    table: str, columns: Columns, rated: Columns, otherwise: Mapping[str, float | str]
) -> Columns:
    """Return a table with the columns of `schemas.CONFIDENCE` of its elements."""
    if table not in NUMBERS:
        return columns
    rows = np.flatnonzero(rated["table"] == table)
    row_of = dict(zip(rated["number"][rows].tolist(), rows, strict=True))
    numbers = columns[NUMBERS[table]].tolist()
    known = np.array([row_of.get(number, -1) for number in numbers], np.int64)
    added = {name: np.append(rated[name], value)[known] for name, value in otherwise.items()}
    return {**columns, **added}
