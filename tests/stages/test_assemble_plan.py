import numpy as np
import pytest
import shapely

from assemble_plan import assemble_plan
from helpers import house_making
from helpers.refusals import refused
from helpers.wall_making import lengths_m, walls
from scanplan.errors import StageError
from scanplan.plan import planning
from scanplan.store import schemas, tables

EVERYTHING = {"n_scans": None, "area_share": None}


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    return house_making.write(tmp_path_factory.mktemp("house"), house_making.segments())


def outputs(folder):
    folder.mkdir(exist_ok=True)
    return {name: folder / f"{name}.parquet" for name in planning.TABLES}


def assembled(inputs, folder, *, settings=house_making.PLAN, **stop):
    paths = outputs(folder)
    assemble_plan(*inputs, paths, **(EVERYTHING | stop), settings=settings)
    return {
        n: tables.read_table(paths[n], schema, allow_empty=True)
        for n, schema in planning.TABLES.items()
    }


def with_walls(inputs, folder, table):
    folder.mkdir(exist_ok=True)
    path = folder / "walls.parquet"
    tables.write_table(path, schemas.WALLS, table, allow_empty=True)
    return [path, *inputs[1:]]


def test_a_house_of_two_rooms(house, tmp_path):
    plan = assembled(house, tmp_path / "plan")
    np.testing.assert_allclose(plan["rooms"]["area_m2"], [16, 15.2], rtol=0.02)
    assert plan["rooms"]["closed"].all()
    assert len(plan["walls"]["wall"]) == 5
    thick = np.isfinite(plan["walls"]["thickness_m"])
    np.testing.assert_allclose(plan["walls"]["thickness_m"][thick], [0.2], atol=0.01)
    assert plan["openings"]["type"].tolist() == ["door"]
    assert plan["openings"]["width_m"][0] == pytest.approx(0.9, abs=0.06)
    assert {plan["openings"]["room_a"][0], plan["openings"]["room_b"][0]} == {0, 1}
    assert (plan["openings"]["sill_m"][0], plan["openings"]["wall"][0]) == (
        0,
        np.flatnonzero(thick)[0],
    )


def test_walls_are_as_sure_as_registration_says_that_poses_are(house, tmp_path):
    """Off by 3 cm along x, and known along y."""
    table = tables.read_table(house[3], schemas.REGISTRATION)
    table |= {name: np.zeros(len(table["kept"])) for name in schemas.COVARIANCE}
    table["cov_x_x_m2"] += 0.03**2
    tables.write_table(tmp_path / "registration.parquet", schemas.REGISTRATION, table)
    found = assembled([*house[:3], tmp_path / "registration.parquet"], tmp_path / "plan")["walls"]
    along_x = np.abs(found["x1_m"] - found["x0_m"]) > np.abs(found["y1_m"] - found["y0_m"])
    np.testing.assert_allclose(found["sigma_offset_m"][~along_x], 0.03, rtol=1e-2)
    assert (found["sigma_offset_m"][along_x] < 0.002).all()


def test_tables_refer_to_each_other(house, tmp_path):
    plan = assembled(house, tmp_path / "plan")
    assert np.isin(plan["faces"]["wall"], plan["walls"]["wall"]).all()
    for side, sign in (("face_left", 1), ("face_right", -1)):
        for wall, face in zip(plan["walls"]["wall"], plan["walls"][side], strict=True):
            if face >= 0:
                assert plan["faces"]["wall"][face] == wall
                way = [
                    plan["walls"][f"{c}1_m"][wall] - plan["walls"][f"{c}0_m"][wall] for c in "xy"
                ]
                normal = [plan["faces"][c][face] for c in ("nx", "ny")]
                assert np.sign(way[0] * normal[1] - way[1] * normal[0]) == sign
    counted = np.bincount(plan["evidence"]["wall"], plan["evidence"]["n_points"])
    np.testing.assert_array_equal(counted, plan["walls"]["n_points"])
    np.testing.assert_array_equal(
        plan["evidence"]["t_ns"], house_making.T_NS[plan["evidence"]["scan_id"]]
    )


def test_free_floor_goes_through_the_door_and_not_through_walls(house, tmp_path):
    free = shapely.union_all(
        shapely.from_wkb(assembled(house, tmp_path / "plan")["free"]["geometry"])
    )
    assert free.covers(shapely.Point(4.1, 1.95))
    assert not free.intersects(shapely.Point(4.1, 1.0))
    assert not free.intersects(shapely.Point(4.1, 3.0))


def test_only_the_first_scans_make_the_plan(house, tmp_path):
    one = assembled(house, tmp_path / "one", n_scans=1)
    assert set(one["evidence"]["scan_id"]) == {2}
    by_share = assembled(house, tmp_path / "share", area_share=0.75)
    assert set(by_share["evidence"]["scan_id"]) == {2}


@pytest.mark.parametrize("is_moved", [True, False])
def test_floor_under_a_box_is_of_its_room_whether_another_scan_saw_it_or_not(tmp_path, is_moved):
    """A box stands in the room, and is moved before the scan that is not chosen, or is not."""
    corners = [(2.2, 2.2), (3.4, 2.2), (3.4, 3.4), (2.2, 3.4)]
    box = [(*a, *b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
    sensors = [*house_making.SENSORS[:2], (3.9, 0.3, 0.9)]
    full, empty = (house_making.scans(house_making.HOUSE + more, sensors) for more in (box, []))
    seen = [*full[:2], (empty if is_moved else full)[2]]
    inputs = house_making.write(tmp_path, house_making.segments(), sensors)
    tables.write_table(inputs[1], schemas.SELECTION, house_making.ordering([0, 1, 2]))
    with tables.open_scan_writer(inputs[2], planar=True) as write_scan:
        for scan_id, xyz_m in seen:
            write_scan(scan_id, (xyz_m * [1, 1, 0])[::8])
    plan = assembled(inputs, tmp_path / "plan", n_scans=2)
    assert set(plan["evidence"]["scan_id"]) == {0, 1}
    assert 15.7 < plan["rooms"]["area_m2"].max() < 16.2


def test_the_same_tables_give_the_same_bytes(house, tmp_path):
    assembled(house, tmp_path / "one"), assembled(house, tmp_path / "other")
    for name in planning.TABLES:
        assert (tmp_path / f"one/{name}.parquet").read_bytes() == (
            tmp_path / f"other/{name}.parquet"
        ).read_bytes()


def test_no_wall_in_the_selected_scans_is_told(house, tmp_path):
    inputs = with_walls(house, tmp_path, walls([(0, 0, 1, 0)]))
    with refused(file="walls.parquet", value="1 scans", key="selection.stop"):
        assembled(inputs, tmp_path / "plan", n_scans=1)
    assert not (tmp_path / "plan/faces.parquet").exists()


def test_no_wall_at_all_is_told(house, tmp_path):
    with refused(value="4 scans"):
        assembled(with_walls(house, tmp_path, walls([])), tmp_path / "plan")


def test_a_single_wall_is_a_plan_without_rooms_but_those_entered(house, tmp_path):
    plan = assembled(
        with_walls(house, tmp_path, walls([house_making.ROOM_A[0]])), tmp_path / "plan"
    )
    assert lengths_m(plan["walls"]).tolist() == pytest.approx(
        [4 + house_making.PLAN["trace"]["reach_m"]], abs=0.1
    )
    # where floor is narrow it is parted, in no wall
    assert set(plan["openings"]["type"]) <= {"unseen", "passage", "gap"}
    assert (plan["openings"]["wall"] == -1).all()
    assert not plan["rooms"]["closed"].any()


def test_walls_where_no_point_is_are_told(house, tmp_path):
    inputs = with_walls(house, tmp_path, walls([(2, 2.5, 3, 2.5), (20, 0, 30, 0)], scan_id=[0, 1]))
    with pytest.raises(StageError, match=r"none of 2 wall segments .*min_length_m"):
        assembled(inputs, tmp_path / "plan")


def test_numbers_that_are_not_finite_are_told(house, tmp_path):
    with refused(value="1 numbers"):
        assembled(
            with_walls(house, tmp_path, walls([(0, 0, 1, 0)]) | {"x1_m": np.array([np.nan])}),
            tmp_path / "plan",
        )
