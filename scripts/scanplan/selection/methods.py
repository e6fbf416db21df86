"""The orders in which scans can be taken into the plan, and the tables that each is worked out from.

Nothing heavy is imported here: the workflow reads this list whenever it starts.
"""

TABLES = {
    "wall_length": ("observations",),
    "visibility": ("visibility",),
    "cluster_hull": (),
    "hull": (),
    "streaming": (),
    "every_nth": (),
    "distance": ("registration",),
    "random": (),
    "sequential": (),
}
"""Method to the tables that it needs beside that of the hulls, which measures the area that every order covers."""

METHODS = tuple(TABLES)

_OBJECTIVE = ("min_overlap", "budget")
SETTINGS = {
    "wall_length": _OBJECTIVE,
    "visibility": _OBJECTIVE,
    "cluster_hull": _OBJECTIVE,
    "hull": _OBJECTIVE,
    "streaming": ("streaming",),
    "every_nth": (),
    "distance": (),
    "random": ("seed",),
    "sequential": (),
}
"""Method to the settings that its order depends on: keys of `selection`, and what the scans may cost together."""

WALL_LIMITS = (
    "reach_deg",
    "max_tilt_deg",
    "max_gap_m",
    "min_height_m",
    "wall_height_m",
    "door_height_m",
    "min_points",
    "min_points_planar",
)
"""Settings of the wall extractor that tell what it could find, for `wall_cells.WallCellSettings`."""
