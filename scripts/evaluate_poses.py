"""Measure where every registered scan was put against where it truly was, before and after refinement."""

import numpy as np

from scanplan.lab.evaluation import pose_errors, truth_file
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables


def evaluate_poses(poses, registration, true_poses, output):
    """Write the errors of the kept scans: as they are, and after the rigid motion that fits all of them best.

    Parameters
    ----------
    poses, registration, true_poses : path-like
        poses.parquet (the localiser's), registration.parquet (refined) and truth_poses.tum.
    output : path-like
        evaluation/poses.parquet, to write.
    """
    scans = registered_scans.read_registered_scans(registration)
    truth = truth_file.interpolate_true_poses(
        truth_file.read_true_poses(true_poses), scans.t_ns, true_poses
    )
    columns = {"scan_id": scans.scan_ids, "t_ns": scans.t_ns}
    for stage, estimate in (
        ("prior", registered_scans.read_prior_poses(poses, scans, registration)),
        ("refined", scans.map_from_sensor),
    ):
        motion = pose_errors.fit_alignment(estimate[:, :3, 3], truth[:, :3, 3])
        for prefix, placed in (("", estimate), ("aligned_", motion @ estimate)):
            distance_m, angle_deg = pose_errors.pose_errors(placed, truth)
            columns[f"{prefix}{stage}_error_m"], columns[f"{prefix}{stage}_error_deg"] = (
                distance_m,
                angle_deg,
            )
            log.log_line(
                f"evaluate_poses: {len(placed)} scans, {prefix}{stage}: {_told(distance_m, angle_deg)}"
            )
    tables.write_table(output, schemas.POSE_ERRORS, columns)


def _told(distance_m, angle_deg):
    (middle_m, high_m), (middle_deg, high_deg) = (
        np.percentile(e, (50, 95)) for e in (distance_m, angle_deg)
    )
    rms_m = np.sqrt(np.mean(distance_m**2))
    return (
        f"median {middle_m:.3f} m, rms {rms_m:.3f} m, 95 % below {high_m:.3f} m, largest {distance_m.max():.3f} m;"
        f" median {middle_deg:.2f} deg, 95 % below {high_deg:.2f} deg, largest {angle_deg.max():.2f} deg"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        evaluate_poses(
            snakemake.input.poses,
            snakemake.input.registration,
            snakemake.input.true_poses,
            snakemake.output.poses,
        )
