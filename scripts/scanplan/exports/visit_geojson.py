"""The next visit as GeoJSON, placed as the plan's."""

import numpy as np
import shapely

from scanplan.exports.geojson import Feature, format_collection, make_feature, state_system
from scanplan.exports.model_origin import NOWHERE, Site
from scanplan.plan.scaled_plan import scale_shapes
from scanplan.types import Array, Columns
from scanplan.visit.next_visit import NextVisit


def format_visit(
    name: str, visit: NextVisit, summary: str, site: Site = NOWHERE, scale: float = 1.0
) -> str:
    """Return a visit as the text of a GeoJSON FeatureCollection, one feature a line.

    Parameters
    ----------
    name : str
        The dataset's.
    summary : str
        In words; a member of the collection, also where there is no feature.
    site : Site
        Where the map lies: coordinates are in its system, the map's where it is in none.
    scale : float
        By which the map is multiplied before.

    Returns
    -------
    str
        Features are, by `feature`: standpoint (Point), way (LineString to a standpoint, none to
        one where the sensor stands already) and question (MultiLineString), with the columns of
        their tables, null where not known: these are in the map's frame, which robots drive in.
    """
    places = np.column_stack([visit.standpoints["x_m"], visit.standpoints["y_m"]])
    of_features = (
        ("standpoint", visit.standpoints, np.asarray(shapely.points(places), object)),
        ("way", visit.standpoints, shapely.from_wkb(visit.standpoints["geometry"])),
        ("question", visit.questions, shapely.from_wkb(visit.questions["geometry"])),
    )
    features = [
        feature
        for what, columns, shapes in of_features
        for feature in _features(what, columns, site.place_shapes(scale_shapes(shapes, scale)))
    ]
    system = state_system(site)
    return format_collection(f"{name}, next visit", features, summary=summary, **system)


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
        if not shape.is_empty
    ]
