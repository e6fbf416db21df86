"""Who made a building model, when it was surveyed, and where it lies."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Site:
    """Where the map frame lies on earth.

    Attributes
    ----------
    crs : str or None
        The projected reference system by its EPSG code, `EPSG:25832`; None if not known.
    east_m, north_m, height_m : float
        The map frame's origin in it.
    turn_deg : float
        From the grid's east to the map frame's x axis, counter-clockwise.
    north_deg : float or None
        From the map frame's x axis to true north, counter-clockwise; None if not known.
    """

    crs: str | None = None
    east_m: float = 0.0
    north_m: float = 0.0
    height_m: float = 0.0
    turn_deg: float = 0.0
    north_deg: float | None = None


@dataclass(frozen=True)
class ModelOrigin:
    """Who made a model, when it was surveyed, and where it lies.

    Attributes
    ----------
    author, organisation : str
        Empty where not stated.
    version : str
        Of the code.
    t_ns : int
        When the last scan was taken, Unix time.
    site : Site
    """

    author: str = ""
    organisation: str = ""
    version: str = "not stated"
    t_ns: int = 0
    site: Site = field(default_factory=Site)
