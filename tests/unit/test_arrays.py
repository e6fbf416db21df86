"""A plan of arrays is the workflow's, and wrong arrays are refused by name."""

import numpy as np
import pytest

import scanplan
from faults import making
from helpers import cloud_files, toy_rooms
from scanplan.errors import StageError
from scanplan.plan import floorplan_files, planning
from scanplan.project import dataset_files
from scanplan.store import registered_scans, schemas, tables, tum

EXACT = {"registration": {"icp_method": "none"}}
PLACES_M = [(x_m, y_m, 0.9) for y_m in (1.2, 2.8) for x_m in (1.0, 2.0, 3.0, 4.0, 5.0)]


def drive(make, *, error_m=0.0):
    """Scans of the toy room in the sensor's frame, and poses that may be off."""
    random = np.random.default_rng(1)
    scans, poses = [], []
    for number, place_m in enumerate(PLACES_M):
        cos, sin = np.cos(0.3 * number), np.sin(0.3 * number)
        pose = np.eye(4)
        pose[:3] = [[cos, -sin, 0, place_m[0]], [sin, cos, 0, place_m[1]], [0, 0, 1, place_m[2]]]
        scans.append((make(np.array(place_m), seed=number) - place_m) @ pose[:3, :3])
        pose[:2, 3] += random.normal(0, error_m, 2) if error_m else 0
        poses.append(pose)
    return scans, np.array(poses)


@pytest.fixture(scope="module", params=["space", "plane"])
def made(request):
    make = toy_rooms.vlp16 if request.param == "space" else toy_rooms.laser
    scans, poses = drive(make, error_m=0.03)
    return scans, poses, scanplan.make_plan(scans, poses, name="toy")


def test_a_plan_has_the_room_that_was_drawn(made):
    plan = made[2]
    assert plan.rooms["area_m2"] == pytest.approx([24.0], abs=0.1)
    assert [shape.area for shape in plan.room_shapes] == pytest.approx(plan.rooms["area_m2"])
    assert plan.openings["type"].tolist() == ["door"]
    assert plan.openings["width_m"] == pytest.approx([0.9], abs=0.02)
    assert set(plan.chosen_ids) <= set(plan.scans.scan_ids) <= set(range(len(PLACES_M)))


def test_poses_are_set_right(made):
    _, given, plan = made
    exact = drive(toy_rooms.laser)[1]
    off_m = plan.scans.map_from_sensor[:, :2, 3] - exact[plan.scans.scan_ids, :2, 3]
    given_off_m = given[:, :2, 3] - exact[:, :2, 3]
    assert np.abs(off_m).max() < 0.01 < np.abs(given_off_m).max()


def test_a_plan_of_arrays_is_that_of_the_workflow(made, tmp_path):
    scans, poses, plan = made
    t_ns = np.arange(1, len(scans) + 1) * 10**9
    folder = tmp_path / "scans"
    files = [
        cloud_files.write_pcd(folder / f"{stamp // 10**9}.0.pcd", xyz_m)
        for stamp, xyz_m in zip(t_ns, scans, strict=True)
    ]
    (tmp_path / dataset_files.POSES_FILE).write_text(tum.format_tum(t_ns, poses))
    making.make_plan(tmp_path, [str(tmp_path / dataset_files.POSES_FILE), *map(str, files)])
    tables_of = {name: tmp_path / f"plan_{name}.parquet" for name in planning.TABLES}
    expected = floorplan_files.read_floorplan(tables_of)
    for table in ("walls", "openings", "rooms"):
        columns = getattr(expected, table)
        assert len(columns["x0_m" if table != "rooms" else "x_m"]) > 0
        for name, values in columns.items():
            found = getattr(plan, table)[name]
            if name.startswith("sigma_end"):
                # the trajectory's file rounds poses: one return more at an end
                assert found == pytest.approx(values, abs=0.03), name
            elif values.dtype.kind == "f":
                assert found == pytest.approx(values, abs=2e-3, nan_ok=True), name
            elif name in ("n_points", "n_rays"):
                # likewise, over the edge of a band
                assert found == pytest.approx(values, abs=2), name
            elif name != "geometry":
                assert found.tolist() == values.tolist(), name
    order = tables.read_table(tmp_path / "order.parquet", schemas.SELECTION)["scan_id"]
    assert plan.chosen_ids.tolist() == order[: len(plan.chosen_ids)].tolist()
    known = registered_scans.read_registered_scans(tmp_path / "registration.parquet")
    assert known.map_from_sensor == pytest.approx(plan.scans.map_from_sensor, abs=1e-3)


@pytest.mark.parametrize("suffix", ["svg", "pdf", "png", "dxf", "geojson"])
def test_a_plan_is_written_as_its_suffix_says(made, tmp_path, suffix):
    begins = {"svg": b"<?xml", "pdf": b"%PDF", "png": b"\x89PNG", "dxf": b"  0", "geojson": b"{"}
    scanplan.write_plan(made[2], tmp_path / f"plan.{suffix}")
    assert (tmp_path / f"plan.{suffix}").read_bytes().startswith(begins[suffix])


def test_another_suffix_is_refused(made, tmp_path):
    with pytest.raises(ValueError, match=r"plan\.dwg: .*\.dxf"):
        scanplan.write_plan(made[2], tmp_path / "plan.dwg")
    assert list(tmp_path.iterdir()) == []


def test_registered_scans_are_not_registered_again(made):
    scans, poses, plan = made
    again = scanplan.make_plan(scans, scanplan.register_scans(scans, poses))
    assert again.walls["x0_m"].tolist() == plan.walls["x0_m"].tolist()
    with pytest.raises(ValueError, match=r"poses: has scan 9, .* 3 given"):
        scanplan.make_plan(scans[:3], plan.scans)


def test_exact_poses_stay_as_they_are():
    scans, poses = drive(toy_rooms.laser)
    known = scanplan.register_scans([xyz_m[:, :2] for xyz_m in scans], poses, settings=EXACT)
    assert known.map_from_sensor == pytest.approx(poses, abs=1e-12)


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"poses": np.eye(4)}, "poses: .*3, 4, 4"),
        ({"poses": 2 * np.tile(np.eye(4), (3, 1, 1))}, r"poses\[0\]"),
        ({"poses": np.tile(np.diag([1, 1, -1, 1.0]), (3, 1, 1))}, r"poses\[0\]"),
        ({"scans": [np.zeros((5, 3)), np.zeros(5), np.zeros((5, 3))]}, r"scans\[1\].*\(5,\)"),
        ({"t_ns": [1, 3, 2]}, "t_ns"),
        ({"t_ns": [1, 2]}, "t_ns"),
        ({"t_ns": [1.0, 2.5, 3.0]}, "t_ns: .*whole"),
        ({"scans": [[[1.0, 2.0], [3.0]]] * 3}, r"scans\[0\]"),
        ({"settings": {"plan": {"method": "hull"}}}, r"plan\.method: .*hull.*wall_length"),
    ],
)
def test_wrong_arrays_are_refused_by_name(change, named):
    given = {"scans": [np.zeros((5, 3))] * 3, "poses": np.tile(np.eye(4), (3, 1, 1)), **change}
    with pytest.raises(ValueError, match=named):
        scanplan.make_plan(given.pop("scans"), given.pop("poses"), **given)


@pytest.mark.parametrize(
    ("settings", "named"),
    [
        ({"plan": {"openings": {"min_opening_m": -1}}}, r"plan\.openings\.min_opening_m"),
        ({}, r"scans: .*0 of 3 candidates"),
    ],
)
def test_wrong_data_end_in_one_line(settings, named):
    with pytest.raises(StageError, match=named):
        scanplan.make_plan(
            [np.full((5, 3), np.nan)] * 3, np.tile(np.eye(4), (3, 1, 1)), settings=settings
        )


def test_the_package_offers_what_it_names():
    with pytest.raises(AttributeError, match="no_such"):
        _ = scanplan.no_such
    assert all(getattr(scanplan, name) is not None for name in scanplan.__all__)
