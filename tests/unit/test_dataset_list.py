"""Many datasets, listed in a file."""

import os

import pytest

from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.project.dataset import list_floors, name_datasets
from scanplan.project.dataset_list import is_list, read_floors, read_list


def write(tmp_path, text):
    file = tmp_path / "floors.tsv"
    file.write_text(text, encoding="utf-8")
    return str(file)


def test_names_and_paths_in_the_order_of_the_file(tmp_path):
    text = "path\tname\tstorey\nb/scans\tfirst\t1\na/level_2\t\t2\n"
    assert read_list(write(tmp_path, text)) == [("first", "b/scans"), ("level_2", "a/level_2")]


def test_a_list_stands_among_other_datasets(tmp_path):
    file = write(tmp_path, "path\none\ntwo\n")
    assert name_datasets(["zero", file]) == {"zero": "zero", "one": "one", "two": "two"}
    assert name_datasets(file) == {"one": "one", "two": "two"}


def test_surveys_of_one_floor_are_together_in_the_order_of_the_file(tmp_path):
    file = write(tmp_path, "path\tfloor\nmay\tground\nhall\t\njune\t ground \n")
    assert read_floors(file) == {"may": "ground", "hall": "hall", "june": "ground"}
    assert list_floors(file) == {"ground": ["may", "june"], "hall": ["hall"]}
    # what no list states is a floor of its own
    assert list_floors(["attic", file]) == {
        **{"attic": ["attic"], "ground": ["may", "june"]},
        "hall": ["hall"],
    }
    assert list_floors(None) == {"demo": ["demo"]}


def test_a_folder_is_no_list(tmp_path):
    (tmp_path / "survey.tsv").mkdir()
    assert not is_list(tmp_path / "survey.tsv")


def test_a_byte_order_mark_is_no_part_of_a_name(tmp_path):
    file = tmp_path / "floors.tsv"
    file.write_text("path\nhall\n", encoding="utf-8-sig")
    assert read_list(file) == [("hall", "hall")]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "its first line names nothing; name the columns name and path"),
        ("name,path\na,b\n", "its first line names name,path"),
        ("path\n", "lists no dataset"),
        ("path\tname\na\t../b\n", "line 2: '../b' names no results"),
        ("name\tpath\na\t\n", "line 2: has no path"),
        ("name\tpath\nx\ta\nx\tb\n", "b: its results would be called x like those of a"),
        ("name\tpath\nX\ta\nx\tb\n", "b: its results would be called x like those of a, case of"),
        ("name\tpath\nthesis\ta\n", "a: thesis is a target .*; choose another name"),
        ("name\tpath\nThesis\ta\n", "a: Thesis is a target"),
        ("name\tpath\nsummary.html\ta\n", "a: summary.html is a target"),
        ("name\tpath\nfloors.csv\ta\n", "a: floors.csv is a target"),
        ("path\tfloor\tfloor\na\tb\tc\n", "names the column floor 2 times; keep one"),
        ("path\nfloors/all\n", "floors/all: all is a target"),
        ("path\tpath\na\tb\n", "names the column path 2 times; keep one"),
        ("name\tpath\tname\nx\ta\ty\n", "names the column name 2 times; keep one"),
        ("path\n" + "a/" * 2500 + "b\n", "is a path of 5001 bytes, at most 4095"),
        ("name\tpath\nx\t" + "a" * 300 + "\n", "is a name of 300 bytes, at most 255"),
        ("path\na\x1b[31mb\n", r"has '\\x1b' in its name; rename it"),
    ],
)
def test_what_says_too_little_is_refused(tmp_path, text, said):
    with pytest.raises(StageError, match=said.replace("(", "\\(")):
        name_datasets(write(tmp_path, text))


def test_a_missing_list_is_told(tmp_path):
    with refused(file="none.tsv"):
        name_datasets(str(tmp_path / "none.tsv"))


def test_a_path_with_nul_is_told():
    with refused(value=("a\\x00b", "\\x00")):
        name_datasets(["a\0b"])


def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "floors.tsv")
    with refused(file="floors.tsv", value="a pipe"):
        name_datasets(str(tmp_path / "floors.tsv"))


def test_bytes_that_are_no_text_are_told(tmp_path):
    file = tmp_path / "floors.tsv"
    file.write_bytes(b"path\n\xff\xfe\n")
    with refused(value="UTF-8"):
        name_datasets(str(file))
