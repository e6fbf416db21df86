"""What is asked of a run on its command line: faults that Snakemake tells as a missing rule."""

import json
import shlex
from collections.abc import Collection, Iterable
from pathlib import PurePath

from scanplan.errors import StageError
from scanplan.plain_types import FilePath
from scanplan.project import dataset, dataset_files, texts


def check_targets(
    targets: Iterable[str],
    datasets: Collection[str],
    others: Collection[str],
    laboratory: FilePath | None = None,
) -> None:
    """Refuse targets that are settings or no paths, and results that this workflow does not make.

    Parameters
    ----------
    targets : iterable of str
        Rules and files.
    datasets : collection of str
        Names of the given ones.
    others : collection of str
        Names of all folders of results that rules make.
    laboratory : path-like, optional
        The workflow that makes what `asks_for_laboratory` finds, where this one is another.

    Raises
    ------
    StageError
        With what to write instead.
    """
    for target in map(str, targets):
        texts.check_path(target)
        key, is_setting, value = target.partition("=")
        if is_setting and "/" not in key:
            raise StageError(
                f"{target}: is a setting, not a target; write --config {_as_config(key, value)}"
            )
        if laboratory is not None and asks_for_laboratory([target]):
            raise StageError(f"{target}: is made by a workflow of its own; give `-s {laboratory}`")
        folder, *rest = PurePath(target).parts or ("",)
        if folder == "results" and len(rest) > 1 and rest[0] not in {*datasets, *others}:
            given = ", ".join(datasets)
            raise StageError(
                f"{target}: no dataset {rest[0]} is given, only {given}; add"
                " `--config dataset=PATH`, the folder or recording that these results are of"
            )


def asks_for_laboratory(words: Iterable[str]) -> bool:
    """Return whether a command asks for what the laboratory's workflow alone makes.

    Parameters
    ----------
    words : iterable of str
        Of the command. The value of an option may look like a target: no harm, as that workflow
        makes all that the other does.
    """
    return any(map(_is_of_laboratory, words))


def _is_of_laboratory(word: str) -> bool:
    folder, *rest = PurePath(word).parts or ("",)
    if folder != "results" or len(rest) < 2:
        return word in dataset_files.OF_LABORATORY
    name, *file = rest
    is_compared = file[0] in dataset.COMPARED_FOLDERS or "/".join(file) in dataset.COMPARISON
    return name == dataset_files.RESERVED or is_compared


def _as_config(key: str, value: str) -> str:
    """Return a setting as `--config` takes it: sections are objects of JSON."""
    section, *keys = key.split(".")
    if not keys:
        return shlex.quote(f"{section}={value}")
    try:
        nested: object = json.loads(value)
    except ValueError:
        nested = value
    for name in reversed(keys):
        nested = {name: nested}
    return f"'{section}={json.dumps(nested)}'"
