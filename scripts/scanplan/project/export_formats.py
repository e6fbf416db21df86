"""The files that a plan is exported to, by the formats that the settings name.

No heavy imports: this runs while the workflow is being parsed.
"""

from __future__ import annotations

from collections.abc import Iterable
from importlib.util import find_spec

from scanplan.errors import name_extra

FILES = {
    "ifc": {"ifc": "plan/plan.ifc"},
    "glb": {"glb": "plan/plan.glb"},
    "gpkg": {"gpkg": "plan/plan.gpkg"},
    "imdf": {"imdf": "plan/imdf.geojson"},
    "csv": {f"{table}_csv": f"plan/{table}.csv" for table in ("walls", "openings", "rooms")},
    "json": {"json": "plan/rooms.json"},
    "tum": {"trajectory": "trajectory.tum", "localiser": "localiser.tum"},
    "masks": {
        f"{mask}_{suffix}": f"plan/{mask}.{suffix}"
        for mask in ("keepout", "speed")
        for suffix in ("pgm", "yaml")
    },
    "editable": {"editable": "plan/presentation.ifc"},
    "bcf": {"bcf": "plan/doubts.bcf"},
    "openplan": {"openplan": "plan/plan.openplan3d.json"},
}
"""What the stage `export_files` writes of each format, by what it is."""
PRESENTATION = {
    "presentation": {
        **{suffix: f"plan/presentation.{suffix}" for suffix in ("svg", "pdf", "png", "dxf")},
        "tiles": "plan/presentation_a3.pdf",
        "walls": "plan/presentation.parquet",
    }
}
"""The same of the stage `export_presentation`."""
CLOUD = {"laz": {"cloud": "cloud.laz", "picture": "cloud.png"}}
"""The same of the stage `export_cloud`."""


LIBRARIES = {"ifc": "ifcopenshell", "editable": "ifcopenshell"}
"""What some formats are written by that not every installation has."""


def list_lacking() -> list[str]:
    """Return the formats whose library is not installed."""
    return [name for name, library in LIBRARIES.items() if find_spec(library) is None]


def tell_lacking() -> list[str]:
    """Return a line for each format that is left out as its library is not installed."""
    return [
        f"{', '.join(list_exports([name]))}: is not written unless asked for, as"
        f" {name_extra(LIBRARIES[name])}"
        for name in list_lacking()
    ]


def list_replaced(formats: Iterable[str]) -> list[str]:
    """Return the files of formats that are not chosen, of an earlier choice, below the same."""
    others = sorted({*FILES, *PRESENTATION} - set(formats))
    return [file for name in others for file in (FILES | PRESENTATION)[name].values()]


def list_files(formats: Iterable[str]) -> dict[str, str]:
    """Return the files of `export_files` below results/<dataset>/, by what they are."""
    return {what: file for name in formats if name in FILES for what, file in FILES[name].items()}


def list_exports(formats: Iterable[str]) -> list[str]:
    """Return all files of some formats, below results/<dataset>/."""
    asked = list(formats)
    others = PRESENTATION | CLOUD
    drawn = [file for name in others if name in asked for file in others[name].values()]
    return [*list_files(asked).values(), *drawn]
