"""Measure how thick the merged map's walls are, by the localiser's and by registered poses."""

import numpy as np

from scanplan.geometry import plane_scatter, se3
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import FilePath


def measure_crispness(
    scans: FilePath,
    registration: FilePath,
    poses: FilePath,
    output: FilePath,
    *,
    most_points: int,
    seed: int,
) -> None:
    """Write how thick the map of the kept scans is.

    Parameters
    ----------
    scans, registration, poses : path-like
        scans.parquet, registration.parquet and poses.parquet.
    output : path-like
        crispness.parquet, to write.
    most_points, seed
        See `plane_scatter.thin_randomly`.
    """
    store = tables.ScanStore(scans)
    kept = registered_scans.read_registered_scans(registration)
    prior = registered_scans.read_prior_poses(poses, kept, registration)
    prior_from_registered = prior @ se3.invert_pose(kept.map_from_sensor)
    progress = log.report_progress(store.scans(), "measure_crispness", total=len(store.scan_ids))
    xyz_m, scan_ids = plane_scatter.thin_randomly(
        progress, most_points=most_points, n_scans=len(store.scan_ids), seed=seed
    )
    motion = prior_from_registered[np.searchsorted(kept.scan_ids, scan_ids)]
    maps = {
        "localiser": np.einsum("nij,nj->ni", motion[:, :3, :3], xyz_m) + motion[:, :3, 3],
        "registered": xyz_m,
    }
    measured = {
        name: plane_scatter.measure_map_scatter(
            points_m,
            scan_ids,
            planar=store.planar,
            seed=seed,
        )
        for name, points_m in maps.items()
    }
    tables.write_table(output, schemas.CRISPNESS, plane_scatter.scatter_columns(measured))
    before_mm, after_mm = (1000 * measured[name].median_m for name in ("localiser", "registered"))
    log.log_line(
        f"measure_crispness: scatter {before_mm:.1f} mm, registered {after_mm:.1f} mm; median"
        " standard deviation of points across surfaces that several scans show"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_crispness(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.input.poses,
            snakemake.output.crispness,
            **snakemake.params.settings,
        )
