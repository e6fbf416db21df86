"""The lists of settings in config/ and the manual's tables, written from the schema."""

import json
import re
import textwrap
import tomllib
from pathlib import Path
from typing import Any

from scanplan.project.settings_schema import ADVANCED, Schema, is_section, read_schema

_ROOT = Path(__file__).parents[3]
_SCHEMAS = ("workflow/schemas/config.schema.yaml", "workflow/thesis/config.schema.yaml")
_MANUAL = "config/settings.md"
_WIDTH = tomllib.loads((_ROOT / "pyproject.toml").read_text())["tool"]["ruff"]["line-length"]
"""Columns, as of the code."""
LABORATORY = ("simulate", "evaluation", "thesis")
"""Sections that no plan of a recording depends on: simulate.yaml alone has them, with all that is
said of a key; of others a list has the first sentence, and the manual all."""
_HEADS = {
    "config.yaml": """\
What a user may want to set, each key with its meaning [unit, range]; settings.md beside has more.
Values here hold for all datasets; those of one belong into a file dataset.yaml in its folder, those
of a run into a file for CONFIG= (--configfile). advanced.yaml and simulate.yaml list all others.
""",
    "advanced.yaml": """\
Tuned keys that few surveys want otherwise, each with its meaning [unit, range]; see settings.md.
This file is not read: copy what you change, with the sections around it, into config.yaml, a
dataset.yaml or a file for CONFIG=.
""",
    "simulate.yaml": """\
What surveys are simulated with and measured by, each key with its meaning [unit, range].
This file is not read: copy what you change, with the sections around it, into the file of a
simulated survey (see surveys/) or a file for CONFIG=.
""",
}
_WRITTEN = "`make settings` writes it anew, from workflow/schemas/config.schema.yaml."
_MARKED = re.compile(r"(?ms)^<!-- settings (\S+) -->\n.*?^<!-- end -->$")
_TABLE_HEAD = "| key | default | unit, range | meaning |\n|---|---|---|---|\n"


def format_settings_files(schema: Schema) -> dict[str, str]:
    """Return the texts of the files in config/ that list all keys with their defaults, by name."""
    return {name: _format_file(head, _sections_of(schema, name)) for name, head in _HEADS.items()}


def _sections_of(schema: Schema, name: str) -> Schema:
    elsewhere = {"advanced.yaml": (ADVANCED,), "simulate.yaml": LABORATORY}
    properties: Schema = schema["properties"]
    if name in elsewhere:
        return {key: properties[key] for key in elsewhere[name]}
    listed = {key for keys in elsewhere.values() for key in keys}
    return {key: node for key, node in properties.items() if key not in listed}


def _format_file(head: str, sections: Schema) -> str:
    lines = [f"# {line}" for line in [*head.splitlines(), _WRITTEN]]
    for key, node in sections.items():
        lines += ["", *_format_node(key, node, "", is_whole=key in LABORATORY)]
    return "\n".join(lines) + "\n"


def _format_node(key: str, node: Schema, indent: str, *, is_whole: bool = False) -> list[str]:
    limits = "" if is_section(node) else _format_limits(node)
    told = node["description"] if is_whole else _first_sentence(node["description"])
    meaning = told + (f" [{limits}]" if limits else "")
    comment = textwrap.wrap(
        meaning, _WIDTH, initial_indent=f"{indent}# ", subsequent_indent=f"{indent}# "
    )
    if not is_section(node):
        return [*comment, f"{indent}{key}: {_format_value(node['default'])}"]
    lines = [*comment, f"{indent}{key}:"]
    for child, below in node["properties"].items():
        lines += _format_node(child, below, f"{indent}  ", is_whole=is_whole)
    return lines


def fill_manual(manual: str, schema: Schema) -> str:
    """Return the manual with every table of settings written anew.

    Parameters
    ----------
    manual : str
        Where it says `<!-- settings poses -->`, a table of that section stands up to
        `<!-- end -->`; `general` is for what is in no section.
    """

    def write(found: re.Match[str]) -> str:
        table = _TABLE_HEAD + "".join(_format_rows(_find_section(schema, found[1])))
        return f"<!-- settings {found[1]} -->\n{table}<!-- end -->"

    return _MARKED.sub(write, manual)


def _find_section(schema: Schema, name: str) -> Schema:
    if name == "general":
        return {key: node for key, node in schema["properties"].items() if not is_section(node)}
    for key in name.split("."):
        schema = schema["properties"][key]
    return schema["properties"]


def _format_rows(nodes: Schema, prefix: str = "") -> list[str]:
    rows = []
    for key, node in nodes.items():
        name = f"{prefix}{key}"
        if is_section(node):
            rows.append(f"| `{name}` | | | {node['description']}: |\n")
            rows += _format_rows(node["properties"], f"{name}.")
        else:
            default, limits = _format_value(node["default"]), _format_limits(node)
            row = f"| `{name}` | {default} | {limits} | {node['description']} |\n"
            rows.append(row.replace("|  |", "| |"))
    return rows


def _first_sentence(text: str) -> str:
    return text.partition(". ")[0]


def _format_value(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value)


def _format_limits(node: Schema) -> str:
    """Return unit and range of a value: `m, above 0, to 1000`."""
    if "enum" in node:
        return ", ".join(node["enum"])
    if node.get("type") == "boolean":
        return "true, false"
    limits = node.get("items", {}) | node
    low, high = limits.get("minimum"), limits.get("maximum")
    parts = [node.get("x-unit")]
    if "maxLength" in node and (low, high) == (None, None):
        parts.append(f"to {node['maxLength']} characters")
    if low is not None and high is not None:
        parts.append(f"{low} to {high}")
    else:
        parts.append(f"from {low}" if low is not None else _above(limits))
        parts.append(f"to {high}" if high is not None else _below(limits))
    return ", ".join(part for part in parts if part)


def _above(limits: Schema) -> str | None:
    return f"above {limits['exclusiveMinimum']}" if "exclusiveMinimum" in limits else None


def _below(limits: Schema) -> str | None:
    return f"below {limits['exclusiveMaximum']}" if "exclusiveMaximum" in limits else None


def write_settings_files(root: Path) -> None:
    """Write the lists of settings and the manual's tables of a project."""
    schema = read_schema(*(root / path for path in _SCHEMAS))
    for name, text in format_settings_files(schema).items():
        (root / "config" / name).write_text(text, encoding="utf-8")
    manual = root / _MANUAL
    manual.write_text(fill_manual(manual.read_text(encoding="utf-8"), schema), encoding="utf-8")


if __name__ == "__main__":
    write_settings_files(_ROOT)
