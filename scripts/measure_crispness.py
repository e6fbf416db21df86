"""Measure how thick the walls of the merged map are, by the localiser's poses and by the registered ones."""

import numpy as np

from scanplan import schemas, se3, stagelog, tables
from scanplan.evaluation import registered
from scanplan.registration import crispness


def measure_crispness(scans, registration, poses, output, *, radius_m, most_points, most_places, seed):
    """Write the crispness of the map of the kept scans.

    Parameters
    ----------
    scans, registration, poses : path-like
        scans.parquet, registration.parquet and poses.parquet.
    output : path-like
        crispness.parquet, to write.
    radius_m, most_points, most_places, seed
        See `crispness.measure`, `crispness.thin` and `crispness.places`.
    """
    store, kept = tables.ScanStore(scans), registered.read(registration)
    to_localiser = registered.prior(poses, kept, registration) @ se3.inverse(kept.map_from_sensor)
    found = stagelog.progress(store.scans(), "measure_crispness", total=len(store.scan_ids))
    xyz_m, scan_ids = crispness.thin(found, most_points=most_points, n_scans=len(store.scan_ids), seed=seed)
    motion = to_localiser[np.searchsorted(kept.scan_ids, scan_ids)]
    maps = {
        "localiser": np.einsum("nij,nj->ni", motion[:, :3, :3], xyz_m) + motion[:, :3, 3],
        "registered": xyz_m,
    }
    measured = {
        name: crispness.of_map(
            points_m, scan_ids, planar=store.planar, radius_m=radius_m, most_places=most_places, seed=seed
        )
        for name, points_m in maps.items()
    }
    tables.write(output, schemas.CRISPNESS, crispness.columns(measured))
    told = ", ".join(f"{name} {1000 * places.median_m:.1f} mm" for name, places in measured.items())
    stagelog.say(f"measure_crispness: walls are thick by {told} (median of the places with scans on each other)")


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        measure_crispness(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.input.poses,
            snakemake.output.crispness,
            **snakemake.params.settings,
        )
