"""Extract the wall segments that each scan shows (thesis, sections 3.4 and 5.3)."""

from scanplan.extraction import survey_walls
from scanplan.stage import log, per_scan
from scanplan.types import FilePath, Settings


def extract_walls(
    scans: FilePath,
    registration: FilePath,
    output: FilePath,
    *,
    extractor: str,
    settings: Settings,
    code: str = "",
    threads: int = 1,
    chunk: str | None = None,
) -> None:
    """Write the walls of every registered scan.

    Parameters
    ----------
    scans, registration : path-like
        scans.parquet and registration.parquet.
    output : path-like
        walls/<extractor>.parquet, to write.
    extractor, settings, code, threads
        See `survey_walls.write_survey_walls`.
    chunk : str, optional
        Which scans, see `per_scan.read_chunk_ids`; all by default.
    """
    survey_walls.write_survey_walls(
        scans,
        registration,
        output,
        stage="extract_walls",
        extractor=extractor,
        settings=settings,
        scan_ids=None if chunk is None else per_scan.read_chunk_ids(scans, chunk),
        code=code,
        threads=threads,
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        extract_walls(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.output.walls,
            extractor=snakemake.wildcards.extractor,
            settings=snakemake.params.settings,
            code=snakemake.params.code,
            threads=snakemake.threads,
            chunk=snakemake.wildcards.get("chunk"),
        )
