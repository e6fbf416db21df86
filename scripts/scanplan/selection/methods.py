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
"""Settings of the wall extractor that tell what it could find, for `wallcells.Settings`."""
