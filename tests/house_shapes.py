"""What repeats, what is handed on and what is a number in the house, read from its syntax.

Nothing is judged here: `house_figures` prints what is counted.
"""

import ast
import io
import keyword
import re
import tokenize
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from typing import TypeGuard

Function = ast.FunctionDef | ast.AsyncFunctionDef

MOST_PARAMETERS = 6  # a reader keeps some seven things in mind
PHRASE_WORDS = 3  # fewer are names, keys or a remedy
RUN_LINES = 6  # what is shorter is alike by chance: an argument a line, a loop of three
_PHRASE = re.compile(rf"[A-Za-z]+(?:,? [A-Za-z]+){{{PHRASE_WORDS - 1},}}")
_TOLD = ("refused", "assert_told")
"""What holds a line to its keys, values and remedies: `tests/helpers/refusals.py`."""
_INTERFACE = "wording"
"""The mark of tests of words that are drawn, shown or named: they are the interface."""
_LAYOUT = (tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.COMMENT)


def count_parameters(function: Function) -> int:
    """Return how many parameters a function takes beside `self` and `cls`."""
    given = function.args
    named = [*given.posonlyargs, *given.args, *given.kwonlyargs, given.vararg, given.kwarg]
    return sum(part is not None and part.arg not in ("self", "cls") for part in named)


def find_chain(function: Function) -> list[str]:
    """Return the longest chain of calls in a function, each made of what one before it gave.

    Returns
    -------
    list of str
        The names that the results are bound to, in order; one that is bound anew is named again.
    """
    chains: dict[str, list[str]] = {}
    longest: list[str] = []
    for statement in _list_statements(function.body):
        used = {name for name in _read_names(statement) if name in chains}
        before = max((chains[name] for name in sorted(used)), key=len, default=[])
        is_call = any(isinstance(node, ast.Call) for node in ast.walk(statement))
        for name in _bound_names(statement):
            chains[name] = [*before, name] if is_call else []
        longest = max([longest, *chains.values()], key=len)
    return longest


def _list_statements(body: Iterable[ast.stmt]) -> Iterator[ast.stmt]:
    """Iterate over simple statements in order, those of blocks among them, once each."""
    for statement in body:
        inner = [part for name in ("body", "orelse") for part in getattr(statement, name, [])]
        if inner and not isinstance(statement, (Function, ast.ClassDef)):
            yield from _list_statements(inner)
        else:
            yield statement


def _bound_names(statement: ast.stmt) -> list[str]:
    if not isinstance(statement, (ast.Assign, ast.AnnAssign, ast.AugAssign)):
        return []
    targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
    nodes = [node for target in targets for node in ast.walk(target)]
    return [n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)]


def _read_names(statement: ast.stmt) -> list[str]:
    names = [node for node in ast.walk(statement) if isinstance(node, ast.Name)]
    # what is added to is read, too
    is_added_to = isinstance(statement, ast.AugAssign)
    return [node.id for node in names if is_added_to or isinstance(node.ctx, ast.Load)]


def is_length_or_share(name: str) -> bool:
    """Return whether a constant is in metres, square metres or shares, by its name."""
    return name.endswith(("_M", "_M2")) or "SHARE" in name


def find_fractions(function: Function) -> Iterator[ast.Constant]:
    """Yield the numbers with a fraction that a function's own text holds."""
    for node in ast.walk(function):
        match node:
            case ast.Constant(value=float(number)) if not number.is_integer():
                yield node


def asserts_prose(test: Function, given: str = "") -> bool:
    """Return whether a test holds three words that follow one another, or more.

    In an assertion, a match, or what a line must tell. What is marked `wording` is left out, and
    words that are given to the code: it hands them on, and better ones of its own cost no test.
    """
    if any(marks_interface(mark) for mark in test.decorator_list):
        return False
    held = (node for part in list_held(test) for node in ast.walk(part))
    return any(phrase not in given for node in held for phrase in _list_phrases(node))


def list_held(test: Function) -> list[ast.expr]:
    """Return the expressions of a test that hold what is said."""
    held: list[ast.expr] = [node.test for node in ast.walk(test) if isinstance(node, ast.Assert)]
    held += [node.value for node in ast.walk(test) if _is_match(node)]
    held += [node for node in ast.walk(test) if _tells(node)]
    matches = {node.id for node in held if isinstance(node, ast.Name)}
    if matches & {part.arg for part in test.args.args}:
        held += test.decorator_list
    return held


def read_given(tree: ast.Module) -> str:
    """Return the texts of a module of tests but docstrings and what its tests hold, a line each."""
    tests = [node for node in ast.walk(tree) if isinstance(node, Function)]
    left_out: set[ast.AST] = {
        node for test in tests for part in list_held(test) for node in ast.walk(part)
    }
    left_out |= {node.value for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    texts = [
        (node, node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    ]
    return "\n".join(text for node, text in texts if node not in left_out)


def _is_match(node: ast.AST) -> TypeGuard[ast.keyword]:
    return isinstance(node, ast.keyword) and node.arg == "match"


def marks_interface(node: ast.AST) -> bool:
    """Return whether an expression is `pytest.mark.wording`."""
    return isinstance(node, ast.Attribute) and node.attr == _INTERFACE


def _tells(node: ast.AST) -> TypeGuard[ast.Call]:
    match node:
        case ast.Call(func=ast.Name(id=name)) | ast.Call(func=ast.Attribute(attr=name)):
            return name in _TOLD
    return False


def _list_phrases(node: ast.AST) -> list[str]:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return _PHRASE.findall(node.value)
    return []


def find_repeated(files: Mapping[str, str], *, by_shape: bool) -> dict[str, int]:
    """Return how many lines of each file stand in runs that stand elsewhere, too.

    Parameters
    ----------
    files : mapping of str to str
        Python texts by name.
    by_shape : bool
        Whether lines are the same that differ in names, texts and numbers alone.

    Returns
    -------
    dict of str to int
        Of files that have some; imports, comments, docstrings and empty lines are no lines of a
        run of `RUN_LINES` or more.
    """
    places = defaultdict(list)
    for name, text in files.items():
        lines = _list_lines(text, by_shape=by_shape)
        for first in range(len(lines) - RUN_LINES + 1):
            run = lines[first : first + RUN_LINES]
            places["\n".join(line for _, line in run)].append((name, [row for row, _ in run]))
    repeated = defaultdict(set)
    for found in places.values():
        for name, rows in found if len(found) > 1 else ():
            repeated[name].update(rows)
    return {name: len(rows) for name, rows in repeated.items()}


def _list_lines(text: str, *, by_shape: bool) -> list[tuple[int, str]]:
    """Return the lines of code of a text with their numbers, in one form."""
    left_out = _rows_left_out(ast.parse(text))
    words = defaultdict(list)
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        row = token.start[0]
        if token.type not in _LAYOUT and row not in left_out and token.string:
            words[row].append(_shape(token) if by_shape else token.string)
    return [(row, " ".join(words[row])) for row in sorted(words)]


def _rows_left_out(tree: ast.AST) -> set[int]:
    """Return the lines of imports and of texts that stand alone, docstrings among them."""
    rows = set()
    for node in ast.walk(tree):
        match node:
            case ast.Expr(value=ast.Constant()) | ast.Import() | ast.ImportFrom():
                rows.update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return rows


def _shape(token: tokenize.TokenInfo) -> str:
    if token.type == tokenize.NAME and not keyword.iskeyword(token.string):
        return "name"
    kinds = {tokenize.NUMBER: "number", tokenize.STRING: "text"}
    return kinds.get(token.type, token.string)
