"""Drive a rover through a drawn building and record what its sensors would."""

from pathlib import Path

from scanplan.lab.buildings.truth import format_features, format_tum
from scanplan.lab.simulation import scan_messages, survey_bag, survey_messages, survey_setup, sweeps
from scanplan.stage import log
from scanplan.store import atomic


def simulate_survey(
    building,
    recording,
    truth,
    true_poses,
    true_trajectory,
    *,
    seed,
    site,
    mount,
    sensor,
    errors,
    drive,
    localiser,
    people,
    threads=1,
):
    """Write a drive's recording (.bag, .db3 or .mcap), the floor's truth, the poses at the stamps and the whole way."""
    found = survey_setup.prepare_site(
        Path(building).read_bytes(), Path(building), mount, seed=seed, **site
    )
    for note in found.notes:
        log.log_line(f"simulate_survey: {note}")
    rig = {"mount": mount, "sensor": sensor, "errors": errors, "drive": drive, "people": people}
    survey = survey_setup.prepare_survey(found, seed=seed, **rig)
    start_ns = survey_bag.EPOCH_NS
    belief = survey_setup.survey_belief(survey, **localiser)
    taken = sweeps.simulate_scans(survey, threads=threads)
    scans = log.report_progress(taken, "simulate_survey", total=len(survey.t_ns))
    survey_bag.write_survey_bag(
        recording,
        survey_messages.encode_mounting(
            start_ns + belief.t_ns[0],
            survey.base_from_sensor,
            scan_messages.sensor_frame(survey.sensor),
        ),
        scan_messages.encode_scans(start_ns + survey.t_ns, survey.sensor, scans),
        *survey_messages.encode_belief(start_ns, belief),
    )
    features, sensor = survey_setup.survey_truth(found, survey)
    atomic.write_text(truth, format_features(features, sensor=sensor))
    for path, (t_ns, pose) in (
        (true_poses, survey_setup.true_poses(survey)),
        (true_trajectory, survey_setup.true_trajectory(survey)),
    ):
        atomic.write_text(path, format_tum(start_ns + t_ns, pose))


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        simulate_survey(
            snakemake.input.building,
            *(
                snakemake.output[name]
                for name in ("recording", "truth", "true_poses", "true_trajectory")
            ),
            **snakemake.params.settings,
            threads=snakemake.threads,
        )
