"""A made-up survey with its truth: a room of 6 m x 4 m, scans that see it, and their walls."""

import json

import numpy as np

from helpers.wall_making import walls
from scanplan.geometry import se3
from scanplan.lab.simulation import rover
from scanplan.store import schemas, tables
from scanplan.store.tum import format_tum

FACES = [(0, 0, 6, 0), (6, 0, 6, 4), (6, 4, 0, 4), (0, 4, 0, 0)]
POSITIONS = [(1.0, 1.0), (3.0, 2.0), (5.0, 3.0)]
SCAN_IDS = [2, 4, 7]
T_NS = np.array(SCAN_IDS, np.int64) * 100_000_000


def write_truth(folder, faces=FACES, positions=POSITIONS):
    """Write truth.geojson and truth_poses.tum."""
    features = [
        {
            "type": "Feature",
            "properties": {"kind": "face", "side": "inside"},
            "geometry": {"type": "LineString", "coordinates": [face[:2], face[2:]]},
        }
        for face in faces
    ]
    (folder / "truth.geojson").write_text(
        json.dumps({"type": "FeatureCollection", "features": features})
    )
    (folder / "truth_poses.tum").write_text(
        format_tum(T_NS, rover.planar_poses(positions, [0.0] * 3, 0.4))
    )


def write_registration(folder, map_from_true=None, positions=POSITIONS):
    """Write poses.parquet (exact) and registration.parquet (moved by `map_from_true`).

    One scan was dropped.
    """
    exact = rover.planar_poses(positions, [0.0] * 3, 0.4)
    moved = exact if map_from_true is None else map_from_true @ exact
    scan_id, t_ns = np.array([0, *SCAN_IDS]), np.array([0, *T_NS])
    for name, schema, poses, others in (
        ("poses", schemas.POSES, exact, {"gap_s": np.zeros(4), "covered": np.ones(4, bool)}),
        (
            "registration",
            schemas.REGISTRATION,
            moved,
            {
                "kept": np.array([False, True, True, True]),
                "reason": ["low_prior_fitness", "kept", "kept", "kept"],
                **dict.fromkeys(
                    ("prior_fitness", "refined_fitness", "rmse_m", *schemas.COVARIANCE), np.zeros(4)
                ),
            },
        ),
    ):
        xyz_m, quat = se3.split_pose(np.concatenate([poses[:1], poses]))
        pose = dict(
            zip((*schemas.XYZ, *schemas.QUAT), np.column_stack([xyz_m, quat]).T.copy(), strict=True)
        )
        tables.write_table(
            folder / f"{name}.parquet", schema, {"scan_id": scan_id, "t_ns": t_ns, **pose, **others}
        )


def write_walls(folder, extractor, segments, scan_id):
    """Write walls/<extractor>.parquet; the scan_ids increase."""
    table = walls(segments, scan_id=scan_id)
    path = folder / "walls" / f"{extractor}.parquet"
    tables.write_table(path, schemas.WALLS, table, allow_empty=True)
    return path


def write_selection(folder, method, scan_ids):
    """Write selection/<method>.parquet."""
    measures = ("gain_m2", "covered_m2", "bound_m2", "gain", "covered", "bound")
    areas = dict.fromkeys(measures, np.ones(len(scan_ids)))
    path = folder / "selection" / f"{method}.parquet"
    known = {
        "rank": np.arange(1, len(scan_ids) + 1),
        "scan_id": scan_ids,
        "n_points": np.full(len(scan_ids), 9),
    }
    tables.write_table(path, schemas.SELECTION, known | areas)
    return path


def shift(x_m, y_m):
    """Return a motion (4, 4) along x and y."""
    motion = np.eye(4)
    motion[:2, 3] = x_m, y_m
    return motion
