"""The model of `confidence.py`, written by `make bench ARGS="confidence FOLDER"`.

Fitted on drives through buildings of these kinds: dwelling, hall, hospital, museum,
office_cellular, office_glass, old_house.
"""

from typing import Any

COEFFICIENTS: dict[str, Any] = {
    "space": {
        "walls": {
            "intercept": 1.79,
            "features": {
                "thing": {"mean": 2.53, "weight": 0.67},
                "line": {"mean": 6.18, "weight": 0.13},
                "agreement": {"mean": 4.43, "weight": 0.21},
            },
        },
        "faces": {
            "intercept": 2.74,
            "features": {
                "thing": {"mean": 3.85, "weight": 0.59},
                "line": {"mean": 6.3, "weight": 0.11},
                "worst_span": {"mean": 3.74, "weight": 0.34},
                "bounding": {"mean": 0.89, "weight": 1.16},
            },
        },
        "openings": {
            "intercept": 1.5,
            "features": {
                "kind": {"mean": 4.35, "weight": 0.42},
                "rays": {"mean": 6.33, "weight": 0.1},
                "wide": {"mean": -0.07, "weight": 6.46},
                "leads": {"mean": 0.74, "weight": 1.63},
            },
        },
        "rooms": {
            "intercept": 2.84,
            "features": {
                "faced": {"mean": 0.77, "weight": 6.06},
                "broad": {"mean": 1.21, "weight": 1.92},
            },
        },
        "level": 0.628,
        "most": 0.963,
        "off": {
            "tuning": {"walls": 0.04, "faces": 0.03, "openings": 0.08, "rooms": 0.04},
            "reporting": {"walls": 0.04, "faces": 0.03, "openings": 0.06, "rooms": 0.13},
        },
    },
    "plane": {
        "walls": {
            "intercept": 0.38,
            "features": {
                "thing": {"mean": 2.21, "weight": 0.91},
                "line": {"mean": 7.24, "weight": 0.28},
            },
        },
        "faces": {
            "intercept": 1.82,
            "features": {
                "thing": {"mean": 3.21, "weight": 1.0},
                "line": {"mean": 6.66, "weight": 0.29},
            },
        },
        "openings": {
            "intercept": 1.07,
            "features": {
                "kind": {"mean": 2.06, "weight": 0.37},
                "wide": {"mean": -0.02, "weight": 2.74},
                "leads": {"mean": 0.7, "weight": 1.03},
            },
        },
        "rooms": {
            "intercept": 0.7,
            "features": {
                "faced": {"mean": 0.69, "weight": 2.65},
                "broad": {"mean": 1.11, "weight": 3.42},
            },
        },
        "level": 0.364,
        "most": 0.944,
        "off": {
            "tuning": {"walls": 0.09, "faces": 0.06, "openings": 0.26, "rooms": 0.09},
            "reporting": {"walls": 0.08, "faces": 0.09, "openings": 0.07, "rooms": 0.09},
            "real": {"openings": 0.03, "rooms": 0.07},
        },
    },
}
