"""Files of settings: plain data, read without executing anything.

PyYAML reads YAML 1.1, as Snakemake itself does with a file for --configfile; by YAML 1.2, as
ruamel.yaml reads it, `yes`, `010` and `1:30` would mean something else here than to Snakemake.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from scanplan.errors import StageError
from scanplan.project import texts, user_file

if TYPE_CHECKING:
    from collections.abc import Sequence

    from scanplan.types import FilePath


_MOST_BYTES = 2**18
"""Four thousand corrections, or ten times all settings; PyYAML reads them in 1 to 3 s, every job
anew."""


_CONFIG = Path(__file__).resolve().parents[3] / "config"
_OCTAL = re.compile(r"[-+]?0[0-7_]+")


class _Loader(yaml.SafeLoader):
    """Plain data, every value written once.

    A duplicate key is refused, as its first values would be lost without a word; so are aliases and
    merge keys, as a few lines of them stand for more values than any memory holds.
    """

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        if self.check_event(yaml.AliasEvent):
            raise _fault("an alias stands for other values, write them out", self.peek_event())
        return super().compose_node(parent, index)

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        pairs = node.value if isinstance(node, yaml.MappingNode) else ()
        known = set()
        for key in (key for key, _ in pairs if isinstance(key, yaml.ScalarNode)):
            if key.tag == "tag:yaml.org,2002:merge":
                raise _fault("`<<` stands for other values, write them out", key)
            if key.value in known:
                raise _fault(f"duplicate key `{key.value}`, keep one of the two", key)
            known.add(key.value)
        return super().construct_mapping(node, deep)

    def construct_scalar(self, node: yaml.ScalarNode | yaml.MappingNode) -> Any:
        value = super().construct_scalar(node)
        if not isinstance(value, str) or value.isascii():
            return value
        try:
            return texts.join_pairs(value)
        except UnicodeDecodeError:
            raise _fault(f"`{value}` has half of a character, write both or none", node) from None

    def construct_object(self, node: yaml.Node, deep: bool = False) -> Any:
        if node.tag.endswith((":int", ":float")) and ":" in node.value:
            raise _fault(f"`{node.value}` would be read as minutes, to the base of 60", node)
        if node.tag.endswith(":int") and _OCTAL.fullmatch(node.value):
            raise _fault(f"`{node.value}` would be read to the base of 8, leave the 0 out", node)
        try:
            return super().construct_object(node, deep)
        except (ValueError, LookupError, AttributeError):
            # what looks like a date or is tagged as a number, and is none
            kind = node.tag.rpartition(":")[2]
            shown = node.value if len(node.value) < 80 else f"{node.value[:40]}..."
            raise _fault(f"`{shown}` is no {kind}", node) from None


def _fault(problem: str, place: Any) -> yaml.MarkedYAMLError:
    return yaml.MarkedYAMLError(problem=problem, problem_mark=place.start_mark)


def list_ours(folder: str) -> dict[str, Path]:
    """Return the files of a folder of `config`, by what a person names them, in order."""
    return {file.stem: file for file in sorted((_CONFIG / folder).glob("*.yaml"))}


def find_ours(key: str, name: str, folder: str, others: Sequence[str] = ()) -> Path:
    """Return the file of a folder of `config` that is named, or else the file of that name.

    Parameters
    ----------
    key : str
        Of the settings, that a person gave the name by.
    others : sequence of str
        Names that need no file.

    Raises
    ------
    StageError
        If there is neither.
    """
    ours = list_ours(folder)
    # a name too long for any file is none
    if name not in ours and not os.path.exists(name):  # noqa: PTH110
        known = ", ".join([*others, *ours])
        raise StageError(f"{key}: {name} does not exist; give one of {known}, or a file")
    return ours.get(name, Path(name))


def is_number(value: object, low: float, high: float) -> bool:
    """Return whether a value that was read is a number within finite limits, NaN not among them.

    An integer may be larger than any float; `True` is no number.
    """
    return isinstance(value, int | float) and not isinstance(value, bool) and low <= value <= high


def read_yaml(path: FilePath) -> dict[Any, Any]:
    """Read a YAML file of settings; plain data only, nothing in it is executed.

    Raises
    ------
    StageError
        If it is no YAML or no mapping, has a duplicate key, an alias or a merge key; see
        `user_file.read_text`.
    """
    text = user_file.read_text(path, "give a YAML file, in UTF-8", _MOST_BYTES)
    try:
        values = yaml.load(text, _Loader) or {}
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
        fault = f"{place}{error.problem or error.context}"
        raise StageError(f"{path}: is not valid YAML ({fault}); mend it") from None
    except RecursionError:
        raise StageError(f"{path}: is nested too deeply for settings; mend it") from None
    except yaml.YAMLError as error:
        raise StageError(f"{path}: is not valid YAML ({error}); write it as text") from None
    if not isinstance(values, dict):
        raise StageError(
            f"{path}: holds {type(values).__name__}, expected `section: {{key: value}}`"
        )
    return values
