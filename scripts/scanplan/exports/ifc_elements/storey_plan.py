"""What the elements of a building model share: the plan, its ids, and what they are to be told."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from scanplan.exports.data.element_ids import ElementIds
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import BoolArray, Columns

EVIDENCE = "Scanplan_Evidence"
"""Name of the property set: IFC keeps the prefix Pset_ for its own."""


@dataclass(frozen=True)
class StoreyPlan:
    """A plan that is to become a storey.

    Attributes
    ----------
    plan : floorplan.FloorPlan
    ids : dict of str to sequence of str
        See `element_ids.ElementIds`.
    external : (n,) bool
        Which walls are the building's outside, see `envelope.find_external_walls`.
    """

    plan: FloorPlan
    ids: ElementIds
    external: BoolArray

    def leads_outside(self, opening: int) -> bool:
        """Return whether the wall that an opening is in is external."""
        host = self.plan.hosts[opening]
        return bool(host >= 0 and self.external[host])

    def name_joined_rooms(self, opening: int) -> list[str]:
        """Return the names of the rooms on both sides of an opening, each once; it may have one."""
        names = dict(zip(self.plan.rooms["room"].tolist(), self.plan.room_names, strict=True))
        columns = self.plan.openings
        rooms = dict.fromkeys(int(columns[side][opening]) for side in ("room_a", "room_b"))
        return [names[room] for room in rooms if room in names]


def describe_doubt(columns: Columns, row: int) -> dict[str, tuple[str, Any]]:
    """Return what a table says of the doubt about an element, and whether a person corrected it.

    As far as it has such columns.
    """
    stated = {name: values[row] for name, values in columns.items()}
    doubt = str(stated.get("doubt", ""))
    return {
        "VerifyOnSite": ("IfcBoolean", bool(stated["verify"]) if "verify" in stated else None),
        "ProbabilityOfExistence": ("IfcReal", known(stated.get("p_true", np.nan))),
        "Doubt": ("IfcText", doubt or None),
        "Corrected": ("IfcLabel", str(stated.get("corrected", "")) or None),
    }


def known(value: float) -> float | None:
    """Return a number, None for NaN."""
    return float(value) if np.isfinite(value) else None
