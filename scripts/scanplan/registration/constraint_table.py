"""The table and the summary of the links between retained scans."""

import numpy as np

from scanplan.geometry import se3
from scanplan.store import schemas

# half of the weight of a measurement that agrees
INLIER_WEIGHT = 0.25
_SLIGHT = 1e-7


def constraint_columns(result):
    """Return the columns of schemas.EDGES from a `multiway.OptimisedMap`; no rows from None."""
    edges = [] if result is None else result.edges
    motion = np.array([edge.fit.target_from_source for edge in edges]).reshape(-1, 4, 4)
    xyz_m, quat_xyzw = se3.split_pose(motion)
    residual = np.zeros((0, 6)) if result is None else _observed(result)
    weight = np.zeros(0) if result is None else result.weight
    fields = ("source", "target", "kind", "fitness", "rmse_m")
    return (
        {name: [getattr(edge, name) for edge in edges] for name in fields}
        | dict(zip(schemas.XYZ, xyz_m.T, strict=True))
        | dict(zip(schemas.QUAT, quat_xyzw.T, strict=True))
        | {
            "unobservable": [edge.fit.n_unobservable for edge in edges],
            "residual_m": np.linalg.norm(residual[:, :3], axis=1),
            "residual_deg": np.degrees(np.linalg.norm(residual[:, 3:], axis=1)),
            "weight": weight,
            "inlier": weight >= INLIER_WEIGHT,
        }
    )


def _observed(result):
    """Residuals (m, 6) in the directions that each link tells of: in the others it cannot be off."""
    information = np.array([edge.fit.information for edge in result.edges]).reshape(-1, 6, 6)
    slight = _SLIGHT * np.trace(information, axis1=1, axis2=2)[:, None, None] * np.eye(6)
    return np.linalg.solve(information + slight, information @ result.residual[:, :, None])[:, :, 0]


def summarise_constraints(result):
    """Return how many links there are, and how many are disbelieved, as one phrase."""
    if result is None:
        return "no links: poses as given"
    kinds = np.array([edge.kind for edge in result.edges])
    false = result.weight < INLIER_WEIGHT
    counts = ", ".join(
        f"{(kinds == k).sum():,} {k} ({(false & (kinds == k)).sum():,} outliers)"
        for k in sorted(set(kinds))
    )
    jumps = int((result.prior_weight < INLIER_WEIGHT).sum())
    return f"links: {counts or 'none'}; {jumps:,} of the localiser's poses are outliers"
