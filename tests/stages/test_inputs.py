"""A flat recorded in every form that is read: its plans are one and the same."""

import pytest

from helpers import e57_making, ptx_making, small_flat
from scanplan.project import dataset_files


@pytest.fixture(scope="module")
def bag_plan(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bag")
    return small_flat.plan_of(folder / "plan", small_flat.write_bag(folder))


@pytest.mark.parametrize(
    ("name", "write"), [("flat.e57", e57_making.write_e57), ("flat.ptx", ptx_making.write_ptx)]
)
def test_stations(tmp_path, bag_plan, name, write):
    write(tmp_path / name, small_flat.station_poses(), small_flat.station_points())
    plan = small_flat.plan_of(tmp_path / "plan", dataset_files.find_files(tmp_path / name))
    small_flat.assert_same_plan(plan, bag_plan)
