"""Hostile words by where people write them; each has to be refused, or drawn as it is.

Names that begin with `+` were in no list that anybody had given.
"""

import json
import random
import string

_LETTERS = "".join(random.Random(1).choices(string.ascii_letters, k=300))

_WALL = "{element: wall, action: add, line: [[1, 1], [4, 1]], thickness_m: T}"
ENTRIES = {
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
POINTS = {
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
SYSTEMS = [
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


FEATURES = {
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
YAML = {
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
LISTS = {
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
PATHS = {
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
STOREYS = "storeys: [{dataset: a, elevation_m: 0}, {dataset: b, elevation_m: 3}]\n"
BUILDINGS = {
    "two at one elevation": STOREYS.replace("3}", "0}"),
    "elevation of 1e8 m": STOREYS.replace("3}", "1.0e+8}"),
    "storey of 10,000 characters": STOREYS.replace("3}", f"3, name: {'a' * 10_000}}}"),
    "named thesis": STOREYS + "name: thesis\n",
    "named like a list's words": STOREYS + "name: summary.html\n",
    "+ named like a storey in capitals": STOREYS + "name: A\n",
    "+ named a dot": STOREYS + "name: '.'\n",
    "+ named up": STOREYS + "name: ../x\n",
    "+ named in a list": STOREYS + "name: [a, b]\n",
    "+ named nothing": STOREYS + "name: ''\n",
    "+ 3 mm apart": STOREYS.replace("3}", "0.003}"),
    "+ elevation of NaN": STOREYS.replace("3}", ".nan}"),
    "+ elevation of a truth": STOREYS.replace("3}", "yes}"),
    "+ elevation octal": STOREYS.replace("3}", "010}"),
    "+ turned by 1e300 degrees": STOREYS.replace("3}", "3, building_from_map: [0, 0, 1.0e+300]}"),
    "+ 1e8 m aside": STOREYS.replace("3}", "3, building_from_map: [1.0e+8, 0, 0]}"),
    "+ named read backwards": STOREYS.replace("3}", '3, name: "a\\u202eb"}'),
    "+ dataset up": STOREYS.replace("dataset: b", "dataset: ../b"),
    "+ frame of 5 MB": STOREYS + f"frame: {'a' * 5_000_000}\n",
    "+ frame with a colour code": STOREYS + 'frame: "\\e[31m"\n',
}
DRAWN = {
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
