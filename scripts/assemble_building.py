"""Put the plans of several storeys into one model, one drawing and one set of sheets."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from scanplan.errors import StageError
from scanplan.exports import drawing
from scanplan.exports.building.dxf_storeys import format_building_dxf
from scanplan.exports.building.ifc_storeys import merge_ifc
from scanplan.exports.building.placed_storey import PlacedStorey
from scanplan.exports.building.sheet_set import compose_sheets
from scanplan.exports.sheet.composition import Sheet
from scanplan.exports.sheet.facts import gather_facts
from scanplan.exports.sheet.locale import Locale, make_locale
from scanplan.plan import floorplan_files
from scanplan.plan.scaled_plan import scale_floorplan
from scanplan.project import building_file, code_files
from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath, Settings


def assemble_building(
    files: Mapping[str, Sequence[FilePath]],
    outputs: Mapping[str, FilePath],
    *,
    name: str,
    storeys: Sequence[Mapping[str, Any]],
    settings: Sequence[Settings],
    receivers: Sequence[Mapping[str, Any]] | None = None,
    version: str = "",
) -> None:
    """Write building.ifc, building.dxf and building.pdf.

    Parameters
    ----------
    files : dict of str to list of path-like
        Of each storey, from the lowest up: `ifc` and the tables of its plan, as `export_plan` has
        them.
    outputs : dict of str to path-like
        `ifc`, `dxf` and `pdf`, to write.
    name : str
        Of the building.
    storeys : sequence of dict
        What `building_file.Storey` says of each, by name.
    settings : sequence of dict
        What `export_plan` is told of each; the lowest storey's `turn` and `dxf_unit` hold for all.
    receivers : sequence of dict, optional
        See `words_file.read_receiver`, of each storey; layers are the lowest one's. English
        and our layers if not given.
    version : str
        Of the software, for the title blocks.

    Raises
    ------
    StageError
        If a storey has neither an elevation nor a floor that was seen.
    """
    elevations_m = [
        _elevation_m(storey, free) for storey, free in zip(storeys, files["free"], strict=True)
    ]
    found_m = {s["dataset"]: high_m for s, high_m in zip(storeys, elevations_m, strict=True)}
    if fault := building_file.explain_low_storey(found_m):
        log.log_warning(f"assemble_building: {fault}; give their `elevation_m` in building.yaml")
    placed = [
        PlacedStorey(
            storey["name"],
            Path(path).read_text(encoding="utf-8"),
            x_m=storey["place"][0],
            y_m=storey["place"][1],
            rotation_rad=math.radians(storey["place"][2]),
            elevation_m=elevation_m,
        )
        for storey, path, elevation_m in zip(storeys, files["ifc"], elevations_m, strict=True)
    ]
    told = receivers or [{}] * len(storeys)
    locales = [
        make_locale(own["units"], of.get("words")) for own, of in zip(settings, told, strict=True)
    ]
    sheets = _compose_sheets(files, name, storeys, settings, version, locales)
    figures = [drawing.draw_sheet(sheet) for sheet in sheets]
    atomic.write_text(outputs["ifc"], merge_ifc(name, placed))
    drawn = format_building_dxf(placed, sheets, settings[0]["dxf_unit"], told[0].get("layers"))
    atomic.write_text(outputs["dxf"], drawn)
    pages = figure_files.format_pdf(figures, f"Floor plans of {name}", sheets[0].facts.answerable)
    atomic.write_bytes(outputs["pdf"], pages)
    heights = ", ".join(
        f"{storey['name']} at {elevation_m:.2f} m"
        for storey, elevation_m in zip(storeys, elevations_m, strict=True)
    )
    on_paper = f"{len(sheets)} sheets at 1:{sheets[0].page.scale}"
    log.log_line(f"assemble_building: {len(storeys)} storeys of {name}: {heights}; {on_paper}")


def _compose_sheets(
    files: Mapping[str, Sequence[FilePath]],
    name: str,
    storeys: Sequence[Mapping[str, Any]],
    settings: Sequence[Settings],
    version: str,
    locales: Sequence[Locale],
) -> list[Sheet]:
    """Return a sheet of each storey, with the names that the building gives it."""
    plans, facts = [], []
    for number, (storey, own) in enumerate(zip(storeys, settings, strict=True)):
        paths = {table: files[table][number] for table in files if table != "ifc"}
        assumed_m = {key: own[key] for key in ("assumed_thickness_m", "assumed_height_m")}
        in_map = floorplan_files.read_floorplan(paths, storey["dataset"], **assumed_m)
        plan = scale_floorplan(in_map)
        evidence = tables.read_table(paths["evidence"], schemas.EVIDENCE, allow_empty=True)
        known = gather_facts(evidence, plan, own, locales[number], version)
        stated = {"project": known.project or name, "storey": storey["name"]}
        facts.append(replace(known, **stated, number=number + 1, of=len(storeys)))
        plans.append(plan)
    rotations_rad = [
        math.radians(storey["place"][2]) if storey["aligned"] else None for storey in storeys
    ]
    return compose_sheets(plans, facts, rotations_rad, turn=settings[0]["turn"])


def _elevation_m(storey: Mapping[str, Any], free: FilePath) -> float:
    """Return where a storey's floor lies: as given, or where the shared map frame shows it."""
    if storey["elevation_m"] is not None:
        return storey["elevation_m"]
    floor_z_m = float(tables.read_note(free, schemas.FREE, "floor_z_m") or "nan")
    if math.isnan(floor_z_m):
        fault = f"no floor was seen in storey {storey['name']}"
        raise StageError(f"{free}: {fault}; give its elevation_m in building.yaml")
    return floor_z_m


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        assemble_building(
            dict(snakemake.input.items()),
            dict(snakemake.output.items()),
            name=snakemake.params.name,
            storeys=snakemake.params.storeys,
            settings=snakemake.params.settings,
            receivers=snakemake.params.receivers,
            version=code_files.state_version(),
        )
