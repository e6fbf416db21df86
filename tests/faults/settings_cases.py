"""Hostile settings: every one ends in one line, and nothing of them is executed."""

from functools import partial
from pathlib import Path

from faults.judging import Case
from scanplan.project.settings import Layer, read_defaults, settings_of_dataset
from scanplan.project.settings_schema import read_schema
from scanplan.project.yaml_file import read_yaml

_ROOT = Path(__file__).resolve().parents[2]
_BOMB = "k0: &k0 {a: 1}\n" + "".join(
    f"k{i}: &k{i}\n  <<: [{', '.join([f'*k{i - 1}'] * 9)}]\n" for i in range(1, 10)
)
_TEXTS = {
    "unknown section": "posess: {keep_every: 3}",
    "unknown key": "poses: {keep_evry: 3}",
    "text for a number": "poses: {keep_every: five}",
    "number as text": "poses: {keep_every: '5'}",
    "fraction for a count": "poses: {keep_every: 5.5}",
    "boolean for a number": "poses: {keep_every: true}",
    "negative": "registration: {voxel_m: -0.1}",
    "zero": "poses: {keep_every: 0}",
    "NaN": "input: {max_range_m: .nan}",
    "infinity": "input: {max_range_m: .inf}",
    "NaN in a list": "advanced: {registration: {icp_distances_m: [0.5, .nan]}}",
    "huge": f"poses: {{keep_every: {'9' * 200}}}",
    "ten thousand digits": f"poses: {{keep_every: {'9' * 10_000}}}",
    "1e400": "poses: {max_gap_s: 1e400}",
    "sexagesimal": "poses: {keep_every: 1:30}",
    "null section": "poses:",
    "list for a section": "poses: [1, 2]",
    "list at the top": "- 1",
    "text alone": "hello",
    "tabs": "poses:\n\tkeep_every: 3",
    "NUL": "poses: {keep_every: 3}\0",
    "key twice": "poses: {keep_every: 3, keep_every: 4}",
    "merge bomb": _BOMB,
    "alias": "a: &a [1]\nposes: *a",
    "recursive alias": "poses: &a {keep_every: *a}",
    "nested deeply": "poses: " + "[" * 5000,
    "python object": "poses: !!python/object/apply:os.system ['touch pwned']",
    "code": "__use_yte__: true\n__definitions__: [\"open('pwned', 'w')\"]",
    "path for a method": "plan: {method: ../../x}",
    "shell for an extractor": "plan: {extractor: 'x; touch pwned'}",
    "path for a recording": "simulate: {recording: ../../../x}",
    "limits that cross": "input: {min_range_m: 9, max_range_m: 5}",
    "short list": "input: {base_from_sensor: [0, 0, 0, 0, 0]}",
    "text in a list": "input: {base_from_sensor: [a, 0, 0, 0, 0, 0]}",
    "far mounting": "input: {base_from_sensor: [1.0e+308, 0, 0, 0, 0, 0]}",
    "line break in a topic": 'input: {cloud_topic: "/x\\n\\e[31mscanplan: well"}',
    "date for a topic": "input: {cloud_topic: 2020-01-01}",
    "text for a switch": "input: {salvage: maybe}",
    "share above one": "advanced: {input: {max_damaged_share: 1.5}}",
}


def list_settings_cases(folder):
    schema = read_schema(_ROOT / "workflow/schemas/config.schema.yaml")
    cases = []
    for number, (name, text) in enumerate(_TEXTS.items()):
        path = Path(folder, f"settings_{number}.yaml")
        path.write_text(text)
        run = partial(_check, path, schema)
        cases.append(Case("settings", name, run, may_pass=False))
    for name, content in {"UTF-16": "poses: {}".encode("utf-16"), "Latin": b"a: \xff"}.items():
        path = Path(folder, f"{name}.yaml")
        path.write_bytes(content)
        cases.append(Case("settings", name, partial(_check, path, schema), may_pass=False))
    for name in ("absent", "folder"):
        path = Path(folder, f"{name}.d.yaml")
        if name == "folder":
            path.mkdir()
        cases.append(Case("settings", name, partial(_check, path, schema), may_pass=False))
    return cases


def _check(path, schema):
    defaults = read_defaults(_ROOT / "config/config.yaml", schema)
    settings_of_dataset(defaults, [Layer(str(path), read_yaml(path))], schema)
