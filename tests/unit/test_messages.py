import struct

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers import bag_making
from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.recordings import messages

XYZ = np.array([[1, 2, 3], [4, 5, 6], [7, 8, 9], [-1, 0, 0.5]], np.float32)


def structured(dtype, shape=(4,), **columns):
    points = np.zeros(shape, dtype)
    for name, values in {"x": XYZ[:, 0], "y": XYZ[:, 1], "z": XYZ[:, 2], **columns}.items():
        points[name] = np.reshape(values, points[name].shape)
    return points


LAYOUTS = {
    "plain": [("x", "<f4"), ("y", "<f4"), ("z", "<f4")],
    "big endian": [("x", ">f4"), ("y", ">f4"), ("z", ">f4")],
    "double": [("x", "<f8"), ("y", "<f8"), ("z", "<f8")],
    "other order": [("intensity", "<u2"), ("z", "<f4"), ("ring", "u1"), ("y", "<f4"), ("x", "<f4")],
    "count above one": [
        ("normal", "<f4", (3,)),
        ("x", "<f4"),
        ("y", "<f4"),
        ("z", "<f4"),
        ("rgb", "u1", (4,)),
    ],
    "padding": {
        "names": list("xyz"),
        "formats": ["<f4"] * 3,
        "offsets": [4, 12, 20],
        "itemsize": 48,
    },
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_point_cloud_layouts(layout):
    message = bag_making.point_cloud2(structured(LAYOUTS[layout]))
    xyz_m, time_raw = messages.read_point_cloud(message)
    assert xyz_m.dtype == np.float32
    np.testing.assert_array_equal(xyz_m, XYZ)
    assert time_raw is None


def test_unaligned_time_of_livox():
    dtype = np.dtype(
        [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("tag", "<u2"), ("timestamp", "<f8")]
    )
    assert dtype.fields["timestamp"][1] == 14
    times = np.arange(4) + 1.7e18
    xyz_m, time_raw = messages.read_point_cloud(
        bag_making.point_cloud2(structured(dtype, timestamp=times))
    )
    np.testing.assert_array_equal(time_raw, times)
    np.testing.assert_array_equal(xyz_m, XYZ)


def test_organised_cloud_with_padded_rows():
    points = structured(LAYOUTS["plain"], (2, 2))
    padded = np.concatenate(
        [np.frombuffer(points.tobytes(), np.uint8).reshape(2, 24), np.full((2, 7), 99, np.uint8)], 1
    )
    message = bag_making.point_cloud2(points, row_step=31, data=padded.ravel())
    np.testing.assert_array_equal(messages.read_point_cloud(message)[0], XYZ)
    last_row_cut_at_its_padding = bag_making.point_cloud2(
        points, row_step=31, data=padded.ravel()[:-7]
    )
    np.testing.assert_array_equal(messages.read_point_cloud(last_row_cut_at_its_padding)[0], XYZ)


def test_duplicate_empty_and_unknown_fields_do_not_matter():
    message = bag_making.point_cloud2(structured(LAYOUTS["plain"]))
    make = type(message.fields[0])
    message.fields += [
        make(name="x", offset=4, datatype=7, count=1),
        make(name="", offset=0, datatype=2, count=12),
    ]
    message.fields += [make(name="strange", offset=900, datatype=77, count=5)]
    np.testing.assert_array_equal(messages.read_point_cloud(message)[0], XYZ)


def test_a_wrong_row_step_of_one_row_does_not_matter():
    message = bag_making.point_cloud2(structured(LAYOUTS["plain"]), row_step=0)
    np.testing.assert_array_equal(messages.read_point_cloud(message)[0], XYZ)


def test_no_points():
    message = bag_making.point_cloud2(np.empty((0, 3), np.float32), fields=[], point_step=0)
    xyz_m, time_raw = messages.read_point_cloud(message)
    assert xyz_m.shape == (0, 3)
    assert time_raw is None


@pytest.mark.parametrize(
    ("overrides", "told"),
    [
        ({"width": 5}, "60 bytes, but 48"),
        ({"width": 2**31, "height": 2**20}, "row_step"),
        ({"width": 2**31}, "but 48 are there"),
        ({"data": np.zeros(0, np.uint8)}, "but 0 are there"),
        ({"point_step": 0}, "point_step 0"),
        ({"point_step": 11, "width": 1}, "field z"),
        ({"height": 2, "width": 2, "row_step": 12}, "row_step 12"),
    ],
)
def test_contradicting_layouts(overrides, told):
    message = bag_making.point_cloud2(structured(LAYOUTS["plain"]), **overrides)
    with pytest.raises(StageError, match=told):
        messages.read_point_cloud(message)


def test_missing_coordinate_names_the_fields_found():
    message = bag_making.point_cloud2(np.zeros(2, [("x", "<f4"), ("y", "<f4"), ("range", "<f4")]))
    with refused(value=("field z", "range, x, y")):
        messages.read_point_cloud(message)


def test_unknown_type_of_a_coordinate():
    message = bag_making.point_cloud2(structured(LAYOUTS["plain"]))
    message.fields[1].datatype = 42
    with pytest.raises(StageError, match="field y: type 42"):
        messages.read_point_cloud(message)


@given(st.data())
@settings(max_examples=60, deadline=None)
def test_any_layout_gives_the_points_back(data):
    n_padding = data.draw(st.integers(0, 3))
    names = data.draw(st.permutations(["x", "y", "z", *(f"p{i}" for i in range(n_padding))]))
    order = data.draw(st.sampled_from("<>"))
    formats = [
        order
        + (
            data.draw(st.sampled_from(["f4", "f8"]))
            if n in "xyz"
            else data.draw(st.sampled_from(["u1", "u2", "f8"]))
        )
        for n in names
    ]
    points = structured(list(zip(names, formats, strict=True)))
    np.testing.assert_array_equal(
        messages.read_point_cloud(bag_making.point_cloud2(points))[0], XYZ
    )


def test_laser_scan_on_paper():
    xyz_m, time_raw = messages.read_laser_scan(
        bag_making.laser_scan([1, 2, 3, 4], time_increment=0.01)
    )
    np.testing.assert_allclose(xyz_m, [[1, 0, 0], [0, 2, 0], [-3, 0, 0], [0, -4, 0]], atol=1e-6)
    np.testing.assert_allclose(time_raw, [0, 0.01, 0.02, 0.03])


def test_laser_scan_drops_what_is_no_return():
    ranges = [0.05, np.inf, np.nan, 30.0, 81.8, 0.1, -1]
    xyz_m, time_raw = messages.read_laser_scan(bag_making.laser_scan(ranges))
    assert np.isfinite(xyz_m).all(axis=1).tolist() == [False] * 5 + [True, False]
    assert time_raw is None


@pytest.mark.parametrize(
    "angles",
    [
        {"angle_min": -180.0, "angle_max": 180.0, "angle_increment": 1.0},
        {"angle_increment": 3.0},
        {"angle_increment": -0.02},
    ],
)
def test_laser_scan_of_more_than_a_turn_is_refused(angles):
    scan = bag_making.laser_scan(np.ones(360), **angles)
    with pytest.raises(StageError, match=r"angle_increment .* rad turns 360 beams by .* degrees"):
        messages.read_laser_scan(scan)


def test_laser_scan_may_overlap_by_a_few_beams():
    # 362 beams a degree apart: the last two repeat the directions of the first
    step_rad = np.deg2rad(1)
    scan = bag_making.laser_scan(np.ones(362), angle_increment=step_rad)
    xyz_m, _ = messages.read_laser_scan(scan)
    np.testing.assert_allclose(xyz_m[:2], xyz_m[360:], atol=1e-6)


@pytest.mark.parametrize("increment", [1e-30, 0.009, -0.0174])
def test_laser_scan_whose_angles_contradict_one_another_is_refused(increment):
    # a turn of 360 beams is 0.0175 rad a beam
    scan = bag_making.laser_scan(np.ones(360), angle_increment=increment)
    with pytest.raises(StageError, match=r"angle_min 0 to angle_max 6.28319 .* 360 beams"):
        messages.read_laser_scan(scan)


@pytest.mark.parametrize("angle_max", [0.0, 2 * np.pi * 359 / 360, 2 * np.pi * 361 / 360])
def test_laser_scan_may_leave_out_its_last_angle_or_count_a_beam_more(angle_max):
    scan = bag_making.laser_scan(np.ones(360), angle_max=angle_max)
    assert np.isfinite(messages.read_laser_scan(scan)[0]).all()


def test_laser_scan_without_limit_or_beams():
    assert np.isfinite(
        messages.read_laser_scan(bag_making.laser_scan([50.0, 60.0], range_max=0.0))[0]
    ).all()
    assert messages.read_laser_scan(bag_making.laser_scan([]))[0].shape == (0, 3)


@pytest.mark.parametrize(
    "ranges, fields",
    [
        ([1, 1], {"angle_increment": 0.0}),
        ([1, 1], {"angle_increment": np.nan}),
        ([1], {"angle_min": np.inf}),
    ],
)
def test_laser_scan_without_directions(ranges, fields):
    with pytest.raises(StageError, match="angle_increment"):
        messages.read_laser_scan(bag_making.laser_scan(ranges, **fields))


@pytest.mark.parametrize("step_s", [0.0, -1.0, np.nan, np.inf])
def test_laser_scan_without_times(step_s):
    scan = bag_making.laser_scan([1, 1], time_increment=step_s)
    assert messages.read_laser_scan(scan)[1] is None


@pytest.mark.parametrize("kind", ["ros1", "sqlite3"])
def test_header_without_decoding(kind):
    maker = bag_making.Maker(kind)
    message = maker.laser(bag_making.START_NS + 7, [1.0], "/laser")
    serialize = maker.store.serialize_cdr if maker.ros2 else maker.store.serialize_ros1
    raw = serialize(message, message.__msgtype__)
    assert messages.read_header(raw, ros2=maker.ros2) == (bag_making.START_NS + 7, "laser")
    with pytest.raises(struct.error):
        messages.read_header(raw[:18], ros2=maker.ros2)


def test_header_of_big_endian_cdr():
    maker = bag_making.Maker("sqlite3")
    message = maker.laser(bag_making.START_NS + 7, [1.0], "laser")
    raw = maker.store.serialize_cdr(message, message.__msgtype__, little_endian=False)
    assert messages.read_header(raw, ros2=True) == (bag_making.START_NS + 7, "laser")
