"""The model of `confidence.py`, written by `make bench ARGS="confidence FOLDER"`.

Fitted on drives through buildings of these kinds: dwelling, hall, hospital, museum,
office_cellular, office_glass, old_house.
"""

from typing import Any

COEFFICIENTS: dict[str, Any] = {
    "space": {
        "walls": {
            "intercept": 2.03,
            "features": {
                "thing": {"mean": 3.33, "weight": 0.61},
                "line": {"mean": 6.44, "weight": 0.2},
                "agreement": {"mean": 4.46, "weight": 0.24},
            },
        },
        "faces": {
            "intercept": 3.34,
            "features": {
                "thing": {"mean": 4.84, "weight": 0.62},
                "line": {"mean": 6.58, "weight": 0.19},
                "worst_span": {"mean": 3.77, "weight": 0.3},
                "bounding": {"mean": 0.89, "weight": 1.25},
            },
        },
        "openings": {
            "intercept": 2.58,
            "features": {
                "kind": {"mean": 3.27, "weight": 0.75},
                "wall": {"mean": 4.53, "weight": 0.04},
                "rays": {"mean": 6.68, "weight": 0.08},
                "wide": {"mean": -0.02, "weight": 9.92},
                "leads": {"mean": 0.83, "weight": 1.36},
            },
        },
        "rooms": {
            "intercept": 3.07,
            "features": {
                "faced": {"mean": 0.75, "weight": 3.08},
                "broad": {"mean": 1.18, "weight": 4.15},
                "apart": {"mean": 7.92, "weight": 0.26},
            },
        },
        "level": 0.683,
        "most": 0.964,
        "off": {
            "tuning": {"walls": 0.03, "faces": 0.02, "openings": 0.05, "rooms": 0.04},
            "reporting": {"walls": 0.05, "faces": 0.02, "openings": 0.07, "rooms": 0.1},
        },
    },
    "plane": {
        "walls": {
            "intercept": 0.94,
            "features": {
                "thing": {"mean": 1.86, "weight": 1.19},
                "line": {"mean": 7.07, "weight": 0.27},
            },
        },
        "faces": {
            "intercept": 2.48,
            "features": {
                "thing": {"mean": 2.59, "weight": 1.31},
                "line": {"mean": 6.67, "weight": 0.31},
                "worst_span": {"mean": 3.52, "weight": 0.04},
            },
        },
        "openings": {
            "intercept": 1.2,
            "features": {
                "kind": {"mean": 1.32, "weight": 0.61},
                "wide": {"mean": -0.03, "weight": 0.86},
                "leads": {"mean": 0.77, "weight": 0.73},
            },
        },
        "rooms": {
            "intercept": 0.77,
            "features": {
                "walled": {"mean": 0.83, "weight": 0.59},
                "faced": {"mean": 0.67, "weight": 3.08},
                "broad": {"mean": 1.11, "weight": 4.19},
                "whole": {"mean": 6.83, "weight": 0.2},
                "apart": {"mean": 6.52, "weight": 0.03},
            },
        },
        "level": 0.517,
        "most": 0.944,
        "off": {
            "tuning": {"walls": 0.05, "faces": 0.02, "openings": 0.18, "rooms": 0.08},
            "reporting": {"walls": 0.05, "faces": 0.06, "openings": 0.16, "rooms": 0.18},
            "real": {"openings": 0.09, "rooms": 0.11},
        },
    },
}
