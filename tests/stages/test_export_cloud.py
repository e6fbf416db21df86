"""The points of the chosen scans, or of all, as a LAZ file and from above."""

import laspy
import numpy as np
import pytest
import shapely
from PIL import Image

from export_cloud import export_cloud
from helpers import e57_making, floorplan_making
from helpers.refusals import refused
from scanplan.plan.corrections.georeference import format_reference
from scanplan.plan.floorplan import GeoReference
from scanplan.store import schemas, tables
from scanplan.store.pose_columns import pose_columns

T_S = 1_699_990_000
LEVELS = {"floor_z_m": "0.0", "ceiling_z_m": "2.5"}
WHITE = (255, 255, 255)
COLOURS = ((255, 0, 0), (0, 128, 0), (0, 0, 255))


@pytest.fixture
def survey(tmp_path):
    paths = [tmp_path / f"{name}.parquet" for name in ("scans", "registration", "selection")]
    scans, registration, selection = paths
    with tables.open_scan_writer(scans, planar=False) as write:
        for scan_id in (2, 5, 7):
            write(scan_id, np.array([(scan_id, 0, 0), (scan_id, 0, 0.01), (scan_id, 1, 0)]))
    ids = np.array([2, 5, 7], np.int32)
    graded = dict.fromkeys(
        ("prior_fitness", "refined_fitness", "rmse_m", *schemas.COVARIANCE), np.ones(3)
    )
    poses = pose_columns(np.zeros((3, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (3, 1)))
    kept = {"kept": np.ones(3, bool), "reason": np.full(3, "", object)}
    stamps = {"scan_id": ids, "t_ns": (T_S + ids.astype(np.int64)) * 10**9}
    tables.write_table(registration, schemas.REGISTRATION, stamps | graded | kept | poses)
    worths = ("gain_m2", "covered_m2", "bound_m2", "gain", "covered", "bound")
    order = {
        "rank": np.array([1, 2, 3], np.int32),
        "scan_id": np.array([7, 2, 5], np.int32),
        "n_points": np.full(3, 3, np.int64),
        **dict.fromkeys(worths, np.array([1.0, 2.0, 3.0])),
    }
    tables.write_table(selection, schemas.SELECTION, order)
    free = tmp_path / "free.parquet"
    floor = shapely.box(0, -1, 8, 2)
    tables.write_table(free, schemas.FREE, floorplan_making.free([floor]), notes=LEVELS)
    return {"scans": scans, "registration": registration, "selection": selection, "free": free}


def exported(survey, path, *, recordings=(), **settings):
    files = {"cloud": path, "picture": path.with_suffix(".png")}
    settings = {"site": {}} | settings
    export_cloud(survey | {"recordings": recordings}, files, settings=settings, n_scans=2)
    return laspy.read(path)


def test_the_chosen_scans_in_the_order_they_were_taken(survey, tmp_path):
    cloud = exported(survey, tmp_path / "cloud.laz", scans="chosen", cell_m=0.0)
    assert cloud["scan_id"].tolist() == [2, 2, 2, 7, 7, 7]
    assert list(cloud.x) == [2, 2, 2, 7, 7, 7]


def test_all_scans_thinned(survey, tmp_path):
    cloud = exported(survey, tmp_path / "cloud.laz", scans="all", cell_m=0.02)
    assert cloud["scan_id"].tolist() == [2, 2, 5, 5, 7, 7]
    assert list(cloud.z) == [0.0] * 6
    assert str(cloud.header.creation_date) == "2023-11-14"


def test_reference_points_of_the_plan_place_it(survey, tmp_path):
    reference = GeoReference("EPSG:25832", 500_000.0, 5_400_000.0, 0.0, 0.01)
    notes = {"georeference": format_reference(reference)}
    here = exported(survey, tmp_path / "here.laz", scans="all", cell_m=0.0)
    tables.write_table(survey["free"], schemas.FREE, floorplan_making.free(), notes=notes)
    placed = exported(survey, tmp_path / "placed.laz", scans="all", cell_m=0.0)
    assert np.array(placed.x) == pytest.approx(np.array(here.x) + 500_000, abs=1e-3)
    assert np.array(placed.y) == pytest.approx(np.array(here.y) + 5_400_000, abs=1e-3)


def test_from_above_points_are_dark_by_height_where_nothing_is_known_of_colours(survey, tmp_path):
    exported(survey, tmp_path / "cloud.laz", scans="all", cell_m=0.0)
    image = Image.open(tmp_path / "cloud.png")
    # the floor that was seen, a metre around it, and 4 cm a pixel
    assert image.size == (250, 125) and image.mode == "L"
    assert image.getpixel((0, 0)) == WHITE[0]
    # scan 2 at x = 2, y = 0: two metres up and three to the right of the lower left corner
    assert image.getpixel((75, 124 - 50)) < image.getpixel((75, 124 - 75)) < WHITE[0]


def stations(tmp_path, n_points=3):
    """Write eight stations at the map's origin as many points as those of `survey`."""
    points = np.array([(1, 0, 0), (1, 0, 0.01), (1, 1, 0)][:n_points], float)
    poses = [np.eye(4) for _ in range(8)]
    for number, pose in enumerate(poses):
        pose[0, 3] = number - 1.0
    colours = np.array(COLOURS[:n_points])
    return [str(e57_making.write_e57(tmp_path / "a.e57", poses, [points] * 8, colours))]


def test_colours_of_stations_are_read_from_their_files(survey, tmp_path):
    cloud = exported(
        survey, tmp_path / "cloud.laz", recordings=stations(tmp_path), scans="all", cell_m=0.0
    )
    rgb = np.column_stack([cloud.red, cloud.green, cloud.blue])
    assert {tuple(row) for row in (rgb >> 8).tolist()} == set(COLOURS)
    image = Image.open(tmp_path / "cloud.png")
    assert image.getpixel((75, 124 - 50)) in COLOURS
    assert image.getpixel((0, 0)) == WHITE


def test_a_file_that_has_other_points_now_ends_in_a_line(survey, tmp_path):
    with refused(value=("scan 2", "3 points", "now 2")):
        exported(
            survey,
            tmp_path / "cloud.laz",
            recordings=stations(tmp_path, n_points=2),
            scans="all",
            cell_m=0.0,
        )
    assert not (tmp_path / "cloud.laz").exists() and not (tmp_path / "cloud.png").exists()
