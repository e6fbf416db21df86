"""Write the scans that make the plan as a recording of their own."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from scanplan.errors import StageError
from scanplan.exports import selected_bag
from scanplan.recordings.recorded_survey import BagSurvey
from scanplan.recordings.survey import Reading, open_survey
from scanplan.selection import stopping
from scanplan.stage import log
from scanplan.store import atomic, registered_scans
from scanplan.types import FilePath


def write_selected_bag(
    recordings: Sequence[str],
    selection: FilePath,
    registration: FilePath,
    output: FilePath,
    settings: FilePath,
    *,
    reading: Mapping[str, Any],
    **stop: Any,
) -> None:
    """Write the recording, and settings with which a plan is made of it.

    Parameters
    ----------
    recordings : list of str
        The dataset's files.
    selection, registration : path-like
        selection/<method>.parquet and registration.parquet.
    output : path-like
        selected.bag, .mcap or .db3, to write.
    settings : path-like
        selected.<suffix>.yaml, to write.
    reading : dict
        Keywords of `survey.open_survey`.
    **stop
        How many scans to use, see `stopping.choose_n_scans`.

    Raises
    ------
    StageError
        If the dataset is a folder of scans, which has no messages.
    """
    chosen_ids, _ = stopping.read_chosen_scans(selection, **stop)
    scan_ids = np.sort(chosen_ids)
    registered = registered_scans.read_registered_scans(registration)
    rows = registered_scans.rows_of_scans(scan_ids, registered, selection, registration)
    poses = registered.map_from_sensor[rows]
    with open_survey(recordings, Reading(**{**reading, "deskew": False})) as survey:
        if not isinstance(survey, BagSurvey):
            raise StageError(
                f"{output}: not written, as {Path(recordings[0]).parent} holds clouds in files and"
                f" no messages, or its scans are of several scanners or sweeps; copy the files of"
                f" the {len(scan_ids)} scans of {selection} instead, or ask for one scanner"
            )
        n_messages = selected_bag.copy_selected_scans(output, survey, scan_ids, poses)
        own_settings = selected_bag.reading_settings(survey, dict(reading))
    # JSON is YAML, too
    atomic.write_text(settings, json.dumps(own_settings, indent=2) + "\n")
    before = sum(Path(file).stat().st_size for file in recordings)
    log.log_line(
        f"write_selected_bag: {len(scan_ids)} scans, {n_messages:,} messages,"
        f" {Path(output).stat().st_size:,} of {before:,} bytes"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        write_selected_bag(
            snakemake.input.recordings,
            snakemake.input.selection,
            snakemake.input.registration,
            snakemake.output.recording,
            snakemake.output.settings,
            reading=snakemake.params.reading,
            **snakemake.params.stop,
        )
