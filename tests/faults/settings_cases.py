"""Hostile settings: every one ends in one line, and nothing of them is executed."""

from functools import partial
from pathlib import Path

from faults.judging import Case
from scanplan.project.settings import (
    LABORATORY_FILE,
    SCHEMA_FILE,
    Layer,
    read_defaults,
    settings_of_dataset,
)
from scanplan.project.settings_schema import read_schema
from scanplan.project.yaml_file import read_yaml

_ROOT = Path(__file__).resolve().parents[2]
_BOMB = "k0: &k0 {a: 1}\n" + "".join(
    f"k{i}: &k{i}\n  <<: [{', '.join([f'*k{i - 1}'] * 9)}]\n" for i in range(1, 10)
)
_EXPORT = "plan: {export: {%s}}"
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
    "a million keys": "".join(f"k{i}: 1\n" for i in range(10**6)),
    "chunk of 1e-300 GB": "advanced: {jobs: {chunk_gb: 1.0e-300}}",
    "seed of 2^64": f"seed: {2**64}",
    "frame of 5 MB": f"input: {{base_frame: {'a' * 5_000_000}}}",
    "project of 100,000 characters": _EXPORT % f"project: {'a' * 100_000}",
    "author of line breaks": _EXPORT % 'author: "a\\n\\nb"',
    "author of U+FFFF": _EXPORT % 'author: "a\\uffff"',
    "lone surrogate in an author": _EXPORT % 'author: "\\ud83c"',
    "EPSG:0": _EXPORT % "site: {crs: EPSG:0}",
    "EPSG of twenty digits": _EXPORT % f"site: {{crs: EPSG:{'9' * 20}}}",
    "a system in degrees": _EXPORT % "site: {crs: EPSG:4326}",
    "east of 1e300": _EXPORT % "site: {east_m: 1.0e+300}",
    "height of -1e9": _EXPORT % "site: {height_m: -1.0e+9}",
    "colour code in a key": '"\\e[31mposes": {keep_every: 3}',
    "+ as many keys as fit": "".join(f"k{i}: 1\n" for i in range(25_000)),
    "+ seeds by the thousand": f"thesis: {{seeds: {[*range(1000)]}}}",
    "+ seed below nothing": "simulate: {seed: -1}",
    "+ octal": "poses: {keep_every: 010}",
    "+ octal below zero": "plan: {export: {site: {north_m: -017}}}",
    "+ storey of nothing to see": _EXPORT % 'storey: "\\u200b"',
    "+ organisation read backwards": _EXPORT % 'organisation: "a\\u202eb"',
    "+ system of a number": _EXPORT % "site: {crs: 25832}",
    "+ system of other digits": _EXPORT % "site: {crs: 'EPSG:٢٥٨٣٢'}",
    "+ system of space": _EXPORT % "site: {crs: 'EPSG: 25832'}",
    "+ geocentric system": _EXPORT % "site: {crs: EPSG:4978}",
    "+ building with NUL": 'simulate: {building: "a\\0b"}',
    "+ building of 5,000 characters": f"simulate: {{building: {'a/' * 2500}b}}",
    "+ storey of 300 characters": f"simulate: {{site: {{storey: {'a' * 300}}}}}",
    "+ storey of 10^30": f"simulate: {{site: {{storey: {10**30}}}}}",
    "+ way by 20,000 corners": f"simulate: {{site: {{waypoints_m: {[[0, 0]] * 20_000}}}}}",
    "+ way to the moon": "simulate: {site: {waypoints_m: [[0, 0], [3.8e+8, 0]]}}",
    "+ scans by 10^30": f"selection: {{stop: {{max_points: {10**30}}}}}",
    "+ topic of 1,000 characters": f"input: {{cloud_topic: /{'a' * 1000}}}",
    "+ method with a colour code": 'plan: {method: "\\e[31m"}',
    "+ two documents": "poses: {}\n---\nposes: {}",
    "+ key of a list": "? [poses]\n: 1",
    "+ key of a map": "? {poses: 1}\n: 1",
    "+ key that is nothing": "~: 1",
    "+ section that is a set": "poses: !!set {a}",
    "+ ordered pairs": "poses: !!omap [keep_every: 3]",
}


def list_settings_cases(folder):
    schema = read_schema(SCHEMA_FILE, LABORATORY_FILE)
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
