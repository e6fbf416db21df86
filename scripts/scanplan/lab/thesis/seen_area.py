"""The floor area that scans truly see, as polygons."""

import numpy as np
import shapely

from scanplan.lab.evaluation import visible_faces


def seen_polygons(faces, places_m, *, max_range_m):
    """Return what can be seen from each place: as far as the first true face, and no farther than the range.

    Parameters
    ----------
    faces : truth_file.TrueFaces
    places_m : (n, 2) float
    max_range_m : float

    Returns
    -------
    (n,) numpy.ndarray of shapely Polygon or MultiPolygon
    """
    hiding_m = np.concatenate([faces.inner_m, faces.outer_m])
    outlines = [
        visible_faces.visible_polygon(hiding_m, place_m, open_m=2 * max_range_m)
        for place_m in places_m
    ]
    # neighbouring corners that coincide make an outline touch itself; what collapses to a line has no area
    touching = np.array([shapely.Polygon(outline) for outline in outlines])
    seen = shapely.make_valid(touching, method="structure", keep_collapsed=False)
    return shapely.intersection(
        seen, shapely.buffer(shapely.points(places_m), max_range_m, quad_segs=64)
    )


def polygon_iou(polygons, seen):
    """Return intersection over union of polygons (n,) with what their scans see (n,); 0 where both are empty."""
    both, either = (
        shapely.area(overlay(polygons, seen)) for overlay in (shapely.intersection, shapely.union)
    )
    return np.divide(both, either, out=np.zeros(len(both)), where=either > 0)
