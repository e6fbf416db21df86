"""Which helper files a stage's script imports, so that an edit of one reruns exactly its stages."""

import ast
import hashlib
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

from scanplan.plain_types import FilePath

_PACKAGE = Path(__file__).parents[1]


def list_helpers(script: FilePath) -> list[Path]:
    """Return the files of this package that a script imports, directly or through one another.

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


def digest_code() -> str:
    """Return 12 hexadecimal digits that name the code: a digest of all scripts and helpers."""
    return _digest_files(sorted(_PACKAGE.parent.rglob("*.py")))


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
    # a workflow asks for the helpers of every script when it starts, and most are shared
    helpers = set()
    for node in _walk(ast.parse(_read(path))):
        if not isinstance(node, ast.ImportFrom) or node.module is None:
            continue
        parts = node.module.split(".")
        if parts[0] == _PACKAGE.name:
            place = _PACKAGE.parent.joinpath(*parts)
            helpers.add(place.with_suffix(".py"))
            helpers.update(place / f"{alias.name}.py" for alias in node.names)
    return frozenset(filter(Path.exists, helpers))


def _walk(tree: ast.AST) -> Iterator[ast.AST]:
    """Iterate over all nodes of a tree but those that are there for type checkers alone."""
    waiting = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        is_for_types = isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        if not is_for_types:
            waiting.extend(ast.iter_child_nodes(node))
