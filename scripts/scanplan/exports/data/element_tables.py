"""The plan's walls, openings and rooms as rows: what CSV files and GeoPackage layers hold."""

import csv
import io
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from scanplan.exports import envelope
from scanplan.exports.data.element_ids import ElementIds
from scanplan.exports.geojson import round_value
from scanplan.plan.floorplan import WAYS, FloorPlan
from scanplan.types import Array, Columns

_NOT_SHOWN = ("geometry",)
_REFERENCES = ("wall", "face_left", "face_right", "room_a", "room_b")
_FORMULA = ("=", "+", "-", "@", "\t", "\r")

Rows = dict[str, list[Any]]
"""Values by column, None where not known."""


def tabulate_elements(
    plan: FloorPlan, ids: ElementIds, nominal_m: Mapping[int, float] | None = None
) -> dict[str, Rows]:
    """Return walls, openings and rooms as rows.

    Parameters
    ----------
    ids : dict of str to sequence of str
        See `element_ids.ElementIds`.
    nominal_m : dict of int to float, optional
        Widths of the catalogue, see `nominal_widths.find_nominal_widths`.

    Returns
    -------
    dict of str to dict of str to list
        By `walls`, `openings` and `rooms`: the columns of the plan's tables but for geometry, with
        `global_id` as in the building model; walls also `height_m` and `external`, openings
        `nominal_width_m` and, as rooms, the names of rooms; rooms `height_m`, where the ceiling was
        seen, `least_height_m`, as high as anything was, `net_area_m2`, less what columns stand on,
        how many doors they have, how many doors and passages, and how wide the widest is. Numbers
        are Python's; None where not known, or for no wall or room.
    """
    names = dict(zip(plan.rooms["room"].tolist(), plan.room_labels, strict=True))
    walls = _plain(plan.walls, ids["wall"])
    walls["length_m"] = np.round(plan.lengths_m, 4).tolist()
    walls["height_m"] = np.round(plan.heights_m, 4).tolist()
    walls["external"] = envelope.find_external_walls(plan).tolist()
    openings = _plain(plan.openings, ids["opening"])
    openings["nominal_width_m"] = [(nominal_m or {}).get(o) for o in openings["opening"]]
    for side in ("a", "b"):
        openings[f"room_{side}_name"] = [names.get(room) for room in openings[f"room_{side}"]]
    rooms = _plain(plan.rooms, ids["room"])
    rooms |= {"number": list(plan.room_numbers), "name": list(plan.room_names)}
    height_m = _known("height_m", plan.least_height_m)
    is_ceiling = plan.height_from == "ceiling"
    rooms["height_m"] = [height_m if is_ceiling else None] * len(plan.room_names)
    rooms["least_height_m"] = [height_m] * len(plan.room_names)
    rooms["net_area_m2"] = np.round(plan.net_areas_m2, 4).tolist()
    numbers = plan.rooms["room"].tolist()
    ways_m = [_list_widths_m(plan, room, WAYS) for room in numbers]
    rooms["n_doors"] = [len(_list_widths_m(plan, room, ("door",))) for room in numbers]
    rooms["n_ways"] = [len(widths_m) for widths_m in ways_m]
    rooms["widest_way_m"] = [_known("width_m", max(w, default=np.nan)) for w in ways_m]
    return {"walls": walls, "openings": openings, "rooms": rooms}


def _list_widths_m(plan: FloorPlan, room: int, types: Sequence[str]) -> list[float]:
    """Return how wide the openings of a room of some types are."""
    openings = plan.openings
    is_of = np.isin(openings["type"], types)
    is_of &= (openings["room_a"] == room) | (openings["room_b"] == room)
    return np.asarray(openings["width_m"], float)[is_of].tolist()


def format_csv(rows: Rows) -> str:
    """Return rows as the text of a CSV file (RFC 4180) with a line of column names.

    Nothing in it is a formula to a spreadsheet: a text that begins like one has a ' before it.
    """
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow(rows)
    writer.writerows([_cell(value) for value in row] for row in zip(*rows.values(), strict=True))
    return text.getvalue()


def format_columns(columns: Columns) -> str:
    """Return the columns of a table but its geometry likewise, lengths to 0.1 mm."""
    rows = {
        name: [round_value(value) for value in values.tolist()]
        for name, values in columns.items()
        if name != "geometry"
    }
    return format_csv(rows)


def _plain(columns: Columns, global_ids: Sequence[str]) -> Rows:
    shown: Mapping[str, Array] = {n: c for n, c in columns.items() if n not in _NOT_SHOWN}
    own, *others = shown
    rows: Rows = {own: shown[own].tolist(), "global_id": list(global_ids)}
    for name in others:
        rows[name] = [_known(name, value) for value in shown[name].tolist()]
    return rows


def _known(name: str, value: Any) -> Any:
    if name in _REFERENCES and value == -1:
        return None
    if not isinstance(value, float):
        return value
    # to a tenth of a millimetre, as drawings are
    return None if np.isnan(value) else round(value, 4)


def _cell(value: Any) -> Any:
    if isinstance(value, bool):
        return str(value).lower()
    is_formula = isinstance(value, str) and value.startswith(_FORMULA)
    return f"'{value}" if is_formula else value
