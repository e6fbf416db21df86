"""Files that a person writes: what is no file is not opened, what is too large not read."""

import pytest

from helpers import odd_files
from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.project.user_file import find_file, read_text
from scanplan.project.yaml_file import read_yaml


@pytest.mark.parametrize(
    ("put", "said"),
    [
        (odd_files.put_pipe, "is a pipe, expected a file"),
        (odd_files.put_device, "is a device, expected a file"),
        (odd_files.put_socket, "is a socket, expected a file"),
        (odd_files.put_folder, "is a folder, expected a file"),
        (odd_files.put_lost_link, "is a link that leads nowhere"),
        (odd_files.put_loop, "cannot be read (Too many levels of symbolic links)"),
    ],
)
def test_what_is_no_file_is_told_and_not_opened(tmp_path, put, said):
    path = tmp_path / "dataset.yaml"
    put(path)
    for read in (find_file, read_text):
        with pytest.raises(StageError) as told:
            read(path, "write one")
        assert str(told.value) == f"{path}: {said}; write one"
    with pytest.raises(StageError) as told:
        read_yaml(path)
    assert said in str(told.value)


def test_a_file_is_found_where_there_is_one(tmp_path):
    path = tmp_path / "dataset.yaml"
    assert find_file(path, "") is None
    with refused(file="dataset.yaml", remedy="write one"):
        read_text(path, "write one")
    path.write_text("a: ü")
    (tmp_path / "link").symlink_to(path)
    assert find_file(tmp_path / "link", "") == tmp_path / "link"
    assert read_text(tmp_path / "link", "") == "a: ü"


def test_a_file_larger_than_people_write_is_not_read(tmp_path):
    path = tmp_path / "dataset.yaml"
    path.write_text("a: 1\n" * 10)
    assert read_text(path, "", most_bytes=50)
    with refused(value=("50 bytes", "most 49")):
        read_text(path, "", most_bytes=49)
    path.write_text("".join(f"k{i}: 1\n" for i in range(10**6)))
    with pytest.raises(StageError, match=r"at most 262,144 are read"):
        read_yaml(path)


def test_a_byte_order_mark_is_no_part_of_a_text(tmp_path):
    path = tmp_path / "dataset.yaml"
    path.write_text("poses: {keep_every: 3}", encoding="utf-8-sig")
    assert read_yaml(path) == {"poses": {"keep_every": 3}}
