"""The files that a plan is exported to, by the formats that the settings name.

No heavy imports: this runs while the workflow is being parsed.
"""

from __future__ import annotations

from collections.abc import Iterable

FILES = {
    "ifc": {"ifc": "plan/plan.ifc"},
    "glb": {"glb": "plan/plan.glb"},
    "gpkg": {"gpkg": "plan/plan.gpkg"},
    "csv": {f"{table}_csv": f"plan/{table}.csv" for table in ("walls", "openings", "rooms")},
    "json": {"json": "plan/rooms.json"},
    "tum": {"trajectory": "trajectory.tum", "localiser": "localiser.tum"},
}
"""What the stage `export_files` writes of each format, by what it is."""
CLOUD = ("laz", "cloud.laz")
"""The format and the file of the stage `export_cloud`."""


def list_files(formats: Iterable[str]) -> dict[str, str]:
    """Return the files of `export_files` below results/<dataset>/, by what they are."""
    return {what: file for name in formats if name in FILES for what, file in FILES[name].items()}


def list_exports(formats: Iterable[str]) -> list[str]:
    """Return all files of some formats, below results/<dataset>/."""
    asked = list(formats)
    laz, cloud = CLOUD
    return [*list_files(asked).values(), *([cloud] if laz in asked else [])]
