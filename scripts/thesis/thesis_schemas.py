"""The columns of the tables that the laboratory writes; units and frames as in `store.schemas`."""

from scanplan.store.schemas import Schema

SECONDS = Schema(
    "seconds",
    1,
    {"method": "string", "extractor": "string", "k": "int32", "seconds": "float64"},
    ("method", "extractor", "k"),
)
ORACLE = Schema(
    "oracle",
    2,
    {
        "extractor": "string",
        "rank": "int32",
        "scan_id": "int32",
        "gain_m": "float64",
        "found_m": "float64",
    },
    ("extractor", "rank"),
)
CLUSTERS = Schema(
    "clusters",
    2,
    {
        **dict.fromkeys(("n_clusters", "rank", "scan_id"), "int32"),
        **dict.fromkeys(("area_m2", "covered_m2"), "float64"),
    },
    ("n_clusters", "rank"),
)
AREAS = Schema(
    "areas",
    3,
    {
        "scan_id": "int32",
        **dict.fromkeys(
            (
                "full_hull_m2",
                "cluster_hull_m2",
                "seen_m2",
                "full_hull_iou",
                "cluster_hull_iou",
                "full_hull_stray_m2",
                "cluster_hull_stray_m2",
            ),
            "float64",
        ),
    },
    ("scan_id",),
)
"""Areas of a scan's hulls and of what it truly sees.

`iou` is intersection over union of a hull with the latter, `stray` a hull's area with one stray
return more.
"""
UNEVENNESS = Schema(
    "unevenness",
    2,
    {"order": "string", "crowd": "int32", "repeats": "int32", "seen_m": "float64"},
    ("order", "crowd", "repeats"),
)
"""True wall length seen by the first scans of an order, those of a crowd taken `repeats` times."""
PREMISES = Schema(
    "premises",
    1,
    {"premise": "string", "item": "int32", "value": "float64"},
    ("premise", "item"),
)
"""What the thesis takes for granted, draw by draw or scan by scan."""
SURROGATES = Schema(
    "surrogates",
    1,
    {
        "surrogate": "string",
        "draw": "int32",
        "value": "float64",
        "ratio": "float64",
        "found": "float64",
    },
    ("surrogate", "draw"),
)
"""What random subsets are worth by a surrogate, and the share of walls that they find.

`ratio` is the submodularity ratio of as many scans added to them.
"""
MEASUREMENTS = Schema(
    "measurements",
    1,
    {
        "case": "string",
        "level": "float64",
        "item": "int32",
        "quantity": "string",
        "value": "float64",
    },
    ("case", "level", "item", "quantity"),
)
"""What an experiment beyond the thesis's measures, see `beyond.measurements`."""
TIMES = Schema(
    "times",
    1,
    {
        "task": "string",
        "size": "int32",
        "item": "int32",
        "found": "int32",
        "seconds": "float64",
    },
    ("task", "size", "item"),
)
CANDIDATES = Schema(
    "candidates",
    1,
    {
        "model": "string",
        "inlier_m": "float64",
        "scan_id": "int32",
        "candidates": "int32",
        "near_walls": "int32",
        "walls": "int32",
    },
    ("model", "inlier_m", "scan_id"),
)
"""Walls that RANSAC finds in a scan, those near true faces, and how many faces these are."""
STEPS = Schema(
    "steps",
    1,
    {
        "step": "int32",
        "name": "string",
        "seconds": "float64",
        "n_scans": "int32",
        "n_bytes": "int64",
    },
    ("step",),
)
NOT_WRITTEN = -1
"""Bytes after a step of `STEPS` that writes no data."""
GATES = Schema(
    "gates",
    1,
    {
        "reading": "string",
        "distance_m": "float64",
        "scan_id": "int32",
        "passed": "bool",
        "kept": "bool",
        "x_m": "float64",
        "y_m": "float64",
    },
    ("reading", "distance_m", "scan_id"),
)
"""Which candidates pass the first gate of algorithm 3, and both, by reading and fitness distance.

Positions are the true ones.
"""
ALIGNMENTS = Schema(
    "alignments",
    1,
    {
        "method": "string",
        "distance_m": "float64",
        "source": "int32",
        "target": "int32",
        **dict.fromkeys(("true_step_m", "step_m", "error_m", "true_fitness", "fitness"), "float64"),
    },
    ("method", "distance_m", "source"),
)
"""Pairs of successive scans aligned from the truth: how far off they end, and with what fitness."""
CLAIMS = Schema(
    "claims",
    3,
    {
        "claim": "string",
        "survey": "string",
        "quantity": "string",
        "value": "float64",
        "unit": "string",
        "holds": "string",
    },
    ("claim", "survey", "quantity"),
)
