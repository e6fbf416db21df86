"""What changed between two surveys as GeoJSON, in the local metres of the earlier one."""

import shapely

from scanplan.exports.geojson import format_collection, make_feature
from scanplan.types import Columns


def format_changes(name: str, columns: Columns, summary: str) -> str:
    """Return changes as the text of a GeoJSON FeatureCollection, one feature a line.

    Parameters
    ----------
    name : str
        Of the comparison.
    columns : dict of str to (n,) array
        Those of `schemas.CHANGES`: a feature's properties.
    summary : str
        In words; a member of the collection.
    """
    shapes = shapely.from_wkb(columns["geometry"])
    names = [n for n in columns if n != "geometry"]
    features = [
        make_feature(f"change-{row}", shape, {n: columns[n][row] for n in names})
        for row, shape in enumerate(shapes)
    ]
    return format_collection(name, features, summary=summary)
