"""The tables of the report's page, as rows of cells that its template shows."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

import numpy as np

from scanplan.plan import floorplan
from scanplan.project.settings import iterate_leaves
from scanplan.report import measure_meanings
from scanplan.stage.run_times import JobCost
from scanplan.types import Columns, FloatArray, Settings
from scanplan.validation import doubts

_NOT_KNOWN = "–"
_OUTSIDE = "outside or not known"
_DEVIATIONS = ("sigma_offset_m", "sigma_end0_m", "sigma_end1_m", "rmse_m")


@dataclass(frozen=True)
class Head:
    """What stands over a column, and whether that is one of numbers."""

    text: str
    is_number: bool


@dataclass(frozen=True)
class Cell:
    """A cell: what is read, its CSS classes, and the number that sorts it (None: it has none)."""

    text: str
    css: str = ""
    sorts_as: float | None = None


@dataclass(frozen=True)
class Row:
    """Cells of a row; `element` is what of the plan choosing the row shows, such as `wall 3`."""

    cells: list[Cell]
    element: str | None = None


@dataclass(frozen=True)
class PageTable:
    """A table by the name that is its id; `sortable` where a click on a head sorts it."""

    name: str
    heads: list[Head]
    rows: list[Row]
    sortable: bool = False


def wall_lengths_m(plan: floorplan.FloorPlan) -> FloatArray:
    """Return the lengths (n,) of the walls of a plan."""
    return plan.lengths_m


def wall_table(plan: floorplan.FloorPlan, evidence: Columns) -> PageTable:
    """Return the table of walls with their evidence, those to verify on site marked."""
    length_m = wall_lengths_m(plan)
    moments = _first_and_last(evidence)
    rows = []
    for i, wall in enumerate(plan.walls["wall"].tolist()):
        at = {name: values[i] for name, values in plan.walls.items()}
        first_ns, last_ns = moments.get(wall, (None, None))
        cells = [
            number_cell(wall, 0),
            _doubt("wall", plan.walls, i),
            Cell(str(at["state"])),
            number_cell(length_m[i], 2),
            number_cell(1000 * at["thickness_m"], 0),
            number_cell(plan.heights_m[i], 2) if plan.low[i] else _blank_number(),
            *(number_cell(1000 * at[name], 1) for name in _DEVIATIONS),
            number_cell(at["n_points"], 0),
            number_cell(at["n_scans"], 0),
            _moment(first_ns),
            _moment(last_ns),
            Cell(at["corrected"]),
        ]
        rows.append(Row(cells, f"wall {wall}"))
    heads = make_heads(
        "#wall", "to verify", "state", "#length (m)", "#thickness (mm)", "#ends at height (m)",
        "#σ offset (mm)", "#σ start (mm)", "#σ end (mm)", "#residual (mm)", "#points", "#scans",
        "#first seen", "#last seen", "corrected",
    )  # fmt: skip
    return PageTable("walls", heads, rows, sortable=True)


def face_table(plan: floorplan.FloorPlan) -> PageTable:
    """Return the table of the faces that are to be verified on site though their walls are not."""
    length_m = np.hypot(*np.diff(floorplan.centrelines_m(plan.faces), axis=1)[:, 0].T)
    rows = []
    records = _records(plan.faces)
    for i in doubts.find_doubtful_faces(plan).tolist():
        at = records[i]
        cells = [
            number_cell(at["face"], 0),
            _doubt("face", plan.faces, i),
            number_cell(at["wall"], 0) if at["wall"] >= 0 else _blank_number(),
            Cell(str(at["state"])),
            number_cell(length_m[i], 2),
            number_cell(at["n_points"], 0),
            number_cell(at["n_scans"], 0),
        ]
        rows.append(Row(cells, f"face {at['face']}"))
    heads = make_heads(
        "#face", "to verify", "#of wall", "state", "#length (m)", "#points", "#scans"
    )
    return PageTable("faces", heads, rows, sortable=True)


def opening_table(plan: floorplan.FloorPlan) -> PageTable:
    """Return the table of openings and of the rooms that each joins."""
    name_of = dict(zip(plan.rooms["room"].tolist(), plan.room_labels, strict=True))
    rows = [
        Row([
            number_cell(at["opening"], 0),
            _doubt("opening", plan.openings, i),
            Cell(at["type"]),
            number_cell(at["width_m"], 2),
            number_cell(at["sill_m"], 2),
            number_cell(at["lintel_m"], 2),
            Cell(f"{name_of.get(at['room_a'], _OUTSIDE)} – {name_of.get(at['room_b'], _OUTSIDE)}"),
            number_cell(at["n_rays"], 0),
            Cell(at["corrected"]),
        ], f"opening {at['opening']}")
        for i, at in enumerate(_records(plan.openings))
    ]  # fmt: skip
    heads = make_heads(
        "#opening", "to verify", "type", "#width (m)", "#sill (m)", "#lintel (m)", "joins",
        "#rays through", "corrected",
    )  # fmt: skip
    return PageTable("openings", heads, rows, sortable=True)


def room_table(plan: floorplan.FloorPlan) -> PageTable:
    """Return the table of rooms."""
    rows = [
        Row([
            number_cell(at["room"], 0),
            Cell(plan.room_labels[i]),
            _doubt("room", plan.rooms, i),
            number_cell(plan.net_areas_m2[i], 2),
            number_cell(at["perimeter_m"], 2),
            Cell("yes" if at["closed"] else "no"),
            number_cell(at["n_scans"], 0),
            Cell(at["corrected"]),
        ], f"room {at['room']}")
        for i, at in enumerate(_records(plan.rooms))
    ]  # fmt: skip
    heads = make_heads(
        "#room", "name", "to verify", "#area (m²)", "#perimeter (m)", "closed",
        "#scans that see it", "corrected",
    )  # fmt: skip
    return PageTable("rooms", heads, rows, sortable=True)


def registration_table(verdicts: Columns, shift_m: FloatArray) -> PageTable:
    """Return the table of verdicts on the candidate scans, the most frequent first.

    Parameters
    ----------
    verdicts : dict of str to (n,) array
        The columns of `schemas.REGISTRATION`.
    shift_m : (n,) float
        How far each scan was moved from the localiser's pose; NaN where not known.
    """
    reasons = verdicts["reason"].astype(str)
    rows = []
    for reason in sorted(set(reasons), key=lambda r: (-np.sum(reasons == r), r)):
        of_reason = reasons == reason
        cells = [
            Cell(reason),
            Cell(_all_or_some(verdicts["kept"][of_reason])),
            number_cell(of_reason.sum(), 0),
            number_cell(of_reason.mean() * 100, 1),
            number_cell(_median(verdicts["prior_fitness"][of_reason]), 3),
            number_cell(_median(verdicts["refined_fitness"][of_reason]), 3),
            number_cell(1000 * _median(verdicts["rmse_m"][of_reason]), 0),
            number_cell(1000 * _median(shift_m[of_reason]), 0),
        ]
        rows.append(Row(cells))
    heads = make_heads(
        "verdict", "kept", "#scans", "#share (%)", "#fitness at the recorded pose",
        "#fitness after alignment", "#residual (mm)", "#shift (mm)",
    )  # fmt: skip
    return PageTable("registration", heads, rows)


def truth_table(measures: Columns, *, leads: str) -> PageTable:
    """Return the table of the plan against the truth, from `schemas.PLAN_EVALUATION`'s columns.

    The frame that leads comes first.
    """
    order = np.argsort(measures["frame"] != leads, kind="stable")
    rows = []
    for name, values in measures.items():
        if name == "frame":
            continue
        numbers = [
            number_cell(value, 0 if name.startswith("n_") else 3)
            for value in values[order].tolist()
        ]
        meaning = Cell(measure_meanings.measure_meaning(name))
        rows.append(Row([Cell(name.replace("_", " ")), *numbers, meaning]))
    heads = make_heads("measure", *(f"#{frame}" for frame in measures["frame"][order]), "meaning")
    return PageTable("truth", heads, rows)


def stage_table(costs: Mapping[str, JobCost]) -> PageTable:
    """Return the table of what each stage took."""
    rows = [
        Row(
            [
                Cell(stage),
                number_cell(cost.seconds, 1),
                number_cell(cost.cpu_s, 1),
                number_cell(cost.memory_mb, 0),
            ]
        )
        for stage, cost in costs.items()
    ]
    if rows:
        total = [
            Cell("all", "total"),
            number_cell(np.nansum([cost.seconds for cost in costs.values()]), 1),
            number_cell(np.nansum([cost.cpu_s for cost in costs.values()]), 1),
            _blank_number(),
        ]
        rows.append(Row(total))
    heads = make_heads("stage", "#time (s)", "#processor (s)", "#peak memory (MB)")
    return PageTable("stages", heads, rows)


def size_table(files: Iterable[tuple[str, str, int]]) -> PageTable:
    """Return the table of data sizes: rows of what, file, bytes."""
    rows = [Row([Cell(what), Cell(file), number_cell(n / 1e6, 3)]) for what, file, n in files]
    return PageTable("sizes", make_heads("what", "file", "#size (MB)"), rows)


def settings_table(values: Settings) -> PageTable:
    """Return the table of settings, nested keys joined by dots."""
    rows = [
        Row([Cell(key), Cell("null" if value is None else str(value))])
        for key, value in iterate_leaves(values)
    ]
    return PageTable("settings", make_heads("key", "value"), rows)


def make_heads(*texts: str) -> list[Head]:
    """Return heads; one that begins with `#` stands over numbers."""
    return [Head(text.removeprefix("#"), text.startswith("#")) for text in texts]


def number_cell(value: float, digits: int) -> Cell:
    """Return a cell of a number, NaN where it is not known."""
    if not np.isfinite(value):
        return Cell(_NOT_KNOWN, "number")
    return Cell(f"{value:,.{digits}f}", "number", float(value))


def _blank_number() -> Cell:
    """Return a cell in a column of numbers where none is asked for."""
    return Cell("", "number")


def _moment(t_ns: int | None) -> Cell:
    if t_ns is None:
        return Cell(_NOT_KNOWN, "number")
    return Cell(datetime.fromtimestamp(t_ns / 1e9, UTC).strftime("%H:%M:%S"), "number", t_ns)


def _records(columns: Columns) -> list[dict[str, Any]]:
    """Return the rows of a table, each by its columns' names."""
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    return [dict(zip(columns, row, strict=True)) for row in rows]


def _first_and_last(evidence: Columns) -> dict[int, tuple[int, int]]:
    """Return the first and the last moment (ns) at which each wall was seen."""
    moments: dict[int, tuple[int, int]] = {}
    for wall, t_ns in zip(evidence["wall"].tolist(), evidence["t_ns"].tolist(), strict=True):
        first_ns, last_ns = moments.get(wall, (t_ns, t_ns))
        moments[wall] = (min(first_ns, t_ns), max(last_ns, t_ns))
    return moments


def _doubt(kind: str, columns: Columns, row: int) -> Cell:
    reason = doubts.explain_doubt(kind, columns, row)
    return Cell(reason, "flag") if reason else Cell("")


def _all_or_some(kept: np.ndarray) -> str:
    if kept.all():
        return "yes"
    return "some" if kept.any() else "no"


def _median(values: np.ndarray) -> float:
    values = values[np.isfinite(values)]
    return float(np.median(values)) if len(values) else np.nan
