"""Area of the union of the free space that scans looked through."""

import numpy as np
import shapely

from scanplan.errors import StageError
from scanplan.selection.polygon_area import PolygonArea

UNIT = "m2"


def objective(scan_ids, columns):
    """Return the objective of a survey; see `orderings.order_scans` for the columns.

    Raises
    ------
    StageError
        If the table of visibility is not of these scans.
    """
    visible = columns["visibility"]
    if not np.array_equal(visible["scan_id"], scan_ids):
        raise StageError(
            f"visibility: holds {len(visible['scan_id'])} scans, not the {len(scan_ids)} that have hulls;"
            " delete the results of this dataset and run again"
        )
    return PolygonArea(shapely.from_wkb(visible["geometry"]))
