"""The price list of rules: lines of code, drives changed, and what changes, one row a rule."""

import ast
import csv
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from ablation_scores import COUNTS, HEADLINES, LESS_IS_BETTER, NUMBERS
from ablation_switches import Rule

import scanplan

Found = Mapping[str, Mapping[str, Mapping[str, Any]]]
"""What a plan is, by drive and rule, see `ablation.ablate`."""

_PACKAGE = Path(scanplan.__file__).parent
_LEAST = 5e-4  # of the last digit that is printed


def report(kind: str, found: Found, rules: Mapping[str, Rule], base: str, folder: Path) -> None:
    """Print the rules as a table in Markdown and write it, and the same numbers as CSV.

    Parameters
    ----------
    kind : str
        Of the drives.
    found : dict of str to dict
        By drive.
    rules : dict of str to Rule
    base : str
        The name of the plan that all are compared with.
    folder : Path
        Where `<kind>.csv` and `<kind>.md` are written.
    """
    rows = [row_of(name, rule, base, found) for name, rule in rules.items()]
    measures = {**HEADLINES, **COUNTS}
    columns = ["rule", "lines", "changed", *(m for m in measures if any(m in row for row in rows))]
    columns.append("worst")
    file = folder / kind.replace(", ", "_").replace(" ", "_")
    with file.with_suffix(".csv").open("w", newline="") as opened:
        writer = csv.DictWriter(opened, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    whole = row_of_base(found)
    lines = [
        f"## {kind}: {len(found)} ({', '.join(found)})",
        "",
        "With all rules: " + ", ".join(f"{measures[m]} {value:.3f}" for m, value in whole.items()),
        "",
        "| " + " | ".join(measures.get(column, column) for column in columns) + " |",
        "|" + "---|" * len(columns),
        *("| " + " | ".join(_say(row.get(c, "")) for c in columns) + " |" for row in rows),
        "",
        "Changes nothing anywhere: "
        + (", ".join(row["rule"] for row in rows if not row["changed"]) or "none"),
        "",
    ]
    text = "\n".join(lines)
    file.with_suffix(".md").write_text(text)
    print(text, flush=True)


def row_of(name: str, rule: Rule, base: str, found: Found) -> dict[str, Any]:
    """Return the row of a rule: how each measure's mean changes without it, and the worst fall.

    Measures are those that drives have with it and without it.

    Parameters
    ----------
    name : str
    rule : Rule
    base : str
        The name of what it is compared with.
    found : dict of str to dict
        By drive.
    """
    changed = [drive for drive, of in found.items() if of[name]["tables"] != of[base]["tables"]]
    deltas: dict[str, dict[str, float]] = {}
    for drive, of in found.items():
        for measure, before in of[base]["scores"].items():
            delta = of[name]["scores"].get(measure, math.nan) - before
            if math.isfinite(delta):
                deltas.setdefault(measure, {})[drive] = delta
    means = {measure: float(np.mean(list(of.values()))) for measure, of in deltas.items()}
    worst = min(_list_gains(deltas), default=(0.0, "", ""))
    words = f"{worst[1]} {worst[0]:+.3f} ({worst[2]})" if worst[0] < -_LEAST else ""
    if failed := [drive for drive in changed if not found[drive][name]["scores"]]:
        words = f"no plan of {', '.join(failed)}"
    return {
        **{"rule": name, "lines": count_lines(rule), "changed": len(changed)},
        **means,
        "worst": words,
    }


def row_of_base(found: Found) -> dict[str, float]:
    """Return the mean of each measure with all rules."""
    scores = [of["nothing"]["scores"] for of in found.values()]
    # what was kept comes back in another order than what was measured now
    known = {
        measure: [of[measure] for of in scores if math.isfinite(of.get(measure, math.nan))]
        for measure in (*HEADLINES, *COUNTS)
    }
    return {measure: float(np.mean(values)) for measure, values in known.items() if values}


def count_lines(rule: Rule) -> int:
    """Return how many lines the code of a rule has."""
    return sum(_count_lines(place) for place in rule.code)


def _count_lines(place: str) -> int:
    module, _, path = place.partition(":")
    text = (_PACKAGE / f"{module.replace('.', '/')}.py").read_text(encoding="utf-8")
    if not path:
        return len(text.splitlines())
    node: Any = ast.parse(text)
    for name in path.split("."):
        node = next(child for child in node.body if getattr(child, "name", "") == name)
    first = min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)])
    return node.end_lineno - first + 1


def _list_gains(deltas: Mapping[str, Mapping[str, float]]) -> Iterator[tuple[float, str, str]]:
    """Yield by how much each share of each drive is better, as more is better of all."""
    for measure, of in deltas.items():
        if measure in HEADLINES and measure not in NUMBERS:
            sign = -1 if measure in LESS_IS_BETTER else 1
            yield from ((sign * delta, HEADLINES[measure], drive) for drive, delta in of.items())


def _say(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:+.3f}" if abs(value) >= _LEAST else "."
    return str(value)
