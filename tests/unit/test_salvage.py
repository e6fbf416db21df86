"""Salvage reads every message that is whole of a damaged recording, and makes none up."""

import re
import struct
from binascii import crc32

import numpy as np
import pytest

from faults import damaged_bags
from helpers import bag_making
from helpers.refusals import assert_told
from scanplan.errors import StageError
from scanplan.recordings import bags
from scanplan.recordings.integrity import unpacking
from scanplan.recordings.salvage import salvaged_reader
from scanplan.recordings.survey import Reading, open_survey


def written(tmp_path, kind, n_scans=10):
    maker = bag_making.Maker(kind)
    return maker.write(tmp_path / "run", bag_making.survey(maker, n_scans=n_scans))


def storage_of(path):
    return path if path.is_file() else next(f for f in path.iterdir() if f.suffix != ".yaml")


@pytest.mark.parametrize("kind", bag_making.KINDS)
def test_of_a_sound_recording_all_is_read_and_nothing_is_lost(tmp_path, kind):
    path = written(tmp_path, kind)
    found, loss = damaged_bags.read_salvaged(path)
    with bags.open_bag(path) as bag:
        names = {topic.name for topic in bag.topics}
        items = bag.messages(names)
        sound = [
            (c.topic, t_ns, raw if isinstance(raw, bytes) else raw.read()) for c, t_ns, raw in items
        ]
    assert found == sound and loss == ""


@pytest.mark.parametrize("kind", damaged_bags.FORMATS)
def test_all_whole_messages_are_recovered_and_none_is_invented(tmp_path, kind):
    bag = damaged_bags.DamagedBag(tmp_path, kind, n_scans=40)
    outcomes = [bag.try_salvage(seed) for seed in range(20)]
    assert sum(o.whole for o in outcomes) > 20 * 20
    assert [o for o in outcomes if o.missed or o.invented or o.untold] == []
    # one place is damaged: without checksums at most the message that lies there differs, and
    # what 40 kB reach of its neighbours
    assert max(o.altered for o in outcomes) <= 3


@pytest.mark.parametrize("kind", bag_making.KINDS)
def test_what_is_cut_off_is_counted_by_topic_and_time(tmp_path, kind):
    path = written(tmp_path, kind, n_scans=40)
    storage = storage_of(path)
    content = storage.read_bytes()
    storage.write_bytes(content[: len(content) // 2])
    if kind.endswith(("bz2", "lz4", "zstd", "file")):
        with bags.open_bag(path, salvage=True) as bag:  # all lies in one chunk
            assert bag.describe_loss()
        return
    with pytest.raises(StageError, match=r"input\.salvage: true"), bags.open_bag(path) as bag:
        list(bag.messages({"/points", "/amcl_pose"}))
    found, loss = damaged_bags.read_salvaged(path)
    assert 0 < len(found) < 121
    assert_told(loss, value=("damaged recording", "its end"))
    if path.is_dir():  # metadata.yaml states how many there were
        n_points = sum(topic == "/points" for topic, _, _ in found)
        assert f"{40 - n_points} of 40 of /points" in loss


def test_the_chunk_that_fails_its_checksum_is_left_out_alone(tmp_path):
    """Of three chunks of bz2, which has checksums of its own, the second is hit."""
    bag = damaged_bags.DamagedBag(tmp_path, "ros1_bz2", n_scans=100)
    content = bytearray(bag.sound)
    second = sorted({message.part for message in bag.found})[1]
    content[(second.begin + second.end) // 2] ^= 1
    bag.file.write_bytes(content)
    found, loss = damaged_bags.read_salvaged(bag.recording)
    held = set(bag.messages)
    assert set(found) < held and len(found) >= 100
    lost = [t_ns for topic, t_ns, _ in held - set(found)]
    first, last = ((t - bag_making.START_NS + 50_000_000) / 1e9 for t in (min(lost), max(lost)))
    n_points = sum(topic == "/points" for topic, _, _ in held - set(found))
    assert f"{n_points} of 100 of /points" in loss
    said = re.findall(r"(\d+\.\d) s", loss)
    assert float(said[0]) <= first and float(said[-1]) >= last - 0.05


def test_messages_that_cannot_be_decoded_count_as_lost(tmp_path):
    path = written(tmp_path, "ros1")
    content = path.read_bytes()
    # the number of fields of the fourth cloud, before the name of the first of them
    place = -1
    for _ in range(4):
        place = content.index(b"\x01\0\0\0x\0\0\0\0", place + 1)
    path.write_bytes(content[: place - 4] + b"\xff\xff\xff\x7f" + content[place:])
    found, loss = damaged_bags.read_salvaged(path)
    assert sum(topic == "/points" for topic, _, _ in found) == 9
    assert "1 of 10 of /points" in loss


@pytest.mark.parametrize(
    ("kind", "is_told"), [("ros1", True), ("ros1_bz2", False), ("mcap", True), ("sqlite3", True)]
)
def test_that_a_message_may_be_altered_is_told_where_no_checksum_shows_it(tmp_path, kind, is_told):
    path = written(tmp_path, kind, n_scans=40)
    storage = storage_of(path)
    storage.write_bytes(storage.read_bytes()[:-300])
    loss = damaged_bags.read_salvaged(path)[1]
    assert_told(loss, value="damaged recording")
    assert loss.endswith("altered") == is_told


@pytest.mark.parametrize("compression", ["", "zstd"])
@pytest.mark.parametrize("has_checksum", [True, False])
def test_chunks_with_a_checksum_are_known_to_be_unaltered(tmp_path, compression, has_checksum):
    path = written(tmp_path, "mcap_zstd" if compression else "mcap", n_scans=10)
    storage = storage_of(path)
    content = bytearray(storage.read_bytes())
    place = content.index(b"\x06", 8)
    head = struct.Struct("<BQQQQII")
    *_, checksum, length = head.unpack_from(content, place)
    assert checksum == 0 and length == len(compression)
    inner = place + head.size + length + 8
    (size,) = struct.unpack_from("<Q", content, inner - 8)
    if has_checksum:
        packed = bytes(content[inner : inner + size])
        records = unpacking.unpack_bytes(packed, form="zstd") if compression else packed
        struct.pack_into("<I", content, place + head.size - 8, crc32(records))
    storage.write_bytes(content)
    assert salvaged_reader.find_records(storage).is_checked == has_checksum


def test_a_survey_says_what_of_it_is_lost(tmp_path):
    path = written(tmp_path, "sqlite3", n_scans=40)
    storage = storage_of(path)
    storage.write_bytes(storage.read_bytes()[:-20_000])
    with open_survey([str(path / "metadata.yaml")], Reading(salvage=True)) as survey:
        assert 10 < len(survey.stamps()) < 40
        (sentence,) = survey.describe_damage()
    assert_told(sentence, value="damaged recording")


def clouds_with_damage(maker, n_scans, n_damaged):
    """Entries of a survey; the first clouds after the tenth state more points than they have."""
    entries = list(bag_making.survey(maker, n_scans=n_scans))
    clouds = [i for i, entry in enumerate(entries) if entry[0] == "/points"]
    for i in clouds[10 : 10 + n_damaged]:
        topic, t_ns, _ = entries[i]
        entries[i] = topic, t_ns, maker.cloud(t_ns, bag_making.room_points(), width=10**6)
    return entries


def test_few_damaged_clouds_are_left_out_and_counted(tmp_path):
    maker = bag_making.Maker()
    path = maker.write(tmp_path / "run", clouds_with_damage(maker, 40, 2))
    with open_survey([str(path)], Reading(max_damaged_share=0.05)) as survey:
        sizes = [len(scan.xyz_m) for scan in survey.scans(range(40))]
        assert_told(*survey.describe_damage(), value="2 of 40 scans")
    assert [i for i, size in enumerate(sizes) if size == 0] == [10, 11]


def test_too_many_damaged_clouds_are_a_fault_of_the_recording(tmp_path):
    maker = bag_making.Maker()
    path = maker.write(tmp_path / "run", clouds_with_damage(maker, 40, 3))
    said = r"scan 12 .*3 of 40 scans are damaged so far, more than advanced.input.max_damaged_share"
    reading = open_survey([str(path)], Reading(max_damaged_share=0.05))
    with reading as survey, pytest.raises(StageError, match=said):
        list(survey.scans(range(40)))


def test_noise_has_no_messages(tmp_path):
    for name in ("run.bag", "run.mcap", "run.db3"):
        path = tmp_path / name
        path.write_bytes(np.random.default_rng(5).bytes(100_000))
        found, loss = damaged_bags.read_salvaged(path)
        assert found == []
    assert_told(loss, value="damaged recording")
