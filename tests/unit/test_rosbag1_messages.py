import os

import pytest
from rosbags import rosbag1

from helpers import bag_making
from helpers.refusals import refused
from scanplan.recordings import bags, rosbag1_messages


@pytest.fixture
def recording(tmp_path):
    """Clouds larger and poses smaller than a head, a late connection, more than one chunk."""
    maker = bag_making.Maker()
    entries = bag_making.survey(maker, n_scans=30)
    entries += [
        ("/late", entries[-1][1] + 1, maker.text("x" * 2000)),
        ("/late", entries[-1][1] + 2, maker.text()),
    ]
    path = tmp_path / "run.bag"
    with rosbag1.Writer(path) as writer:
        writer.chunk_threshold = 5_000
        maker._fill(writer, entries, maker.store.serialize_ros1)
    return path


def plain(path, names):
    with bags.open_bag(path) as bag:
        assert bags.is_uncompressed(bag._reader)
        return [
            (c.topic, t_ns, stored.head, stored.read()) for c, t_ns, stored in bag.messages(names)
        ]


@pytest.mark.parametrize(
    "names", [{"/points"}, {"/amcl_pose", "/late"}, {"/points", "/amcl_pose", "/late"}]
)
def test_agrees_with_rosbags(recording, names):
    with rosbag1.Reader(recording) as reader:
        assert len(reader.chunk_infos) > 3
        wanted = [c for c in reader.connections if c.topic in names]
        expected = [(c.topic, t_ns, raw) for c, t_ns, raw in reader.messages(wanted)]
    assert [(topic, t_ns, raw) for topic, t_ns, _, raw in plain(recording, names)] == expected


def test_a_head_is_the_beginning(recording):
    for _, _, head, raw in plain(recording, {"/points", "/late"}):
        assert raw.startswith(head) and (len(head) > 900 or head == raw)


def test_compressed_bags_are_left_to_rosbags(tmp_path):
    maker = bag_making.Maker("ros1_lz4")
    with bags.open_bag(maker.write(tmp_path / "run", bag_making.survey(maker))) as bag:
        assert not bags.is_uncompressed(bag._reader)


def test_an_index_that_leads_astray(recording):
    data = bytearray(recording.read_bytes())
    with rosbag1.Reader(recording) as reader:
        points = next(c for c in reader.connections if c.topic == "/points")
        entry = reader.indexes[points.id][5]
        place = reader.chunks[entry.chunk_pos].datapos + entry.offset
    at = data.index(b"op=", place) + 3
    data[at] = 9
    recording.write_bytes(data)
    with refused(file="run.bag", value="the index"):
        plain(recording, {"/points"})


def test_a_message_larger_than_its_chunk(recording):
    data = bytearray(recording.read_bytes())
    with rosbag1.Reader(recording) as reader:
        points = next(c for c in reader.connections if c.topic == "/points")
        entry = reader.indexes[points.id][5]
        place = reader.chunks[entry.chunk_pos].datapos + entry.offset
    size = int.from_bytes(data[place : place + 4], "little")
    data[place + 4 + size : place + 8 + size] = (10**9).to_bytes(4, "little")
    recording.write_bytes(data)
    with refused(value="1000000000 bytes"):
        plain(recording, {"/points"})


def test_a_message_that_the_file_does_not_hold(tmp_path):
    path = tmp_path / "short"
    path.write_bytes(b"abc")
    with path.open("rb") as file, pytest.raises(ValueError, match=r"5 bytes .* 3"):
        rosbag1_messages.StoredMessage(file.fileno(), 0, 5, b"").read()


@pytest.mark.parametrize("n_unread", [0, 1, 17, 100])
def test_what_is_not_wanted_at_the_beginning_is_not_read(recording, monkeypatch, n_unread):
    names = {"/points", "/amcl_pose"}
    whole = plain(recording, names)
    n_read = 0
    pread = os.pread

    def counted(*place):
        nonlocal n_read
        n_read += 1
        return pread(*place)

    monkeypatch.setattr(os, "pread", counted)
    with bags.open_bag(recording) as bag:
        found = list(bag.messages(names, n_unread=n_unread))
        assert [(c.topic, t_ns) for c, t_ns, _ in found] == [item[:2] for item in whole]
        assert [raw for _, _, raw in found[:n_unread]] == [b""] * min(n_unread, len(whole))
        assert [raw.read() for _, _, raw in found[n_unread:]] == [i[3] for i in whole[n_unread:]]
    assert (n_read == 0) == (n_unread >= len(whole))
