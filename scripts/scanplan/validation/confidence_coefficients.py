"""The model of `confidence.py`, written by `make bench ARGS="confidence FOLDER"`.

Fitted on drives through buildings of these kinds: dwelling, hall, hospital, museum,
office_cellular, office_glass, old_house.
"""

from typing import Any

COEFFICIENTS: dict[str, Any] = {
    "space": {
        "walls": {
            "intercept": 1.93,
            "features": {
                "thing": {"mean": 2.95, "weight": 0.57},
                "line": {"mean": 6.43, "weight": 0.14},
                "agreement": {"mean": 4.41, "weight": 0.24},
            },
        },
        "faces": {
            "intercept": 2.82,
            "features": {
                "thing": {"mean": 4.27, "weight": 0.46},
                "line": {"mean": 6.47, "weight": 0.18},
                "worst_span": {"mean": 3.7, "weight": 0.37},
                "bounding": {"mean": 0.88, "weight": 1.71},
            },
        },
        "openings": {
            "intercept": 2.29,
            "features": {
                "kind": {"mean": 1.9, "weight": 0.65},
                "host": {"mean": 4.06, "weight": 0.03},
                "rays": {"mean": 6.66, "weight": 0.06},
                "wide": {"mean": -0.02, "weight": 5.81},
                "leads": {"mean": 0.83, "weight": 1.98},
            },
        },
        "rooms": {
            "intercept": 3.1,
            "features": {
                "faced": {"mean": 0.76, "weight": 4.23},
                "broad": {"mean": 1.21, "weight": 3.22},
            },
        },
        "level": 0.643,
        "most": 0.964,
        "off": {
            "tuning": {"walls": 0.03, "faces": 0.03, "openings": 0.11, "rooms": 0.06},
            "reporting": {"walls": 0.04, "faces": 0.03, "openings": 0.08, "rooms": 0.1},
        },
    },
    "plane": {
        "walls": {
            "intercept": 0.4,
            "features": {
                "thing": {"mean": 2.57, "weight": 0.78},
                "line": {"mean": 7.22, "weight": 0.27},
            },
        },
        "faces": {
            "intercept": 1.78,
            "features": {
                "thing": {"mean": 3.45, "weight": 0.89},
                "line": {"mean": 6.68, "weight": 0.29},
            },
        },
        "openings": {
            "intercept": 1.02,
            "features": {
                "kind": {"mean": 0.98, "weight": 1.14},
                "wide": {"mean": -0.02, "weight": 1.39},
                "leads": {"mean": 0.7, "weight": 0.78},
            },
        },
        "rooms": {
            "intercept": 0.63,
            "features": {
                "faced": {"mean": 0.7, "weight": 2.23},
                "broad": {"mean": 1.11, "weight": 2.95},
            },
        },
        "level": 0.395,
        "most": 0.944,
        "off": {
            "tuning": {"walls": 0.07, "faces": 0.04, "openings": 0.26, "rooms": 0.08},
            "reporting": {"walls": 0.07, "faces": 0.08, "openings": 0.15, "rooms": 0.13},
            "real": {"openings": 0.1, "rooms": 0.08},
        },
    },
}
