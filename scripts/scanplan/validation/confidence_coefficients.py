"""The model of `confidence.py`, written by `make bench ARGS="confidence FOLDER"`.

Fitted on drives through buildings of these kinds: dwelling, hall, hospital, museum,
office_cellular, office_glass, old_house.
"""

from typing import Any

COEFFICIENTS: dict[str, Any] = {
    "space": {
        "walls": {
            "intercept": 1.81,
            "features": {
                "thing": {"mean": 2.48, "weight": 0.58},
                "line": {"mean": 6.23, "weight": 0.14},
                "agreement": {"mean": 4.36, "weight": 0.2},
            },
        },
        "faces": {
            "intercept": 2.52,
            "features": {
                "thing": {"mean": 3.71, "weight": 0.47},
                "line": {"mean": 6.36, "weight": 0.1},
                "worst_span": {"mean": 3.7, "weight": 0.34},
                "bounding": {"mean": 0.89, "weight": 1.27},
            },
        },
        "openings": {
            "intercept": 0.0,
            "features": {
                "kind": {"mean": 4.49, "weight": 0.32},
                "wall": {"mean": 3.61, "weight": 0.47},
                "rays": {"mean": 5.11, "weight": 0.22},
                "wide": {"mean": -0.1, "weight": 6.76},
                "leads": {"mean": 0.68, "weight": 1.9},
            },
        },
        "rooms": {
            "intercept": 2.2,
            "features": {
                "walled": {"mean": 0.91, "weight": 4.19},
                "faced": {"mean": 0.73, "weight": 3.49},
                "broad": {"mean": 1.21, "weight": 0.51},
            },
        },
        "level": 0.671,
        "most": 0.958,
        "off": {
            "tuning": {"walls": 0.04, "faces": 0.02, "openings": 0.02, "rooms": 0.07},
            "reporting": {"walls": 0.05, "faces": 0.03, "openings": 0.04, "rooms": 0.22},
        },
    },
    "plane": {
        "walls": {
            "intercept": 0.67,
            "features": {
                "thing": {"mean": 2.1, "weight": 0.96},
                "line": {"mean": 7.15, "weight": 0.27},
                "agreement": {"mean": 4.82, "weight": 0.08},
            },
        },
        "faces": {
            "intercept": 1.92,
            "features": {
                "thing": {"mean": 3.03, "weight": 1.05},
                "line": {"mean": 6.62, "weight": 0.31},
                "worst_span": {"mean": 3.6, "weight": 0.03},
            },
        },
        "openings": {
            "intercept": 0.23,
            "features": {
                "kind": {"mean": 1.98, "weight": 0.15},
                "host": {"mean": 2.59, "weight": 0.29},
                "wall": {"mean": 3.63, "weight": 0.06},
                "rays": {"mean": 2.94, "weight": 0.04},
                "wide": {"mean": -0.03, "weight": 1.92},
                "leads": {"mean": 0.61, "weight": 1.31},
            },
        },
        "rooms": {
            "intercept": 0.41,
            "features": {
                "walled": {"mean": 0.84, "weight": 0.91},
                "faced": {"mean": 0.66, "weight": 3.2},
                "broad": {"mean": 1.07, "weight": 2.37},
            },
        },
        "level": 0.437,
        "most": 0.972,
        "off": {
            "tuning": {"walls": 0.08, "faces": 0.04, "openings": 0.14, "rooms": 0.1},
            "reporting": {"walls": 0.1, "faces": 0.12, "openings": 0.1, "rooms": 0.11},
            "real": {"openings": 0.15, "rooms": 0.06},
        },
    },
}
