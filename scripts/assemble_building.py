"""Put the plans of several storeys into one model and one drawing."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from scanplan.errors import StageError
from scanplan.exports.building.dxf_storeys import merge_dxf
from scanplan.exports.building.ifc_storeys import merge_ifc
from scanplan.exports.building.placed_storey import PlacedStorey
from scanplan.stage import log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath


def assemble_building(
    files: Mapping[str, Sequence[FilePath]],
    outputs: Mapping[str, FilePath],
    *,
    name: str,
    storeys: Sequence[Mapping[str, Any]],
) -> None:
    """Write building.ifc and building.dxf.

    Parameters
    ----------
    files : dict of str to list of path-like
        `ifc`, `dxf` and `free` of each storey's plan, from the lowest up.
    outputs : dict of str to path-like
        `ifc` and `dxf`, to write.
    name : str
        Of the building.
    storeys : sequence of dict
        What `building_file.Storey` says of each, by name.

    Raises
    ------
    StageError
        If a storey has neither an elevation nor a floor that was seen.
    """
    elevations_m = [
        _elevation_m(storey, free) for storey, free in zip(storeys, files["free"], strict=True)
    ]

    def place(paths: Sequence[FilePath]) -> list[PlacedStorey]:
        return [
            PlacedStorey(
                storey["name"],
                Path(path).read_text(encoding="utf-8"),
                x_m=storey["place"][0],
                y_m=storey["place"][1],
                rotation_rad=math.radians(storey["place"][2]),
                elevation_m=elevation_m,
            )
            for storey, path, elevation_m in zip(storeys, paths, elevations_m, strict=True)
        ]

    atomic.write_text(outputs["ifc"], merge_ifc(name, place(files["ifc"])))
    atomic.write_text(outputs["dxf"], merge_dxf(place(files["dxf"])))
    heights = ", ".join(
        f"{storey['name']} at {elevation_m:.2f} m"
        for storey, elevation_m in zip(storeys, elevations_m, strict=True)
    )
    log.log_line(f"assemble_building: {len(storeys)} storeys of {name}: {heights}")


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
            {kind: snakemake.input[kind] for kind in ("ifc", "dxf", "free")},
            dict(snakemake.output.items()),
            name=snakemake.params.name,
            storeys=snakemake.params.storeys,
        )
