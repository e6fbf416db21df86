"""Measure how thick the walls of the merged map are, by the localiser's poses and by the registered ones."""

import numpy as np

from scanplan.geometry import plane_scatter, se3
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables


def measure_crispness(
    scans, registration, poses, output, *, radius_m, most_points, most_places, seed
):
    """Write the crispness of the map of the kept scans.

    Parameters
    ----------
    scans, registration, poses : path-like
        scans.parquet, registration.parquet and poses.parquet.
    output : path-like
        crispness.parquet, to write.
    radius_m, most_points, most_places, seed
        See `plane_scatter.measure_scatter`, `plane_scatter.thin_randomly` and
        `plane_scatter.choose_places`.
    """
    store, kept = tables.ScanStore(scans), registered_scans.read_registered_scans(registration)
    to_localiser = registered_scans.read_prior_poses(poses, kept, registration) @ se3.invert_pose(
        kept.map_from_sensor
    )
    found = log.report_progress(store.scans(), "measure_crispness", total=len(store.scan_ids))
    xyz_m, scan_ids = plane_scatter.thin_randomly(
        found, most_points=most_points, n_scans=len(store.scan_ids), seed=seed
    )
    motion = to_localiser[np.searchsorted(kept.scan_ids, scan_ids)]
    maps = {
        "localiser": np.einsum("nij,nj->ni", motion[:, :3, :3], xyz_m) + motion[:, :3, 3],
        "registered": xyz_m,
    }
    measured = {
        name: plane_scatter.measure_map_scatter(
            points_m,
            scan_ids,
            planar=store.planar,
            radius_m=radius_m,
            most_places=most_places,
            seed=seed,
        )
        for name, points_m in maps.items()
    }
    tables.write_table(output, schemas.CRISPNESS, plane_scatter.scatter_columns(measured))
    told = ", ".join(f"{name} {1000 * places.median_m:.1f} mm" for name, places in measured.items())
    log.log_line(
        f"measure_crispness: walls are thick by {told} (median of the places with scans on each other)"
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
