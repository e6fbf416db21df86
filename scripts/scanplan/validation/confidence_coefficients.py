"""The model of `confidence.py`, written by `make bench ARGS="confidence FOLDER"`.

Fitted on drives through buildings of these kinds: dwelling, hall, hospital, museum,
office_cellular, office_glass, old_house.
"""

from typing import Any

COEFFICIENTS: dict[str, Any] = {
    "space": {
        "walls": {
            "intercept": 1.76,
            "features": {
                "thing": {"mean": 2.56, "weight": 0.63},
                "line": {"mean": 6.14, "weight": 0.13},
                "agreement": {"mean": 4.42, "weight": 0.24},
            },
        },
        "faces": {
            "intercept": 2.82,
            "features": {
                "thing": {"mean": 3.84, "weight": 0.61},
                "line": {"mean": 6.3, "weight": 0.11},
                "worst_span": {"mean": 3.76, "weight": 0.36},
                "bounding": {"mean": 0.89, "weight": 1.19},
            },
        },
        "openings": {
            "intercept": 2.09,
            "features": {
                "kind": {"mean": 1.78, "weight": 0.99},
                "wall": {"mean": 4.49, "weight": 0.07},
                "rays": {"mean": 6.66, "weight": 0.09},
                "wide": {"mean": -0.03, "weight": 7.62},
                "leads": {"mean": 0.8, "weight": 1.37},
            },
        },
        "rooms": {
            "intercept": 2.84,
            "features": {
                "faced": {"mean": 0.77, "weight": 6.03},
                "broad": {"mean": 1.21, "weight": 1.92},
            },
        },
        "level": 0.639,
        "most": 0.963,
        "off": {
            "tuning": {"walls": 0.04, "faces": 0.03, "openings": 0.11, "rooms": 0.04},
            "reporting": {"walls": 0.03, "faces": 0.03, "openings": 0.08, "rooms": 0.13},
        },
    },
    "plane": {
        "walls": {
            "intercept": 0.4,
            "features": {
                "thing": {"mean": 2.22, "weight": 0.92},
                "line": {"mean": 7.17, "weight": 0.27},
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
            "intercept": 1.17,
            "features": {
                "kind": {"mean": 0.91, "weight": 0.88},
                "wide": {"mean": -0.01, "weight": 2.86},
                "leads": {"mean": 0.73, "weight": 1.06},
            },
        },
        "rooms": {
            "intercept": 0.7,
            "features": {
                "faced": {"mean": 0.69, "weight": 2.65},
                "broad": {"mean": 1.11, "weight": 3.42},
            },
        },
        "level": 0.374,
        "most": 0.944,
        "off": {
            "tuning": {"walls": 0.08, "faces": 0.06, "openings": 0.28, "rooms": 0.09},
            "reporting": {"walls": 0.08, "faces": 0.09, "openings": 0.1, "rooms": 0.09},
            "real": {"openings": 0.1, "rooms": 0.07},
        },
    },
}
