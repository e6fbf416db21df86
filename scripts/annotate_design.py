"""Write a copy of a design that says how it was built, and topics for what differs."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from scanplan.exports.changes import annotated_ifc, model_facts
from scanplan.exports.data import model_topics
from scanplan.exports.sheet.locale import make_locale
from scanplan.recordings.clocks import end_of_survey_ns
from scanplan.stage import log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath


def annotate_design(
    deviations: FilePath,
    design: FilePath,
    evidence: FilePath,
    model: FilePath,
    topics: FilePath,
    words: Mapping[str, Any] | None = None,
) -> None:
    """Write as_built.ifc and deviations.bcf.

    Parameters
    ----------
    deviations : path-like
        deviations.parquet.
    design : path-like
        The .ifc file that it was made of.
    evidence : path-like
        evidence.parquet of plan/: when the survey was.
    model, topics : path-like
        Files to write.
    words : dict, optional
        Of the receiver's language, see `words_file.read_words`; English if not given.

    Raises
    ------
    StageError
        If a file is damaged.
    """
    columns = tables.read_table(deviations, schemas.DEVIATIONS, allow_empty=True)
    floor_m = float(json.loads(tables.read_note(deviations, schemas.DEVIATIONS, "floor_m")))
    stamps = tables.read_table(evidence, schemas.EVIDENCE, allow_empty=True)["t_ns"]
    facts = model_facts.gather_deviations(columns)
    found = model_facts.list_topics(columns, floor_m, make_locale("m", words))
    name = Path(design).stem
    atomic.write_text(model, annotated_ifc.annotate_model(design, "Scanplan_AsBuilt", facts))
    atomic.write_bytes(topics, model_topics.format_topics(name, found, end_of_survey_ns(stamps)))
    log.log_line(
        f"annotate_design: {len(facts)} elements with properties, {len(found)} topics of what"
        " differs"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        annotate_design(
            snakemake.input.table,
            snakemake.input.design,
            snakemake.input.evidence,
            snakemake.output.model,
            snakemake.output.topics,
            snakemake.params.words,
        )
