"""SQLite opens no file with a path above its limit, which is told before it is tried."""

import sqlite3
from contextlib import closing

import pytest

from helpers import bag_making
from helpers.refusals import refused
from scanplan.recordings import bags
from scanplan.store import sqlite_paths


def place(folder, length, name="a.db3"):
    """Return a file whose whole path has so many characters."""
    rest = length - len(str(folder.resolve())) - len(name) - 2
    while rest > 200:
        folder /= "x" * 100
        rest -= 101
    folder /= "y" * rest
    folder.mkdir(parents=True)
    return folder / name


def test_the_limit_is_sqlites_own(tmp_path):
    longest = place(tmp_path / "a", sqlite_paths.LONGEST)
    with closing(sqlite3.connect(longest)) as file:
        file.execute("CREATE TABLE a (b)")
    sqlite_paths.check_sqlite_path(longest, "")
    longer = place(tmp_path / "b", sqlite_paths.LONGEST + 1)
    with pytest.raises(sqlite3.OperationalError, match="unable to open"):
        sqlite3.connect(longer)
    with refused(file="a.db3", value="505 bytes"):
        sqlite_paths.check_sqlite_path(longer, "leave it")


def test_a_recording_with_too_long_a_path_is_told(tmp_path):
    maker = bag_making.Maker("sqlite3")
    recording = maker.write(tmp_path / "run", bag_making.survey(maker, n_scans=3))
    moved = recording.rename(place(tmp_path, 520).parent / "run")
    with (
        refused(value="whole path", remedy="move the"),
        bags.open_bag(moved),
    ):
        pass
