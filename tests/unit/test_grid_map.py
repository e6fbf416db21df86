import io
from dataclasses import replace

import numpy as np
import pytest
import shapely
import yaml
from PIL import Image

from helpers import floorplan_making
from helpers.floorplan_making import bare, plan
from scanplan.exports import grid_map


def as_nav2_reads(grid):
    """A map as nav2's map_server loads it (map_io.cpp, trinary): (x, y) to 0, 100 or -1."""
    about = yaml.safe_load(grid_map.format_map_yaml(grid, "map.pgm"))
    image = np.asarray(Image.open(io.BytesIO(grid_map.format_pgm(grid))).convert("L"), float)
    assert about["mode"] == "trinary" and 0 < about["free_thresh"] < about["occupied_thresh"] < 1
    occupancy = image / 255 if about["negate"] else (255 - image) / 255
    cells = np.full(image.shape, -1)
    cells[occupancy > about["occupied_thresh"]] = 100
    cells[occupancy < about["free_thresh"]] = 0
    x0, y0, yaw = about["origin"]
    assert yaw == 0

    def at(x_m, y_m):
        column, row = int((x_m - x0) // about["resolution"]), int((y_m - y0) // about["resolution"])
        return cells[image.shape[0] - 1 - row, column]

    return at


@pytest.mark.parametrize(
    ("place", "value"),
    [
        ((2, 1), 0),  # a room's floor
        ((5, 2.5), -1),  # the part of the other that no ray went over
        ((4.05, 1.5), 0),  # the door between them
        ((4.05, 0.5), 100),  # the wall beside it
        ((1.5, -0.1), 100),  # the window
        ((-0.1, 1.5), -1),  # the entrance, which no ray went over
        ((7.11, 1.5), 100),  # the single face
        ((2.5, 2.0), 100),  # the surface in the middle of the room
        ((6, 3.1), 100),  # the inferred wall
        ((7.6, 1), -1),  # outside
    ],
)
def test_a_map_server_sees_what_is_there(place, value):
    assert as_nav2_reads(grid_map.draw_grid_map(plan(), 0.05))(*place) == value


def test_walls_have_no_hole_that_a_planner_could_leak_through():
    cells = grid_map.draw_grid_map(plan(openings=floorplan_making.openings([])), 0.05).cells[::-1]
    # from a cell of the room, by cells that share an edge, nothing outside of both is reached
    reached = np.zeros(cells.shape, bool)
    reached[int((1 + 0.7) / 0.05), int((1 + 0.7) / 0.05)] = True
    while True:
        grown = reached.copy()
        grown[1:] |= reached[:-1]
        grown[:-1] |= reached[1:]
        grown[:, 1:] |= reached[:, :-1]
        grown[:, :-1] |= reached[:, 1:]
        grown &= cells != grid_map.Grey.OCCUPIED
        if (grown == reached).all():
            break
        reached = grown
    assert reached.sum() * 0.05**2 < 12.0
    assert reached.sum() * 0.05**2 > 11.0


@pytest.mark.parametrize("cell_m", [0.02, 0.05, 0.1])
def test_free_area_is_that_of_the_floor(cell_m):
    drawn = replace(
        bare([(20, 0, 21, 0, -1)]), free=floorplan_making.free([floorplan_making.ROOMS[0]])
    )
    grid = grid_map.draw_grid_map(drawn, cell_m)
    assert (grid.cells == grid_map.Grey.FREE).sum() * cell_m**2 == pytest.approx(12.0, rel=0.02)


def test_a_pillar_in_the_floor_is_not_free():
    floor = floorplan_making.ROOMS[0].difference(floorplan_making.shapely.box(1, 1, 2, 2))
    at = as_nav2_reads(grid_map.draw_grid_map(plan(free=floorplan_making.free([floor])), 0.05))
    assert (at(1.5, 1.5), at(0.5, 1.5), at(2.5, 1.5)) == (-1, 0, 0)


def test_a_campus_is_drawn_with_larger_cells():
    grid = grid_map.draw_grid_map(bare([(0, 0, 3000, 10, -1), (0, 0, 0, 1000, -1)]), 0.05)
    assert grid.resolution_m == 0.4 and grid.cells.size <= 64_000_000


def test_a_plan_of_one_face_has_a_map():
    assert set(np.unique(grid_map.draw_grid_map(bare([(0, 0, 1, 0, -1)]), 0.05).cells)) == {
        grid_map.Grey.OCCUPIED,
        grid_map.Grey.UNKNOWN,
    }


def test_a_window_in_a_wall_of_one_known_side_is_no_thicker_than_that():
    """The east face is at 7.1 m, a cell's edge; the room before it is free, behind is unknown."""
    openings = floorplan_making.openings([((7.1, 0.5, 7.1, 1.7), 1, "window", 0.9, 2.1, 1, -1)])
    openings["thickness_m"][:] = np.nan
    at = as_nav2_reads(grid_map.draw_grid_map(plan(openings=openings), 0.05))
    assert [at(x, 1.0) for x in (7.03, 7.12, 7.18)] == [0, 100, -1]
    assert [at(x, 0.2) for x in (7.03, 7.12, 7.18)] == [0, 100, -1]


@pytest.mark.parametrize(
    ("place", "value"),
    [
        ((2, 1), 0),  # a room's floor
        ((4.05, 1.5), 0),  # the door between the rooms
        ((5, 2.5), 100),  # what no ray went over
        ((1.5, -0.1), 100),  # the window
        ((-0.1, 1.5), 100),  # the entrance, though rays went over it: it leads outside
        ((7.6, 1), 100),  # outside
    ],
)
def test_a_robot_keeps_to_floor_that_was_seen_and_does_not_leave(place, value):
    floor = floorplan_making.free([*floorplan_making.FREE, shapely.box(-0.5, 1.0, 0.1, 2.0)])
    drawn = plan(free=floor)
    assert as_nav2_reads(grid_map.draw_grid_map(drawn, 0.05))(-0.1, 1.5) == 0
    assert as_nav2_reads(grid_map.draw_keepout(drawn, 0.05))(*place) == value


def test_a_robot_is_slow_near_doors():
    grid = grid_map.draw_speed(plan(), 0.05)
    about = yaml.safe_load(grid_map.format_map_yaml(grid, "speed.pgm", "raw"))
    image = np.asarray(Image.open(io.BytesIO(grid_map.format_pgm(grid))))
    x0, y0, _ = about["origin"]

    def percent(x_m, y_m):
        return image[len(image) - 1 - int((y_m - y0) / 0.05), int((x_m - x0) / 0.05)]

    assert about["mode"] == "raw"
    # the door between the rooms is at x = 4.05 m, from y = 1 to 1.9 m, in a wall of 0.1 m
    assert percent(4.05, 1.5) == percent(4.9, 1.5) == percent(3.2, 1.5) == 50
    assert percent(5.3, 1.5) == percent(2.5, 2.9) == 0
    assert grid.cells.shape == grid_map.draw_grid_map(plan(), 0.05).cells.shape
