"""Plan from where a second visit would settle what the plan leaves unseen or doubtful."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from scanplan.exports import visit_geojson
from scanplan.exports.model_origin import find_site
from scanplan.plan import floorplan_files
from scanplan.plan.survey_scale import find_factor
from scanplan.rays.tolerances import FEW
from scanplan.selection import stopping
from scanplan.stage import log
from scanplan.store import atomic, registered_scans, schemas, tables
from scanplan.types import FilePath, Settings
from scanplan.visit import next_visit, sensor_reach


def plan_next_visit(
    inputs: Mapping[str, FilePath],
    outputs: Mapping[str, FilePath],
    *,
    name: str,
    settings: Settings,
    site: Settings | None = None,
    **stop: Any,
) -> None:
    """Write what of a plan a second visit is to settle, and the standpoints from which it does.

    Parameters
    ----------
    inputs : dict of str to path-like
        `faces`, `walls`, `openings`, `rooms`, `free` and `confidence` of plan/; `selection`,
        `scans` and `registration`: selection/<method>.parquet, scans.parquet and
        registration.parquet.
    outputs : dict of str to path-like
        `questions`, `standpoints` and `geojson`, to write.
    name : str
        The dataset's.
    settings : dict
        Keywords of `next_visit.VisitSettings`.
    site : dict, optional
        Where the map lies, as `model_origin.find_site` takes it; reference points come first.
    **stop
        How many scans make the plan, see `stopping.choose_n_scans`.
    """
    selection, registration = inputs["selection"], inputs["registration"]
    drawn = floorplan_files.read_floorplan(inputs, name)
    registered = registered_scans.read_registered_scans(registration)
    chosen_ids, _ = stopping.read_chosen_scans(selection, **stop)
    # what one scan does not show of the sensor's field, others do; the first are of most places
    shown_ids = np.sort(chosen_ids[: FEW * FEW])
    rows = registered_scans.rows_of_scans(shown_ids, registered, selection, registration)
    poses = registered.map_from_sensor
    points = (xyz_m for _, xyz_m in tables.ScanStore(inputs["scans"]).scans(shown_ids))
    reach = sensor_reach.measure_reach(zip(points, poses[rows], strict=True), drawn.floor_z_m)
    limits = next_visit.VisitSettings(**settings)
    visit = next_visit.plan_visit(drawn, poses[:, :2, 3], reach, limits)
    words = next_visit.summarise_visit(visit)
    notes = {"summary": words}
    tables.write_table(
        outputs["questions"], schemas.QUESTIONS, visit.questions, allow_empty=True, notes=notes
    )
    tables.write_table(
        outputs["standpoints"], schemas.STANDPOINTS, visit.standpoints, allow_empty=True
    )
    placed = find_site(drawn.georeference, site or {})
    factor = find_factor(drawn.scale)
    collection = visit_geojson.format_visit(name, visit, words, placed, factor)
    atomic.write_text(outputs["geojson"], collection)
    log.log_line(f"plan_next_visit: {words}")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        plan_next_visit(
            dict(snakemake.input.items()),
            dict(snakemake.output.items()),
            name=snakemake.wildcards.dataset,
            settings=snakemake.params.settings,
            site=snakemake.params.site,
            **snakemake.params.stop,
        )
