"""Write a copy of the later survey's building model that says what changed."""

from scanplan.exports.changes import annotated_ifc, model_facts
from scanplan.stage import log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath


def annotate_changes(
    changes: FilePath,
    ids: FilePath,
    model: FilePath,
    annotated: FilePath,
    earlier: FilePath | None = None,
) -> None:
    """Write changes.ifc.

    Parameters
    ----------
    changes : path-like
        changes.parquet.
    ids, model : path-like
        ids.parquet and plan.ifc of the later survey's plan.
    annotated : path-like
        File to write.
    earlier : path-like, optional
        ids.parquet of the earlier survey: what was there before bears the ids that it had.

    Raises
    ------
    StageError
        If a file is damaged.
    """
    columns = tables.read_table(changes, schemas.CHANGES, allow_empty=True)
    known = tables.read_table(ids, schemas.ELEMENT_IDS, allow_empty=True)
    facts = model_facts.gather_changes(columns, known)
    carried: dict[str, str] = {}
    if earlier is not None:
        before = tables.read_table(earlier, schemas.ELEMENT_IDS, allow_empty=True)
        carried = model_facts.carry_ids(columns, before, known)
    stated = {guid: {**of, "id_in_plan": guid} for guid, of in facts.items()}
    text = annotated_ifc.annotate_model(model, "Scanplan_Changes", stated, carried)
    atomic.write_text(annotated, text)
    log.log_line(
        f"annotate_changes: {len(facts)} elements say what became of them, {len(carried)} bear the"
        " ids that they had"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        annotate_changes(
            snakemake.input.table,
            snakemake.input.ids,
            snakemake.input.model,
            snakemake.output.annotated,
            snakemake.input.get("earlier") or None,
        )
