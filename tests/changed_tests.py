"""The files that `make quick` looks at: what changed since the branch left main, and its tests.

Usage: changed_tests.py tests     test files, one a line
       changed_tests.py python    changed files to check the types of

A changed helper has the tests that import it, directly or through the helpers of the tests, or else
those of the files that import it, and so on; a stage has the tests that import it, a test has
itself. Tests of whole runs are left to `make test`.
"""

import ast
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("scripts", "tests")
"""Where `import name` is looked for, as pyproject.toml has it for pytest."""

KINDS = ("unit", "stages", "thesis")
ALWAYS = "tests/unit/test_house.py"
SETTINGS = ("config/", "workflow/schemas/")
OF_SETTINGS = ("tests/unit/test_settings.py", "tests/unit/test_dataset.py")
BASES = ("main", "origin/main")
MOST_NEAREST = 12
"""Test files of what imports a changed file; that more use it is for `make test`."""


def list_changed(root: Path) -> list[str]:
    """Return the files changed since this branch left main, those not yet added included."""
    changed = _git(root, "diff", "--name-only", "--diff-filter=d", find_base(root))
    new = _git(root, "ls-files", "--others", "--exclude-standard")
    return sorted({*changed, *new})


def find_base(root: Path) -> str:
    """Return the commit where this branch left main; on main itself the last one published."""
    head = _git(root, "rev-parse", "HEAD")[0]
    for name in BASES:
        known = _git(root, "rev-parse", "--verify", "--quiet", name, check=False)
        base = _git(root, "merge-base", "HEAD", name) if known else [head]
        if base[0] != head:
            return base[0]
    return head


def _git(root: Path, *words: str, check: bool = True) -> list[str]:
    command = ["git", "-C", str(root), *words]
    said = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=check).stdout
    return said.splitlines()


def list_tests(changed: Iterable[str], root: Path) -> list[str]:
    """Return the test files, relative to the root, that belong to changed files."""
    changed = list(changed)
    tests = [path for kind in KINDS for path in root.glob(f"tests/{kind}/test_*.py")]
    names = {path: path.relative_to(root).as_posix() for path in tests}
    chosen = {ALWAYS} | (set(changed) & set(names.values()))
    if any(file.startswith(SETTINGS) for file in changed):
        chosen.update(OF_SETTINGS)
    used = {path: used_files(path, root) for path in tests}
    for file in changed:
        if file.endswith(".py"):
            chosen.update(names[path] for path in find_nearest(root / file, used, root))
    return sorted(name for name in chosen if (root / name).exists())


def find_nearest(file: Path, used: dict[Path, set[Path]], root: Path) -> set[Path]:
    """Return the tests that use a file, or else those of the nearest that import it."""
    reached, added = {file}, {file}
    while added:
        found = {test for test, files in used.items() if files & added}
        if found:
            return found if file in added or len(found) <= MOST_NEAREST else set()
        added = {path for path in root.glob("scripts/**/*.py") if _imports_any(path, added, root)}
        added -= reached
        reached |= added
    return set()


def _imports_any(path: Path, files: set[Path], root: Path) -> bool:
    names = {file.stem for file in files}
    text = path.read_text(encoding="utf-8")
    # to parse all files takes seconds
    return any(name in text for name in names) and bool(imported_files(path, root) & files)


def used_files(test: Path, root: Path) -> set[Path]:
    """Return the files that a test imports: directly, or through helpers of the tests."""
    found: set[Path] = set()
    waiting = [test]
    while waiting:
        for file in imported_files(waiting.pop(), root) - found:
            found.add(file)
            if file.is_relative_to(root / "tests"):
                waiting.append(file)
    return found


def imported_files(file: Path, root: Path) -> set[Path]:
    """Return the project's files that a file imports."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module)
            names.update(f"{node.module}.{alias.name}" for alias in node.names)
    places = [root / folder / name.replace(".", "/") for folder in FOLDERS for name in names]
    return {place.with_suffix(".py") for place in places if place.with_suffix(".py").exists()}


def list_typed(changed: Iterable[str]) -> list[str]:
    """Return the changed files whose types are checked."""
    return [file for file in changed if file.startswith("scripts/") and file.endswith(".py")]


if __name__ == "__main__":
    commands = {"tests": lambda files: list_tests(files, ROOT), "python": list_typed}
    print(*commands[sys.argv[1]](list_changed(ROOT)), sep="\n")
