"""Links from the report to the files that lie beside it."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import PurePath

_WORDS = {
    "plan.svg": "drawing (SVG)",
    "plan.pdf": "drawing (PDF)",
    "plan.png": "picture (PNG)",
    "presentation.pdf": "regular drawing (PDF)",
    "presentation_a3.pdf": "the same on A3",
    "presentation.svg": "regular drawing (SVG)",
    "presentation.png": "its picture (PNG)",
    "presentation.ifc": "its building model to go on with (IFC)",
    "keepout.pgm": "where a robot keeps out (nav2)",
    "speed.pgm": "where a robot is slow (nav2)",
    "doubts.bcf": "doubts for model viewers (BCF)",
    "plan.openplan3d.json": "project to edit (openPlan3D)",
    "presentation.dxf": "its CAD (DXF)",
    "plan.dxf": "CAD (DXF)",
    "plan.ifc": "building model (IFC)",
    "plan.geojson": "GeoJSON",
    "plan.gpkg": "GIS (GeoPackage)",
    "imdf.geojson": "rooms and ways (IMDF)",
    "plan.glb": "3-D model (GLB)",
    "rooms.csv": "rooms (CSV)",
    "openings.csv": "openings (CSV)",
    "walls.csv": "walls (CSV)",
    "rooms.json": "rooms and doors (JSON)",
    "cloud.laz": "points (LAZ)",
    "cloud.png": "points from above (PNG)",
    "next_visit.geojson": "next visit (GeoJSON)",
    "map.yaml": "robot map (nav2)",
    "map.pgm": "its image (PGM)",
    "trajectory.tum": "trajectory (TUM)",
    "localiser.tum": "localiser's trajectory (TUM)",
    "summary.txt": "summary",
}
_NO_PRODUCT = (".parquet", ".html")


@dataclass(frozen=True)
class ResultLink:
    """A file beside the report: where it lies from there, and what it is."""

    href: str
    text: str


def link_results(files: Iterable[str]) -> list[ResultLink]:
    """Return links to the files that people open; tables between stages and figures are none.

    Parameters
    ----------
    files : iterable of str
        Paths from the report's folder.

    Returns
    -------
    list of ResultLink
        In the order of their importance; a file that is not known comes last, by its name.
    """
    known = list(_WORDS)
    products = [PurePath(file) for file in files]
    shown = [
        p for p in products if p.suffix not in _NO_PRODUCT and p.parts[0] not in ("figures", "..")
    ]
    shown.sort(key=lambda p: (known.index(p.name) if p.name in known else len(known), str(p)))
    return [ResultLink(p.as_posix(), _WORDS.get(p.name, p.name)) for p in shown]
