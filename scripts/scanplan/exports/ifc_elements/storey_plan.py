"""What the elements of a building model share: the plan, its ids, and what they are to be told."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from scanplan.exports.data.element_ids import ElementIds
from scanplan.exports.drafting.regular_plan import ASSUMED
from scanplan.exports.ifc_model import ClassCode
from scanplan.exports.sheet.leaves import Swing
from scanplan.exports.sheet.locale import Locale
from scanplan.exports.sheet.openings import find_swings
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import BoolArray, Columns

EVIDENCE = "Scanplan_Evidence"
"""Name of the property set: IFC keeps the prefix Pset_ for its own."""
NOMINAL = "Scanplan_Nominal"
"""Name of the set that says by how much an element of a regular plan differs from what it was."""
_ALIKE_M = 0.001  # of a size of the catalogue: what a wall is wide that is drawn as wide


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
    catalogue : mapping, optional
        Of a regular plan: its nominal sizes, see `catalogue_file.read_catalogue`.
    """

    plan: FloorPlan
    ids: ElementIds
    external: BoolArray
    catalogue: Mapping[str, Any] | None = None

    @cached_property
    def is_thickness_measured(self) -> BoolArray:
        """Of which walls (n,) both sides were seen, or how deep reveals are."""
        if "thickness_from" not in self.plan.walls:
            return self.plan.thick
        return self.plan.thick & np.asarray(self.plan.walls["thickness_from"] != ASSUMED, bool)

    @cached_property
    def swings(self) -> Mapping[int, Swing]:
        """How doors open, by row of openings, where leaves showed it; none of a measured plan."""
        return {} if self.catalogue is None else find_swings(self.plan)

    def name_type(self, kind: str, size_m: float) -> tuple[str, float]:
        """Return the name of the type of a size, empty of none, and its size.

        That is the catalogue's of a regular plan, or else to half a centimetre, no less than one:
        bricks are 11.5, 17.5 and 36.5 cm thick.
        """
        sizes: Mapping[str, float] = (self.catalogue or {}).get(kind, {})
        for name, nominal_m in sizes.items():
            if abs(nominal_m - size_m) <= _ALIKE_M:
                return name, nominal_m
        return "", max(round(200 * float(size_m)), 1) / 200

    def find_code(self, kind: str, name: str) -> ClassCode | None:
        """Return the code of a type of a list of the catalogue; None of none."""
        catalogue = self.catalogue or {}
        system = catalogue.get("classification", {})
        if not system:
            return None
        code = catalogue["codes"][kind].get(name, system[kind])
        published = (system.get("source"), system.get("edition"))
        return ClassCode(system["system"], code, system["titles"].get(code), *published)

    def leads_outside(self, opening: int) -> bool:
        """Return whether the wall that an opening is in is external."""
        host = self.plan.hosts[opening]
        return bool(host >= 0 and self.external[host])

    def name_joined_rooms(self, opening: int) -> list[str]:
        """Return the names of the rooms on both sides of an opening, each once; it may have one."""
        names = dict(zip(self.plan.rooms["room"].tolist(), self.plan.room_labels, strict=True))
        columns = self.plan.openings
        rooms = dict.fromkeys(int(columns[side][opening]) for side in ("room_a", "room_b"))
        return [names[room] for room in rooms if room in names]


def describe_doubt(locale: Locale, columns: Columns, row: int) -> dict[str, tuple[str, Any]]:
    """Return what a table says of the doubt about an element, and whether a person corrected it.

    As far as it has such columns, in words of a language.
    """
    stated = {name: values[row] for name, values in columns.items()}
    doubt, corrected = (str(stated.get(name, "")) for name in ("doubt", "corrected"))
    return {
        "VerifyOnSite": ("IfcBoolean", bool(stated["verify"]) if "verify" in stated else None),
        "ProbabilityOfExistence": ("IfcReal", known(stated.get("p_true", np.nan))),
        "Doubt": ("IfcText", locale.say(doubt) or None),
        "Corrected": ("IfcLabel", locale.credit(corrected) or None),
    }


def known(value: float) -> float | None:
    """Return a number, None for NaN."""
    return float(value) if np.isfinite(value) else None
