"""Measure where every registered scan was put against where it truly was."""

import numpy as np

from scanplan.lab.evaluation import pose_errors, truth_file
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import Array, FilePath, FloatArray


def evaluate_poses(
    poses: FilePath, registration: FilePath, true_poses: FilePath, output: FilePath
) -> None:
    """Write the errors of the kept scans, before refinement and after it.

    They are measured as the scans are, and after the rigid motion that fits all of them best.

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
    prior = registered_scans.read_prior_poses(poses, scans, registration)
    columns: dict[str, Array] = {"scan_id": scans.scan_ids, "t_ns": scans.t_ns}
    for stage, estimate in (("prior", prior), ("refined", scans.map_from_sensor)):
        motion = pose_errors.fit_alignment(estimate[:, :3, 3], truth[:, :3, 3])
        for name, placed in ((stage, estimate), (f"aligned_{stage}", motion @ estimate)):
            distance_m, angle_deg = pose_errors.pose_errors(placed, truth)
            columns[f"{name}_error_m"] = distance_m
            columns[f"{name}_error_deg"] = angle_deg
            errors = _summarise_errors(distance_m, angle_deg)
            log.log_line(f"evaluate_poses: {len(placed)} scans, {name}: {errors}")
    tables.write_table(output, schemas.POSE_ERRORS, columns)


def _summarise_errors(distance_m: FloatArray, angle_deg: FloatArray) -> str:
    middle_m, high_m = np.percentile(distance_m, (50, 95))
    middle_deg, high_deg = np.percentile(angle_deg, (50, 95))
    rms_m = np.sqrt(np.mean(distance_m**2))
    return (
        f"median {middle_m:.3f} m, rms {rms_m:.3f} m, 95 % below {high_m:.3f} m,"
        f" largest {distance_m.max():.3f} m; median {middle_deg:.2f} deg,"
        f" 95 % below {high_deg:.2f} deg, largest {angle_deg.max():.2f} deg"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        evaluate_poses(
            snakemake.input.poses,
            snakemake.input.registration,
            snakemake.input.true_poses,
            snakemake.output.poses,
        )
