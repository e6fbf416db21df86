"""The sensors that drives are made with: what they are, how they are carried, how poses come.

Each is a survey's settings: the section `simulate`, and how many scans are candidates. What is not
said is the simulator's default.
"""

from typing import Any

Settings = dict[str, Any]

# 60 % of the rays within 8 degrees of square come back from a pane, 4 % are mirrored, 8 % are lost
GLASS = {"glass_pass": 0.28, "glass_drop": 0.08, "glass_mirror": 0.04, "glass_return_deg": 8.0}
# ASSUME centimetres of bias as papers on such sensors measure them, and that a shining floor
# returns nothing to a ray that meets it at more than 65 degrees
PHYSICS = {
    **GLASS,
    "polished_from_deg": 65.0,
    "bias_incidence_m": 0.006,
    "bias_intensity_m": 0.008,
}
LOCALISER = {"noise_m": 0.05, "noise_deg": 1.0, "jumps_per_min": 1.0}
# ASSUME the sway of a head or a hand while walking: some centimetres and degrees
SWAY = {"sway_deg": 2.0, "sway_m": 0.02}
ROVER = {"speed_m_s": 0.75, "turn_rate_deg_s": 60.0}
TROLLEY = {"speed_m_s": 0.9, "turn_rate_deg_s": 60.0}
WALK = {"speed_m_s": 1.0, "turn_rate_deg_s": 75.0}
SLAM = {"kind": "slam", "noise_m": 0.02, "noise_deg": 0.4, "walk_m": 0.015, "walk_deg": 0.15}

SPATIAL: dict[str, Settings] = {
    "vlp16_rover": {
        "mount": {"height_m": 0.45},
        "sensor": {"model": "vlp16", "n_azimuth": 900, "rate_hz": 5.0},
        "errors": {**PHYSICS, "mixed_deg": 0.18, "stray_share": 0.001},
        "drive": ROVER,
        "people": {"count": 2, "standing": 1},
    },
    "ouster64_trolley": {
        "mount": {"height_m": 1.15},
        "sensor": {"model": "ouster64", "n_azimuth": 512, "rate_hz": 4.0, "max_range_m": 50.0},
        "errors": {**PHYSICS, "noise_m": 0.015, "mixed_deg": 0.35},
        "drive": TROLLEY,
        "people": {"standing": 2},
    },
    "uneven32_tilted": {
        "mount": {"height_m": 0.9, "pitch_deg": 18.0},
        "sensor": {"model": "uneven32", "n_azimuth": 720, "rate_hz": 5.0},
        "errors": {**PHYSICS, "noise_m": 0.02, "mixed_deg": 0.18},
        "drive": ROVER,
        "people": {"count": 2},
    },
    "rosette_hand": {
        "mount": {"height_m": 1.35, "forward_m": 0.2},
        "sensor": {"model": "rosette", "n_azimuth": 2000, "rate_hz": 5.0, "max_range_m": 40.0},
        "errors": {**PHYSICS, "noise_m": 0.02, "stray_share": 0.002},
        "drive": {**WALK, **SWAY},
        "localiser": SLAM,
        "people": {"followers": 1},
    },
    "vlp16_hand": {
        "mount": {"height_m": 1.5, "forward_m": 0.2},
        "sensor": {"model": "vlp16", "n_azimuth": 900, "rate_hz": 5.0},
        "errors": {**PHYSICS, "mixed_deg": 0.18},
        "drive": {**WALK, **SWAY},
        "localiser": SLAM,
        "people": {"followers": 1, "standing": 1},
    },
    "vlp16_upside_down": {
        "mount": {"height_m": 1.85, "roll_deg": 180.0},
        "sensor": {"model": "vlp16", "n_azimuth": 900, "rate_hz": 5.0},
        "errors": {**PHYSICS, "stray_share": 0.002},
        "drive": TROLLEY,
        "people": {"count": 2},
    },
    "vlp16_odometry": {
        "mount": {"height_m": 0.6},
        "sensor": {"model": "vlp16", "n_azimuth": 900, "rate_hz": 5.0},
        "errors": {**PHYSICS, "mixed_deg": 0.18},
        "drive": ROVER,
        "localiser": {"present": False},
        "odometry": {
            **{"scale_share": 0.01, "drift_deg_per_m": 0.2, "random_m": 0.01, "random_deg": 0.3},
            "slips_per_m": 0.01,
        },
    },
    "vlp16_unconverged": {
        "mount": {"height_m": 0.5},
        "sensor": {"model": "vlp16", "n_azimuth": 900, "rate_hz": 5.0},
        "errors": {**PHYSICS, "stray_share": 0.001},
        "drive": ROVER,
        "localiser": {**LOCALISER, "start_off_m": 0.6, "start_off_deg": 10.0, "converge_m": 5.0},
        "people": {"count": 2},
    },
}
"""Name to the settings of a sensor that sees in space."""

PLANAR: dict[str, Settings] = {
    "laser270": {
        "mount": {"height_m": 0.3},
        "sensor": {
            **{"model": "laser", "n_azimuth": 541, "field_deg": 270.0},
            **{"max_range_m": 30.0, "rate_hz": 10.0},
        },
        "errors": {**PHYSICS, "noise_m": 0.01, "mixed_deg": 0.25},
        "drive": ROVER,
        "people": {"count": 2, "standing": 1},
    },
    "laser360": {
        "mount": {"height_m": 0.22},
        "sensor": {
            **{"model": "laser", "n_azimuth": 360, "field_deg": 360.0},
            **{"min_range_m": 0.15, "max_range_m": 12.0, "rate_hz": 5.5},
        },
        "errors": {**PHYSICS, "noise_m": 0.02, "stray_share": 0.003},
        "drive": {"speed_m_s": 0.5, "turn_rate_deg_s": 60.0},
        "people": {"count": 1},
    },
    "laser180": {
        "mount": {"height_m": 0.35},
        "sensor": {
            **{"model": "laser", "n_azimuth": 181, "field_deg": 180.0},
            **{"max_range_m": 80.0, "rate_hz": 1.0, "sweep": False},
        },
        "errors": {**PHYSICS, "noise_m": 0.02},
        "drive": {"speed_m_s": 1.0, "turn_rate_deg_s": 60.0},
        "people": {"count": 3},
    },
    "laser270_slam": {
        "mount": {"height_m": 0.25},
        "sensor": {
            **{"model": "laser", "n_azimuth": 541, "field_deg": 270.0},
            **{"max_range_m": 20.0, "rate_hz": 10.0},
        },
        "errors": {**PHYSICS, "noise_m": 0.015, "mixed_deg": 0.25},
        "drive": ROVER,
        "localiser": SLAM,
        "people": {"followers": 1},
    },
}
"""Name to the settings of a 2-D scanner."""

_STEP_M = 0.7  # from candidate to candidate: the longest ways of 170 m have less than 400
_TURN_DEG = 40.0


def survey_settings(sensor: str, building: str, seed: int) -> Settings:
    """Return the settings of a survey of a drawing with one of the sensors."""
    made = {**SPATIAL, **PLANAR}[sensor]
    site = {"route": "rooms", "clearance_m": 0.25}
    simulate = {"building": building, "seed": seed, "site": site, "localiser": LOCALISER}
    every = made["sensor"]["rate_hz"] * _STEP_M / made["drive"]["speed_m_s"]
    poses = {"keep_every": max(1, round(every)), "max_step_m": _STEP_M, "max_turn_deg": _TURN_DEG}
    return {"poses": poses, "simulate": {**simulate, **made}}
