"""The model of `confidence.py`, written by `make bench ARGS="confidence FOLDER"`.

Fitted on drives through buildings of these kinds: dwelling, hall, hospital, museum,
office_cellular, office_glass, old_house.
"""

from typing import Any

COEFFICIENTS: dict[str, Any] = {
    "space": {
        "walls": {
            "intercept": 2.1,
            "features": {
                "thing": {"mean": 3.39, "weight": 0.62},
                "line": {"mean": 6.45, "weight": 0.19},
                "agreement": {"mean": 4.47, "weight": 0.23},
            },
        },
        "faces": {
            "intercept": 3.36,
            "features": {
                "thing": {"mean": 4.82, "weight": 0.63},
                "line": {"mean": 6.58, "weight": 0.19},
                "worst_span": {"mean": 3.79, "weight": 0.3},
                "bounding": {"mean": 0.89, "weight": 1.24},
            },
        },
        "openings": {
            "intercept": 2.57,
            "features": {
                "kind": {"mean": 1.91, "weight": 1.16},
                "host": {"mean": 4.54, "weight": 0.17},
                "rays": {"mean": 6.65, "weight": 0.03},
                "wide": {"mean": -0.02, "weight": 6.53},
                "leads": {"mean": 0.83, "weight": 1.5},
            },
        },
        "rooms": {
            "intercept": 3.07,
            "features": {
                "faced": {"mean": 0.75, "weight": 3.07},
                "broad": {"mean": 1.18, "weight": 4.15},
                "apart": {"mean": 7.92, "weight": 0.26},
            },
        },
        "level": 0.657,
        "most": 0.964,
        "off": {
            "tuning": {"walls": 0.03, "faces": 0.02, "openings": 0.09, "rooms": 0.05},
            "reporting": {"walls": 0.05, "faces": 0.02, "openings": 0.08, "rooms": 0.1},
        },
    },
    "plane": {
        "walls": {
            "intercept": 1.0,
            "features": {
                "thing": {"mean": 1.89, "weight": 1.2},
                "line": {"mean": 7.15, "weight": 0.28},
            },
        },
        "faces": {
            "intercept": 2.47,
            "features": {
                "thing": {"mean": 2.58, "weight": 1.31},
                "line": {"mean": 6.66, "weight": 0.31},
                "worst_span": {"mean": 3.5, "weight": 0.04},
            },
        },
        "openings": {
            "intercept": 1.01,
            "features": {
                "kind": {"mean": 0.96, "weight": 1.36},
                "wide": {"mean": -0.03, "weight": 0.74},
                "leads": {"mean": 0.73, "weight": 0.73},
            },
        },
        "rooms": {
            "intercept": 0.78,
            "features": {
                "walled": {"mean": 0.83, "weight": 1.07},
                "faced": {"mean": 0.67, "weight": 2.94},
                "broad": {"mean": 1.11, "weight": 4.17},
                "whole": {"mean": 6.83, "weight": 0.21},
                "apart": {"mean": 6.52, "weight": 0.03},
            },
        },
        "level": 0.518,
        "most": 0.944,
        "off": {
            "tuning": {"walls": 0.05, "faces": 0.02, "openings": 0.19, "rooms": 0.08},
            "reporting": {"walls": 0.05, "faces": 0.06, "openings": 0.1, "rooms": 0.18},
            "real": {"openings": 0.12, "rooms": 0.12},
        },
    },
}
