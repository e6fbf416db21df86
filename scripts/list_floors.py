"""Write what every floor was like at each of its surveys, and what had changed since the last."""

from collections.abc import Mapping, Sequence

from scanplan.exports.data import element_tables
from scanplan.plan import floorplan_files
from scanplan.report import changes_page, floor_table
from scanplan.stage import log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath

_PLAN = ("faces", "walls", "openings", "rooms", "free", "furniture", "confidence")


def list_floors(
    surveys: Sequence[Mapping[str, str]],
    inputs: Sequence[Mapping[str, FilePath]],
    outputs: Mapping[str, FilePath],
    page: Mapping[str, str],
) -> None:
    """Write floors.csv and floors.html.

    Parameters
    ----------
    surveys : sequence of dict of str to str
        `floor`, `survey`, and `earlier`, the one before; empty of a floor's first.
    inputs : sequence of dict of str to path-like
        Of each: `faces`, `walls`, `openings`, `rooms`, `free`, `furniture`, `evidence` and
        `confidence` of plan/, and where there is an earlier one `changes`.
    outputs : dict of str to path-like
        `csv` and `page`, to write.
    page : dict of str to str
        The page's template and style, file name to text.

    Raises
    ------
    StageError
        If a file is damaged.
    """
    rows = []
    for of, files in zip(surveys, inputs, strict=True):
        plan = floorplan_files.read_floorplan({part: files[part] for part in _PLAN}, of["survey"])
        evidence = tables.read_table(files["evidence"], schemas.EVIDENCE, allow_empty=True)
        changes = None
        if of["earlier"]:
            changes = tables.read_table(files["changes"], schemas.CHANGES, allow_empty=True)
        rows.append(floor_table.describe_survey(of, plan, evidence, changes))
    columns = {name: [row[name] for row in rows] for name in rows[0]}
    atomic.write_text(outputs["csv"], element_tables.format_csv(columns))
    atomic.write_text(outputs["page"], floor_table.format_page(rows, page))
    n_floors = len({of["floor"] for of in surveys})
    log.log_line(f"list_floors: {n_floors} floors, {len(rows)} surveys")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        list_floors(
            snakemake.params.surveys,
            [
                {
                    name.partition("_")[2]: file
                    for name, file in snakemake.input.items()
                    if name.partition("_")[0] == f"s{row}"
                }
                for row in range(len(snakemake.params.surveys))
            ],
            dict(snakemake.output.items()),
            changes_page.read_sources(snakemake.input.page),
        )
