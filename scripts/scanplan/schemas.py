"""The columns of the tables between the stages.

Coordinates are metres in the map frame, z up; stamps nanoseconds; quaternions x, y, z, w. Units are in the names.
"""

from dataclasses import dataclass

XYZ = ("x_m", "y_m", "z_m")
QUAT = ("qx", "qy", "qz", "qw")
_POSE = dict.fromkeys((*XYZ, *QUAT), "float64")
_SEGMENT = dict.fromkeys(("x0_m", "y0_m", "x1_m", "y1_m", "nx", "ny"), "float64")


@dataclass(frozen=True)
class Schema:
    """A table's name, version, columns (name to Arrow type, in order) and the columns its rows are sorted by."""

    name: str
    version: int
    columns: dict
    sorted_by: tuple
    geometry: bool = False


POSES = Schema(
    "poses",
    1,
    {"scan_id": "int32", "t_ns": "int64", **_POSE, "gap_s": "float64", "covered": "bool"},
    ("scan_id",),
)
REGISTRATION = Schema(
    "registration",
    1,
    {
        "scan_id": "int32",
        "t_ns": "int64",
        "prior_fitness": "float64",
        "refined_fitness": "float64",
        "rmse_m": "float64",
        "kept": "bool",
        "reason": "string",
        **_POSE,
    },
    ("scan_id",),
)
EDGES = Schema(
    "edges",
    1,
    {
        "source": "int32",
        "target": "int32",
        "kind": "string",
        "fitness": "float64",
        "rmse_m": "float64",
        **_POSE,
        "unobservable": "int32",
        "residual_m": "float64",
        "residual_deg": "float64",
        "weight": "float64",
        "inlier": "bool",
    },
    ("source", "target"),
)
SCANS = Schema("scans", 1, {"scan_id": "int32", "x_m": "float32", "y_m": "float32", "z_m": "float32"}, ("scan_id",))
HULLS = Schema(
    "hulls",
    1,
    {"scan_id": "int32", "cluster": "int32", "n_points": "int32", "area_m2": "float64", "geometry": "binary"},
    ("scan_id", "cluster"),
    geometry=True,
)
SELECTION = Schema(
    "selection",
    1,
    {"rank": "int32", "scan_id": "int32", "gain_m2": "float64", "covered_m2": "float64", "bound_m2": "float64"},
    ("rank",),
)
WALLS = Schema(
    "walls",
    1,
    {
        "scan_id": "int32",
        "wall": "int32",
        **_SEGMENT,
        "n_points": "int32",
        "rmse_m": "float64",
        "z_min_m": "float64",
        "z_max_m": "float64",
    },
    ("scan_id", "wall"),
)
FACES = Schema(
    "faces",
    1,
    {
        "face": "int32",
        **_SEGMENT,
        "n_points": "int64",
        "n_scans": "int32",
        "rmse_m": "float64",
        "z_min_m": "float64",
        "z_max_m": "float64",
    },
    ("face",),
)
_WITHIN = ("005m", "010m", "015m")
EVALUATION = Schema(
    "evaluation",
    1,
    {
        "method": "string",
        "extractor": "string",
        "k": "int32",
        **dict.fromkeys(("false_negative", "correct_match", "false_positive"), "float64"),
        **{
            f"{truth}{measure}_{within}": "float64"
            for truth in ("", "visible_")
            for measure in ("completeness", "correctness", "f1")
            for within in _WITHIN
        },
        "n_walls": "int32",
        **dict.fromkeys(
            (
                "walls_per_true_wall",
                "redundancy",
                "seen",
                "missed_not_seen",
                "missed_misregistered",
                "missed_misextracted",
                "oracle_share",
                "seconds",
            ),
            "float64",
        ),
    },
    ("method", "extractor", "k"),
)
ORACLE = Schema("oracle", 1, {"rank": "int32", "scan_id": "int32", "gain_m": "float64", "seen_m": "float64"}, ("rank",))
POSE_ERRORS = Schema(
    "pose_errors",
    1,
    {
        "scan_id": "int32",
        "t_ns": "int64",
        **dict.fromkeys(
            (
                f"{aligned}{stage}_error_{unit}"
                for aligned in ("", "aligned_")
                for stage in ("prior", "refined")
                for unit in ("m", "deg")
            ),
            "float64",
        ),
    },
    ("scan_id",),
)
