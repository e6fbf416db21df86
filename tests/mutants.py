"""Do tests fail where code is wrong? Random places of the code changed, and how many tests notice.

Usage: mutants.py [COUNT [SEED]] [--full]

Changes one place of `scripts/` at a time (60 places if no count is given): a comparison, a sum, a
condition, a number. Each mutant of the last commit is tried in a checkout of its own with the tests
that `make quick` would run of its file; `--full` tries those that stay alive with all tests, too.
A test that fails without the change counts for nothing. The same seed and commit give the same
places. Nothing has a limit: read what is alive, and strengthen its tests or delete the code.
"""

import ast
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path

from changed_tests import ALWAYS, list_tests

ROOT = Path(__file__).resolve().parents[1]
QUICK = "not workflow and not recordings"
FULL = "not slurm"
USUAL = (60, 1)
"""How many mutants are tried, and the seed that they are drawn with."""
MOST_S = {QUICK: 900, FULL: 7200}
"""A mutant that runs longer hangs: several times what the tests take on a busy machine."""

_SWAPPED = {
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.And: ast.Or,
    ast.Or: ast.And,
}
_NAMES = {"min": "max", "max": "min", "any": "all", "all": "any"}
_ALIKE = ("strict", "frozen", "check", "copy", "stacklevel")
"""Keywords whose value changes nothing where the code is right."""


@dataclass(frozen=True)
class Mutant:
    """A place of a file, and the text that takes the place of what stands there."""

    file: str
    line: int
    begin: int
    end: int
    old: str
    new: str

    def apply(self, text: str) -> str:
        """Return a file's text with the change; places count bytes."""
        data = text.encode()
        return (data[: self.begin] + self.new.encode() + data[self.end :]).decode()

    def __str__(self) -> str:
        """Say it in a line."""
        old, new = (" ".join(part.split()) for part in (self.old, self.new))
        return f"{self.file}:{self.line}  {old}  ->  {new}"


def list_mutants(file: str, text: str) -> list[Mutant]:
    """Return all mutants of a file, in the order of their places."""
    starts = [0]
    for row in text.encode().splitlines(keepends=True):
        starts.append(starts[-1] + len(row))
    found = []
    for node in _walk(ast.parse(text)):
        for changed in _change(node):
            begin = starts[node.lineno - 1] + node.col_offset
            end = starts[(node.end_lineno or 0) - 1] + (node.end_col_offset or 0)
            old = text.encode()[begin:end].decode()
            found.append(Mutant(file, node.lineno, begin, end, old, f"({ast.unparse(changed)})"))
    return sorted(found, key=lambda mutant: (mutant.begin, mutant.end, mutant.new))


def _walk(node: ast.AST) -> Iterator[ast.expr]:
    """Yield the expressions that run: no annotations, decorators, or parts of formatted texts."""
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list"):
            continue
        for below in value if isinstance(value, list) else [value]:
            if _says_how_to_read(below) or not isinstance(below, ast.AST):
                continue
            if isinstance(below, ast.expr):
                yield below
            yield from _walk(below)


def _says_how_to_read(node: object) -> bool:
    match node:
        case ast.JoinedStr() | ast.If(test=ast.Name(id="TYPE_CHECKING")):
            return True
        case ast.If(test=ast.Compare(left=ast.Name(id="__name__"))):
            return True
        case ast.keyword(arg=name):
            return name in _ALIKE
    return False


def _change(node: ast.expr) -> Iterator[ast.expr]:
    """Yield what an expression may be changed to, by itself."""
    changed = deepcopy(node)
    match changed:
        case ast.Compare(ops=[op]) if type(op) in _SWAPPED:
            changed.ops = [_SWAPPED[type(op)]()]
        case ast.BinOp(op=op) | ast.BoolOp(op=op) if type(op) in _SWAPPED:
            changed.op = _SWAPPED[type(op)]()
        case ast.UnaryOp(op=ast.Not() | ast.USub(), operand=operand):
            changed = operand
        case ast.Constant(value=bool(value)):
            changed.value = not value
        case ast.Constant(value=int(value)):
            changed.value = value + 1
        case ast.Constant(value=float(value)):
            changed.value = value * 2 or 1.0
        case ast.Call(func=ast.Name(id=name)) if name in _NAMES:
            changed.func = ast.Name(_NAMES[name])
        case ast.IfExp(test=test):
            changed.test = ast.UnaryOp(ast.Not(), test)
        case _:
            return
    yield changed


def choose_mutants(root: Path, count: int, seed: int) -> list[Mutant]:
    """Return mutants of all files of `scripts/`, drawn at random."""
    found: list[Mutant] = []
    for path in sorted(root.glob("scripts/**/*.py")):
        found += list_mutants(path.relative_to(root).as_posix(), path.read_text(encoding="utf-8"))
    return random.Random(seed).sample(found, count)


def try_mutant(mutant: Mutant, root: Path, tests: list[str], marks: str) -> str:
    """Return the test that a mutant fails, "too long" if it hangs, or nothing if it is alive."""
    path = root / mutant.file
    right = path.read_text(encoding="utf-8")
    left_out: list[str] = []
    path.write_text(mutant.apply(right), encoding="utf-8")
    try:
        while failed := _first_failure(root, [*tests, *left_out], marks):
            path.write_text(right, encoding="utf-8")
            if failed == "too long" or not _first_failure(root, [failed], marks):
                return failed
            left_out.append(f"--deselect={failed}")
            path.write_text(mutant.apply(right), encoding="utf-8")
    finally:
        path.write_text(right, encoding="utf-8")
    return ""


def _first_failure(root: Path, words: list[str], marks: str) -> str:
    command = [
        sys.executable,
        "-B",
        "-m",
        "pytest",
        "-x",
        "-q",
        "-n",
        "0",
        "-p",
        "no:cacheprovider",
    ]
    command += ["-m", marks, *words]
    try:
        said = subprocess.run(
            command, cwd=root, capture_output=True, text=True, check=False, timeout=MOST_S[marks]
        )
    except subprocess.TimeoutExpired:
        return "too long"
    if said.returncode in (0, 5):  # 5: all tests are left out by their marks
        return ""
    rows = [row.split(" ", 1)[1] for row in said.stdout.splitlines() if _tells(row)]
    return rows[0].partition(" - ")[0].removesuffix(": ") if rows else words[0]


def _tells(row: str) -> bool:
    return row.startswith(("FAILED tests", "ERROR tests"))


def run_trial(count: int, seed: int, *, full: bool) -> None:
    """Try mutants of the last commit, and print each with what became of it, and how many died."""
    killed = {"quick": 0, "full": 0}
    with tempfile.TemporaryDirectory(prefix="mutants") as folder:
        root = Path(folder, "code")
        _git("worktree", "add", "--quiet", "--detach", str(root), "HEAD")
        (root / ".venv").symlink_to(ROOT / ".venv")
        try:
            for mutant in choose_mutants(root, count, seed):
                began_s = time.monotonic()
                # what holds the house's structure sees no wrong number
                tests = [name for name in list_tests([mutant.file], root) if name != ALWAYS]
                failed = try_mutant(mutant, root, tests, QUICK) if tests else ""
                killed["quick"] += bool(failed)
                if full and not failed:
                    failed = try_mutant(mutant, root, ["tests"], FULL)
                killed["full"] += bool(failed)
                took_s = time.monotonic() - began_s
                print(f"{'killed' if failed else 'ALIVE':<7}{took_s:5.0f} s  {mutant}", flush=True)
                print(f"{'':16}{failed or ' '.join(tests) or 'no test'}", flush=True)
        finally:
            _git("worktree", "remove", "--force", str(root))
    print(f"the tests of the file kill {killed['quick']} of {count} mutants (seed {seed})")
    if full:
        print(f"all tests kill {killed['full']} of {count}")


def _git(*words: str) -> None:
    subprocess.run(["git", "-C", str(ROOT), *words], check=True)


def read_words(words: list[str]) -> tuple[int, int, bool]:
    """Return the count, the seed and whether all tests are tried, as the command line says."""
    numbers = [int(word) for word in words if word.isdecimal()]
    wrong = [word for word in words if word != "--full" and not word.isdecimal()]
    if wrong or len(numbers) > len(USUAL):
        sys.exit(f"{' '.join(wrong or words)}: not of [COUNT [SEED]] [--full]")
    count, seed = [*numbers, *USUAL[len(numbers) :]]
    return count, seed, "--full" in words


if __name__ == "__main__":
    count, seed, is_full = read_words(sys.argv[1:])
    run_trial(count, seed, full=is_full)
