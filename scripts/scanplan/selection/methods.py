"""The orders in which scans can be taken into the plan: everything that is said of each, once.

Nothing heavy is imported here: the workflow reads this table whenever it starts. An ordering is one
entry here, its function, and its name in the schema of the configuration.
"""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Method:
    """One ordering method.

    Attributes
    ----------
    label : str
        Its name in legends.
    colour : str
        Of its curves.
    objective : str, optional
        Function of `objectives` that makes what it maximises greedily.
    order : str, optional
        Where it maximises nothing greedily: the function that orders a `SurveyScans`, as
        module.function of this package.
    unit : str
        Of its objective; covered area where it has none.
    is_area : bool
        Whether its objective is the covered area of its own polygons; the others' area is that of
        `AREA_METHOD`.
    is_baseline : bool
        Whether it looks at nothing measured; figures dash it.
    tables : tuple of str
        What it needs beside scans or, where it `needs_hulls`, hulls.
    settings : tuple of str
        What it depends on: keys of `selection`, and `budget`, what the scans may cost together.
    """

    label: str
    colour: str
    objective: str | None = None
    order: str | None = None
    unit: str = "m2"
    is_area: bool = False
    is_baseline: bool = False
    tables: tuple[str, ...] = ()
    settings: tuple[str, ...] = ()

    @property
    def needs_hulls(self) -> bool:
        """Whether what it covers is the area of hulls: its own objective, or for want of one."""
        return self.objective is None or self.is_area


_GREEDY = ("min_overlap", "budget")

METHODS = {
    "wall_length": Method(
        label="greedy by wall length",
        colour="#0072b2",
        objective="cover_wall_length",
        unit="m",
        tables=("observations",),
        settings=_GREEDY,
    ),
    "visibility": Method(
        label="greedy by free space",
        colour="#009e73",
        objective="cover_free_space",
        tables=("visibility",),
        settings=_GREEDY,
    ),
    "cluster_hull": Method(
        label="greedy by cluster hulls",
        colour="#d55e00",
        objective="cover_cluster_hulls",
        is_area=True,
        settings=_GREEDY,
    ),
    "hull": Method(
        label="greedy by one hull per scan",
        colour="#e69f00",
        objective="cover_full_hulls",
        is_area=True,
        settings=_GREEDY,
    ),
    "streaming": Method(
        label="in one pass by cluster hulls",
        colour="#000000",
        order="streaming.order_in_one_pass",
        settings=("streaming",),
    ),
    "every_nth": Method(
        label="every n-th",
        colour="#cc79a7",
        order="baselines.order_every_nth",
        is_baseline=True,
    ),
    "distance": Method(
        label="farthest next",
        colour="#56b4e9",
        order="baselines.order_by_distance",
        is_baseline=True,
        tables=("registration",),
    ),
    "random": Method(
        label="random",
        colour="#8c6d4f",
        order="baselines.order_randomly",
        is_baseline=True,
        settings=("seed",),
    ),
    "sequential": Method(
        label="as recorded",
        colour="#999999",
        order="baselines.order_sequentially",
        is_baseline=True,
    ),
}
"""Ordering methods by name, in the order of legends."""

AREA_METHOD = "cluster_hull"
"""The method whose objective measures covered area for all that are no area themselves."""

WALL_LIMITS = (
    "reach_deg",
    "max_gap_m",
    "min_height_m",
    "wall_height_m",
    "door_height_m",
)
"""Settings of the wall extractor that decide what it could find; `wall_cells` takes them too."""
