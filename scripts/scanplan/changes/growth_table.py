"""What surveys contributed to a plan of all, as a table and in words."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from scanplan.changes import change_table
from scanplan.changes.contributions import Contribution, sum_lengths_m
from scanplan.changes.growth import Grown
from scanplan.plan.floorplan import FloorPlan, say_count
from scanplan.types import Array, Columns

_TABLES = {"wall": "walls", "opening": "openings", "room": "rooms"}
_AGES = ("last_seen", "age_days", "p_stands")
_AGED = 0.5  # of days: surveys of one day are of one age


def tabulate_contributions(grown: Grown) -> dict[str, Array]:
    """Return the columns of `schemas.CONTRIBUTIONS`."""
    rows = [
        (of, name, share, last == of.last)
        for of in grown.contributions
        for last, (name, share) in enumerate(zip(grown.names, of.shares, strict=True))
    ]
    sizes = change_table.measure_shapes([of.shape for of, *_ in rows])
    return {
        "contribution": np.arange(len(rows), dtype=np.int32),
        "element": np.array([of.table for of, *_ in rows], object),
        "number": np.array([of.number for of, *_ in rows], np.int32),
        "survey": np.array([name for _, name, *_ in rows], object),
        "seen_share": np.array([share for *_, share, _ in rows], float),
        "is_last": np.array([is_last for *_, is_last in rows], bool),
        "age_days": np.array([of.age_days for of, *_ in rows], float),
        "p_stands": np.array([of.p_stands for of, *_ in rows], float),
        **sizes,
    }


def date_elements(grown: Grown) -> FloorPlan:
    """Return the plan of all, its tables with which survey saw an element last, and how it aged.

    The columns are `last_seen`, the survey's name, `age_days` and `p_stands`, as of
    `schemas.CONTRIBUTIONS`.
    """
    parts = {}
    for key, table in _TABLES.items():
        columns: Columns = getattr(grown.plan, table)
        shown = {of.number: of for of in grown.contributions if of.table == key}
        listed = [shown.get(number) for number in columns[key].tolist()]
        aged = {
            "last_seen": np.array([grown.names[of.last] if of else "" for of in listed], object),
            "age_days": np.array([of.age_days if of else np.nan for of in listed], float),
            "p_stands": np.array([of.p_stands if of else np.nan for of in listed], float),
        }
        parts[table] = {**columns, **aged}
    return replace(grown.plan, **parts)


def state_ages(grown: Grown, ids: Mapping[str, Sequence[str]]) -> dict[str, dict[str, str | float]]:
    """Return the same as properties of a building model, by the GlobalIds of tables' elements."""
    dated = date_elements(grown)
    stated = {}
    for key, guids in ids.items():
        columns: Columns = getattr(dated, _TABLES[key])
        rows = zip(*(columns[name].tolist() for name in _AGES), strict=True)
        for guid, (name, age_days, p_stands) in zip(guids, rows, strict=True):
            if name:
                aged = {"last_seen": name, "age_days": round(age_days, 1)}
                stated[guid] = aged | {"still_stands": round(p_stands, 4)}
    return stated


def state_surveys(grown: Grown) -> dict[str, str]:
    """Return the notes of `schemas.CONTRIBUTIONS`."""
    return {"surveys": json.dumps(list(grown.names)), "scans": json.dumps(list(grown.n_scans))}


def summarise_growth(grown: Grown) -> list[str]:
    """Return in lines what each survey gave, what changed from each to the next, what is stale."""
    *alone_m, shared_m = sum_lengths_m(grown.contributions).tolist()
    lines = [
        f"{name}: {say_count(n_scans, 'scan')}, {length_m:.1f} m of wall that no other saw"
        for name, n_scans, length_m in zip(grown.names, grown.n_scans, alone_m, strict=True)
    ]
    lines.append(f"seen by more than one: {shared_m:.1f} m of wall")
    for (before, after), step in zip(pairwise(grown.names), grown.steps, strict=True):
        said = change_table.summarise_changes(step.changes)
        lines += [f"{before} to {after}: {line}" for line in said]
    if grown.n_unlevelled:
        blind = say_count(grown.n_unlevelled, "survey")
        lines.append(f"{blind}: neither floor nor ceiling was seen, heights are those of its map")
    return [*lines, _summarise_stale(grown.contributions)]


def _summarise_stale(found: Sequence[Contribution]) -> str:
    stale = [of for of in found if of.is_stale]
    if not stale:
        return "the latest survey saw all of it"
    counts = [
        say_count(n, table) for table in _TABLES if (n := sum(of.table == table for of in stale))
    ]
    oldest = max(of.age_days for of in stale)
    age = f", up to {oldest:.0f} days before" if oldest >= _AGED else ""
    least = min(of.p_stands for of in stale)
    return (
        f"not seen by the latest survey: {', '.join(counts)}{age}; each still stands with a"
        f" probability of {least:.2f} or more"
    )
