"""Units that clouds and poses may be recorded in; metres come out."""

from typing import NamedTuple

METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}
"""How long each is, by definition; inches and feet are the international ones."""


class Units(NamedTuple):
    """What clouds and poses are in, each a name of `METRES`; transforms are as the poses are."""

    cloud: str = "m"
    pose: str = "m"

    @property
    def cloud_m(self) -> float:
        """How many metres a unit of the clouds is."""
        return METRES[self.cloud]

    @property
    def pose_m(self) -> float:
        """How many metres a unit of the poses is."""
        return METRES[self.pose]

    def describe(self) -> str:
        """Return what is scaled, empty where nothing is."""
        if self == IN_METRES:
            return ""
        return (
            f"clouds are in {self.cloud}, poses and transforms in {self.pose}"
            " (advanced.input.cloud_unit, advanced.input.pose_unit): all become metres"
        )


IN_METRES = Units()
