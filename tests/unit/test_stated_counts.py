"""Recordings that state more than can be read of them are refused."""

import bz2
import sqlite3
import struct
from pathlib import Path

import lz4.frame
import numpy as np
import pytest
from backports import zstd
from rosbags import rosbag1
from rosbags.rosbag2 import storage_mcap

from helpers import bag_making
from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.recordings import bags
from scanplan.recordings.integrity import unpacking

TOPICS = {"/amcl_pose": 61, "/points": 30}


def written(tmp_path, kind, *, alone=False):
    maker = bag_making.Maker(kind)
    path = maker.write(tmp_path / "run", bag_making.survey(maker, n_scans=30))
    return next(path.glob("*.mcap")) if alone else path


def count_messages(path):
    with bags.open_bag(path) as bag:
        names = {topic.name for topic in bag.topics} & TOPICS.keys()
        came = [connection.topic for connection, _, _ in bag.messages(names)]
    return {name: came.count(name) for name in names}


def flip(path, place, bit):
    content = bytearray(path.read_bytes())
    content[place] ^= 1 << bit
    path.write_bytes(bytes(content))


@pytest.mark.parametrize("kind", ["mcap", "mcap_zstd"])
def test_no_bit_of_an_mcap_loses_messages_in_silence(tmp_path, kind):
    """Bits of the summary and, where it is not packed, of the messages, over all of the file."""
    path = written(tmp_path, kind, alone=True)
    whole = path.read_bytes()
    rng = np.random.default_rng(17)
    told = 0
    for place in rng.choice(np.arange(len(whole) // 4, len(whole)), 250, replace=False):
        flip(path, place, rng.integers(8))
        try:
            # a name that changed is another topic, which lacks when it is looked for
            came = count_messages(path)
            assert all(number >= TOPICS[name] for name, number in came.items())
        except StageError:
            told += 1
        path.write_bytes(whole)
    assert 0 < told < 250


def test_a_chunk_that_the_index_has_lost_is_missed(tmp_path):
    maker = bag_making.Maker("mcap")
    large = np.ones((5000, 3), np.float32)  # 60 kB each: 30 of them need two chunks of 1 MB
    entries = [
        (name, t_ns, maker.cloud(t_ns, large) if name == "/points" else message)
        for name, t_ns, message in bag_making.survey(maker, n_scans=30)
    ]
    path = next(maker.write(tmp_path / "run", entries).glob("*.mcap"))
    assert count_messages(path) == TOPICS
    content = path.read_bytes()
    (summary,) = struct.unpack_from("<Q", content, len(content) - 28)
    # after the summary begins: the record of a chunk's index is turned into one nobody knows
    place = summary
    while content[place] != 0x08:
        place += 9 + struct.unpack_from("<Q", content, place + 1)[0]
    flip(path, place, 7)
    with pytest.raises(StageError, match=r"run.mcap: topic .* of its (61|30) messages.*mcap recov"):
        count_messages(path)


def test_a_summary_with_a_wrong_checksum_is_refused(tmp_path):
    path = written(tmp_path, "mcap", alone=True)
    content = path.read_bytes()
    path.write_bytes(content[:-12] + b"\1\2\3\4" + content[-8:])
    with refused(file="run.mcap", value="checksum"):
        count_messages(path)


def test_messages_that_a_database_lacks_are_missed(tmp_path):
    path = written(tmp_path, "sqlite3")
    with sqlite3.connect(next(path.glob("*.db3"))) as database:
        database.execute("DELETE FROM messages WHERE id % 2")
    with pytest.raises(StageError, match=r"topic .* of its .* messages .*sqlite3 FILE .recover"):
        count_messages(path)


def test_messages_that_a_ros1_index_lacks_are_missed(tmp_path):
    path = written(tmp_path, "ros1")
    content = bytearray(path.read_bytes())
    with rosbag1.Reader(path) as reader:
        clouds = next(c.id for c in reader.connections if c.topic == "/points")
        counts = reader.chunk_infos[0].connection_counts
    record = b"".join(struct.pack("<II", *pair) for pair in counts.items())
    place = content.rindex(record)
    place += 8 * list(counts).index(clouds) + 4
    content[place : place + 4] = struct.pack("<I", counts[clouds] + 7)
    path.write_bytes(bytes(content))
    with pytest.raises(StageError, match=r"topic /points: 30 of its 37 .*rosbag reindex"):
        count_messages(path)


def test_a_bag_behind_another_is_told(tmp_path):
    path = written(tmp_path, "ros1")
    content = path.read_bytes()
    with bags.open_bag(path) as bag:
        assert bag.describe_loss() == ""
    path.write_bytes(2 * content)
    with bags.open_bag(path) as bag:
        assert f"{len(content):,} bytes behind" in bag.describe_loss()
        assert "a file of its own" in bag.describe_loss()
    assert count_messages(path) == TOPICS


def test_a_file_of_nothing_is_refused_whatever_its_size(tmp_path):
    path = tmp_path / "x.bag"
    with path.open("wb") as file:
        file.truncate(2**40)
    with pytest.raises(StageError, match=r"x.bag: .*overwritten"), bags.open_bag(path):
        pass


def test_the_remedy_of_an_mcap_in_a_folder_is_that_of_an_mcap(tmp_path):
    path = written(tmp_path, "mcap")
    storage = next(path.glob("*.mcap"))
    storage.write_bytes(storage.read_bytes()[:-10])
    with pytest.raises(StageError, match="mcap recover"):
        count_messages(path)


PACKED = {"bz2": bz2.compress, "lz4": lz4.frame.compress, "zstd": zstd.compress}


@pytest.mark.parametrize("form", PACKED)
def test_what_unpacks_as_stated_comes_whole(form):
    data = np.random.default_rng(3).bytes(100_000) + bytes(400_000)
    packed = PACKED[form](data)
    assert unpacking.unpack_bytes(packed, len(data), form=form) == data
    assert unpacking.unpack_bytes(packed, form=form) == data
    twice = unpacking.unpack_bytes(packed + packed, 2 * len(data), form=form)
    assert twice == data + data


@pytest.mark.parametrize("form", PACKED)
@pytest.mark.parametrize("size", [999, 1001, 10**12])
def test_what_unpacks_to_another_size_is_refused(form, size):
    with pytest.raises(ValueError, match="unpack to"):
        unpacking.unpack_bytes(PACKED[form](bytes(1000)), size, form=form)


@pytest.mark.parametrize("form", PACKED)
def test_what_is_cut_short_is_refused(form):
    packed = PACKED[form](np.random.default_rng(3).bytes(1000))
    with pytest.raises(ValueError, match=r"cut short|unpack to"):
        unpacking.unpack_bytes(packed[:-20], 1000, form=form)


@pytest.mark.parametrize("form", PACKED)
def test_a_bomb_is_not_unpacked(form, monkeypatch):
    monkeypatch.setattr(unpacking, "MOST_UNPACKED_BYTES", 10**6)
    with pytest.raises(ValueError, match="more than 1000000"):
        unpacking.unpack_bytes(PACKED[form](bytes(10**7)), form=form)


@pytest.mark.parametrize("kind", ["ros1_bz2", "ros1_lz4"])
def test_a_chunk_larger_than_stated_is_refused(tmp_path, kind):
    path = written(tmp_path, kind)
    with rosbag1.Reader(path) as reader:
        chunk = next(iter(reader.chunks.values()))
    bomb = PACKED[kind.split("_")[1]](bytes(10**6))
    content = bytearray(path.read_bytes())
    content[chunk.datapos : chunk.datapos + len(bomb)] = bomb
    path.write_bytes(bytes(content))
    with refused(file=path.name, value="unpack to"):
        count_messages(path)


def test_a_compressed_message_is_bounded(tmp_path, monkeypatch):
    path = written(tmp_path, "sqlite3_message")
    assert count_messages(path) == TOPICS
    monkeypatch.setattr(unpacking, "MOST_UNPACKED_BYTES", 500)
    with refused(value=500):
        count_messages(path)


def test_a_file_that_unpacks_to_more_than_fits_is_refused(tmp_path):
    path = written(tmp_path, "sqlite3_file")
    packed = next(path.glob("*.zstd"))
    # a frame of zstd that states 2^60 bytes in the eight behind its descriptor
    packed.write_bytes(b"\x28\xb5\x2f\xfd\xe0" + struct.pack("<Q", 2**60) + b"\1\0\0")
    with pytest.raises(StageError, match=r"unpacks to 1152921504.6 GB.*set TMPDIR"):
        count_messages(path)


def test_mcap_files_are_unpacked_within_their_bounds():
    with pytest.raises(ValueError, match="more than 1000"):
        storage_mcap.decompress(zstd.compress(bytes(10**6)), "zstd", 1000, 0)


def test_the_size_of_a_file_without_a_frame_is_not_known(tmp_path):
    Path(tmp_path, "run.db3.zstd").write_bytes(b"no frame")
    unpacking.check_room(tmp_path)
