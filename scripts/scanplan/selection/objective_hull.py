"""Area of the union of one convex hull per scan, the thesis's baseline (3.3.2)."""

from scanplan.selection import hulls
from scanplan.selection.polygon_area import PolygonArea

UNIT = "m2"


def objective(_scan_ids, columns):
    """Return the objective of a survey; see `orderings.order_scans` for the columns."""
    return PolygonArea(hulls.scan_full_hulls(columns["hulls"])[1])
