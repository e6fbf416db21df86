"""Length of wall that scans show well enough to be found, each stretch as well as the best of them shows it.

This closes the loop between walls and selection (thesis, chapter 6) without extracting the walls of any scan.
"""

import numpy as np

from scanplan.errors import StageError
from scanplan.selection import wall_cells
from scanplan.selection.cell_coverage import CellCoverage

UNIT = "m"


def objective(scan_ids, columns):
    """Return the objective of a survey; see `orderings.order_scans` for the columns.

    Raises
    ------
    StageError
        If the table of observations holds other scans.
    """
    seen = columns["observations"]
    if not np.isin(seen["scan_id"], scan_ids).all():
        raise StageError(
            f"observations: of scans that are none of the {len(scan_ids)} that have hulls;"
            " delete the results of this dataset and run again"
        )
    row = np.searchsorted(scan_ids, seen["scan_id"])
    return CellCoverage(row, wall_cells.number_cells(seen), seen["length_m"], len(scan_ids))
