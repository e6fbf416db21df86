"""Extract the wall segments of the scans that make the plan, as far as they are not known."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from scanplan.extraction import survey_walls
from scanplan.selection import stopping
from scanplan.stage import log
from scanplan.types import FilePath, Settings


def extract_chosen_walls(
    scans: FilePath,
    registration: FilePath,
    selection: FilePath,
    output: FilePath,
    *,
    extractor: str,
    settings: Settings,
    stop: Mapping[str, Any],
    walls: FilePath | None = None,
    code: str = "",
    threads: int = 1,
) -> None:
    """Write the walls of the first scans of an ordering.

    What an earlier run has extracted of the same points, by the same code and settings, is taken
    from there: from `output` itself, of fewer chosen scans, and from the table of all scans.

    Parameters
    ----------
    scans, registration, selection : path-like
        scans.parquet, registration.parquet and selection/<method>.parquet.
    output : path-like
        plan/segments.parquet, to write.
    stop : dict
        How many scans are chosen, see `stopping.choose_n_scans`.
    walls : path-like, optional
        walls/<extractor>.parquet, where there is one.
    extractor, settings, code, threads
        See `survey_walls.write_survey_walls`.
    """
    chosen_ids, _ = stopping.read_chosen_scans(selection, **stop)
    survey_walls.write_survey_walls(
        scans,
        registration,
        output,
        stage="extract_chosen_walls",
        extractor=extractor,
        settings=settings,
        scan_ids=np.sort(chosen_ids),
        known=[output] if walls is None else [output, walls],
        code=code,
        threads=threads,
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        extract_chosen_walls(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.input.selection,
            snakemake.output.segments,
            extractor=snakemake.params.extractor,
            settings=snakemake.params.settings,
            stop=snakemake.params.stop,
            walls=snakemake.params.walls,
            code=snakemake.params.extraction_code,
            threads=snakemake.threads,
        )
