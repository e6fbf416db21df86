"""The house in figures: size, constants, settings, names and types, counted from a checkout's text.

Usage: house_figures.py [--types] [CHECKOUT ...]

Prints one column for each checkout (this one if none is given), so that two commits can be
compared; `--types` also runs basedpyright on each, which takes a minute or two. Nothing of a
checkout is imported or run.
"""

import ast
import json
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TypeGuard

import yaml

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = "scanplan"
MAX_COLUMNS = 100  # what ruff wraps at

Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class Figures:
    """What is counted of a checkout; every field is a row of the table."""

    files: int
    lines: int
    functions: int
    longest_function: int
    numeric_constants: int
    constants_with_reason: float
    visible_keys: int
    largest_package: int
    public_functions: int
    public_annotated: float
    lines_over_100: int
    duplicate_names: int
    type_errors: int | None = None


MEANINGS = {
    "files": "Python files below scripts/",
    "lines": "their lines",
    "functions": "functions and methods",
    "longest_function": "lines of the longest function",
    "numeric_constants": "module-level names bound to numbers",
    "constants_with_reason": "share of these with a comment beside them",
    "visible_keys": "keys with a value in config/config.yaml",
    "largest_package": "modules of the largest package",
    "public_functions": "public functions and methods",
    "public_annotated": "share of these fully annotated",
    "lines_over_100": f"lines over {MAX_COLUMNS} columns",
    "duplicate_names": "public functions named as one of another module",
    "type_errors": "errors of basedpyright",
}


@dataclass(frozen=True)
class Module:
    """A parsed file.

    Attributes
    ----------
    path : Path
        Relative to the folder that was read.
    lines : list of str
    tree : ast.Module
    """

    path: Path
    lines: list[str]
    tree: ast.Module


def read_modules(folder: Path) -> list[Module]:
    """Return the Python files below a folder, parsed, sorted by their paths."""
    modules = []
    for path in sorted(folder.rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        modules.append(Module(path.relative_to(folder), text.splitlines(), ast.parse(text)))
    return modules


def count_house(checkout: Path, *, types: bool = False) -> Figures:
    """Return the figures of a checkout; its basedpyright errors only where asked for."""
    modules = read_modules(checkout / "scripts")
    constants = [
        has_reason(module, statement)
        for module in modules
        for statement, count in find_numeric_constants(module)
        for _ in range(count)
    ]
    functions = [node for m in modules for node in ast.walk(m.tree) if isinstance(node, Function)]
    public = [node for m in modules for node in find_public_functions(m)]
    return Figures(
        files=len(modules),
        lines=sum(len(module.lines) for module in modules),
        functions=len(functions),
        longest_function=max(map(count_lines, functions)),
        numeric_constants=len(constants),
        constants_with_reason=sum(constants) / len(constants),
        visible_keys=count_keys(checkout / "config/config.yaml"),
        largest_package=max(count_package_modules(modules).values()),
        public_functions=len(public),
        public_annotated=sum(map(is_annotated, public)) / len(public),
        lines_over_100=len(find_long_lines(modules)),
        duplicate_names=len(find_duplicate_names(modules)),
        type_errors=count_type_errors(checkout) if types else None,
    )


def find_numeric_constants(module: Module) -> Iterator[tuple[ast.stmt, int]]:
    """Yield the statements of a module that bind names to numbers, and the number of names."""
    for statement in module.tree.body:
        if isinstance(statement, ast.Assign):
            count = _numeric_names(statement.targets[0], statement.value)
        elif isinstance(statement, ast.AnnAssign) and statement.value is not None:
            count = _numeric_names(statement.target, statement.value)
        else:
            continue
        if count:
            yield statement, count


def _numeric_names(target: ast.expr, value: ast.expr) -> int:
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        return sum(map(_numeric_names, target.elts, value.elts))
    return int(is_numeric(value))


def is_numeric(value: ast.expr) -> bool:
    """Return whether an expression is a number, arithmetic with one, or a collection of numbers."""
    match value:
        case ast.Constant(value=number):
            return type(number) in (int, float)
        case ast.UnaryOp(operand=operand):
            return is_numeric(operand)
        case ast.BinOp(left=left, right=right):
            return is_numeric(left) or is_numeric(right)
        case ast.Tuple(elts=parts) | ast.List(elts=parts) | ast.Set(elts=parts):
            return bool(parts) and all(map(is_numeric, parts))
        case ast.Dict(values=parts):
            return bool(parts) and all(map(is_numeric, parts))
        case ast.Call(func=ast.Attribute(), args=parts):
            # np.deg2rad(5) and its like
            return bool(parts) and all(map(is_numeric, parts))
    return False


def has_reason(module: Module, statement: ast.stmt) -> bool:
    """Return whether a comment stands beside or above a statement, or its own text below it."""
    first, last = statement.lineno - 1, statement.end_lineno or statement.lineno
    above, below = module.lines[max(first - 1, 0)], "".join(module.lines[last : last + 1])
    beside = any(" # " in line for line in module.lines[first:last])
    return beside or above.startswith("#") or below.startswith('"""')


def count_keys(config: Path) -> int:
    """Return the number of keys of a YAML file that have a value rather than keys of their own."""
    return _leaves(yaml.safe_load(config.read_text(encoding="utf-8")))


def _leaves(value: object) -> int:
    return sum(map(_leaves, value.values())) if isinstance(value, dict) and value else 1


def count_package_modules(modules: list[Module]) -> Counter[str]:
    """Return how many modules lie in each folder of the package itself, `__init__` left out."""
    paths = [module.path for module in modules if module.path.parts[0] == PACKAGE]
    return Counter(str(path.parent) for path in paths if path.stem != "__init__")


def find_public_functions(module: Module) -> Iterator[Function]:
    """Yield the functions and the methods of a module whose names have no leading underscore."""
    for node in module.tree.body:
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            yield from (method for method in node.body if _is_public_function(method))
        elif _is_public_function(node):
            yield node


def _is_public_function(node: ast.stmt) -> TypeGuard[Function]:
    return isinstance(node, Function) and not node.name.startswith("_")


def is_annotated(function: Function) -> bool:
    """Return whether every parameter of a function, and what it returns, has a type."""
    arguments = function.args
    named = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
    gathered = [part for part in (arguments.vararg, arguments.kwarg) if part]
    own = [part for part in (*named, *gathered) if part.arg not in ("self", "cls")]
    return function.returns is not None and all(part.annotation for part in own)


def count_lines(function: Function) -> int:
    """Return a function's lines without its docstring."""
    total = (function.end_lineno or function.lineno) - function.lineno + 1
    first = function.body[0]
    documented = ast.get_docstring(function, clean=False) is not None
    return total - ((first.end_lineno or 0) - first.lineno + 1 if documented else 0)


def find_long_lines(modules: list[Module]) -> list[str]:
    """Return `file:line` of every line over `MAX_COLUMNS`."""
    return [
        f"{module.path}:{number}"
        for module in modules
        for number, line in enumerate(module.lines, 1)
        if len(line) > MAX_COLUMNS
    ]


def find_duplicate_names(modules: list[Module]) -> list[str]:
    """Return `name (file)` of every public function whose name another module uses, too."""
    named = [
        (node.name, module.path)
        for module in modules
        if module.path.parts[0] == PACKAGE
        for node in module.tree.body
        if isinstance(node, Function) and not node.name.startswith("_")
    ]
    uses = Counter(name for name, _ in named)
    return sorted(f"{name} ({path.stem})" for name, path in named if uses[name] > 1)


def find_unannotated(modules: list[Module]) -> list[str]:
    """Return `file:line name` of every public function without types."""
    return [
        f"{module.path}:{node.lineno} {node.name}"
        for module in modules
        for node in find_public_functions(module)
        if not is_annotated(node)
    ]


def count_type_errors(checkout: Path) -> int:
    """Return how many errors basedpyright finds with this project's own settings."""
    settings = {
        "include": [str(checkout / "scripts")],
        "extraPaths": [str(checkout / "scripts")],
        "pythonVersion": "3.11",
        "typeCheckingMode": "standard",
        "reportUndefinedVariable": False,
        "reportMissingTypeStubs": False,
    }
    with tempfile.TemporaryDirectory() as folder:
        config = Path(folder, "pyrightconfig.json")
        config.write_text(json.dumps(settings))
        checker = Path(sys.executable).with_name("basedpyright")
        command = [str(checker), "--outputjson", "--pythonpath", sys.executable, "-p", str(config)]
        said = subprocess.run(command, capture_output=True, text=True, check=False)
    return json.loads(said.stdout)["summary"]["errorCount"]


def format_figures(columns: dict[str, Figures]) -> str:
    """Return the table of several checkouts' figures, one column each."""
    width = max(map(len, MEANINGS.values()))
    rows = [f"{'':{width}}" + "".join(f"{name:>12}" for name in columns)]
    for field in fields(Figures):
        values = [getattr(figures, field.name) for figures in columns.values()]
        if any(value is not None for value in values):
            cells = "".join(f"{_cell(value):>12}" for value in values)
            rows.append(f"{MEANINGS[field.name]:{width}}{cells}")
    return "\n".join(rows)


def _cell(value: float | None) -> str:
    if value is None:
        return "-"
    return f"{value:.1%}" if isinstance(value, float) else f"{value:,}"


if __name__ == "__main__":
    wanted = [word for word in sys.argv[1:] if word != "--types"]
    checkouts = [Path(word).resolve() for word in wanted] or [ROOT]
    counted = {path.name: count_house(path, types="--types" in sys.argv) for path in checkouts}
    print(format_figures(counted))
