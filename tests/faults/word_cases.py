"""What people write: names, lists, corrections, buildings, and what stands in their files' place.

Cases whose names begin with `+` were in no list that anybody had given.
"""

import json
import random
import string
from functools import partial
from pathlib import Path

from faults.judging import Case
from helpers import odd_files
from helpers.corrected_files import exported, read_texts
from helpers.default_settings import SCHEMA, SETTINGS
from scanplan.exports.sheet.lettering import clean_text
from scanplan.project import building_file, corrections_file, dataset, overlooked_files
from scanplan.project.settings import end_on_faulty_settings

_ROOT = Path(__file__).resolve().parents[2]
_LETTERS = "".join(random.Random(1).choices(string.ascii_letters, k=300))

_WALL = "{element: wall, action: add, line: [[1, 1], [4, 1]], thickness_m: T}"
_ENTRIES = {
    "action in a list": "{element: wall, action: [1], at: [1, 2]}",
    "element in a list": "{element: [wall], action: keep, at: [1, 2]}",
    "lone surrogate": '{element: room, at: [1, 2], name: "\\ud83c"}',
    "U+FFFF": '{element: room, at: [1, 2], name: "a\\uffff"}',
    "line break in a name": '{element: room, at: [1, 2], name: "a\\nb"}',
    "colour code in a name": '{element: room, at: [1, 2], name: "\\e[31ma"}',
    "colour code in a key": '{element: room, at: [1, 2], "\\e[31m": 1, name: a}',
    "name of 100,000 characters": f"{{element: room, at: [1, 2], name: {'a' * 100_000}}}",
    "wall in millimetres": "{element: wall, action: add, line: [[0, 0], [30000, 0]]}",
    "wall of 1e11 m": "{element: wall, action: add, line: [[0, 0], [1.0e+11, 0]]}",
    "thickness of 1e-300": _WALL.replace("T", "1.0e-300"),
    "thickness of 9.9": _WALL.replace("T", "9.9"),
    "+ thickness in millimetres": _WALL.replace("T", "200"),
    "+ thickness of NaN": _WALL.replace("T", ".nan"),
    "+ thickness of a truth": _WALL.replace("T", "yes"),
    "+ thickness octal": _WALL.replace("T", "01"),
    "+ wall of 1 mm": "{element: wall, action: add, line: [[0, 0], [0.001, 0]]}",
    "+ line of three places": "{element: wall, action: add, line: [[0, 0], [1, 0], [1, 1]]}",
    "+ line of heights": "{element: wall, action: add, line: [[0, 0, 1], [1, 0, 1]]}",
    "+ place as text": "{element: wall, action: keep, at: '1, 2'}",
    "+ place of sexagesimals": "{element: wall, action: keep, at: [1:30, 2]}",
    "+ place of octals": "{element: wall, action: keep, at: [010, 2]}",
    "+ name that is a no": "{element: room, at: [1, 2], name: no}",
    "+ name that is a date": "{element: room, at: [1, 2], name: 2020-01-01}",
    "+ name of nothing to see": '{element: room, at: [1, 2], name: "\\u200b\\u00ad"}',
    "+ name read backwards": '{element: room, at: [1, 2], name: "a\\u202eb"}',
    "+ name with a line separator": '{element: room, at: [1, 2], name: "a\\u2028b"}',
    "+ name with NEL": '{element: room, at: [1, 2], name: "a\\x85b"}',
    "+ surrogates in reverse": '{element: room, at: [1, 2], name: "\\udfe0\\ud83c"}',
    "+ name in bytes": "{element: room, at: [1, 2], name: !!binary aGk=}",
    "+ name of a set": "{element: room, at: [1, 2], name: !!set {a}}",
    "+ kind of a list": "{element: opening, at: [1, 2], kind: [door]}",
    "+ entry of another's keys": "{wall: {at: [1, 2]}}",
    "+ key that is a number": "{element: room, at: [1, 2], name: a, 5: 6}",
    "+ key that is nothing": "{element: room, at: [1, 2], name: a, ~: 6}",
}
_POINTS = {
    "50 km apart": ([[0, 0], [9, 0]], [[0, 0], [50_000, 0]]),
    "mirrored": ([[0, 0], [9, 0], [0, 9]], [[0, 0], [9, 0], [0, -9]]),
    "at one place": ([[0, 0], [0, 1e-9]], [[0, 0], [0, 9]]),
    "scale 1000": ([[0, 0], [9, 0]], [[0, 0], [9000, 0]]),
    "east 1e300": ([[0, 0], [9, 0]], [[1e300, 0], [1e300, 9]]),
    "+ map in millimetres": ([[0, 0], [9000, 0]], [[0, 0], [9, 0]]),
    "+ world in feet": ([[0, 0], [9, 0]], [[0, 0], [29.5, 0]]),
    "+ world in degrees": ([[0, 0], [90, 0]], [[8.5, 47.3], [8.501, 47.3]]),
    "+ east and north swapped": (
        [[0, 0], [9, 0], [3, 9]],
        [[5e6, 4e5], [5e6, 400_009], [5_000_009, 400_003]],
    ),
    "+ one of nine off": (
        [[i, i % 2] for i in range(0, 90, 10)],
        [[i + 300 * (i == 40), i % 2] for i in range(0, 90, 10)],
    ),
    "+ world at one place": ([[0, 0], [9, 0]], [[5, 5], [5, 5]]),
    "+ other zones": ([[0, 0], [90, 0]], [[500_000, 5e6], [100_000, 5e6]]),
}
_SYSTEMS = [
    "EPSG:0",
    f"EPSG:{'9' * 20}",
    "EPSG:4326",
    "EPSG:4978",
    "epsg:25832",
    "EPSG:²",
    "EPSG: 25832",
]
_ROOM = {"element": "room", "name": "a"}
_WALL_KEPT = {"element": "wall", "action": "keep"}


def _feature(properties, kind, coordinates):
    geometry = {"type": kind, "coordinates": coordinates}
    return json.dumps({"features": [{"properties": properties, "geometry": geometry}]})


_FEATURES = {
    "geometry that is a word": '{"features": [{"properties": {}, "geometry": "Point"}]}',
    "+ features in an object": '{"features": {"a": 1}}',
    "+ features twice": '{"features": [], "features": []}',
    "+ property twice": _feature(_ROOM, "Point", [1, 1]).replace("element", "name", 1),
    "+ nested a million deep": "[" * 10**6,
    "+ a million features": '{"features": [' + "{}," * 10**6 + "{}]}",
    "+ polygon": _feature(_WALL_KEPT, "Polygon", [[[0, 0], [1, 0], [1, 1]]]),
    "+ coordinates that are NaN": _feature(_WALL_KEPT, "Point", [float("nan"), 1]),
    "+ coordinates of 10,000 digits": _feature(_ROOM, "Point", [7, 1]).replace("7", "7" * 10_000),
    "+ coordinates that are none": _feature(_ROOM, "Point", None),
    "+ coordinates in a text": _feature(_ROOM, "Point", "1, 2"),
    "+ lone surrogate": _feature(_ROOM | {"name": "\ud83c"}, "Point", [1, 1]),
    "+ properties in a list": '{"features": [{"properties": [], "geometry": {}}]}',
    "+ UTF-16": '{"features": []}'.encode("utf-16"),
}
_YAML = {
    "a million keys": "".join(f"k{i}: 1\n" for i in range(10**6)),
    "+ a million entries": "corrections:\n" + "- 1\n" * 10**6,
    "+ two documents": "corrections: []\n---\ncorrections: []\n",
    "+ entries with keys of their own": "corrections: {1: {element: wall}}",
    "+ key twice": "corrections: []\ncorrections: []\n",
    "+ a tag of its own": "corrections: !mine []",
    "+ a directive": "%YAML 3.0\n---\ncorrections: []\n",
    "+ as many brackets as fit": "corrections: " + "[" * 250_000,
    "+ keys of one text": "corrections: [" + "{a, " * 60_000,
}  # fmt: skip
_LISTS = {
    "path twice": "path\tpath\na\tb\n",
    "name twice": "name\tpath\tname\na\tb\tc\n",
    "X and x": "name\tpath\nX\ta\nx\tb\n",
    "summary.html": "name\tpath\nsummary.html\ta\n",
    "thesis": "path\na/thesis\n",
    "a path of 5,000 characters": "path\n" + "a/" * 2500 + "b\n",
    "a path with NUL": "path\na\0b\n",
    "a path with a colour code": "path\n\x1b[31ma\n",
    "a name with a colour code": "name\tpath\n\x1b[31m\ta\n",
    "+ a target": "path\na/ALL\n",
    "+ Comparison": "name\tpath\nComparison\ta\n",
    "+ SUMMARY.Parquet": "name\tpath\nSUMMARY.Parquet\ta\n",
    "+ a column in capitals": "Path\na\n",
    "+ a header after a blank": "\n\npath\na\n",
    "+ commas": "path,name\na,b\n",
    "+ UTF-16": "path\na\n".encode("utf-16"),
    "+ a path of 300 characters in one name": f"path\n{_LETTERS}\n",
    "+ a name of 300 characters": f"name\tpath\n{_LETTERS}\ta\n",
    "+ a name of two dots": "name\tpath\n..\ta\n",
    "+ a quote that never ends": 'path\n"a\nb\nc\n',
    "+ a field of 200,000 characters": f"path\n{'a' * 200_000}\n",
    "+ five megabytes": "path\n" + "a\n" * 2_500_000,
    "+ a path read backwards": "path\na\u202eb\n",
    "+ a path with U+2028": "path\na\u2028b\n",
    "+ two paths that differ in signs": "path\na b\na_b\n",
    "+ one folder by two ways": "path\n./a\nb/../a\n",
}
_PATHS = {
    "NUL": "a\0b",
    "5,000 characters": "a/" * 2500,
    "a colour code": "\x1b[31ma",
    "+ 300 characters": _LETTERS,
    "+ bytes that are no UTF-8": "a\udcff",
    "+ a line break": "a\nb",
    "+ nothing but dots": "...",
    "+ spaces": "   ",
    "+ the root": "/",
}
_STOREYS = "storeys: [{dataset: a, elevation_m: 0}, {dataset: b, elevation_m: 3}]\n"
_BUILDINGS = {
    "two at one elevation": _STOREYS.replace("3}", "0}"),
    "elevation of 1e8 m": _STOREYS.replace("3}", "1.0e+8}"),
    "storey of 10,000 characters": _STOREYS.replace("3}", f"3, name: {'a' * 10_000}}}"),
    "named thesis": _STOREYS + "name: thesis\n",
    "named like a list's words": _STOREYS + "name: summary.html\n",
    "+ named like a storey in capitals": _STOREYS + "name: A\n",
    "+ named a dot": _STOREYS + "name: '.'\n",
    "+ named up": _STOREYS + "name: ../x\n",
    "+ named in a list": _STOREYS + "name: [a, b]\n",
    "+ named nothing": _STOREYS + "name: ''\n",
    "+ 3 mm apart": _STOREYS.replace("3}", "0.003}"),
    "+ elevation of NaN": _STOREYS.replace("3}", ".nan}"),
    "+ elevation of a truth": _STOREYS.replace("3}", "yes}"),
    "+ elevation octal": _STOREYS.replace("3}", "010}"),
    "+ turned by 1e300 degrees": _STOREYS.replace("3}", "3, building_from_map: [0, 0, 1.0e+300]}"),
    "+ 1e8 m aside": _STOREYS.replace("3}", "3, building_from_map: [1.0e+8, 0, 0]}"),
    "+ named read backwards": _STOREYS.replace("3}", '3, name: "a\\u202eb"}'),
    "+ dataset up": _STOREYS.replace("dataset: b", "dataset: ../b"),
    "+ frame of 5 MB": _STOREYS + f"frame: {'a' * 5_000_000}\n",
    "+ frame with a colour code": _STOREYS + 'frame: "\\e[31m"\n',
}
_DRAWN = {
    "braces": "{dataset} {}",
    "caret and backslash": "a ^J \\P \\U+0041",
    "emoji": "Küche 🏠",
    "+ markup": "<b onload=x>&amp;</b>",
    "+ percent codes": "%%c 100 %%% %d %s",
    "+ codes of another alphabet": "\\M+1A2B4 \\\\U+00e9",
    "+ quotes": "\"'`$(x)${y}",
    "+ a formula": "=HYPERLINK(1)",
    "+ mathematics": "$\\frac{1}{2}$",
    "+ Chinese": "厨房",
    "+ from right to left": "מטבח",
    "+ a family of four": "👨\u200d👩\u200d👧\u200d👦",
    "+ marks upon marks": "a" + "\u0301" * 40,
    "+ eighty wide letters": "W" * 80,
    "+ eighty emoji": "🏠" * 80,
    "+ the end of IFC": "ENDSEC;END-ISO-10303-21;'",
    "+ the end of a stream": "endstream endobj (\\) Tj",
    "+ SQL": "'); DROP TABLE rooms; --",
    "+ private use": "\ue000 Flur",
}  # fmt: skip


def list_word_cases(folder, n_drawn):
    """Cases of all that people write; of names that are drawn so many."""
    folder = Path(folder, "words")
    folder.mkdir()
    return [
        *_list_corrections(folder),
        *_list_lists(folder),
        *_list_buildings(folder),
        *_list_places(folder),
        *_list_overlooked(folder),
        *_list_drawn(folder, n_drawn),
    ]


def _write(folder, name, content):
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8"))
    return path


def _list_corrections(folder):
    texts = {name: f"corrections:\n- {entry}\n" for name, entry in _ENTRIES.items()} | _YAML
    for system in _SYSTEMS:
        texts[f"crs {system}"] = _state_points([[0, 0], [9, 0]], [[1, 2], [10, 2]], system)
    for name, (at, world) in _POINTS.items():
        texts[f"points {name}"] = _state_points(at, world, "EPSG:25832")
    cases = []
    for number, (name, text) in enumerate(texts.items()):
        path = _write(folder / f"corrections_{number}", "corrections.yaml", text)
        run = partial(corrections_file.read_corrections, path)
        cases.append(Case("corrections", name, run, may_pass=False))
    for number, (name, text) in enumerate(_FEATURES.items()):
        path = _write(folder / f"features_{number}", "corrections.geojson", text)
        run = partial(corrections_file.read_corrections, path)
        cases.append(Case("corrections of GeoJSON", name, run, may_pass=False))
    pair = json.dumps({"element": "room", "at": [1, 2], "name": "🏠"})
    path = _write(folder / "pair", "corrections.yaml", f"corrections:\n- {pair}\n")
    run = partial(corrections_file.read_corrections, path)
    return [*cases, Case("corrections", "a pair", run, lambda found: found[0].name == "🏠")]


def _state_points(at, world, crs):
    said = {"element": "reference_point", "crs": crs}
    points = [said | {"at": a, "world": w} for a, w in zip(at, world, strict=True)]
    # YAML has JSON in it, but for exponents without a point
    return json.dumps({"corrections": points}, ensure_ascii=False).replace("1e+300", "1.0e+300")


def _list_lists(folder):
    cases = []
    for number, (name, text) in enumerate(_LISTS.items()):
        path = _write(folder / f"list_{number}", "floors.tsv", text)
        run = partial(dataset.name_datasets, str(path))
        cases.append(Case("lists", name, run, may_pass=False))
    for name, path in _PATHS.items():
        run = partial(dataset.name_datasets, [path])
        cases.append(Case("paths", name, run, may_pass=False))
    return cases


def _list_buildings(folder):
    cases = []
    for number, (name, text) in enumerate(_BUILDINGS.items()):
        inside = folder / f"building_{number}"
        _write(inside, "building.yaml", text)
        given = {dataset: str(inside / dataset) for dataset in "ab"}
        run = partial(building_file.find_building, given)
        cases.append(Case("buildings", name, run, may_pass=False))
    return cases


def _put_large(path):
    path.write_bytes(b"# no end\n" * 10**6)


_IN_PLACE = {
    "a pipe": odd_files.put_pipe,
    "a device": odd_files.put_device,
    "a folder": odd_files.put_folder,
    "a dangling link": odd_files.put_lost_link,
    "+ a link to itself": odd_files.put_loop,
    "+ a socket": odd_files.put_socket,
    "+ nine megabytes": _put_large,
}


def _list_places(folder):
    """Something else in the place of a file that people write."""
    cases = []
    read = {
        "dataset.yaml": _describe,
        "corrections.yaml": _describe,
        "corrections.geojson": _describe,
        "building.yaml": _find_building,
        "floors.tsv": _read_list,
        "survey.yaml": _describe_survey,
        "mine.yaml": _read_configfile,
    }
    for name, run in read.items():
        for what, put in _IN_PLACE.items():
            if (name, what) in (("floors.tsv", "a folder"), ("survey.yaml", "a folder")):
                continue  # a folder of any name is a dataset
            inside = folder / f"{name}_{put.__name__}"
            _write(inside / "d", "run.bag", "x")
            _write(inside / "e", "run.bag", "x")
            put((inside / "d" if run is _describe else inside) / name)
            case = partial(run, inside, name)
            cases.append(Case("in the place of files", f"{what}: {name}", case, may_pass=False))
    for name in ("truth.geojson", "truth_poses.tum"):
        for what in ("a pipe", "a dangling link", "a folder"):
            inside = folder / f"{name}_{what.replace(' ', '_')}"
            _write(inside / "d", "run.bag", "x")
            _IN_PLACE[what](inside / "d" / name)
            case = partial(_describe, inside, name)
            cases.append(Case("in the place of files", f"+ {what}: {name}", case, may_pass=False))
    return cases


def _describe(folder, _):
    known = {"defaults": SETTINGS, "given": [], "schema": SCHEMA}
    return dataset.describe_dataset("d", folder / "d", drawings=_ROOT / "config/buildings", **known)


def _describe_survey(folder, name):
    known = {"defaults": SETTINGS, "given": [], "schema": SCHEMA}
    return dataset.describe_dataset(
        "d", folder / name, drawings=_ROOT / "config/buildings", **known
    )


def _find_building(folder, _):
    return building_file.find_building({name: str(folder / name) for name in "de"})


def _read_list(folder, name):
    return dataset.name_datasets(str(folder / name))


def _read_configfile(folder, name):
    end_on_faulty_settings(["snakemake", "--configfile", str(folder / name)])


def _list_overlooked(folder):
    """Names of files that are nearly those that are read: each is told."""
    cases = []
    names = ["corrections.yml", "Corrections.yaml", "corrections.json", "+ CORRECTIONS.YAML.TXT"]
    names += ["+ Dataset.YML", "+ truth.json", "+ Truth_poses.tum"]
    for number, name in enumerate(names):
        inside = folder / f"overlooked_{number}"
        _write(inside, "run.bag", "x")
        _write(inside, name.removeprefix("+ "), "{}")
        run = partial(overlooked_files.list_overlooked, inside)
        cases.append(Case("overlooked files", name, run, lambda notes: len(notes) == 1))
    given = folder / "overlooked_building"
    _write(given, "Building.yml", _STOREYS)
    run = partial(building_file.list_overlooked, {name: str(given / name) for name in "ab"})
    return [*cases, Case("overlooked files", "+ Building.yml", run, lambda notes: len(notes) == 1)]


def _list_drawn(folder, n_drawn):
    cases = []
    for number, (what, name) in enumerate([*_DRAWN.items()][:n_drawn]):
        inside = folder / f"drawn_{number}"
        inside.mkdir()
        run = partial(_draw, inside, name)
        cases.append(Case("names in drawings", what, run, partial(_holds, name)))
    return cases


def _draw(folder, name):
    entry = {"element": "room", "at": [5, 1], "name": name}
    return read_texts(exported(folder, [entry], name="office", project=name, storey=name))


def _holds(name, found):
    """Whether all files hold a name, in drawings as far as there is room and a glyph."""
    quoted = f"'{name}" if name.startswith("=") else name
    told = {**dict.fromkeys(("ifc", "geojson", "json", "gpkg"), name), "csv": quoted}
    if len(name) < 40:
        told |= {"dxf": clean_text(name), "svg": clean_text(name)}
    if name.isascii() and len(name) < 40:
        told |= {"pdf": name}
    return all(text in found[kind] for kind, text in told.items())
