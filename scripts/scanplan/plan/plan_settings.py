"""What of the whole configuration the plan is made with."""

_OTHERS = ("method", "extractor", "export")
_FURNITURE = (
    "max_rmse_m",
    "wall_height_m",
    "furniture_height_m",
    "hang_height_m",
    "over_share",
    "through_share",
    "missing_share",
    "furniture_depth_m",
    "furniture_length_m",
    "stub_length_m",
    "door_width_m",
    "corner_m",
)


def select_plan_settings(settings):
    """Return the keywords of `planning.make_plan_settings`.

    Parameters
    ----------
    settings : dict
        The whole configuration of a dataset. What is furniture in single scans, by the extractor of
        the plan's walls, is furniture in the plan.

    Returns
    -------
    dict of str to dict
    """
    plan = settings["plan"]
    walls = settings["walls"][plan["extractor"]]
    own = {name: part for name, part in plan.items() if name not in _OTHERS}
    return own | {"furniture": {key: walls[key] for key in _FURNITURE}}
