"""Corrections carried out on the plan of two rooms drawn by hand."""

import yaml

from correct_plan import correct_plan
from helpers import floorplan_making
from scanplan.plan import floorplan, floorplan_files, planning
from scanplan.store import tables

MADE = {name: getattr(floorplan_making, name) for name in planning.TABLES}


def write_plan(folder):
    """The tables of the plan in a folder, by name."""
    paths = {name: folder / f"{name}.parquet" for name in planning.TABLES}
    notes = {"floor_z_m": "0.0", "ceiling_z_m": "2.5", "other": "kept"}
    for name, schema in planning.TABLES.items():
        own = notes if name == "free" else None
        tables.write_table(paths[name], schema, MADE[name](), notes=own)
    return paths


def corrected(plan, *entries):
    """The corrected plan of such tables; `element: wall` and the like are keys of each entry."""
    folder = plan["walls"].parent
    path = folder / "corrections.yaml"
    path.write_text(yaml.safe_dump({"corrections": list(entries)}))
    outputs = {name: folder / f"corrected/{name}.parquet" for name in planning.TABLES}
    correct_plan(path, plan, outputs)
    return floorplan_files.read_floorplan(outputs, "office")


def faces_of(plan, wall):
    """Lines of the faces of a wall, (n, 2, 2)."""
    return floorplan.centrelines_m(plan.faces)[plan.faces["wall"] == wall]
