"""Models and drawings of surveys, read back, beside the models that were driven through."""

from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import shapely

from scanplan.design import design_reading
from scanplan.design.drawn_storey import DrawnStorey
from scanplan.edited.dxf_reading import read_dxf
from scanplan.edited.elements import Drawing, Element
from scanplan.edited.ifc_reading import read_ifc
from scanplan.exports.sheet.openings import list_symbols
from scanplan.geometry.lines import left_normals
from scanplan.plan import floorplan, floorplan_files
from scanplan.plan.scaled_plan import scale_floorplan
from scanplan.store import schemas, tables
from scanplan.types import FloatArray

_FILES = ("plan.ifc", "presentation.ifc", "plan.dxf", "presentation.dxf")
_LEAST_M = 0.5  # a shorter wall is a jamb or a pier, and no type
_TABLES = ("faces", "walls", "openings", "rooms", "free", "furniture")
_Lines = dict[tuple[str, int], FloatArray | None]
_Elements = dict[tuple[str, int], Element]


def bench(results: Path, models: Path, surveys: Sequence[str]) -> None:
    """Print what is in each survey's files, beside its model, and in the tables they are made of.

    Parameters
    ----------
    results : Path
        Folder of the surveys' results.
    models : Path
        Folder of the models.
    surveys : sequence of str
        Each as NAME=MODEL/STOREY, or NAME alone where there is no model.
    """
    print("| | walls | m | thicknesses, cm (m of wall) | doors | windows | passages | rooms | m2 |")
    print("|---|---|---|---|---|---|---|---|---|")
    for survey in surveys:
        name, _, truth = survey.partition("=")
        if truth:
            model, _, storey = truth.partition("/")
            found = design_reading.read_design(models / model)
            _print_storey(f"{name}: {model}", next(of for of in found if of.name == storey))
        _print_tables(f"{name}: tables", results / name / "plan")
        for file in _FILES:
            (storey_read,) = design_reading.read_design(results / name / "plan" / file)
            _print_storey(f"{name}: {file}", storey_read)
    for survey in surveys:
        name = survey.partition("=")[0]
        _print_round_trip(name, results / name / "plan")


def _print_storey(title: str, storey: DrawnStorey) -> None:
    lines_m = [wall.line_m for wall in storey.walls]
    lengths_m = [float(np.hypot(*(line_m[1] - line_m[0]))) for line_m in lines_m]
    kinds = Counter(opening.kind for opening in storey.openings)
    areas_m2 = [space.area.area for space in storey.spaces]
    thickness_m = [wall.thickness_m for wall in storey.walls]
    _print_row(title, lengths_m, thickness_m, kinds, areas_m2)


def _print_tables(title: str, plan: Path) -> None:
    folder = plan / "corrected" if (plan / "corrected/walls.parquet").is_file() else plan
    walls = tables.read_table(folder / "walls.parquet", schemas.PLAN_WALLS)
    openings = tables.read_table(folder / "openings.parquet", schemas.OPENINGS, allow_empty=True)
    rooms = tables.read_table(folder / "rooms.parquet", schemas.ROOMS, allow_empty=True)
    along_m = [walls[f"{axis}1_m"] - walls[f"{axis}0_m"] for axis in ("x", "y")]
    is_hosted = openings["wall"] >= 0
    _print_row(
        title,
        np.hypot(*along_m).tolist(),
        walls["thickness_m"].tolist(),
        Counter(openings["type"][is_hosted].tolist()),
        shapely.area(shapely.from_wkb(rooms["geometry"])).tolist(),
    )


def _print_row(
    title: str,
    lengths_m: Sequence[float],
    thickness_m: Sequence[float],
    kinds: Counter[str],
    areas_m2: Sequence[float],
) -> None:
    classes: Counter[str] = Counter()
    for length_m, thick_m in zip(lengths_m, thickness_m, strict=True):
        if length_m >= _LEAST_M:
            classes["?" if np.isnan(thick_m) else f"{100 * thick_m:.0f}"] += round(length_m)
    listed = ", ".join(f"{cm} ({n})" for cm, n in classes.most_common())
    n_panes = kinds["window"] + kinds["glass"]
    cells = [title, len(lengths_m), f"{sum(lengths_m):.1f}", listed, kinds["door"], n_panes]
    cells += [kinds["passage"] + kinds["gap"], len(areas_m2), f"{sum(areas_m2):.1f}"]
    print("| " + " | ".join(map(str, cells)) + " |", flush=True)


def _print_round_trip(name: str, plan: Path) -> None:
    """Print how many elements files have of what they are made of, and how far lines are off.

    Lines of walls and openings, across, to the middle of walls as they are drawn; what reaches into
    corners does so along. Regular files are held against their model.
    """
    measured = _read_lines(plan)
    regular = _key_by_number(plan / "presentation.ifc", read_ifc)
    for file, read in (("plan.ifc", read_ifc), ("plan.dxf", read_dxf)):
        _print_found(f"{name}: {file}", measured, _key_by_number(plan / file, read))
    drawn = _key_by_number(plan / "presentation.dxf", read_dxf)
    lines = {key: element.line_m for key, element in regular.items()}
    _print_found(f"{name}: presentation.dxf", lines, drawn)


def _print_found(title: str, expected: _Lines, found: _Elements) -> None:
    said = []
    for kind in ("wall", "opening", "room"):
        keys = [key for key in expected if key[0] == kind]
        both = [key for key in keys if key in found]
        extra = sum(key[0] == kind and key not in expected for key in found)
        off_m = [_across(expected[key], found[key]) for key in both]
        far = f", off by at most {1000 * max(off_m, default=0.0):.2f} mm" if kind != "room" else ""
        said.append(f"{len(both)} of {len(keys)} {kind}s and {extra} more{far}")
    print(f"{title} read back: {'; '.join(said)}", flush=True)


def _across(expected_m: FloatArray | None, element: Element) -> float:
    """Return how far a line is off another, across; 0 of curved walls, read as a whole."""
    if expected_m is None or element.line_m is None or element.is_bent:
        return 0.0
    return float(np.abs((element.line_m - expected_m[0]) @ left_normals(expected_m[None])[0]).max())


def _read_lines(plan: Path) -> _Lines:
    """Return the lines of a plan's elements, in the middle of walls as they are drawn."""
    folder = plan / "corrected" if (plan / "corrected/walls.parquet").is_file() else plan
    found = scale_floorplan(
        floorplan_files.read_floorplan(
            {table: folder / f"{table}.parquet" for table in _TABLES}, plan.parent.name
        )
    )
    left_m, right_m = found.sides_m
    walls_m = floorplan.centrelines_m(found.walls)
    walls_m += ((left_m - right_m) / 2)[:, None, None] * left_normals(walls_m)[:, None]
    openings_m = [symbol.axis_m for symbol in list_symbols(found)]
    lines: _Lines = {("room", int(number)): None for number in found.rooms["room"]}
    for kind, columns, of_m in (
        ("wall", found.walls, walls_m),
        ("opening", found.openings, openings_m),
    ):
        lines |= {(kind, int(n)): line_m for n, line_m in zip(columns[kind], of_m, strict=True)}
    return lines


def _key_by_number(file: Path, read: Callable[[Path], Drawing]) -> _Elements:
    """Return the elements of a file by kind and number in tables."""
    drawing = read(file)
    ids = tables.read_table(file.parent / "ids.parquet", schemas.ELEMENT_IDS, allow_empty=True)
    by_id = dict(zip(ids["global_id"].tolist(), ids["number"].tolist(), strict=True))

    def number_of(element: Element) -> int:
        return int(element.key) if file.suffix != ".ifc" else int(by_id[element.key])

    of = [element for element in drawing.elements if element.kind != "furniture"]
    return {(element.kind, number_of(element)): element for element in of}
