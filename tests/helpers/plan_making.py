"""Plans made up for tests.

Their tables, columns by name, as the stage that assembles a plan writes them.
"""

import numpy as np
import shapely

from helpers.wall_making import walls
from scanplan.store import schemas, tables

_EMPTY = {
    "int32": np.int32,
    "int64": np.int64,
    "float64": float,
    "bool": bool,
    "string": object,
    "binary": object,
}


def table(schema, rows=()):
    """Return columns of rows, each a dict; what a row does not say is 0."""
    return {
        name: np.array([row.get(name, _nothing(kind)) for row in rows], _EMPTY[kind])
        for name, kind in schema.columns.items()
    }


def _nothing(kind):
    return {"string": "", "bool": False, "binary": b""}.get(kind, 0)


def line(segment):
    """Return the ends (x0, y0, x1, y1) as columns of a row."""
    return dict(zip(("x0_m", "y0_m", "x1_m", "y1_m"), segment, strict=True))


def faces(segments, state="observed"):
    """Return observed faces, each seen from the left of its way."""
    shown = walls(segments)
    own = {
        "face": np.arange(len(segments)),
        "n_scans": np.ones(len(segments), int),
        "wall": np.full(len(segments), -1),
    }
    states = {"state": np.full(len(segments), state, object)}
    return (
        {name: shown[name] for name in schemas.FACES.columns if name in shown and name != "wall"}
        | own
        | states
    )


def write(folder, scan_ids, *, face_segments, wall_rows=(), opening_rows=(), rooms=()):
    """Write the tables of a plan, and return their paths by name; `rooms` are polygons."""
    number = {"walls": "wall", "openings": "opening", "rooms": "room"}
    room_rows = [{"geometry": shapely.to_wkb(room), "area_m2": room.area} for room in rooms]
    rows = {"walls": wall_rows, "openings": opening_rows, "rooms": room_rows}
    kinds = {"walls": schemas.PLAN_WALLS, "openings": schemas.OPENINGS, "rooms": schemas.ROOMS}
    made = {
        name: table(kinds[name], [{number[name]: i, **row} for i, row in enumerate(rows[name])])
        for name in rows
    }
    made["evidence"] = table(schemas.EVIDENCE, [{"scan_id": scan_id} for scan_id in scan_ids])
    made["faces"] = faces(face_segments)
    made["furniture"] = table(schemas.FURNITURE)
    made["free"] = table(schemas.FREE)
    kinds |= {"evidence": schemas.EVIDENCE, "faces": schemas.FACES}
    kinds |= {"furniture": schemas.FURNITURE, "free": schemas.FREE}
    paths = {name: folder / f"{name}.parquet" for name in made}
    for name, path in paths.items():
        tables.write_table(path, kinds[name], made[name], allow_empty=True)
    return paths
