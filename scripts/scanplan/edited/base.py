"""The results that a file was edited of: its plan as it is, before corrections and after."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from scanplan.edited.differences import count_same
from scanplan.edited.elements import Drawing, Element
from scanplan.errors import StageError
from scanplan.plan import planning
from scanplan.plan.corrections.rows import PlanRows, Row, rows_of_plan
from scanplan.plan.floorplan_files import read_scale
from scanplan.plan.survey_scale import find_factor
from scanplan.store import schemas, tables
from scanplan.types import FilePath

FILES = {
    ".json": ("plan.openplan3d.json",),
    ".ifc": ("plan.ifc", "presentation.ifc"),
    ".dxf": ("plan.dxf", "presentation.dxf"),
}
"""What of results' plan/ an edited file may be made of, by its suffix."""
_LEAST_SHARE = 0.5
"""Of the elements that an edited file has as they were: of another survey or run hardly any are."""


@dataclass(frozen=True)
class EditedPlan:
    """The plan that was edited.

    Attributes
    ----------
    found : PlanRows
        As it was found: corrections are of places in it.
    shown : PlanRows
        With the corrections that there were: what was edited.
    numbers : mapping of (str, str) to int
        Numbers of elements by their kind and GlobalId.
    factor : float
        By which the files' places are those of the map multiplied.
    """

    found: PlanRows
    shown: PlanRows
    numbers: Mapping[tuple[str, str], int]
    factor: float = 1.0

    def find_row(self, element: Element) -> Row | None:
        """Return the row of an element that was edited; None of one that the plan has not."""
        number = self.numbers.get((element.kind, element.key.partition("~")[0]))
        if number is None:
            digits = element.key.rpartition("-")[2]
            number = int(digits) if digits.isdecimal() else -1
        return find_number(self.shown, element.kind, number)


def find_number(rows: PlanRows, kind: str, number: int) -> Row | None:
    """Return the row of an element of a kind with a number; None without."""
    return next((row for row in rows.of(kind) if row[kind] == number), None)


def read_edited_plan(results: Path) -> EditedPlan:
    """Read the plan of results, before corrections and after, and the ids of its elements.

    Raises
    ------
    StageError
        If tables are missing, damaged, or of another version.
    """
    folder = results / "plan"
    found = _read_rows(folder)
    corrected = folder / "corrected"
    edited = corrected if (corrected / "walls.parquet").exists() else folder
    shown = _read_rows(edited)
    scale = read_scale(tables.read_notes(edited / "free.parquet", schemas.FREE))
    ids = tables.read_table(folder / "ids.parquet", schemas.ELEMENT_IDS, allow_empty=True)
    named = zip(ids["kind"].tolist(), ids["global_id"].tolist(), strict=True)
    numbers = dict(zip(named, ids["number"].tolist(), strict=True))
    return EditedPlan(found, shown, numbers, find_factor(scale))


def _read_rows(folder: Path) -> PlanRows:
    read = {
        name: tables.read_table(folder / f"{name}.parquet", schema, allow_empty=True)
        for name, schema in planning.TABLES.items()
    }
    return rows_of_plan(read)


def choose_base(path: FilePath, edited: Drawing, bases: Mapping[Path, Drawing]) -> Path:
    """Return which file of results an edited one was made of: the one it has most in common with.

    Raises
    ------
    StageError
        If it has little in common with any.
    """
    shares = {
        place: count_same(base, edited) / max(len(base.elements), 1)
        for place, base in bases.items()
    }
    best = max(shares, key=lambda place: shares[place])
    if shares[best] < _LEAST_SHARE:
        n_same = round(shares[best] * len(bases[best].elements))
        fault = f"has {n_same} of {len(bases[best].elements)} elements as in {best}"
        remedy = "it is of another survey or an older run; edit the newest file"
        raise StageError(f"{path}: {fault}; {remedy}")
    return best
