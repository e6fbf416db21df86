"""Drive a rover through a drawn building and record what its sensors would."""

from pathlib import Path

from scanplan.lab.buildings.truth import format_features
from scanplan.lab.simulation import scan_messages, survey_bag, survey_messages, survey_setup, sweeps
from scanplan.stage import log
from scanplan.store import atomic
from scanplan.store.tum import format_tum
from scanplan.types import FilePath, Settings


def simulate_survey(
    building: FilePath,
    recording: FilePath,
    truth: FilePath,
    true_poses: FilePath,
    true_trajectory: FilePath,
    *,
    seed: int,
    odometry: Settings,
    localiser: Settings,
    start_ns: int = survey_bag.EPOCH_NS,
    threads: int = 1,
    **scene: Settings,
) -> None:
    """Write a drive's recording (.bag, .db3 or .mcap), the floor's truth, and the true poses.

    The poses at the scans' stamps, and those of the whole way; the drive begins at `start_ns`.

    Parameters
    ----------
    odometry, localiser : dict
        Settings of `survey_setup.survey_belief`.
    **scene
        `site`, `mount`, `sensor`, `errors`, `drive` and `people`: those of
        `survey_setup.prepare_site` and `survey_setup.prepare_survey`.
    """
    data = Path(building).read_bytes()
    planar = scene["sensor"]["model"] == "laser"
    place = survey_setup.prepare_site(data, Path(building), scene, seed=seed, planar=planar)
    for note in place.notes:
        log.log_line(f"simulate_survey: {note}")
    survey = survey_setup.prepare_survey(place, scene, seed=seed)
    errors_of_poses = {key: value for key, value in localiser.items() if key != "present"}
    belief = survey_setup.survey_belief(
        survey, odometry, sway_known=scene["drive"]["sway_known"], **errors_of_poses
    )
    scans = log.report_progress(
        sweeps.simulate_scans(survey, threads=threads), "simulate_survey", total=len(survey.t_ns)
    )
    survey_bag.write_survey_bag(
        recording,
        survey_messages.encode_mounting(
            start_ns + belief.t_ns[0],
            survey.base_from_sensor,
            scan_messages.sensor_frame(survey.sensor),
        ),
        scan_messages.encode_scans(start_ns + survey.t_ns, survey.sensor, scans),
        *survey_messages.encode_belief(start_ns, belief, localised=localiser["present"]),
    )
    features, view = survey_setup.survey_truth(place, survey)
    atomic.write_text(truth, format_features(features, sensor=view))
    t_ns, poses = survey_setup.true_poses(survey)
    atomic.write_text(true_poses, format_tum(start_ns + t_ns, poses))
    t_ns, poses = survey_setup.true_trajectory(survey)
    atomic.write_text(true_trajectory, format_tum(start_ns + t_ns, poses))


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        simulate_survey(
            snakemake.input.building,
            snakemake.output.recording,
            snakemake.output.truth,
            snakemake.output.true_poses,
            snakemake.output.true_trajectory,
            **snakemake.params.settings,
            threads=snakemake.threads,
        )
