"""The next visit as GeoJSON, in the local metres of the survey."""

import json

import numpy as np
import shapely

from scanplan.exports.geojson import CRS, NOTE, Feature, round_value
from scanplan.types import Array, Columns
from scanplan.visit.next_visit import NextVisit


def format_visit(name: str, visit: NextVisit, summary: str) -> str:
    """Return a visit as the text of a GeoJSON FeatureCollection, one feature a line.

    Parameters
    ----------
    name : str
        The dataset's.
    summary : str
        In words; a member of the collection, also where there is no feature.

    Returns
    -------
    str
        Features are, by `feature`: standpoint (Point), way (LineString to a standpoint) and
        question (MultiLineString), with the columns of their tables, null where not known.
    """
    collection = {
        "type": "FeatureCollection",
        "name": f"{name}, next visit",
        "crs": {"type": "name", "properties": {"name": CRS}},
        "note": NOTE,
        "units": "m",
        "summary": summary,
    }
    places = np.column_stack([visit.standpoints["x_m"], visit.standpoints["y_m"]])
    features = [
        *_features("standpoint", visit.standpoints, np.asarray(shapely.points(places))),
        *_features("way", visit.standpoints, shapely.from_wkb(visit.standpoints["geometry"])),
        *_features("question", visit.questions, shapely.from_wkb(visit.questions["geometry"])),
    ]
    head = json.dumps(collection, ensure_ascii=False)
    lines = ",\n".join(json.dumps(feature, allow_nan=False) for feature in features)
    return f'{head[:-1]}, "features": [\n{lines}\n]}}\n'


def _features(what: str, columns: Columns, shapes: Array) -> list[Feature]:
    """Return features of the rows of a table; of ways their number and length alone."""
    names = ("standpoint", "way_m") if what == "way" else [n for n in columns if n != "geometry"]
    # a tenth of a millimetre
    rounded = shapely.transform(shapes, lambda xy_m: np.round(xy_m, 4) + 0.0)
    features = []
    for row, shape in enumerate(rounded):
        values = {name: round_value(columns[name][row]) for name in names}
        features.append({
            "type": "Feature",
            "id": f"{what}-{row + 1}",
            "properties": {"feature": what, **values},
            "geometry": json.loads(shapely.to_geojson(shape)),
        })  # fmt: skip
    return features
