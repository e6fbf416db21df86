import numpy as np
import pandas as pd
import pytest
import shapely
from shapely import LineString

from helpers import evaluation_making, scene_making
from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.lab.evaluation.scores import hand_truth, plan_scores, raster_truth, score_files
from scanplan.store import schemas, tables

ROOM = shapely.box(0, 0, 6, 4)


def write_plan(folder, **given):
    """Write the tables of a plan as plain Parquet, without any statement of a version."""
    (folder / "plan").mkdir()
    for name, columns in scene_making.tables(**given).items():
        pd.DataFrame(columns).to_parquet(folder / f"plan/{name}.parquet")
    notes = {"floor_z_m": "-0.4", "ceiling_z_m": "2.3"}
    free = {"part": np.array([0]), "geometry": np.array([shapely.to_wkb(ROOM)], object)}
    tables.write_table(folder / "plan/free.parquet", schemas.FREE, free, notes=notes)


class TestResults:
    def prepare(self, folder, map_from_true=None, **given):
        evaluation_making.write_truth(folder)
        faces = evaluation_making.FACES
        rows = [(LineString([f[:2], f[2:]]), {"kind": "face"}) for f in faces]
        rows += [
            (LineString([f[:2], f[2:]]), {"kind": "wall", "thickness_m": 0.2, "height_m": 2.7})
            for f in faces
        ]
        rows.append((ROOM, {"kind": "room", "name": "hall", "visited": True}))
        scene_making.write_features(folder / "truth.geojson", rows)
        evaluation_making.write_registration(folder, map_from_true)
        write_plan(folder, **given)

    def score(self, folder, **given):
        placed = score_files.place_results(
            folder, folder / "truth.geojson", folder / "truth_poses.tum", **given
        )
        return score_files.score_results(placed)

    def test_a_plan_of_any_version_without_confidence_is_scored(self, tmp_path):
        faces = [(f[:2], f[2:]) for f in evaluation_making.FACES]
        self.prepare(tmp_path, faces=faces, rooms=[ROOM], openings=[])
        row = self.score(tmp_path).measures
        assert row["wall_correctness_005"] == pytest.approx(1)
        assert row["wall_completeness_005"] == pytest.approx(1)
        assert row["room_iou"] == row["room_height_right"] == pytest.approx(1)
        assert row["all_no_probability"] == 1

    def test_it_is_moved_onto_the_truth_by_its_poses(self, tmp_path):
        motion = np.eye(4)
        motion[:2, :2], motion[:2, 3] = [[0, -1], [1, 0]], (3, -2)
        faces = np.array([(f[:2], f[2:]) for f in evaluation_making.FACES], float)
        moved = faces @ motion[:2, :2].T + motion[:2, 3]
        room = shapely.transform(ROOM, lambda xy: xy @ motion[:2, :2].T + motion[:2, 3])
        self.prepare(tmp_path, motion, faces=moved, rooms=[room], openings=[])
        row = self.score(tmp_path).measures
        assert row["wall_completeness_005"] == pytest.approx(1)
        assert row["room_iou"] == pytest.approx(1)

    def test_confidence_is_read_where_it_is(self, tmp_path):
        faces = [(f[:2], f[2:]) for f in evaluation_making.FACES]
        self.prepare(tmp_path, faces=faces, rooms=[ROOM], openings=[])
        rated = scene_making.confidence(("faces", 0, 0.5, True), ("rooms", 0, 0.995, False))
        pd.DataFrame(rated).to_parquet(tmp_path / "plan/confidence.parquet")
        row = self.score(tmp_path).measures
        assert row["face_right_flagged"] == 0.25
        assert (row["room_sure_n"], row["room_sure_right"]) == (1, 1.0)

    def test_points_tell_what_was_hit(self, tmp_path):
        faces = [(f[:2], f[2:]) for f in evaluation_making.FACES]
        self.prepare(tmp_path, faces=faces[:1], rooms=[ROOM], openings=[])
        # a metre of the first wall and one of the third, at heights of walls
        along = np.arange(1.0, 2.01, 0.05)
        points = np.concatenate(
            [np.stack([along, np.full_like(along, y), np.ones_like(along)], 1) for y in (0, 4)]
        )
        with tables.open_scan_writer(tmp_path / "scans.parquet", planar=False) as write:
            write(2, points)
        row = self.score(tmp_path, with_points=True).measures
        assert row["wall_completeness_hit_010"] == pytest.approx(0.5, abs=0.01)

    def test_a_missing_table_is_named(self, tmp_path):
        self.prepare(tmp_path, faces=[[(0, 0), (6, 0)]], rooms=[ROOM], openings=[])
        (tmp_path / "plan/rooms.parquet").unlink()
        with pytest.raises(StageError, match=r"rooms\.parquet: is missing"):
            self.score(tmp_path)


class TestHand:
    def features(self):
        rows = [(LineString(f), {"kind": "surface"}) for f in scene_making.FACES]
        rows += [
            (room, {"kind": "room", "name": name, "entered": True})
            for room, name in zip(scene_making.ROOMS, "AB", strict=True)
        ]
        rows.append((scene_making.DOOR, {"kind": "opening", "type": "door"}))
        rows.append((LineString([(8.2, 0), (8.2, 3)]), {"kind": "unseen"}))
        return rows

    def test_a_plan_is_fitted_and_scored(self, tmp_path):
        truth = scene_making.write_features(tmp_path / "hand.geojson", self.features())
        motion = se3.pose_matrix([[0.12, -0.2, 0]], [[0, 0, np.sin(0.004), np.cos(0.004)]])[0]
        back = np.linalg.inv(motion)

        def moved(xy_m):
            return np.asarray(xy_m) @ back[:2, :2].T + back[:2, 3]

        write_plan(
            tmp_path,
            faces=moved(np.array(scene_making.FACES)),
            openings=[("door", moved(scene_making.DOOR.coords))],
            rooms=[shapely.transform(r, moved) for r in scene_making.ROOMS],
        )
        row = score_files.score_results(score_files.place_results_by_hand(tmp_path, truth)).measures
        assert row["wall_completeness_005"] == pytest.approx(1)
        assert row["room_iou"] == pytest.approx(1, abs=0.01)
        assert (row["hand_doors_true"], row["hand_doors_found"]) == (1, 1)
        assert row["moved_deg"] == pytest.approx(np.degrees(0.008), abs=0.05)
        assert np.isnan(row["wall_correctness_010"])
        assert "leaves_true" not in row

    def test_what_nothing_supports_is_no_surface_to_find(self, tmp_path):
        truth = scene_making.write_features(tmp_path / "hand.geojson", self.features())
        scene = hand_truth.read_hand_scene(truth)
        # 26 m less the wall of 3 m, and 0.3 m beside it and beside the door: the corners of the
        # wall lie on two others, and so do the four ends at the door, 0.1 m off its line
        beside_door_m = np.sqrt(0.3**2 - 0.1**2)
        expected_m = 26 - 3 - 2 * 0.3 - 4 * beside_door_m
        length_m = np.hypot(*(scene.inner_m[:, 1] - scene.inner_m[:, 0]).T).sum()
        assert length_m == pytest.approx(expected_m, abs=0.01)

    def test_openings_of_what_is_not_drawn_are_not_judged(self, tmp_path):
        truth = scene_making.write_features(tmp_path / "hand.geojson", self.features())
        scene = hand_truth.read_hand_scene(truth)
        drawn = scene_making.tables(
            openings=[("door", scene_making.DOOR.coords), ("door", [(30, 0), (31, 0)])]
        )
        rows = plan_scores.score_plan(drawn, np.eye(4), scene).elements
        openings = rows["table"] == "opening"
        assert rows["verdict"][openings].tolist() == ["right", "unknown"]


class TestRaster:
    def write(self, path):
        # cells of 0.5 m: two rooms of 4 x 2 cells, a door cell between them, walls around
        labels = np.zeros((4, 11), int)
        labels[1:3, 1:5], labels[1:3, 6:10] = 1, 2
        free = labels > 0
        free[1, 5] = True
        np.savez(path, rooms=labels.astype(np.int16), m=0.5, xy=[(1.0, 1.0)], free=free)
        return raster_truth.read_raster_scene(path)

    def test_rooms_lie_where_their_cells_do_and_the_way_enters_them(self, tmp_path):
        scene = self.write(tmp_path / "truth.npz")
        assert scene.rooms[0].equals(shapely.box(0.5, 0.5, 2.5, 1.5))
        assert scene.rooms[1].equals(shapely.box(3.0, 0.5, 5.0, 1.5))
        assert scene.entered.tolist() == [True, False]

    def test_surfaces_are_edges_of_rooms_that_are_not_free(self, tmp_path):
        scene = self.write(tmp_path / "truth.npz")
        length_m = np.hypot(*(scene.inner_m[:, 1] - scene.inner_m[:, 0]).T).sum()
        # two outlines of 6 m, less the door's two sides
        assert length_m == pytest.approx(2 * 6 - 2 * 0.5)

    def place(self, tmp_path):
        """Registered where the scans 2, 4 and 7 were taken, turned by a quarter."""
        self.write(tmp_path / "truth.npz")
        with np.load(tmp_path / "truth.npz") as stored:
            given = dict(stored)
        turned = [(y, -x) for x, y in evaluation_making.POSITIONS]
        way = np.zeros((8, 2))
        way[evaluation_making.SCAN_IDS] = turned
        way[:, 0] += 0.2
        way[:, 1] += 2
        np.savez(tmp_path / "truth.npz", **{**given, "xy": way})
        evaluation_making.write_registration(tmp_path)
        return score_files.place_results_by_raster(tmp_path, tmp_path / "truth.npz")

    def test_the_map_lies_where_its_scans_were_taken(self, tmp_path):
        placed = self.place(tmp_path)
        np.testing.assert_allclose(
            placed.motion[:2, [0, 1, 3]], [[0, 1, 0.2], [-1, 0, 2.0]], atol=1e-9
        )

    def test_rooms_and_lines_of_any_method_are_scored(self, tmp_path):
        placed = self.place(tmp_path)
        back = np.linalg.inv(placed.motion)
        room = shapely.transform(
            shapely.box(0.5, 0.5, 2.5, 1.5), lambda xy: xy @ back[:2, :2].T + back[:2, 3]
        )
        row = score_files.score_peer_rooms(placed, [room]).measures
        assert (row["rooms_true"], row["room_iou"]) == (1, pytest.approx(1))
        line_m = np.array([[(0.5, 0.5), (2.5, 0.5)]]) @ back[:2, :2].T + back[:2, 3]
        row = score_files.score_peer_lines(placed, line_m).measures
        # two metres of eleven, and 0.1 m round each of its two corners
        assert row["wall_completeness_010"] == pytest.approx(2.2 / 11, abs=0.005)

    def test_scans_that_the_truth_has_not_are_another_recording(self, tmp_path):
        self.write(tmp_path / "truth.npz")
        evaluation_making.write_registration(tmp_path)
        with pytest.raises(StageError, match="has 1 places, scan 7"):
            score_files.place_results_by_raster(tmp_path, tmp_path / "truth.npz")
