"""Scans of a grid map: what places in its free floor see of its occupied cells."""

from functools import partial

import numpy as np
import pytest
from PIL import Image

from helpers import refusals
from scanplan.project import dataset_files
from scanplan.recordings import frame_edges, grid_map_scans
from scanplan.recordings.motion import pose_kind
from scanplan.recordings.survey import Reading, open_survey

LIMITS = {"min_range_m": 0.1, "max_range_m": 50.0}
FREE, OCCUPIED, UNKNOWN = 254, 0, 205
YAML = """image: room.pgm
mode: trinary
resolution: 0.05
origin: [-1.0, 2.0, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""


def room():
    """A room of 3 m by 2 m, its west wall unknown, as rows from the least y."""
    cells = np.full((60, 80), UNKNOWN, np.uint8)
    cells[9:51, 9:71] = OCCUPIED
    cells[10:50, 10:70] = FREE
    cells[9:51, 9] = UNKNOWN
    return cells


def write(folder, cells=None, text=YAML, name="room.pgm"):
    folder.mkdir(parents=True, exist_ok=True)
    Image.fromarray((room() if cells is None else cells)[::-1]).save(folder / name)
    (folder / "room.yaml").write_text(text)
    return folder


def read(folder):
    """Return where scans were taken (n, 2), and what they see, in the map."""
    with open_survey(dataset_files.find_files(folder), Reading(**LIMITS)) as survey:
        t_ns = survey.stamps()
        assert survey.planar and survey.pose_kind == pose_kind.STATIONS
        assert ["0.05 m" in told for told in survey.describe_rays()] == [True]
        pose, _, _ = frame_edges.chain_poses(survey.pose_edges(), t_ns, max_gap_s=1)
        scans = list(survey.scans(range(len(t_ns))))
    return pose[:, :2, 3], [s.xyz_m + p[:3, 3] for s, p in zip(scans, pose, strict=True)]


def test_places_lie_in_the_open_and_see_the_middles_of_occupied_cells(tmp_path):
    places, seen = read(write(tmp_path))
    # the floor goes from (-0.5, 2.5) to (2.5, 4.5)
    assert len(places) >= 8
    assert (places >= (-0.28, 2.72)).all() and (places <= (2.28, 4.28)).all()
    for xyz_m in seen:
        x_m, y_m = xyz_m[:, 0], xyz_m[:, 1]
        is_on_wall = np.isclose(x_m, 2.525, atol=1e-5)
        is_on_wall |= np.isclose(y_m, 2.475, atol=1e-5) | np.isclose(y_m, 4.525, atol=1e-5)
        assert is_on_wall.all()
        # beams into the unknown do not come back
        assert 360 < len(xyz_m) < 720 and (x_m > -0.55).all()


def test_on_much_floor_places_are_farther_apart(tmp_path, monkeypatch):
    all_places, _ = read(write(tmp_path))
    monkeypatch.setattr(grid_map_scans, "_MOST_PLACES", 4)
    places, _ = read(tmp_path)
    assert 3 <= len(places) < len(all_places)
    assert (places >= (-0.28, 2.72)).all() and (places <= (2.28, 4.28)).all()


def test_other_images_and_negated_ones_are_the_same_map(tmp_path):
    _, seen = read(write(tmp_path / "a"))
    text = YAML.replace("room.pgm", "'room.png'  # of slam_toolbox")
    _, of_png = read(write(tmp_path / "b", text=text, name="room.png"))
    negated = 255 - room()
    _, of_negated = read(write(tmp_path / "c", negated, YAML.replace("negate: 0", "negate: 1")))
    for one, other, third in zip(seen, of_png, of_negated, strict=True):
        np.testing.assert_array_equal(one, other)
        np.testing.assert_array_equal(one, third)


def raw_room():
    """The room as shares in per cent, as nav2 saves it in mode raw."""
    of_grey = np.full(256, 255, np.uint8)
    of_grey[[FREE, OCCUPIED]] = 0, 100
    return of_grey[room()]


def transparent_room():
    """The room in shades, transparent where it is unknown."""
    return np.dstack([np.where(room() == UNKNOWN, FREE, room()), 255 * (room() != UNKNOWN)])


@pytest.mark.parametrize(
    ("cells", "text", "name"),
    [
        # what nav2's map_saver states: 205 is less than that
        (room(), YAML.replace("0.196", "0.25"), "room.pgm"),
        (255 - room(), YAML.replace("0.196", "0.25").replace("negate: 0", "negate: 1"), "room.pgm"),
        (raw_room(), YAML.replace("trinary", "raw"), "room.pgm"),
        (
            transparent_room().astype(np.uint8),
            YAML.replace("trinary", "scale").replace("pgm", "png"),
            "room.png",
        ),
    ],
)
def test_what_is_unknown_stays_so_in_every_mode(tmp_path, cells, text, name):
    places, seen = read(write(tmp_path / "a"))
    same_places, same = read(write(tmp_path / "b", cells, text, name))
    np.testing.assert_array_equal(same_places, places)
    for one, other in zip(seen, same, strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_map_with_a_yaw_lies_turned_about_its_origin(tmp_path):
    places, seen = read(write(tmp_path / "a"))
    text = YAML.replace("2.0, 0]", f"2.0, {np.pi / 2}]")
    turned_places, turned = read(write(tmp_path / "b", text=text))

    def turn(xy_m):
        x_m, y_m = (xy_m - [-1.0, 2.0]).T
        return np.column_stack([-y_m - 1.0, x_m + 2.0])

    np.testing.assert_allclose(turned_places, turn(places), atol=1e-9)
    # in its own frame each sees the same
    for place, turned_place, one, other in zip(places, turned_places, seen, turned, strict=True):
        np.testing.assert_allclose(other[:, :2] - turned_place, one[:, :2] - place, atol=1e-6)


refusal = partial(refusals.refusal, read)


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ("0.05", "50", "resolution 50 m"),
        ("0.05", "fine", "resolution"),
        ("0.05", "0", "resolution 0 m"),
        ("-1.0, 2.0, 0", "-1.0, 2.0, .inf", "a yaw"),
        ("trinary", "colours", "trinary, scale, raw"),
        ("-1.0, 2.0, 0", "-1.0, 2.0", "map_server"),
        ("-1.0, 2.0, 0", ".nan, 2.0, 0", "origin nan"),
        ("-1.0, 2.0, 0", "-1.0, 9000, 0", "origin -1, 9000"),
        ("negate: 0", "negate: .inf", "map_server"),
        ("room.pgm", "hall.pgm", "hall.pgm"),
        ("negate: 0", "negate: 1", "0 places"),
    ],
)
def test_a_description_that_cannot_be_ends_in_a_line(tmp_path, old, new, named):
    assert named in refusal(write(tmp_path, text=YAML.replace(old, new)))


@pytest.mark.parametrize("content", [b"P5\n80 60\n255\n", b"P5\n999999 999999\n255\n\0", b"GIF89a"])
def test_an_image_that_cannot_be_ends_in_a_line(tmp_path, content):
    (write(tmp_path) / "room.pgm").write_bytes(content)
    assert "room.pgm" in refusal(tmp_path)


def test_two_maps_in_a_folder_end_in_a_line(tmp_path):
    (write(tmp_path) / "other.yaml").write_text(YAML)
    assert "2 grid maps" in refusal(tmp_path)
