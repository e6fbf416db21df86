import numpy as np

from scanplan.store import schemas, tables
from thesis import thesis_schemas
from thesis.stages.tabulate_seconds import tabulate_seconds


def test_order_and_share_of_the_extraction_add_up(tmp_path):
    names = [("hull", "one"), ("hull", "two"), ("oracle", "one")]
    rows = [
        {**dict.fromkeys(schemas.EVALUATION.columns, 0), "method": m, "extractor": e, "k": k}
        for m, e in names
        for k in (1, 4)
    ]
    tables.write_table(
        tmp_path / "walls.parquet",
        schemas.EVALUATION,
        {c: [row[c] for row in rows] for c in rows[0]},
    )
    files = {}
    # of two, each chunk of the scans was a job
    for name, of_jobs in (("hull", [3.0]), ("one", [8.0]), ("two", [11.0, 5.0])):
        files[name] = [tmp_path / f"{name}_{number}.tsv" for number in range(len(of_jobs))]
        for file, seconds in zip(files[name], of_jobs, strict=True):
            file.write_text(f"s\th:m:s\n{seconds}\t-\n")
    ordering, extraction = {"hull": files.pop("hull")}, files
    tabulate_seconds(tmp_path / "walls.parquet", ordering, extraction, tmp_path / "seconds.parquet")
    found = tables.read_table(tmp_path / "seconds.parquet", thesis_schemas.SECONDS)
    assert list(zip(found["method"], found["extractor"], found["k"], strict=True)) == [
        ("hull", "one", 1), ("hull", "one", 4), ("hull", "two", 1), ("hull", "two", 4)
    ]  # fmt: skip
    np.testing.assert_allclose(found["seconds"], [3 + 2, 3 + 8, 3 + 4, 3 + 16])
