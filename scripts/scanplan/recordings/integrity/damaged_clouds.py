"""Clouds that cannot be decoded: counted and left out, as long as they are few."""

from collections.abc import Callable

import numpy as np

from scanplan.errors import StageError
from scanplan.recordings.clouds import Scan
from scanplan.stage import log


class DamagedClouds:
    """Counts the damaged clouds among those that are read.

    Parameters
    ----------
    n_read : int
        How many are read in all.
    max_share : float
        More than this share of them is no accident but a fault of the recording.
    begin : int
        Scans before this one are told and counted elsewhere.

    Attributes
    ----------
    faults : list of str
        What is wrong with each damaged one.
    """

    def __init__(self, n_read: int, max_share: float, begin: int = 0) -> None:
        self._n_read = n_read
        self._max_share = max_share
        self._begin = begin
        self.faults: list[str] = []

    def read(self, scan_id: int, t_ns: int, decode: Callable[[], Scan]) -> Scan:
        """Return what `decode` does; of a damaged cloud a scan without points.

        Raises
        ------
        StageError
            If there are too many damaged ones.
        """
        try:
            return decode()
        except StageError as error:
            if scan_id >= self._begin:
                self.leave_out(str(error))
                log.log_warning(f"{error}; left out")
            return Scan(scan_id, t_ns, np.empty((0, 3), np.float32), None, 0)

    def leave_out(self, fault: str) -> None:
        """Count a damaged cloud, given what is wrong with it.

        Raises
        ------
        StageError
            If there are too many.
        """
        self.faults.append(fault)
        if len(self.faults) > self._max_share * self._n_read:
            raise StageError(
                f"{fault}; {len(self.faults)} of {self._n_read} scans are damaged so far, more"
                " than advanced.input.max_damaged_share"
            ) from None

    def describe(self) -> list[str]:
        """Return how many were left out, as a sentence; none where all could be decoded."""
        if not self.faults:
            return []
        return [f"{len(self.faults):,} of {self._n_read:,} scans are damaged and left out"]
