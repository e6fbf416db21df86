"""The model of `confidence.py`, written by `make bench ARGS="confidence FOLDER"`.

Fitted on drives through buildings of these kinds: dwelling, hall, hospital, museum,
office_cellular, office_glass, old_house.
"""

from typing import Any

COEFFICIENTS: dict[str, Any] = {
    "space": {
        "walls": {
            "intercept": 1.64,
            "features": {
                "thing": {"mean": 2.49, "weight": 0.66},
                "line": {"mean": 6.11, "weight": 0.11},
                "agreement": {"mean": 4.32, "weight": 0.19},
            },
        },
        "faces": {
            "intercept": 2.48,
            "features": {
                "thing": {"mean": 3.82, "weight": 0.54},
                "line": {"mean": 6.3, "weight": 0.09},
                "worst_span": {"mean": 3.69, "weight": 0.32},
                "bounding": {"mean": 0.88, "weight": 1.13},
            },
        },
        "openings": {
            "intercept": 1.26,
            "features": {
                "kind": {"mean": 4.39, "weight": 0.34},
                "wall": {"mean": 4.38, "weight": 0.08},
                "rays": {"mean": 6.29, "weight": 0.05},
                "wide": {"mean": -0.07, "weight": 6.85},
                "leads": {"mean": 0.74, "weight": 1.66},
            },
        },
        "rooms": {
            "intercept": 2.71,
            "features": {
                "walled": {"mean": 0.93, "weight": 1.04},
                "faced": {"mean": 0.77, "weight": 4.82},
                "broad": {"mean": 1.21, "weight": 2.34},
            },
        },
        "level": 0.61,
        "most": 0.964,
        "off": {
            "tuning": {"walls": 0.04, "faces": 0.02, "openings": 0.08, "rooms": 0.07},
            "reporting": {"walls": 0.03, "faces": 0.02, "openings": 0.05, "rooms": 0.11},
        },
    },
    "plane": {
        "walls": {
            "intercept": 0.41,
            "features": {
                "thing": {"mean": 2.21, "weight": 0.89},
                "line": {"mean": 7.25, "weight": 0.28},
            },
        },
        "faces": {
            "intercept": 1.83,
            "features": {
                "thing": {"mean": 3.23, "weight": 0.98},
                "line": {"mean": 6.65, "weight": 0.29},
            },
        },
        "openings": {
            "intercept": 1.26,
            "features": {
                "kind": {"mean": 2.07, "weight": 0.43},
                "wide": {"mean": -0.02, "weight": 3.18},
                "leads": {"mean": 0.7, "weight": 1.2},
            },
        },
        "rooms": {
            "intercept": 0.65,
            "features": {
                "faced": {"mean": 0.69, "weight": 3.15},
                "broad": {"mean": 1.11, "weight": 3.35},
            },
        },
        "level": 0.346,
        "most": 0.944,
        "off": {
            "tuning": {"walls": 0.1, "faces": 0.07, "openings": 0.24, "rooms": 0.11},
            "reporting": {"walls": 0.07, "faces": 0.1, "openings": 0.11, "rooms": 0.1},
            "real": {"openings": 0.05, "rooms": 0.06},
        },
    },
}
