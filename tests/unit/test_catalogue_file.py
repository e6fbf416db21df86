"""Catalogues of nominal sizes: what they may say, and one line for each mistake."""

import json
import re

import pytest

from helpers.default_settings import SETTINGS
from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.project.catalogue_file import read_catalogue

GOOD = """\
walls: [{name: thin, size_m: 0.08}, {name: thick, size_m: 0.3}]
doors: [{name: leaf, size_m: 1}]
windows: []
facade_m: 0.42
"""


TITLED = "classification: {{system: X, walls: W, doors: D, windows: G, titles: {}}}"


def written(folder, text):
    path = folder / "catalogue.yaml"
    path.write_text(text)
    return path


def test_a_catalogue_gives_sizes_by_name(tmp_path):
    read = read_catalogue(written(tmp_path, GOOD))
    assert read == {
        "is_ours": False,
        "walls": {"thin": 0.08, "thick": 0.3},
        "doors": {"leaf": 1.0},
        "windows": {},
        "facade_m": 0.42,
        "classification": {},
        "codes": {"walls": {}, "doors": {}, "windows": {}},
    }


def test_lists_have_a_code_and_entries_may_have_their_own(tmp_path):
    system = "classification: {system: Ours, walls: W, doors: D, windows: G}\n"
    own = GOOD.replace("size_m: 1}", "size_m: 1, code: D.2}") + system
    # a window of the same name has its own, or none
    own = own.replace("windows: []", "windows: [{name: leaf, size_m: 1}]")
    read = read_catalogue(written(tmp_path, own))
    codes = {"walls": "W", "doors": "D", "windows": "G"}
    assert read["classification"] == {"system": "Ours", **codes, "titles": {}}
    assert read["codes"] == {"walls": {}, "doors": {"leaf": "D.2"}, "windows": {}} and read[
        "doors"
    ] == {"leaf": 1.0}


def test_a_system_may_state_who_publishes_it_its_edition_and_titles(tmp_path):
    stated = {"source": "Us", "edition": "2", "titles": {"W": "Walls", "D.2": "Leaves"}}
    system = {"system": "Ours", "walls": "W", "doors": "D", "windows": "G"} | stated
    text = f"{GOOD}classification: {json.dumps(system)}\n"
    assert read_catalogue(written(tmp_path, text))["classification"] == system


@pytest.mark.parametrize("region", [None, "north_america"])
def test_all_codes_of_ours_have_a_title(region):
    system = read_catalogue(region)["classification"]
    assert system["source"]
    assert {system[kind] for kind in ("walls", "doors", "windows")} == set(system["titles"])


def test_ours_is_read_where_none_is_given():
    ours = read_catalogue(SETTINGS["plan"]["export"]["catalogue"])
    assert ours["walls"] and ours["doors"] and ours["windows"]


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ("facade_m: 0.42\n", "", "facade_m"),
        ("windows: []", "windows: []\nroofs: []", "roofs"),
        ("windows: []", "windows: 3", "windows"),
        ("size_m: 0.08", "size_m: 8", "walls, entry 1"),
        ("size_m: 0.08", "size_m: .nan", "walls, entry 1"),
        ("size_m: 0.08", "size_m: true", "walls, entry 1"),
        ("size_m: 0.08", f"size_m: 1{400 * '0'}", "walls, entry 1"),
        ("size_m: 0.08", "size_m: '0.08'", "walls, entry 1"),
        ("size_m: 0.3", "size_m: 0.08", "walls, entry 2"),
        ("name: thick", "name: thin", "walls, entry 2"),
        ("name: thick", "name: ''", "walls, entry 2"),
        ("size_m: 1}", "size_m: 1, colour: red}", "doors, entry 1"),
        ("[{name: leaf, size_m: 1}]", "[1.0]", "doors, entry 1"),
        ("facade_m: 0.42", "facade_m: 0", "facade_m"),
        ("facade_m: 0.42", "facade_m: 0.42\nclassification: {system: X, walls: W}", "windows"),
        ("facade_m: 0.42", "facade_m: 0.42\nclassification: 3", "classification"),
        ("facade_m: 0.42", f"facade_m: 0.42\n{TITLED.format('W')}", "titles"),
        ("facade_m: 0.42", f"facade_m: 0.42\n{TITLED.format('{W: 3}')}", "titles, W"),
        ("size_m: 1}", "size_m: 1, code: ''}", "doors, entry 1: code"),
    ],
)
def test_a_mistake_is_named_with_file_and_entry(tmp_path, old, new, named):
    path = written(tmp_path, GOOD.replace(old, new, 1))
    with pytest.raises(StageError) as raised:
        read_catalogue(path)
    assert str(path) in str(raised.value) and named in str(raised.value)


def test_an_unknown_key_of_the_classification_is_named_with_those_that_are_known(tmp_path):
    own = "classification: {system: X, walls: W, doors: D, windows: G, colour: red}\n"
    path = written(tmp_path, GOOD + own)
    with refused(file=str(path), key=("colour", "edition", "titles"), remedy="leave it out"):
        read_catalogue(path)


def test_a_catalogue_that_is_not_there_is_told(tmp_path):
    with refused(file="none.yaml"):
        read_catalogue(tmp_path / "none.yaml")


def test_a_region_has_a_catalogue_of_ours():
    read = read_catalogue("north_america")
    # what a name says last it measures, in inches: 5 5/8 in, or 8 in
    for name, size_m in read["walls"].items():
        *_, said = re.findall(r"(?:(\d+) )?(?:(\d+)/(\d+) )?in$", name) or [("", "", "")]
        whole, above, below = (int(part or 0) for part in said)
        inches = whole + above / (below or 1)
        assert size_m == pytest.approx(inches * 0.0254, abs=6e-4), name
    assert read["doors"]["door 3-0"] == pytest.approx(3 * 0.3048, abs=5e-4)
    assert read["classification"]["system"] == "OmniClass"


def test_a_region_that_we_have_not_is_told_with_those_that_we_have():
    with refused(value="atlantis", remedy="north_america"):
        read_catalogue("atlantis")
