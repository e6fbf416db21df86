"""The tables of a plan as rows, to be changed one by one."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import shapely

from scanplan.plan import plan_tables
from scanplan.store import schemas
from scanplan.types import Array, Columns

Row = dict[str, Any]
"""Values of a table's row by column."""
_SCHEMAS = {
    "faces": schemas.FACES,
    "walls": schemas.PLAN_WALLS,
    "openings": schemas.OPENINGS,
    "rooms": schemas.ROOMS,
    "evidence": schemas.EVIDENCE,
    "furniture": schemas.FURNITURE,
}


@dataclass
class PlanRows:
    """Rows of the tables of a plan, and how high its floor is in the map frame, metres."""

    faces: list[Row]
    walls: list[Row]
    openings: list[Row]
    rooms: list[Row]
    evidence: list[Row]
    furniture: list[Row]
    floor_z_m: float = 0.0

    def of(self, element: str) -> list[Row]:
        """Return the rows of walls, faces, openings, rooms or furniture by the singular."""
        return getattr(self, _table_of(element))

    def wall_of(self, row: Row) -> Row | None:
        """Return the wall that a face or an opening is of; None of none."""
        return next((wall for wall in self.walls if wall["wall"] == row["wall"]), None)

    def room_at(self, place: shapely.Point) -> Row | None:
        """Return the room that a place is in; None of none."""
        at = (room for room in self.rooms if shapely.from_wkb(room["geometry"]).covers(place))
        return next(at, None)

    def drop(self, element: str, number: int) -> None:
        """Remove a wall with its faces and evidence, an opening, or a room and what names it.

        Likewise a face.
        """
        kept = [row for row in self.of(element) if row[element] != number]
        setattr(self, _table_of(element), kept)
        if element == "wall":
            self.faces = [row for row in self.faces if row["wall"] != number]
            self.evidence = [row for row in self.evidence if row["wall"] != number]
        for row in self.openings if element == "room" else []:
            row |= {side: -1 for side in ("room_a", "room_b") if row[side] == number}

    def next_number(self, element: str) -> int:
        """Return the first free number after those of faces, walls, openings and so on."""
        return max((row[element] for row in self.of(element)), default=-1) + 1


def _table_of(element: str) -> str:
    return element if element == "furniture" else f"{element}s"


def rows_of_plan(tables: Mapping[str, Columns], floor_z_m: float = 0.0) -> PlanRows:
    """Return the tables of a plan, by the names of planning's, as rows."""
    rows = {}
    for name in _SCHEMAS:
        columns = tables[name]
        values = zip(*(column.tolist() for column in columns.values()), strict=True)
        rows[name] = [dict(zip(columns, row, strict=True)) for row in values]
    return PlanRows(**rows, floor_z_m=floor_z_m)


def columns_of_plan(rows: PlanRows) -> dict[str, dict[str, Array]]:
    """Return rows as tables again, by name."""
    return {
        name: plan_tables.columns_of_rows(getattr(rows, name), schema)
        for name, schema in _SCHEMAS.items()
    }
