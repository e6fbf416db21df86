"""The files of the plan drawn by hand with what a person says of it, and the words in them."""

import json
import re
import zlib
from contextlib import suppress
from xml.etree import ElementTree

import ezdxf
import ifcopenshell
import numpy as np
import pandas as pd
import pyogrio
import yaml

from correct_plan import correct_plan
from export_files import export_files
from export_plan import export_plan
from export_presentation import export_presentation
from helpers import floorplan_making
from helpers.default_settings import SETTINGS
from helpers.report_making import registration
from scanplan.plan import planning
from scanplan.project import catalogue_file, export_formats, stage_settings
from scanplan.store import schemas, tables
from scanplan.store.pose_columns import pose_columns

DRAWN = ("geojson", "dxf", "svg", "pdf", "png", "pgm", "yaml")
FILES = export_formats.list_files(export_formats.FILES)
REGULAR = export_formats.PRESENTATION["presentation"]


def exported(folder, corrections=(), name="office", **settings):
    """The files of the plan drawn by hand, with corrections."""
    plan = {table: folder / f"{table}.parquet" for table in planning.TABLES}
    for table, schema in planning.TABLES.items():
        tables.write_table(plan[table], schema, getattr(floorplan_making, table)())
    if corrections:
        path = folder / "corrections.yaml"
        path.write_text(yaml.safe_dump({"corrections": list(corrections)}))
        outputs = {table: folder / f"corrected/{table}.parquet" for table in planning.TABLES}
        correct_plan(path, plan, outputs)
        plan = outputs
    registered = registration()
    plan |= {"registration": folder / "registration.parquet", "poses": folder / "poses.parquet"}
    tables.write_table(plan["registration"], schemas.REGISTRATION, registered)
    n = len(registered["scan_id"])
    poses = {
        "scan_id": registered["scan_id"],
        "t_ns": registered["t_ns"],
        **pose_columns(np.zeros((n, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (n, 1))),
        "gap_s": np.zeros(n),
        "covered": np.ones(n, bool),
    }
    tables.write_table(plan["poses"], schemas.POSES, poses)
    files = {kind: folder / f"plan.{kind}" for kind in DRAWN}
    files |= {kind: folder / FILES[kind] for kind in FILES if kind != "laz"}
    drawing = stage_settings.select_drawing(SETTINGS) | settings
    export_plan(plan, files, name=name, settings=drawing)
    written = {kind: files[kind] for kind in FILES if kind in files}
    written |= {"ids": folder / "ids.parquet", "known": folder / "known.parquet"}
    own = stage_settings.select_files(SETTINGS)
    export_files(plan, written, name=name, source="a", settings=own)
    of_regular = {what: folder / file for what, file in REGULAR.items()}
    regular = stage_settings.select_presentation(SETTINGS) | settings
    sizes = catalogue_file.read_catalogue(None)
    export_presentation(plan, of_regular, name=name, settings=regular, catalogue=sizes)
    return files | {"regular": of_regular["dxf"]}


def pdf_texts(pdf):
    """The words that a PDF of ours shows: two bytes a character, parted where letters are moved."""
    for stream in re.findall(rb"stream\r?\n(.*?)\r?\nendstream", pdf, re.DOTALL):
        with suppress(zlib.error):
            # the last byte of what is packed may be read as the end of a line
            content = zlib.decompressobj().decompress(stream)
            for word in re.findall(rb"\[ (.*?) \]\s+TJ", content, re.DOTALL):
                parts = re.findall(rb"\(((?:\\.|[^\\()])*)\)", word, re.DOTALL)
                yield re.sub(rb"\\(.)", rb"\1", b"".join(parts)).decode("utf-16-be")


def read_texts(files):
    """What each file of a plan shows as text, as programs read it, by kind of file."""
    (spaces,) = [ifcopenshell.open(files["ifc"]).by_type("IfcSpace")]
    features = json.loads(files["geojson"].read_text(encoding="utf-8"))["features"]
    about, _, _, columns = pyogrio.raw.read(files["gpkg"], layer="rooms")
    document = ezdxf.readfile(files["dxf"])
    attributes = [a for insert in document.modelspace().query("INSERT") for a in insert.attribs]
    shown = ElementTree.parse(files["svg"]).iter()
    return {
        "ifc": [space.LongName for space in spaces],
        "geojson": [feature["properties"].get("name") for feature in features],
        "json": [room["name"] for room in json.loads(files["json"].read_text())["rooms"]],
        "gpkg": dict(zip(about["fields"], columns, strict=True))["name"].tolist(),
        "csv": pd.read_csv(files["rooms_csv"])["name"].tolist(),
        "dxf": [ezdxf.decode_dxf_unicode(a.plain_text()) for a in attributes],
        "svg": ["".join(element.itertext()) for element in shown],
        "pdf": list(pdf_texts(files["pdf"].read_bytes())),
    }
