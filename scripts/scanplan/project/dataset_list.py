"""A list of many datasets in a file: tab-separated, a line each, as sample sheets are.

Standard library only: this runs while the workflow is being parsed.
"""

import csv
import io
from collections.abc import Iterator
from pathlib import Path

from scanplan.errors import StageError
from scanplan.plain_types import FilePath
from scanplan.project import dataset_files, texts, user_file

SUFFIX = ".tsv"
_COLUMNS = ("name", "path")


def is_list(given: FilePath) -> bool:
    """Return whether what was given as a dataset is a file that lists datasets."""
    return Path(given).suffix == SUFFIX and not Path(given).is_dir()


def read_list(file: FilePath) -> list[tuple[str, str]]:
    """Read the datasets that a file lists.

    Parameters
    ----------
    file : path-like
        UTF-8, separated by tabs, the columns named in its first line: `path`, what else is given as
        a dataset, from the working directory; and, if wanted, `name`, which its results bear. Other
        columns are left alone.

    Returns
    -------
    list of (str, str)
        Name and path of each dataset, in the order of the file.

    Raises
    ------
    StageError
        If the file cannot be read, has no such columns or no line, or a line of it says too little.
    """
    return [(name, path) for name, path, _ in _read(file)]


def read_floors(file: FilePath) -> dict[str, str]:
    """Read which floor each dataset of a list is a survey of.

    Parameters
    ----------
    file : path-like
        As of `read_list`, with a column `floor` if wanted: surveys of one floor have the same word
        there, the earliest above.

    Returns
    -------
    dict of str to str
        By the name of a dataset; its own name where no floor is stated.

    Raises
    ------
    StageError
        As `read_list`.
    """
    return {name: floor or name for name, _, floor in _read(file)}


def _read(file: FilePath) -> list[tuple[str, str, str]]:
    text = user_file.read_text(file, "give a list with the columns name and path")
    try:
        rows = csv.DictReader(io.StringIO(text, newline=""), delimiter="\t")
        datasets = list(_read_rows(file, rows))
    except csv.Error as error:
        raise StageError(f"{file}: {error}; write a line `name<tab>path` for each") from None
    if not datasets:
        raise StageError(f"{file}: lists no dataset; write a line `name<tab>path` for each")
    return datasets


def _read_rows(file: FilePath, rows: csv.DictReader) -> Iterator[tuple[str, str, str]]:
    columns = rows.fieldnames or ()
    if "path" not in columns:
        named = ", ".join(columns) or "nothing"
        raise StageError(
            f"{file}: its first line names {named}; name the columns {' and '.join(_COLUMNS)},"
            " separated by tabs"
        )
    for column in (*_COLUMNS, "floor"):
        if (n_such := columns.count(column)) > 1:
            raise StageError(f"{file}: names the column {column} {n_such} times; keep one of them")
    for row in rows:
        place = f"{file}: line {rows.line_num}"
        path = (row["path"] or "").strip()
        if not path:
            raise StageError(f"{place}: has no path; write one, or drop the line")
        texts.check_path(path)
        name = (row.get("name") or "").strip()
        if name and dataset_files.dataset_name(name) != name:
            raise StageError(f"{place}: {name!r} names no results; use letters, digits, _ . -")
        floor = (row.get("floor") or "").strip()
        yield name or dataset_files.dataset_name(path), path, floor
