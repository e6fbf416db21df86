"""The model of `confidence.py`, written by `make bench ARGS="confidence ..."`.

Fitted on office_11, duplexup_1, demo_2, office_12, ring_1; tested on duplex_1, fzk_1, office_13,
demo_1, duplex_2, fzk_2, office_14, fzkup_1, duplexup_2.
"""

from typing import Any

COEFFICIENTS: dict[str, Any] = {
    "walls": {
        "intercept": 4.1878,
        "features": {
            "agreement": {"mean": 4.8148, "weight": 0.0426},
            "observed": {"mean": 0.9203, "weight": 1.9582},
            "undoubled": {"mean": 0.888, "weight": 2.2126},
            "joined": {"mean": 1.7784, "weight": 1.3588},
            "bounding": {"mean": 0.9474, "weight": 1.9787},
            "worst_span": {"mean": -0.4497, "weight": 0.6878},
            "points": {"mean": 6.6137, "weight": 0.1912},
            "length": {"mean": 1.846, "weight": 0.5167},
        },
        "level": 0.943,
    },
    "faces": {
        "intercept": 6.5126,
        "features": {
            "agreement": {"mean": 4.7928, "weight": 0.444},
            "worst_span": {"mean": 3.6582, "weight": 0.3231},
            "points": {"mean": 5.5957, "weight": 0.2452},
            "observed": {"mean": 0.863, "weight": 0.0},
            "length": {"mean": 0.5096, "weight": 0.5702},
            "smooth": {"mean": -1.0763, "weight": 0.3689},
            "undoubled": {"mean": 0.9458, "weight": 1.2237},
            "joined": {"mean": 1.8937, "weight": 2.3886},
            "bounding": {"mean": 0.9723, "weight": 1.4402},
        },
        "level": 0.968,
    },
    "openings": {
        "intercept": 5.7007,
        "features": {
            "kind": {"mean": 2.9096, "weight": 3.3252},
            "sill": {"mean": 0.9088, "weight": 0.6487},
            "lintel": {"mean": 0.2134, "weight": 1.9438},
            "usual": {"mean": 0.9625, "weight": 0.4842},
            "wall": {"mean": 4.9899, "weight": 0.6326},
            "joined": {"mean": 1.9837, "weight": 1.0046},
            "alone": {"mean": 0.9153, "weight": 4.586},
            "width": {"mean": -0.0706, "weight": 0.0836},
        },
        "level": 0.93,
    },
    "rooms": {
        "intercept": 4.4546,
        "features": {
            "closed": {"mean": 0.8304, "weight": 0.0},
            "walled": {"mean": 0.9128, "weight": 0.0},
            "faced": {"mean": 0.8516, "weight": 5.9468},
            "parted": {"mean": -0.0017, "weight": 14.3066},
            "broad": {"mean": 1.2778, "weight": 3.6336},
        },
        "level": 0.958,
    },
}
