"""Many datasets, listed in a file."""

import pytest

from scanplan.errors import StageError
from scanplan.project.dataset import name_datasets
from scanplan.project.dataset_list import is_list, read_list


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
        ("name\tpath\nthesis\ta\n", "rename the dataset"),
    ],
)
def test_what_says_too_little_is_refused(tmp_path, text, said):
    with pytest.raises(StageError, match=said.replace("(", "\\(")):
        name_datasets(write(tmp_path, text))


def test_a_missing_list_is_told(tmp_path):
    with pytest.raises(StageError, match="No such file"):
        name_datasets(str(tmp_path / "none.tsv"))


def test_bytes_that_are_no_text_are_told(tmp_path):
    file = tmp_path / "floors.tsv"
    file.write_bytes(b"path\n\xff\xfe\n")
    with pytest.raises(StageError, match="no text in UTF-8"):
        name_datasets(str(file))
