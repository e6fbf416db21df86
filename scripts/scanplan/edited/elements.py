"""What a file of a plan shows, whatever its format: elements with what a person may change."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.types import FloatArray


@dataclass(frozen=True, eq=False)
class Element:
    """An element of a drawing or model.

    Attributes
    ----------
    kind : str
        wall, opening, room or furniture.
    key : str
        What the file knows it by; of what another program added that one's.
    line_m : (2, 2) float or None
        Of a wall its line, of an opening from jamb to jamb, metres in the map frame.
    outline : geometry or None
        Of furniture.
    facts : mapping
        As far as the file has them: `thickness_m`, `height_m` of walls; `kind`, `sill_m`,
        `lintel_m` and `opens_m`, where the free end of an open leaf is, of openings; `number`,
        `name`, `use` of rooms; `kind` of furniture.
    host : str
        Of an opening: the key of its wall, where the file knows it.
    is_bent : bool
        Of a wall that is curved.
    joined : sequence of str
        Of a wall of a regular drawing: keys of the plan's walls that are pieces of it, too.
    """

    kind: str
    key: str
    line_m: FloatArray | None = None
    outline: BaseGeometry | None = None
    facts: Mapping[str, Any] = field(default_factory=dict)
    host: str = ""
    is_bent: bool = False
    joined: Sequence[str] = ()

    def divide_places(self, factor: float) -> "Element":
        """Return it with its places so many times nearer to the origin; sizes stay."""
        facts = dict(self.facts)
        if "opens_m" in facts:
            facts["opens_m"] = facts["opens_m"] / factor
        outline = self.outline
        if outline is not None:
            outline = shapely.transform(outline, lambda xy_m: xy_m / factor)
        line_m = None if self.line_m is None else np.asarray(self.line_m) / factor
        return replace(self, line_m=line_m, outline=outline, facts=facts)

    @property
    def middle(self) -> shapely.Point | None:
        """Where it is; None of a room."""
        if self.line_m is not None:
            return shapely.Point(np.asarray(self.line_m).mean(axis=0))
        return None if self.outline is None else self.outline.centroid

    @property
    def length_m(self) -> float:
        """How long its line is."""
        return 0.0 if self.line_m is None else float(np.hypot(*(self.line_m[1] - self.line_m[0])))

    @property
    def along(self) -> FloatArray:
        """Unit vector (2,) of its line."""
        assert self.line_m is not None
        return (self.line_m[1] - self.line_m[0]) / self.length_m


@dataclass(frozen=True)
class Drawing:
    """What a file shows.

    Attributes
    ----------
    elements : sequence of Element
    other : mapping of str to int
        What else there is that no correction says, such as stairs or texts: how many.
    survey : str
        The dataset that it says to be of, empty where it does not.
    """

    elements: Sequence[Element]
    other: Mapping[str, int] = field(default_factory=dict)
    survey: str = ""

    def of(self, kind: str) -> list[Element]:
        """Return its elements of a kind."""
        return [element for element in self.elements if element.kind == kind]
