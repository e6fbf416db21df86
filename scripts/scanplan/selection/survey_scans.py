"""Scans to order, and the data that orders depend on."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from scanplan.types import Columns, IntArray


@dataclass(frozen=True, eq=False)
class SurveyScans:
    """The scans of a survey.

    Attributes
    ----------
    scan_ids : (n,) int, increasing
    tables : dict of str to columns
        `hulls`, and those that `methods.METHODS` names for the method.
    seed : int, optional
        For random orders.
    streaming : dict
        Keywords of `streaming.order_streaming`.
    """

    scan_ids: IntArray
    tables: Mapping[str, Columns] = field(default_factory=dict)
    seed: int | None = None
    streaming: Mapping[str, Any] = field(default_factory=dict)

    def __len__(self) -> int:
        """Return the number of scans."""
        return len(self.scan_ids)
