"""The next visit as GeoJSON, in the local metres of the survey."""

import numpy as np
import shapely

from scanplan.exports.geojson import Feature, format_collection, make_feature
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
    places = np.column_stack([visit.standpoints["x_m"], visit.standpoints["y_m"]])
    features = [
        *_features("standpoint", visit.standpoints, np.asarray(shapely.points(places))),
        *_features("way", visit.standpoints, shapely.from_wkb(visit.standpoints["geometry"])),
        *_features("question", visit.questions, shapely.from_wkb(visit.questions["geometry"])),
    ]
    return format_collection(f"{name}, next visit", features, summary=summary)


def _features(what: str, columns: Columns, shapes: Array) -> list[Feature]:
    """Return features of the rows of a table; of ways their number and length alone."""
    names = ("standpoint", "way_m") if what == "way" else [n for n in columns if n != "geometry"]
    return [
        make_feature(
            f"{what}-{row + 1}",
            shape,
            {"feature": what, **{name: columns[name][row] for name in names}},
        )
        for row, shape in enumerate(shapes)
    ]
