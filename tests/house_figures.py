"""The house in figures: size, constants, settings, names and types, counted from a checkout's text.

Usage: house_figures.py [--types] [--places] [CHECKOUT ...]

Prints one column for each checkout (this one if none is given), so that two commits can be
compared; `--types` also runs basedpyright on each, which takes a minute or two; `--places` says
below what is counted of the last: keys, numbers, chains, functions, repeated lines. Nothing of a
checkout is imported or run, and no figure has a limit.
"""

import ast
import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from house_finds import (
    MAX_COLUMNS,
    count_keys,
    count_lines,
    count_package_lines,
    find_duplicate_names,
    find_lengths_and_shares,
    find_long_lines,
    find_long_parameter_lists,
    find_numeric_constants,
    find_prose_tests,
    find_public_functions,
    has_reason,
    is_annotated,
    list_chains,
    list_fractions,
    list_keys,
    read_modules,
    read_texts,
)
from house_shapes import (
    MOST_PARAMETERS,
    PHRASE_WORDS,
    RUN_LINES,
    Function,
    find_chain,
    find_repeated,
)

ROOT = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class Figures:
    """What is counted of a checkout; every field is a row of the table."""

    files: int
    lines: int
    functions: int
    longest_function: int
    numeric_constants: int
    constants_with_reason: float
    keys: int
    visible_keys: int
    lengths_and_shares: int
    fractions: int
    longest_chain: int
    long_parameter_lists: int
    equal_lines: int
    alike_lines: int
    public_functions: int
    public_annotated: float
    lines_over_100: int
    duplicate_names: int
    prose_tests: int
    type_errors: int | None = None


MEANINGS = {
    "files": "Python files below scripts/",
    "lines": "their lines",
    "functions": "functions and methods",
    "longest_function": "lines of the longest function",
    "numeric_constants": "module-level names bound to numbers",
    "constants_with_reason": "share of these with a comment beside them",
    "keys": "keys of settings",
    "visible_keys": "keys with a value in config/config.yaml",
    "lengths_and_shares": "constants in metres or shares, the model's left out",
    "fractions": "fractions written into functions, the model's left out",
    "longest_chain": "calls of the longest chain in a function",
    "long_parameter_lists": f"functions with more than {MOST_PARAMETERS} parameters",
    "equal_lines": f"lines in runs of {RUN_LINES} that stand twice",
    "alike_lines": "the same where names, texts and numbers may differ",
    "public_functions": "public functions and methods",
    "public_annotated": "share of these fully annotated",
    "lines_over_100": f"lines over {MAX_COLUMNS} columns",
    "duplicate_names": "public functions named as one of another module",
    "prose_tests": f"tests of messages that hold {PHRASE_WORDS} words in a row or more",
    "type_errors": "errors of basedpyright",
}


def count_house(checkout: Path, *, types: bool = False) -> Figures:
    """Return the figures of a checkout; its basedpyright errors only where asked for."""
    modules = read_modules(checkout / "scripts")
    texts = read_texts(modules)
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
        keys=len(list_keys(checkout)),
        visible_keys=count_keys(checkout / "config/config.yaml"),
        lengths_and_shares=len(find_lengths_and_shares(modules)),
        fractions=len(list_fractions(modules)),
        longest_chain=max(len(find_chain(function)) for function in functions),
        long_parameter_lists=len(find_long_parameter_lists(modules)),
        equal_lines=sum(find_repeated(texts, by_shape=False).values()),
        alike_lines=sum(find_repeated(texts, by_shape=True).values()),
        public_functions=len(public),
        public_annotated=sum(map(is_annotated, public)) / len(public),
        lines_over_100=len(find_long_lines(modules)),
        duplicate_names=len(find_duplicate_names(modules)),
        prose_tests=len(find_prose_tests(read_modules(checkout / "tests"))),
        type_errors=count_type_errors(checkout) if types else None,
    )


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
    rows: dict[str, list[Any]] = {"": list(columns)}
    for field in fields(Figures):
        values = [getattr(figures, field.name) for figures in columns.values()]
        if any(value is not None for value in values):
            rows[MEANINGS[field.name]] = [_cell(value) for value in values]
    return _format_rows(rows)


def format_packages(columns: dict[str, dict[str, tuple[int, int]]]) -> str:
    """Return the table of several checkouts' packages: lines, and files in brackets."""
    rows: dict[str, list[Any]] = {"lines (files) of packages": list(columns)}
    for package in sorted({name for counted in columns.values() for name in counted}):
        pairs = [counted.get(package, (0, 0)) for counted in columns.values()]
        rows[package] = [f"{lines:,} ({files})" if files else "-" for files, lines in pairs]
    return _format_rows(rows)


def _format_rows(rows: dict[str, list[Any]]) -> str:
    width = max(map(len, rows))
    return "\n".join(
        f"{head:{width}}" + "".join(f"{cell:>14}" for cell in cells) for head, cells in rows.items()
    )


def format_places(checkout: Path) -> str:
    """Return what is counted of a checkout, a place a line, under what it is."""
    modules = read_modules(checkout / "scripts")
    repeated = find_repeated(read_texts(modules), by_shape=False)
    parts = {
        MEANINGS["keys"]: list_keys(checkout),
        MEANINGS["lengths_and_shares"]: find_lengths_and_shares(modules),
        MEANINGS["fractions"]: list_fractions(modules),
        MEANINGS["longest_chain"]: list_chains(modules)[:20],
        MEANINGS["long_parameter_lists"]: find_long_parameter_lists(modules),
        MEANINGS["prose_tests"]: find_prose_tests(read_modules(checkout / "tests")),
        MEANINGS["equal_lines"]: [f"{name} ({n})" for name, n in sorted(repeated.items())],
    }
    return "\n\n".join("\n  ".join([f"{head}:", *lines]) for head, lines in parts.items())


def _cell(value: float | None) -> str:
    if value is None:
        return "-"
    return f"{value:.1%}" if isinstance(value, float) else f"{value:,}"


if __name__ == "__main__":
    wanted = [word for word in sys.argv[1:] if not word.startswith("--")]
    checkouts = [Path(word).resolve() for word in wanted] or [ROOT]
    counted = {path.name: count_house(path, types="--types" in sys.argv) for path in checkouts}
    sizes = {path.name: count_package_lines(read_modules(path / "scripts")) for path in checkouts}
    print(format_figures(counted), format_packages(sizes), sep="\n\n")
    if "--places" in sys.argv:
        print("", format_places(checkouts[-1]), sep="\n")
