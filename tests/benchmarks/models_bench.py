"""Models and drawings of surveys, read back, beside the models that were driven through."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import ifcopenshell
import numpy as np
import shapely
from ezdxf.entities.dxfentity import DXFEntity
from ezdxf.entities.insert import Insert
from ezdxf.entities.lwpolyline import LWPolyline
from ezdxf.filemanagement import readfile
from ifcopenshell import entity_instance
from ifcopenshell.util.element import get_pset

from scanplan.design import design_reading
from scanplan.design.drawn_storey import DrawnStorey
from scanplan.exports.dxf_document import APPLICATION
from scanplan.store import schemas, tables

_FILES = ("plan.ifc", "presentation.ifc", "plan.dxf", "presentation.dxf")
_LEAST_M = 0.5  # a shorter wall is a jamb or a pier, and no type
_PER_M = {4: 1000.0, 6: 1.0}  # by the units of DXF: millimetres, metres
_APPLICATION_CODE = 1001  # of extended data: whose they are


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
    """Print how many elements of the tables the measured plan's files have, and what is off."""
    elements = {
        "wall": _read_sizes(plan, "walls", schemas.PLAN_WALLS, "wall"),
        "opening": _read_sizes(plan, "openings", schemas.OPENINGS, "opening"),
        "room": _read_sizes(plan, "rooms", schemas.ROOMS, "room"),
    }
    for file, read in (("plan.ifc", _read_ifc), ("plan.dxf", _read_dxf)):
        found = read(plan / file)
        said = []
        for table, sizes in elements.items():
            both = sizes.keys() & found[table].keys()
            off = max((abs(sizes[number] - found[table][number]) for number in both), default=0.0)
            said.append(f"{len(both)} of {len(sizes)} {table}s, off by at most {off:.4f}")
        print(f"{name}: {file} read back: {'; '.join(said)}", flush=True)


def _read_sizes(plan: Path, table: str, schema: schemas.Schema, key: str) -> dict[int, float]:
    """Return lengths of walls, widths of openings in walls and areas of rooms by number."""
    folder = plan / "corrected" if (plan / "corrected/walls.parquet").is_file() else plan
    columns = tables.read_table(folder / f"{table}.parquet", schema, allow_empty=True)
    if key == "room":
        sizes = shapely.area(shapely.from_wkb(columns["geometry"]))
    else:
        sizes = np.hypot(*(columns[f"{axis}1_m"] - columns[f"{axis}0_m"] for axis in ("x", "y")))
    is_wanted = np.ones(len(sizes), bool)
    if key == "opening":
        is_wanted = np.isin(columns["type"], ("door", "window"))
    if key == "wall":
        is_wanted = ~np.isfinite(columns["arc_radius_m"])
    numbers = columns[key][is_wanted].tolist()
    return dict(zip(numbers, sizes[is_wanted].tolist(), strict=True))


def _read_ifc(path: Path) -> dict[str, dict[int, float]]:
    """Return the same of a model: by its quantities, and the widths of doors and windows."""
    model = ifcopenshell.open(path)

    def measure(ifc_class: str, quantities: str, name: str) -> Iterator[tuple[str, float]]:
        for element in model.by_type(ifc_class):
            assert isinstance(element, entity_instance)
            found = get_pset(element, quantities, name)
            assert isinstance(found, float)
            number = element.Name if ifc_class == "IfcSpace" else element.Tag
            yield number, found

    def number(sizes: Iterable[tuple[str, float]]) -> dict[int, float]:
        return {int(of): size for of, size in sizes}

    doors = measure("IfcDoor", "Qto_DoorBaseQuantities", "Width")
    windows = measure("IfcWindow", "Qto_WindowBaseQuantities", "Width")
    return {
        "wall": number(measure("IfcWall", "Qto_WallBaseQuantities", "Length")),
        "opening": number([*doors, *windows]),
        "room": number(measure("IfcSpace", "Qto_SpaceBaseQuantities", "NetFloorArea")),
    }


def _read_dxf(path: Path) -> dict[str, dict[int, float]]:
    """Return the same of a drawing: its lines, blocks and outlines, by their extended data."""
    document = readfile(path)
    per_m = _PER_M[document.units]
    found: dict[str, dict[int, float]] = {"wall": {}, "opening": {}, "room": {}}
    for entity in document.modelspace():
        facts = _read_facts(entity)
        layer = entity.dxf.layer
        if isinstance(entity, Insert) and "opening" in facts:
            found["opening"][facts["opening"]] = entity.dxf.xscale / per_m
        if not isinstance(entity, LWPolyline):
            continue
        corners_m = np.array([point[:2] for point in entity.get_points("xy")]) / per_m
        if layer == "A-WALL-CNTR" and "wall" in facts:
            found["wall"][facts["wall"]] = float(np.hypot(*np.diff(corners_m, axis=0).T).sum())
        elif layer.startswith("A-AREA") and "room" in facts:
            area_m2 = shapely.Polygon(corners_m).area
            found["room"][facts["room"]] = max(area_m2, found["room"].get(facts["room"], 0.0))
    return found


def _read_facts(entity: DXFEntity) -> dict[str, int]:
    if not entity.has_xdata(APPLICATION):
        return {}
    values = [tag.value for tag in entity.get_xdata(APPLICATION) if tag.code != _APPLICATION_CODE]
    pairs = zip(values[::2], values[1::2], strict=True)
    return {name: value for name, value in pairs if name in ("wall", "opening", "room")}
