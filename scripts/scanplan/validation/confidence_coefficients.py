"""The model of `confidence.py`, written by `make bench ARGS="confidence ..."`.

Fitted on drawn_22, drawn_23, drawn_24, drawn_25, drawn_26, drawn_27, drawn_28, drawn_29, drawn_30,
drawn_31, drawn_32, drawn_35, drawn_36, drawn_37, drawn_38, drawn_41, drawn_44; tested on demo_1,
demo_2, ring_1, ring_2, duplex_1, duplex_2, duplex_3, fzk_1, fzk_2, fzk_3.
"""

from typing import Any

COEFFICIENTS: dict[str, Any] = {
    "level": 0.908,
    "walls": {
        "intercept": 3.8289,
        "features": {
            "agreement": {"mean": 4.9647, "weight": 0.4273},
            "observed": {"mean": 0.949, "weight": 4.3745},
            "undoubled": {"mean": 0.8946, "weight": 0.6441},
            "joined": {"mean": 1.6732, "weight": 0.6832},
            "bounding": {"mean": 0.9599, "weight": 0.8711},
            "worst_span": {"mean": -0.4312, "weight": 0.4332},
            "points": {"mean": 6.644, "weight": 0.1871},
            "length": {"mean": 1.527, "weight": 0.4632},
        },
    },
    "faces": {
        "intercept": 5.5009,
        "features": {
            "agreement": {"mean": 5.1411, "weight": 0.4508},
            "worst_span": {"mean": 4.2539, "weight": 0.2949},
            "points": {"mean": 5.8615, "weight": 0.2827},
            "observed": {"mean": 0.8843, "weight": 0.0},
            "length": {"mean": 0.3118, "weight": 0.4609},
            "smooth": {"mean": -1.1945, "weight": 0.2312},
            "undoubled": {"mean": 0.9333, "weight": 0.1893},
            "joined": {"mean": 1.8362, "weight": 1.1314},
            "bounding": {"mean": 0.9776, "weight": 0.6769},
        },
    },
    "openings": {
        "intercept": 2.7888,
        "features": {
            "kind": {"mean": 2.9348, "weight": 3.5642},
            "usual": {"mean": 0.8715, "weight": 4.7712},
            "wall": {"mean": 4.7297, "weight": 0.2529},
            "joined": {"mean": 1.9257, "weight": 1.1032},
            "alone": {"mean": 0.9106, "weight": 2.3635},
            "width": {"mean": -0.1539, "weight": 0.7022},
        },
    },
    "rooms": {
        "intercept": 5.4429,
        "features": {
            "walled": {"mean": 0.9182, "weight": 4.9828},
            "faced": {"mean": 0.7977, "weight": 0.7423},
            "broad": {"mean": 1.1909, "weight": 4.0942},
        },
    },
}
