"""The model of `confidence.py`, written by `make bench ARGS="confidence ..."`.

Fitted on dwelling_101_vlp16_rover, dwelling_102_vlp16_unconverged,
office_cellular_101_ouster64_trolley, office_cellular_102_vlp16_rover,
hospital_101_vlp16_unconverged, hospital_102_uneven32_tilted, old_house_101_vlp16_hand,
old_house_103_uneven32_tilted, museum_102_vlp16_hand, hall_101_vlp16_odometry, hall_103_vlp16_hand,
office_glass_103_vlp16_rover; tested on attic_201_vlp16_hand, basement_202_uneven32_tilted,
hotel_203_vlp16_rover, school_202_vlp16_rover, library_202_vlp16_hand, shop_201_vlp16_odometry,
office_open_203_vlp16_odometry.
"""

from typing import Any

COEFFICIENTS: dict[str, Any] = {
    "level": 0.627,
    "walls": {
        "intercept": 1.8199,
        "features": {
            "agreement": {"mean": 4.0185, "weight": 0.4479},
            "observed": {"mean": 0.9153, "weight": 0.8072},
            "undoubled": {"mean": 0.8988, "weight": 0.4635},
            "joined": {"mean": 1.457, "weight": 0.235},
            "bounding": {"mean": 0.8199, "weight": 0.8371},
            "worst_span": {"mean": -0.1016, "weight": 0.2057},
            "points": {"mean": 7.1249, "weight": 0.2288},
            "length": {"mean": 0.7469, "weight": 0.0},
        },
    },
    "faces": {
        "intercept": 2.1568,
        "features": {
            "agreement": {"mean": 3.893, "weight": 0.2736},
            "worst_span": {"mean": 3.3609, "weight": 0.2221},
            "points": {"mean": 5.4427, "weight": 0.0423},
            "observed": {"mean": 0.7663, "weight": 0.0},
            "length": {"mean": -0.2531, "weight": 0.0},
            "smooth": {"mean": -1.2988, "weight": 0.1338},
            "undoubled": {"mean": 0.9394, "weight": 0.0483},
            "joined": {"mean": 1.6391, "weight": 0.2205},
            "bounding": {"mean": 0.886, "weight": 1.2978},
        },
    },
    "openings": {
        "intercept": 0.3062,
        "features": {
            "kind": {"mean": 2.7186, "weight": 0.5001},
            "usual": {"mean": 0.8431, "weight": 1.7104},
            "wall": {"mean": 3.7682, "weight": 0.321},
            "joined": {"mean": 1.8066, "weight": 0.752},
            "alone": {"mean": 0.8275, "weight": 0.5545},
            "width": {"mean": 0.0259, "weight": 0.0},
        },
    },
    "rooms": {
        "intercept": 3.1495,
        "features": {
            "walled": {"mean": 0.8591, "weight": 0.0},
            "faced": {"mean": 0.7216, "weight": 7.3243},
            "broad": {"mean": 1.1472, "weight": 0.1292},
        },
    },
}
