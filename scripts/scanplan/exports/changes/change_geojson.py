"""What two plans differ by as GeoJSON, in the local metres of the first."""

import shapely

from scanplan.exports.geojson import format_collection, make_feature
from scanplan.types import Columns


def format_changes(name: str, noun: str, columns: Columns, summary: str) -> str:
    """Return changes or deviations as the text of a GeoJSON FeatureCollection, one feature a line.

    Parameters
    ----------
    name : str
        Of the comparison.
    noun : str
        What a row is called in its id.
    columns : dict of str to (n,) array
        Those of `schemas.CHANGES` or `schemas.DEVIATIONS`: a feature's properties.
    summary : str
        In words; a member of the collection.
    """
    shapes = shapely.from_wkb(columns["geometry"])
    names = [n for n in columns if n != "geometry"]
    features = [
        make_feature(f"{noun}-{row}", shape, {n: columns[n][row] for n in names})
        for row, shape in enumerate(shapes)
    ]
    return format_collection(name, features, summary=summary)
