"""Which helper files a stage's script imports, so that an edit of one reruns exactly the stages that use it."""

import ast
import hashlib
from functools import cache
from pathlib import Path

_PACKAGE = Path(__file__).parents[1]


def list_helpers(script):
    """Return the files of this package that a script imports, directly or through one another.

    Parameters
    ----------
    script : path-like
        A Python file that imports helpers as `from scanplan.topic import helper` or
        `from scanplan.topic.helper import ...`.

    Returns
    -------
    list of pathlib.Path, sorted
    """
    found, waiting = set(), [Path(script)]
    while waiting:
        for helper in _imports(waiting.pop()) - found:
            found.add(helper)
            waiting.append(helper)
    return sorted(found)


def digest_code():
    """Return 12 hexadecimal digits that name the code: a digest of all scripts and helpers."""
    total = hashlib.sha256()
    for file in sorted(_PACKAGE.parent.rglob("*.py")):
        total.update(file.read_bytes())
    return total.hexdigest()[:12]


@cache
def _imports(path):
    # a workflow asks for the helpers of every script when it starts, and most are shared
    found = set()
    for node in ast.walk(ast.parse(Path(path).read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == _PACKAGE.name:
            named = _PACKAGE.parent.joinpath(*node.module.split("."))
            found.update(
                [named.with_suffix(".py"), *(named / f"{alias.name}.py" for alias in node.names)]
            )
    return frozenset(filter(Path.exists, found))
