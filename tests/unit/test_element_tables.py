"""pandas reads the rows of the plan's tables from CSV."""

import io

import numpy as np
import pandas as pd
import pytest
import shapely

from helpers import floorplan_making
from helpers.floorplan_making import bare, plan
from scanplan.exports.data import element_ids, element_tables
from scanplan.store import schemas


def tabulated(drawn):
    return element_tables.tabulate_elements(drawn, element_ids.ids_from_places(drawn))


def read(rows, **how):
    return pd.read_csv(io.StringIO(element_tables.format_csv(rows)), **how)


def test_walls_have_their_columns_lengths_heights_and_ids():
    drawn = plan()
    walls = read(tabulated(drawn)["walls"])
    assert walls["wall"].tolist() == [0, 1, 2, 3, 4, 5]
    assert walls["global_id"].tolist() == element_ids.ids_from_places(drawn)["wall"]
    assert walls["length_m"].tolist() == pytest.approx([7.2, 3.2, 3.05, 4.15, 3.2, 3.2])
    assert walls["height_m"].tolist() == [floorplan_making.HEIGHT_M] * 6
    assert walls["external"].tolist() == [True] * 5 + [False]
    assert walls["thickness_m"].isna().tolist() == [False, True, False, False, False, False]
    assert walls["face_right"].isna().tolist() == [False, True, True, True, True, False]


def test_openings_name_the_rooms_that_they_join():
    openings = read(tabulated(plan())["openings"], keep_default_na=False)
    assert openings["room_a_name"].tolist() == ["Room 0"] * 3
    assert openings["room_b_name"].tolist() == ["", "Room 1", ""]
    assert openings["room_b"].tolist() == ["", "1", ""]


def test_rooms_have_areas_and_no_geometry():
    rooms = read(tabulated(plan())["rooms"])
    assert rooms["area_m2"].tolist() == [12.0, 9.0] and "geometry" not in rooms


def test_numbers_have_no_more_digits_than_they_mean():
    walls = floorplan_making.walls() | {"rmse_m": np.full(6, 1 / 3)}
    assert tabulated(plan(walls=walls))["walls"]["rmse_m"] == [0.3333] * 6


@pytest.mark.parametrize("name", ["=HYPERLINK(1)", "+1", "-1", "@x", "a\nb", 'a,"b"', "<b>"])
def test_a_name_is_neither_a_formula_nor_another_cell(name):
    drawn = plan()
    drawn.rooms["name"] = np.array([name, "Hall"], object)
    rooms = read(tabulated(drawn)["rooms"])
    assert rooms["name"].tolist() == [f"'{name}" if name[0] in "=+-@" else name, "Hall"]


def test_a_plan_of_faces_alone_has_heads_without_rows():
    rows = tabulated(bare())
    assert [len(read(rows[table])) for table in ("walls", "openings", "rooms")] == [0, 0, 0]


def test_rooms_have_a_height_where_the_ceiling_was_seen_and_else_a_least_one():
    seen = tabulated(plan(floor_z_m=0.0, ceiling_z_m=2.7))["rooms"]
    assert seen["height_m"] == seen["least_height_m"] == [2.7, 2.7]
    unseen = tabulated(plan(floor_z_m=0.0))["rooms"]
    assert unseen["height_m"] == [None, None]
    assert unseen["least_height_m"] == [floorplan_making.HEIGHT_M] * 2


def test_rooms_state_their_net_area_and_their_ways():
    column = floorplan_making.furniture([shapely.box(1, 1, 1.5, 1.5)], schemas.COLUMN)
    drawn = floorplan_making.plan(furniture=column)
    rooms = element_tables.tabulate_elements(drawn, element_ids.ids_from_places(drawn))["rooms"]
    assert rooms["net_area_m2"] == [11.75, 9.0] and rooms["area_m2"] == [12.0, 9.0]
    # an entrance of 1 m and a door of 0.9 m; the window is none
    assert rooms["n_ways"] == [2, 1] and rooms["widest_way_m"] == [1.0, 0.9]
    assert rooms["n_doors"] == [2, 1]
    passage = floorplan_making.openings()
    passage["type"][1] = "passage"
    rooms = tabulated(floorplan_making.plan(openings=passage))["rooms"]
    assert rooms["n_doors"] == [1, 0] and rooms["n_ways"] == [2, 1]
    shut = floorplan_making.plan(openings=floorplan_making.openings([]))
    rooms = element_tables.tabulate_elements(shut, element_ids.ids_from_places(shut))["rooms"]
    assert rooms["n_ways"] == [0, 0] and rooms["widest_way_m"] == [None, None]
