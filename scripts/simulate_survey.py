"""Drive a rover through a drawn building and record what its sensors would."""

from pathlib import Path

from scanplan import atomic, stagelog
from scanplan.simulation import scanmessages, surveybag, surveying, surveymessages, sweeps
from scanplan.simulation import truth as ground_truth


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
    found = surveying.site(Path(building).read_bytes(), Path(building), mount, seed=seed, **site)
    for note in found.notes:
        stagelog.say(f"simulate_survey: {note}")
    rig = {"mount": mount, "sensor": sensor, "errors": errors, "drive": drive, "people": people}
    survey = surveying.prepare(found, seed=seed, **rig)
    start_ns = surveybag.EPOCH_NS
    belief = surveying.belief(survey, **localiser)
    taken = sweeps.scans(survey, threads=threads)
    scans = stagelog.progress(taken, "simulate_survey", total=len(survey.t_ns))
    surveybag.write(
        recording,
        surveymessages.mounting(start_ns + belief.t_ns[0], survey.base_from_sensor, scanmessages.frame(survey.sensor)),
        scanmessages.scans(start_ns + survey.t_ns, survey.sensor, scans),
        *surveymessages.belief(start_ns, belief),
    )
    features, sensor = surveying.truth(found, survey)
    atomic.write_text(truth, ground_truth.feature_collection(features, sensor=sensor))
    for path, (t_ns, pose) in (
        (true_poses, surveying.true_poses(survey)),
        (true_trajectory, surveying.true_trajectory(survey)),
    ):
        atomic.write_text(path, ground_truth.tum(start_ns + t_ns, pose))


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        simulate_survey(
            snakemake.input.building,
            *(snakemake.output[name] for name in ("recording", "truth", "true_poses", "true_trajectory")),
            **snakemake.params.settings,
            threads=snakemake.threads,
        )
