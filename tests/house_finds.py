"""What the house is counted by: modules, constants, keys and functions of a checkout's text."""

import ast
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeGuard

import yaml

from house_shapes import (
    MOST_PARAMETERS,
    Function,
    asserts_prose,
    count_parameters,
    find_chain,
    find_fractions,
    is_length_or_share,
    marks_interface,
    read_given,
)

PACKAGE = "scanplan"
PACKAGES = (PACKAGE, "thesis")
MAX_COLUMNS = 100  # what ruff wraps at
_MODEL = Path(PACKAGE, "plan/model")
"""What says in densities how likely a plan is: a number there is a prior."""
_PARAMETERS = re.compile(r"^Parameters\n-+\n(.*?)(?=\n\n\w+\n---|\Z)", re.DOTALL | re.MULTILINE)
_SILENT = re.compile(r"^(\S.*) : [^\n(<>{,]*$(?!\n )", re.MULTILINE)
"""A parameter with a class alone, which its annotation says: no shape, range or meaning."""


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


def read_texts(modules: list[Module]) -> dict[str, str]:
    """Return the texts of modules by their paths."""
    return {str(module.path): "\n".join(module.lines) + "\n" for module in modules}


def list_keys(checkout: Path) -> list[str]:
    """Return all keys of settings, those that have keys of their own left out, joined by dots."""
    schemas = sorted(checkout.glob("workflow/*/config.schema.yaml"))
    parsed = [yaml.safe_load(schema.read_text(encoding="utf-8")) for schema in schemas]
    return [key for schema in parsed for key in _keys_below(schema, "")]


def _keys_below(node: dict[str, Any], prefix: str) -> Iterator[str]:
    for key, below in node["properties"].items():
        name = f"{prefix}{key}"
        if "properties" in below:
            yield from _keys_below(below, f"{name}.")
        else:
            yield name


def find_lengths_and_shares(modules: list[Module]) -> list[str]:
    """Return `file:line name` of constants in metres or shares outside the model."""
    found = []
    for module in _leave_out_model(modules):
        for statement, _ in find_numeric_constants(module):
            place = f"{module.path}:{statement.lineno}"
            bound = filter(is_length_or_share, _list_targets(statement))
            found += [f"{place} {name}" for name in bound]
    return found


def _list_targets(statement: ast.stmt) -> list[str]:
    nodes = [node for node in ast.walk(statement) if isinstance(node, ast.Name)]
    return [node.id for node in nodes if isinstance(node.ctx, ast.Store)]


def list_fractions(modules: list[Module]) -> list[str]:
    """Return `file:line number` of the fractions that functions outside the model hold."""
    found = {
        (str(module.path), node.lineno, node.col_offset, node.value)
        for module in _leave_out_model(modules)
        for function in ast.walk(module.tree)
        if isinstance(function, Function)
        for node in find_fractions(function)
    }
    return [f"{path}:{row} {value}" for path, row, _, value in sorted(found, key=str)]


def _leave_out_model(modules: list[Module]) -> list[Module]:
    return [module for module in modules if not module.path.is_relative_to(_MODEL)]


def find_long_parameter_lists(modules: list[Module]) -> list[str]:
    """Return `file:line name (number)` of functions with more than `MOST_PARAMETERS`."""
    return [
        f"{module.path}:{node.lineno} {node.name} ({count_parameters(node)})"
        for module in modules
        for node in ast.walk(module.tree)
        if isinstance(node, Function) and count_parameters(node) > MOST_PARAMETERS
    ]


def find_prose_tests(modules: list[Module]) -> list[str]:
    """Return `file:line name` of tests that hold what is said word by word.

    Modules whose `pytestmark` says that wording is their subject are left out.
    """
    of_messages = [
        module
        for module in modules
        if not any(
            isinstance(statement, ast.Assign)
            and any(map(marks_interface, ast.walk(statement.value)))
            for statement in module.tree.body
        )
    ]
    return [
        f"{module.path}:{node.lineno} {node.name}"
        for module in of_messages
        for given in [read_given(module.tree)]
        for node in ast.walk(module.tree)
        if isinstance(node, Function) and node.name.startswith("test_")
        if asserts_prose(node, given)
    ]


def list_chains(modules: list[Module]) -> list[str]:
    """Return `file:line name (number): names` of every function's chain, the longest first."""
    functions = [(m, n) for m in modules for n in ast.walk(m.tree) if isinstance(n, Function)]
    chains = [(find_chain(node), module, node) for module, node in functions]
    chains.sort(key=lambda found: -len(found[0]))
    return [
        f"{module.path}:{node.lineno} {node.name} ({len(chain)}): {' > '.join(chain)}"
        for chain, module, node in chains
    ]


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


def count_package_lines(modules: list[Module]) -> dict[str, tuple[int, int]]:
    """Return files and lines of each package: the product's, the laboratory's, and stages."""
    counted: dict[str, tuple[int, int]] = {}
    for module in modules:
        package = _name_package(module.path)
        files, lines = counted.get(package, (0, 0))
        counted[package] = (files + 1, lines + len(module.lines))
    return counted


def _name_package(path: Path) -> str:
    top, *below = path.parts
    if not below:
        return "stages"
    return "/".join((top, below[0])) if top in PACKAGES and len(below) > 1 else top


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


def find_silent_parameters(modules: list[Module]) -> list[str]:
    """Return `file:line names` of parameters of which docstrings say no more than annotations."""
    return [
        f"{module.path}:{node.lineno} {names}"
        for module in modules
        for node in ast.walk(module.tree)
        if isinstance(node, Function | ast.ClassDef)
        for listed in _PARAMETERS.findall(ast.get_docstring(node) or "")
        for names in _SILENT.findall(listed)
    ]
