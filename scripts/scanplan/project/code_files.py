"""Which helper files a stage's script imports, so that an edit of one reruns exactly its stages."""

import hashlib
import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path

import scanplan
from scanplan.plain_types import FilePath

_PACKAGE = Path(__file__).parents[1]
_LABORATORY = "thesis"
_IMPORT = re.compile(
    rf"^[ \t]*from ((?:{_PACKAGE.name}|{_LABORATORY})[\w.]*) import (\([^)]*\)|.*)", re.MULTILINE
)
_NAME = re.compile(r"\w+")
_FOR_TYPES = re.compile(r"^if TYPE_CHECKING:\n(?:[ \t].*\n|\n)*", re.MULTILINE)


def list_helpers(script: FilePath) -> list[Path]:
    """Return the files of our packages that a script imports, directly or through one another.

    Parameters
    ----------
    script : path-like
        A Python file that imports helpers as `from scanplan.topic import helper` or
        `from scanplan.topic.helper import ...`. What it imports for types alone, under
        `if TYPE_CHECKING:`, is no helper: it cannot change a result.

    Returns
    -------
    list of pathlib.Path, sorted
    """
    helpers: set[Path] = set()
    waiting = [Path(script)]
    while waiting:
        for helper in _imports(waiting.pop()) - helpers:
            helpers.add(helper)
            waiting.append(helper)
    return sorted(helpers)


@cache
def digest_helpers(script: FilePath) -> str:
    """Return 12 hexadecimal digits that name what the helpers of a script say."""
    return _digest_files(list_helpers(script))


def state_version() -> str:
    """Return what results state of the software that made them: its release and its code."""
    return f"scanplan {scanplan.__version__}, code {digest_code()}"


def digest_code() -> str:
    """Return 12 hexadecimal digits that name the code of plans: a digest of scripts and helpers.

    The laboratory's are left out, as no plan is made by them.
    """
    laboratory = _PACKAGE.with_name(_LABORATORY)
    files = sorted(_PACKAGE.parent.rglob("*.py"))
    return _digest_files(file for file in files if not file.is_relative_to(laboratory))


def _digest_files(files: Iterable[Path]) -> str:
    total = hashlib.sha256()
    for file in files:
        total.update(_read(file).encode())
    return total.hexdigest()[:12]


@cache
def _read(file: Path) -> str:
    return file.read_text(encoding="utf-8")


@cache
def _imports(path: Path) -> frozenset[Path]:
    # whenever a workflow starts, of every script: syntax trees take seven times as long
    helpers = set()
    for module, names in _IMPORT.findall(_FOR_TYPES.sub("", _read(path))):
        place = _PACKAGE.parent.joinpath(*module.split("."))
        helpers.add(place.with_suffix(".py"))
        helpers.update(place / f"{name}.py" for name in _NAME.findall(names))
    return frozenset(filter(Path.exists, helpers))
