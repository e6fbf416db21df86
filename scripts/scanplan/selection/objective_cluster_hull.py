"""Area of the union of the hulls of scans' clusters (thesis 3.3.2, algorithm 1)."""

from scanplan.selection import hulls
from scanplan.selection.polygon_area import PolygonArea

UNIT = "m2"


def objective(_scan_ids, columns):
    """Return the objective of a survey; see `orderings.order_scans` for the columns."""
    return PolygonArea(hulls.scan_polygons(columns["hulls"])[1])
