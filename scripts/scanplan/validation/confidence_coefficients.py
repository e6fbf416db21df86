"""The model of `confidence.py`, written by `make bench ARGS="confidence FOLDER"`.

Fitted on drives through buildings of these kinds: dwelling, hall, hospital, museum,
office_cellular, office_glass, old_house.
"""

from typing import Any

COEFFICIENTS: dict[str, Any] = {
    "space": {
        "walls": {
            "intercept": 1.83,
            "features": {
                "thing": {"mean": 2.48, "weight": 0.6},
                "line": {"mean": 6.22, "weight": 0.13},
                "agreement": {"mean": 4.36, "weight": 0.2},
            },
        },
        "faces": {
            "intercept": 2.52,
            "features": {
                "thing": {"mean": 3.72, "weight": 0.48},
                "line": {"mean": 6.35, "weight": 0.1},
                "worst_span": {"mean": 3.7, "weight": 0.34},
                "bounding": {"mean": 0.89, "weight": 1.22},
            },
        },
        "openings": {
            "intercept": 0.13,
            "features": {
                "kind": {"mean": 4.48, "weight": 0.33},
                "wall": {"mean": 4.01, "weight": 0.51},
                "rays": {"mean": 5.66, "weight": 0.24},
                "wide": {"mean": -0.11, "weight": 7.38},
                "leads": {"mean": 0.68, "weight": 1.78},
            },
        },
        "rooms": {
            "intercept": 2.12,
            "features": {
                "walled": {"mean": 0.9, "weight": 6.59},
                "faced": {"mean": 0.77, "weight": 1.42},
            },
        },
        "level": 0.672,
        "most": 0.961,
        "off": {
            "tuning": {"walls": 0.04, "faces": 0.02, "openings": 0.03, "rooms": 0.07},
            "reporting": {"walls": 0.08, "faces": 0.05, "openings": 0.08, "rooms": 0.18},
        },
    },
    "plane": {
        "walls": {
            "intercept": 0.67,
            "features": {
                "thing": {"mean": 2.1, "weight": 0.96},
                "line": {"mean": 7.16, "weight": 0.27},
                "agreement": {"mean": 4.82, "weight": 0.08},
            },
        },
        "faces": {
            "intercept": 1.92,
            "features": {
                "thing": {"mean": 3.03, "weight": 1.05},
                "line": {"mean": 6.61, "weight": 0.31},
            },
        },
        "openings": {
            "intercept": 0.38,
            "features": {
                "kind": {"mean": 1.98, "weight": 0.1},
                "host": {"mean": 3.1, "weight": 0.47},
                "wall": {"mean": 4.34, "weight": 0.12},
                "rays": {"mean": 3.51, "weight": 0.17},
                "wide": {"mean": -0.02, "weight": 6.8},
                "leads": {"mean": 0.62, "weight": 1.08},
            },
        },
        "rooms": {
            "intercept": 0.34,
            "features": {
                "faced": {"mean": 0.72, "weight": 5.79},
                "broad": {"mean": 1.06, "weight": 1.42},
            },
        },
        "level": 0.458,
        "most": 0.976,
        "off": {
            "tuning": {"walls": 0.08, "faces": 0.04, "openings": 0.09, "rooms": 0.12},
            "reporting": {"walls": 0.12, "faces": 0.13, "openings": 0.12, "rooms": 0.11},
            "real": {"openings": 0.12, "rooms": 0.06},
        },
    },
}
