"""The model of `confidence.py`, written by `make bench ARGS="confidence ..."`.

Fitted on office_11, duplexup_1, demo_2, office_12; tested on duplex_1, fzk_1, office_13, demo_1.
"""

from typing import Any

COEFFICIENTS: dict[str, Any] = {
    "walls": {
        "intercept": 3.6918,
        "features": {
            "agreement": {"mean": 5.0735, "weight": 0.3682},
            "worst_span": {"mean": -0.4206, "weight": 0.3236},
            "points": {"mean": 6.4421, "weight": 0.262},
            "scans": {"mean": 1.8764, "weight": -0.1744},
            "observed": {"mean": 0.902, "weight": 3.1252},
            "length": {"mean": 1.6478, "weight": 0.7748},
            "two_sided": {"mean": 0.4367, "weight": -0.1645},
            "placed": {"mean": 4.6983, "weight": -1.1216},
        },
        "level": 0.924,
    },
    "faces": {
        "intercept": 5.1939,
        "features": {
            "agreement": {"mean": 4.8395, "weight": 0.581},
            "worst_span": {"mean": 3.8575, "weight": 0.095},
            "points": {"mean": 5.3931, "weight": 0.4241},
            "scans": {"mean": 1.1794, "weight": -1.2191},
            "observed": {"mean": 0.8321, "weight": -0.8915},
            "length": {"mean": 0.3532, "weight": 0.4209},
            "smooth": {"mean": -1.0662, "weight": 0.2062},
        },
        "level": 0.957,
    },
    "openings": {
        "intercept": 2.6501,
        "features": {
            "agreement": {"mean": 4.1513, "weight": -0.0432},
            "kind": {"mean": 4.0218, "weight": 0.5082},
            "rays": {"mean": 6.5826, "weight": -0.0385},
            "sill": {"mean": 0.8544, "weight": 0.6369},
            "lintel": {"mean": 0.068, "weight": 2.5642},
            "between_rooms": {"mean": 0.5793, "weight": -0.8332},
            "is_door": {"mean": 0.644, "weight": -0.9978},
            "length": {"mean": 0.0543, "weight": -2.4909},
        },
        "level": 0.884,
    },
    "rooms": {
        "intercept": 3.2524,
        "features": {
            "closed": {"mean": 0.7701, "weight": 0.0359},
            "walled": {"mean": 0.8913, "weight": 2.1695},
            "scans": {"mean": 1.8782, "weight": -0.5452},
            "compact": {"mean": -0.4758, "weight": 2.8052},
            "area": {"mean": 2.7134, "weight": 1.9692},
        },
        "level": 0.861,
    },
}
