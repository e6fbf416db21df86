"""Deviations from a design as a table, and in words."""

import json
from collections.abc import Sequence

import numpy as np

from scanplan.changes.change_table import state_tie, tabulate_shapes
from scanplan.design.as_built import AsBuilt
from scanplan.design.deviations import FAULTS, VERDICTS, Deviation
from scanplan.types import Array

_TABLES = ("wall", "opening", "room", "column")


def tabulate_deviations(told: Sequence[Deviation]) -> dict[str, Array]:
    """Return the columns of `schemas.DEVIATIONS`."""
    return {
        "deviation": np.arange(len(told), dtype=np.int32),
        "element": np.array([of.change.table for of in told], object),
        "guid": np.array([of.guid for of in told], object),
        "name": np.array([of.name for of in told], object),
        "number_design": np.array([of.change.number_a for of in told], np.int32),
        "number_built": np.array([of.change.number_b for of in told], np.int32),
        "verdict": np.array([of.verdict for of in told], object),
        "p": np.array([of.p for of in told], float),
        "fault": np.array([of.is_fault for of in told], bool),
        "kind_design": np.array([of.change.kind_a for of in told], object),
        "kind_built": np.array([of.change.kind_b for of in told], object),
        "limit_m": np.array([of.limit_m for of in told], float),
        "built_m2": np.array([of.built_m2 for of in told], float),
        **tabulate_shapes([of.change for of in told]),
        "doubt": np.array([of.doubt for of in told], object),
    }


def state_design(found: AsBuilt, tolerances: str) -> dict[str, str]:
    """Return the notes of `schemas.DEVIATIONS`."""
    storey = found.storey
    stated = {"storey": storey.name, "floor_m": storey.floor_m, "tolerances": tolerances}
    return state_tie(found.compared) | {name: json.dumps(of) for name, of in stated.items()}


def summarise_deviations(told: Sequence[Deviation]) -> list[str]:
    """Return in a line for each kind of element how many of each verdict there are."""
    return [line for table in _TABLES if (line := _summarise(table, told))]


def _summarise(table: str, told: Sequence[Deviation]) -> str:
    of_table = [of for of in told if of.change.table == table]
    parts = []
    for verdict in VERDICTS:
        found = [of for of in of_table if of.verdict == verdict]
        sure = [of for of in found if of.is_fault or verdict not in FAULTS]
        words = verdict.replace("_", " ")
        if sure:
            length = (
                f" ({sum(of.change.shape.length for of in sure):.1f} m)" if table == "wall" else ""
            )
            parts.append(f"{len(sure)} {words}{length}")
        if doubtful := len(found) - len(sure):
            parts.append(f"{doubtful} maybe {words}")
    return f"{table}: {', '.join(parts)}" if parts else ""
