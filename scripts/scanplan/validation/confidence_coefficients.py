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
                "thing": {"mean": 2.49, "weight": 0.65},
                "line": {"mean": 6.11, "weight": 0.11},
                "agreement": {"mean": 4.32, "weight": 0.18},
            },
        },
        "faces": {
            "intercept": 2.49,
            "features": {
                "thing": {"mean": 3.82, "weight": 0.53},
                "line": {"mean": 6.3, "weight": 0.09},
                "worst_span": {"mean": 3.69, "weight": 0.32},
                "bounding": {"mean": 0.89, "weight": 1.32},
            },
        },
        "openings": {
            "intercept": 1.23,
            "features": {
                "kind": {"mean": 4.39, "weight": 0.34},
                "wall": {"mean": 4.38, "weight": 0.06},
                "rays": {"mean": 6.29, "weight": 0.07},
                "wide": {"mean": -0.07, "weight": 6.84},
                "leads": {"mean": 0.72, "weight": 1.4},
            },
        },
        "rooms": {
            "intercept": 2.54,
            "features": {
                "walled": {"mean": 0.92, "weight": 3.25},
                "faced": {"mean": 0.76, "weight": 4.4},
                "broad": {"mean": 1.22, "weight": 1.65},
            },
        },
        "level": 0.614,
        "most": 0.964,
        "off": {
            "tuning": {"walls": 0.04, "faces": 0.02, "openings": 0.09, "rooms": 0.06},
            "reporting": {"walls": 0.04, "faces": 0.03, "openings": 0.06, "rooms": 0.11},
        },
    },
    "plane": {
        "walls": {
            "intercept": 0.63,
            "features": {
                "thing": {"mean": 2.26, "weight": 0.86},
                "line": {"mean": 7.18, "weight": 0.27},
            },
        },
        "faces": {
            "intercept": 2.05,
            "features": {
                "thing": {"mean": 3.27, "weight": 0.98},
                "line": {"mean": 6.63, "weight": 0.28},
            },
        },
        "openings": {
            "intercept": 1.16,
            "features": {
                "kind": {"mean": 2.08, "weight": 0.41},
                "wide": {"mean": -0.02, "weight": 2.54},
                "leads": {"mean": 0.69, "weight": 1.19},
            },
        },
        "rooms": {
            "intercept": 0.55,
            "features": {
                "walled": {"mean": 0.84, "weight": 0.54},
                "faced": {"mean": 0.67, "weight": 2.67},
                "broad": {"mean": 1.1, "weight": 2.37},
            },
        },
        "level": 0.415,
        "most": 0.944,
        "off": {
            "tuning": {"walls": 0.08, "faces": 0.05, "openings": 0.21, "rooms": 0.06},
            "reporting": {"walls": 0.08, "faces": 0.11, "openings": 0.06, "rooms": 0.11},
            "real": {"openings": 0.03, "rooms": 0.06},
        },
    },
}
