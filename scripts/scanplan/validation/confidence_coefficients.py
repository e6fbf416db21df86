"""The model of `confidence.py`, written by `make bench ARGS="confidence FOLDER"`.

Fitted on drives through buildings of these kinds: dwelling, hall, hospital, museum,
office_cellular, office_glass, old_house.
"""

from typing import Any

COEFFICIENTS: dict[str, Any] = {
    "space": {
        "walls": {
            "intercept": 2.27,
            "features": {
                "thing": {"mean": 3.01, "weight": 0.71},
                "line": {"mean": 6.51, "weight": 0.18},
                "agreement": {"mean": 4.43, "weight": 0.32},
            },
        },
        "faces": {
            "intercept": 3.53,
            "features": {
                "thing": {"mean": 4.32, "weight": 0.73},
                "line": {"mean": 6.6, "weight": 0.15},
                "worst_span": {"mean": 3.77, "weight": 0.39},
                "bounding": {"mean": 0.89, "weight": 1.26},
            },
        },
        "openings": {
            "intercept": 2.62,
            "features": {
                "kind": {"mean": 1.92, "weight": 1.1},
                "host": {"mean": 4.04, "weight": 0.2},
                "rays": {"mean": 6.66, "weight": 0.03},
                "wide": {"mean": -0.02, "weight": 5.66},
                "leads": {"mean": 0.84, "weight": 1.59},
            },
        },
        "rooms": {
            "intercept": 3.36,
            "features": {
                "faced": {"mean": 0.75, "weight": 4.11},
                "broad": {"mean": 1.2, "weight": 3.47},
            },
        },
        "level": 0.68,
        "most": 0.964,
        "off": {
            "tuning": {"walls": 0.04, "faces": 0.02, "openings": 0.08, "rooms": 0.03},
            "reporting": {"walls": 0.05, "faces": 0.03, "openings": 0.08, "rooms": 0.12},
        },
    },
    "plane": {
        "walls": {
            "intercept": 0.53,
            "features": {
                "thing": {"mean": 2.52, "weight": 0.61},
                "line": {"mean": 7.17, "weight": 0.19},
            },
        },
        "faces": {
            "intercept": 1.85,
            "features": {
                "thing": {"mean": 3.39, "weight": 0.8},
                "line": {"mean": 6.7, "weight": 0.25},
            },
        },
        "openings": {
            "intercept": 1.11,
            "features": {
                "kind": {"mean": 0.97, "weight": 1.43},
                "wide": {"mean": -0.02, "weight": 1.98},
                "leads": {"mean": 0.69, "weight": 0.82},
            },
        },
        "rooms": {
            "intercept": 0.77,
            "features": {
                "walled": {"mean": 0.85, "weight": 0.54},
                "faced": {"mean": 0.71, "weight": 2.85},
                "broad": {"mean": 1.12, "weight": 3.26},
            },
        },
        "level": 0.459,
        "most": 0.944,
        "off": {
            "tuning": {"walls": 0.08, "faces": 0.07, "openings": 0.27, "rooms": 0.11},
            "reporting": {"walls": 0.09, "faces": 0.09, "openings": 0.11, "rooms": 0.1},
            "real": {"openings": 0.16, "rooms": 0.1},
        },
    },
}
