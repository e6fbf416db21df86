import re
import struct

import pytest

from helpers import bag_making
from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.recordings import bags

KINDS = bag_making.KINDS


def simple(maker, n=30):
    """Clouds and poses, enough bytes for several chunks."""
    entries = bag_making.survey(maker, n_scans=n)
    return [*entries, ("/chatter", bag_making.START_NS, maker.text("x" * 100))]


@pytest.fixture
def recording(tmp_path, request):
    maker = bag_making.Maker(request.param)
    return maker.write(tmp_path / "with space" / "run", simple(maker))


def read_all(path, names=("/points", "/amcl_pose"), **settings):
    with bags.open_bag(path, **settings) as bag:
        return [bag.decode(connection, raw) for connection, _, raw in bag.messages(set(names))]


def storage_of(path):
    return (
        path if path.is_file() else next(file for file in path.iterdir() if file.suffix != ".yaml")
    )


@pytest.mark.parametrize("recording", KINDS, indirect=True)
def test_every_kind_reads(recording):
    with bags.open_bag(recording) as bag:
        assert bag.start_ns == bag_making.START_NS - 50_000_000
        assert sorted((t.name, t.count) for t in bag.topics) == [
            ("/amcl_pose", 61),
            ("/chatter", 1),
            ("/points", 30),
        ]
        got = [
            (c.topic, bag.header(c, raw), bag.decode(c, raw))
            for c, _, raw in bag.messages({"/points"})
        ]
    assert {topic for topic, _, _ in got} == {"/points"}
    assert [header for _, header, _ in got] == [
        (bag_making.START_NS + i * 10**8, "lidar") for i in range(30)
    ]
    assert all(message.width == 60 and message.header.frame_id == "lidar" for _, _, message in got)


def test_no_topic_asked_for_is_no_message(tmp_path):
    maker = bag_making.Maker()
    assert read_all(maker.write(tmp_path / "run", simple(maker)), ["/nothing"]) == []


@pytest.mark.parametrize("recording", ["sqlite3", "mcap"], indirect=True)
def test_a_storage_file_alone(recording, tmp_path):
    alone = tmp_path / storage_of(recording).name
    storage_of(recording).rename(alone)
    assert len(read_all(alone)) == 91


@pytest.mark.parametrize("folder", ["100% #1?", "a%20b"])
@pytest.mark.parametrize("kind", ["ros1", "sqlite3", "mcap"])
def test_names_that_mean_something_in_a_uri(tmp_path, folder, kind):
    maker = bag_making.Maker(kind)
    path = maker.write(tmp_path / "plain", simple(maker))
    (tmp_path / folder).mkdir()
    path = path.rename(tmp_path / folder / path.name)
    assert len(read_all(path)) == 91


def test_files_of_a_rosbag2_folder_named_so(tmp_path):
    maker = bag_making.Maker("sqlite3")
    folder = maker.write(tmp_path / "run", simple(maker))
    odd = storage_of(folder).rename(folder / "odd#name.db3")
    assert len(read_all(odd)) == 91
    metadata = folder / "metadata.yaml"
    metadata.write_text(metadata.read_text().replace("run.db3", "'odd#name.db3'"))
    with pytest.raises(StageError, match=r"odd#name.db3: .* rename it"):
        read_all(folder)


def cut(path, share):
    path.write_bytes(path.read_bytes()[: int(path.stat().st_size * share)])


def cut_tail(path):
    path.write_bytes(path.read_bytes()[:-10])


def no_index(path):
    data = path.read_bytes()
    at = data.index(b"index_pos=") + 10
    path.write_bytes(data[:at] + struct.pack("<Q", 0) + data[at + 8 :])


def scramble(path):
    data = bytearray(path.read_bytes())
    middle = len(data) // 3
    data[middle : middle + 400] = b"\xa5" * 400
    path.write_bytes(bytes(data))


def text(path):
    path.write_text("no recording at all\n" * 20)


def overwrite_head(path):
    path.write_bytes(bytes(64) + path.read_bytes()[64:])


def zero_index_record(path):
    data = path.read_bytes()
    begin = data.index(b"op=\x04") - 8
    path.write_bytes(data[:begin] + bytes(60) + data[begin + 60 :])


def zero_connection(path):
    data = path.read_bytes()
    begin = data.rindex(b"op=\x07") - 8
    path.write_bytes(data[:begin] + bytes(60) + data[begin + 60 :])


def miscount_index(path):
    data = path.read_bytes()
    at = data.rindex(b"count=", 0, data.rindex(b"op=\x04") + 60) + 6
    path.write_bytes(data[:at] + struct.pack("<I", 12345) + data[at + 4 :])


def empty(path):
    path.write_bytes(b"")


@pytest.mark.parametrize(
    ("recording", "damage", "fault", "remedy"),
    [
        ("ros1", lambda p: cut(p, 0.5), "it is cut off: it has ", "rosbag reindex"),
        ("ros1", cut_tail, "its index is damaged", "rosbag reindex"),
        ("ros1", no_index, "its index is missing", "rosbag reindex"),
        ("ros1", overwrite_head, "its beginning is overwritten", "rosbag reindex"),
        ("ros1", zero_index_record, "its index is damaged", "rosbag reindex"),
        ("ros1", zero_connection, "its index is damaged", "rosbag reindex"),
        ("ros1", miscount_index, "its index is damaged", "rosbag reindex"),
        ("ros1", empty, "it is empty", "copy it again"),
        ("ros1", text, "but text that begins with", "copy it again"),
        ("ros1_lz4", scramble, "some of its messages are damaged", "rosbag reindex"),
        ("ros1_bz2", scramble, "some of its messages are damaged", "rosbag reindex"),
        ("mcap", lambda p: cut(p, 0.5), "its end is missing", "mcap recover"),
        ("mcap", cut_tail, "its end is missing", "mcap recover"),
        ("mcap", overwrite_head, "its beginning is overwritten", "mcap recover"),
        ("mcap", empty, "it is empty", "mcap recover"),
        ("mcap", text, "but text that begins with", "copy it again"),
        ("mcap_zstd", scramble, "some of its messages are damaged", "mcap recover"),
        ("sqlite3", lambda p: cut(p, 0.5), "it is cut off: it has ", "sqlite3 FILE .recover"),
        ("sqlite3", overwrite_head, "its beginning is overwritten", "ros2 bag reindex"),
        ("sqlite3", empty, "it is empty", "copy it again"),
        ("sqlite3", text, "but text that begins with", "copy it again"),
        ("sqlite3_message", scramble, "is damaged", "sqlite3 FILE .recover"),
        ("sqlite3_file", scramble, "is damaged", "sqlite3 FILE .recover"),
        ("sqlite3_file", empty, "it is cut off", "sqlite3 FILE .recover"),
    ],
    indirect=["recording"],
)
def test_damage_is_told_in_one_line_of_plain_words(recording, damage, fault, remedy):
    storage = storage_of(recording)
    damage(storage)
    target = storage if storage.suffix == ".mcap" else recording
    with pytest.raises(StageError, match=remedy) as caught:
        read_all(target)
    told = str(caught.value)
    assert str(target) in told
    assert fault in told
    assert "\n" not in told
    assert not re.search(r"\w(Error|Exception)\b", told)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("rosbag2_bagfile_information:\n  version: 5\n", "metadata key is missing"),
        ("rosbag2_bagfile_information: !!python/object/apply:os.getcwd []\n", "cannot be read"),
        ("a: [", "YAML"),
    ],
)
def test_bad_metadata(tmp_path, content, told):
    maker = bag_making.Maker("sqlite3")
    path = maker.write(tmp_path / "run", simple(maker))
    (path / "metadata.yaml").write_text(content)
    with pytest.raises(StageError, match=told):
        read_all(path)


def test_missing_storage_file(tmp_path):
    maker = bag_making.Maker("sqlite3")
    path = maker.write(tmp_path / "run", simple(maker))
    storage_of(path).unlink()
    with pytest.raises(StageError, match="missing"):
        read_all(path)


def test_mcap_of_another_profile(tmp_path):
    maker = bag_making.Maker("mcap")
    path = storage_of(maker.write(tmp_path / "run", simple(maker)))
    path.write_bytes(path.read_bytes().replace(b"\x04\0\0\0ros2", b"\x04\0\0\0ros1", 1))
    with pytest.raises(StageError, match="profile"):
        read_all(path)


def test_a_bad_definition_on_another_topic_does_not_matter(tmp_path):
    maker = bag_making.Maker("ros1")
    path = maker.write(tmp_path / "run", simple(maker))
    data, good = path.read_bytes(), b"message_definition=string data\n"
    assert good in data
    path.write_bytes(data.replace(good, b"message_definition=$$$$$$ %%%%\n"))
    assert len(read_all(path)) == 91


def test_a_bad_definition_of_a_needed_topic_falls_back_to_the_standard(tmp_path):
    maker = bag_making.Maker("ros1")
    path = maker.write(tmp_path / "run", simple(maker))
    data, good = path.read_bytes(), b"bool is_bigendian\n"
    path.write_bytes(data.replace(good, b"bool &&_bigendian\n"))
    assert len(read_all(path)) == 91


def test_a_connection_is_decoded_by_its_own_definition(tmp_path):
    maker = bag_making.Maker("ros1")
    definition = (
        "uint8 version\ngeometry_msgs/Point position\n"
        + "=" * 80
        + "\nMSG: geometry_msgs/Point\nfloat32 x\n"
    )
    path = tmp_path / "own.bag"
    with bags.rosbag1.Writer(path) as writer:
        connection = writer.add_connection(
            "/pose", "geometry_msgs/msg/PoseStamped", msgdef=definition, md5sum="0" * 32
        )
        writer.write(connection, 1, struct.pack("<Bf", 9, 1.5))
        other = writer.add_connection(
            "/pose2", "geometry_msgs/msg/PoseStamped", typestore=maker.store
        )
        message = maker.pose_stamped(5, (1, 2, 3))
        writer.write(other, 2, maker.store.serialize_ros1(message, message.__msgtype__))
    own, standard = read_all(path, ["/pose", "/pose2"])
    assert (own.version, own.position.x) == (9, 1.5)
    assert standard.pose.position.z == 3


IDL = """{sep}
IDL: geometry_msgs/msg/PoseStamped
module geometry_msgs {{ module msg {{ struct PoseStamped {{
uint8 version; geometry_msgs::msg::Point position; }}; }}; }};
{sep}
IDL: geometry_msgs/msg/Point
module geometry_msgs {{ module msg {{ struct Point {{ float x; }}; }}; }};
""".format(sep="=" * 80)


@pytest.mark.parametrize("plugin", ["MCAP", "SQLITE3"])
def test_definitions_in_idl(tmp_path, plugin):
    msgtype = "geometry_msgs/msg/PoseStamped"
    with bags.rosbag2.Writer(
        tmp_path / "run", version=9, storage_plugin=bags.rosbag2.StoragePlugin[plugin]
    ) as writer:
        connection = writer.add_connection("/pose", msgtype, msgdef=IDL, rihs01="RIHS01_0")
        writer.write(connection, 1, b"\0\1\0\0" + struct.pack("<Bxxxf", 9, 1.5))
    (message,) = read_all(tmp_path / "run", ["/pose"])
    assert (message.version, message.position.x) == (9, 1.5)


@pytest.mark.parametrize("kind", ["ros1", "sqlite3"])
def test_the_standard_definitions_know_transforms(kind, tmp_path):
    maker = bag_making.Maker(kind)
    entries = [("/tf", 1, maker.transforms((5, "map", "odom", (1, 2, 3))))]
    path = maker.write(tmp_path / "run", entries)
    if kind == "ros1":
        path.write_bytes(
            path.read_bytes().replace(
                b"TransformStamped[] transforms", b"$$$nsformStamped[] transforms"
            )
        )
    (message,) = read_all(path, ["/tf"])
    assert message.transforms[0].transform.translation.z == 3


def test_unknown_release(tmp_path):
    with (
        pytest.raises(StageError, match=r"input.ros2_release: hydro .*humble"),
        bags.open_bag("x", ros2_release="hydro"),
    ):
        pass


def test_a_message_cut_short_names_its_topic(tmp_path):
    maker = bag_making.Maker("sqlite3")
    path = maker.write(tmp_path / "run", simple(maker))
    with bags.open_bag(path) as bag:
        connection, _, raw = next(bag.messages({"/points"}))
        with pytest.raises(StageError, match=r"topic /points.*ros2_release"):
            bag.decode(connection, raw[:-30])
        with pytest.raises(StageError, match="topic /points"):
            bag.header(connection, raw[:9])


@pytest.mark.recordings
def test_the_index_of_an_old_bag(recordings_dir):
    path = recordings_dir / "broken" / "bad_index.bag"
    with refused(file="bad_index.bag", remedy="rosbag reindex"):
        read_all(path)


@pytest.mark.parametrize("salvage", [False, True])
@pytest.mark.parametrize(
    ("name", "head", "told"),
    [
        ("notes.bag", b"Drive 3, upper floor\nbattery low\n", "not a ROS 1 bag (.bag) but text"),
        ("notes.bag", "Gr\u00fc\u00dfe".encode(), "text that begins with 'Gr\u00fc\u00dfe'"),
        ("page.mcap", b"<!DOCTYPE html>\n", "begins with '<!DOCTYPE html>'"),
        ("run.bag", b"\x89MCAP0\r\n\x01", "but an MCAP file; rename it to *.mcap"),
        ("run.db3", b"#ROSBAG V2.0\n", "but a ROS 1 bag; rename it to *.bag"),
        ("run.bag", b"\x1f\x8b\x08\x00", "but packed by gzip; unpack it"),
    ],
)
def test_another_kind_of_file_is_named(tmp_path, name, head, told, salvage):
    path = tmp_path / name
    path.write_bytes(head)
    with (
        pytest.raises(StageError, match=re.escape(told)) as caught,
        bags.open_bag(path, salvage=salvage),
    ):
        pass
    assert "\n" not in str(caught.value)


def test_letters_cut_at_the_end_of_what_is_looked_at_are_text(tmp_path):
    path = tmp_path / "notes.bag"
    path.write_bytes(b"x" + "\u00fc".encode() * 400)
    with pytest.raises(StageError, match="but text"), bags.open_bag(path):
        pass


def test_a_bag_whose_head_is_damaged_is_left_to_its_reader(tmp_path):
    maker = bag_making.Maker("ros1")
    path = maker.write(tmp_path / "run", simple(maker))
    content = bytearray(path.read_bytes())
    content[0] ^= 1
    path.write_bytes(content)
    with refused(file=path.name, value="beginning"), bags.open_bag(path):
        pass
    with bags.open_bag(path, salvage=True) as bag:
        assert {topic.name for topic in bag.topics} >= {"/points", "/amcl_pose"}
