"""Keys of earlier versions: what each is called now, or why there is none any more."""

from collections.abc import Iterable

from scanplan.errors import MOST_NAMED

_EXTRACTORS = ("cluster_ransac", "iterative_ransac")
_OF_BOTH_EXTRACTORS = {
    **{
        key: f"walls.{key}"
        for key in (
            "inlier_m",
            "max_gap_m",
            "min_length_m",
            "min_height_m",
        )
    },
    "door_height_m": "building.door_height_m",
    "wall_height_m": "building.wall_height_m",
    "furniture_height_m": "building.furniture_height_m",
    "door_width_m": "building.max_door_m",
    "seed": "seed",
}

RENAMED = {
    **{
        f"walls.{extractor}.{old}": new
        for extractor in _EXTRACTORS
        for old, new in _OF_BOTH_EXTRACTORS.items()
    },
    "crispness.seed": "seed",
    "hulls.seed": "seed",
    "selection.seed": "seed",
    "selection.visibility.max_height_m": "building.door_height_m",
    "plan.merge.max_gap_m": "walls.max_gap_m",
    "plan.trace.max_gap_m": "walls.max_gap_m",
    "plan.trace.door_height_m": "building.door_height_m",
    "plan.pair.min_thickness_m": "building.min_thickness_m",
    "plan.pair.max_thickness_m": "building.max_thickness_m",
    "plan.openings.max_door_m": "building.max_door_m",
    "plan.trust.min_scans": "plan.merge.min_scans",
}
"""Old key to the new one; beside these, a key that is known with or without `advanced` moved."""

_LABELS = "labels of lines and surfaces decide now what is a wall"
_UNSEEN = "what walls close is a room's, whoever saw its floor"
DROPPED = {
    "advanced.plan.surfaces": _LABELS,
    **{
        f"{section}.{key}": _LABELS
        for section in ("advanced.walls", "walls", *(f"walls.{name}" for name in _EXTRACTORS))
        for key in (
            "hang_height_m",
            "over_share",
            "through_share",
            "missing_share",
            "stub_length_m",
            "furniture_length_m",
        )
    },
    "thesis": "the laboratory's workflow alone knows it: workflow/thesis/Snakefile",
    **dict.fromkeys(("plan.rooms.max_unseen", "advanced.plan.rooms.max_unseen"), _UNSEEN),
    "plan.right_angles": "faces are drawn as turned as their points are",
}
"""Key or section that is gone, and why."""
_OF_ANY_EXTRACTOR = (
    *("min_points", "min_points_planar", "max_tilt_deg", "max_rmse_m"),
    *("furniture_depth_m", "corner_m"),
)
_FIXED = {
    "registration": (
        *("previous_apart_m", "previous_turn_deg", "min_facing_fitness", "icp_max_iterations"),
        *("localiser_sigma_tilt_deg", "anchor_apart_m", "drift", "batch_size", "anchor_after"),
    ),
    "registration.graph": (
        *("loop_radius_m", "loop_apart", "loop_step_m", "loop_step_planar_m", "loops_per_scan"),
        *("loops_per_scan_planar", "loop_min_fitness", "edge_sigma_m", "edge_sigma_deg"),
        "kernel_sigmas",
    ),
    "crispness": ("radius_m", "most_places"),
    "selection": (
        *("visibility.sector_deg", "visibility.min_height_m", "streaming.epsilon"),
        "playing.max_cells",
    ),
    "walls": (
        *("cluster_ransac.trials", "iterative_ransac.trials", "iterative_ransac.max_planes"),
        *("thesis_ransac.max_trials", "cluster_ransac.bandwidth_m", *_OF_ANY_EXTRACTOR),
        *(f"{extractor}.{key}" for extractor in _EXTRACTORS for key in _OF_ANY_EXTRACTOR),
    ),
    "plan": ("trace", "ranges", "pair", "openings.max_closed_m", "rooms.min_walled", "trust"),
    "plan.merge": (
        *("max_angle_deg", "ghost_distance_m", "ghost_share", "align_gap_m", "min_length_m"),
        *("registration_sigma_m", "min_points_per_m", "lone_length_m", "corner_m"),
    ),
    "plan.export": ("range_scale_sigma",),
    "plan.validation": ("max_rays", "span_m", "place_m"),
    "simulate.errors": ("bias_m", "quantum_m", "grazing_from_deg"),
    "simulate.drive": ("sway_hz",),
    "simulate.odometry": ("max_slip_m", "max_slip_deg"),
    "simulate.localiser": (
        *("drift_time_s", "max_jump_m", "transform_tolerance_s", "loop_late_m"),
    ),
}
DROPPED |= {
    f"{prefix}{section}.{key}": "no survey needed another value than its default"
    for section, keys in _FIXED.items()
    for key in keys
    for prefix in ("", "advanced.")
}


def explain_old_keys(given: Iterable[str], known: Iterable[str]) -> str | None:
    """Return what became of keys of earlier versions, in one line; None where none of them is one.

    Parameters
    ----------
    given : iterable of str
        Keys that are set, joined by dots.
    known : iterable of str
        Keys that may be set.
    """
    known = set(known)
    explained = [_what_became(key, known) for key in given if key not in known]
    changes = [change for change in explained if change]
    if not changes:
        return None
    n_more = len(changes) - MOST_NAMED
    more = f", and {n_more} more" if n_more > 0 else ""
    return "old keys: " + ", ".join(changes[:MOST_NAMED]) + more


def _what_became(key: str, known: set[str]) -> str | None:
    moved = (f"advanced.{key}", key.removeprefix("advanced."))
    new = RENAMED.get(key) or next((name for name in moved if name in known), None)
    if new:
        return f"{key} is now {new}"
    reasons = (why for old, why in DROPPED.items() if f"{key}.".startswith(f"{old}."))
    why = next(reasons, None)
    return f"{key} is gone ({why})" if why else None
