"""Choose scans while a recording plays: each is taken or left as it comes, in bounded memory.

Thesis, chapter 6: "the current method of choosing scans works offline ...; a different approach
would need to be taken to select scans in real time".
"""

from collections import OrderedDict

import numpy as np

from scanplan.selection.wall_cells import KEYS
from scanplan.types import Columns

_MOST_CELLS = 200_000  # a floor of 1,500 m2 has 8,000

Cell = tuple[int, int, int]


class PlayingSelection:
    """Takes every scan of whose wall enough is new.

    What the scans taken so far show is kept cell by cell, as `wall_cells` measures it, and nothing
    else of them: neither points nor poses.

    Parameters
    ----------
    min_new_share : float, above 0, at most 1
        Of the length of wall that a scan shows, what no scan taken before shows.
    max_cells : int, >= 1
        Cells that are kept; beyond, those that no scan has shown for longest are forgotten. Where
        the rover comes back after that, it is as if it had not been there.

    Attributes
    ----------
    most_held : int
        The largest number of cells kept at a time.

    Raises
    ------
    ValueError
        If a parameter is out of its range.
    """

    def __init__(self, *, min_new_share: float, max_cells: int = _MOST_CELLS) -> None:
        if not 0 < min_new_share <= 1 or max_cells < 1:
            raise ValueError(
                f"min_new_share is {min_new_share}, must be above 0 and at most 1; max_cells is"
                f" {max_cells}, must be at least 1"
            )
        self._min_new_share = min_new_share
        self._max_cells = max_cells
        self._shown_m: OrderedDict[Cell, float] = OrderedDict()
        self.most_held = 0

    def take(self, observed: Columns) -> bool:
        """Decide on the next scan of the recording.

        Parameters
        ----------
        observed : dict of str to (m,) array
            What `wall_cells.observe_wall_cells` measures of it. A scan that shows no wall is left.

        Returns
        -------
        bool
        """
        cells = list(zip(*(np.asarray(observed[key]).tolist() for key in KEYS), strict=True))
        lengths_m = np.asarray(observed["length_m"], float).tolist()
        shown = dict(zip(cells, lengths_m, strict=True))
        new_m = sum(max(0.0, m - self._shown_m.get(cell, 0.0)) for cell, m in shown.items())
        for cell in filter(self._shown_m.__contains__, cells):
            self._shown_m.move_to_end(cell)
        total_m = sum(lengths_m)
        if total_m <= 0 or new_m < self._min_new_share * total_m:
            return False
        for cell, length_m in shown.items():
            self._shown_m[cell] = max(length_m, self._shown_m.get(cell, 0.0))
        while len(self._shown_m) > self._max_cells:
            self._shown_m.popitem(last=False)
        self.most_held = max(self.most_held, len(self._shown_m))
        return True
