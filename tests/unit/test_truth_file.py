import json

import numpy as np
import pytest

from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.lab.evaluation import truth_file, visible_faces
from scanplan.lab.simulation import rover
from scanplan.store.tum import format_tum


def geojson(path, *features):
    drawn = [
        {
            "type": "Feature",
            "properties": values,
            "geometry": {"type": kind, "coordinates": coordinates},
        }
        for values, kind, coordinates in features
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": drawn}))
    return path


INNER = ({"kind": "face", "side": "inside"}, "LineString", [[0, 0], [4, 0]])
OUTER = ({"kind": "face", "side": "outside"}, "LineString", [[0, -0.2], [4, -0.2]])
ROOM = ({"kind": "room"}, "Polygon", [[[0, 0], [4, 0], [4, 4], [0, 0]]])


class TestFaces:
    def test_only_faces_are_read_by_side(self, tmp_path):
        bent = ({"kind": "face"}, "LineString", [[4, 0], [4, 3, 9], [4, 3], [0, 3]])
        faces = truth_file.read_true_faces(
            geojson(tmp_path / "t.geojson", ROOM, INNER, OUTER, bent)
        )
        np.testing.assert_array_equal(
            faces.inner_m, [[(0, 0), (4, 0)], [(4, 0), (4, 3)], [(4, 3), (0, 3)]]
        )
        np.testing.assert_array_equal(faces.outer_m, [[(0, -0.2), (4, -0.2)]])

    def test_a_screen_hides_and_is_not_to_be_found(self, tmp_path):
        screen = ({"kind": "screen"}, "LineString", [[1, 1], [2, 1]])
        faces = truth_file.read_true_faces(geojson(tmp_path / "t.geojson", INNER, screen))
        assert len(faces.inner_m) == 1
        np.testing.assert_array_equal(faces.outer_m, [[(1, 1), (2, 1)]])

    @pytest.mark.parametrize(
        ("face", "match"),
        [
            (({"kind": "face", "side": "left"}, "LineString", [[0, 0], [1, 0]]), "side 'left'"),
            (({"kind": "face"}, "LineString", [[0, 0]]), "feature 0 is a face"),
            (({"kind": "face"}, "LineString", [[0, 0], [1, "x"]]), "feature 0 is a face"),
            (({"kind": "face"}, "LineString", [[0, 0], [1, float("nan")]]), "feature 0 is a face"),
            (({"kind": "face"}, "Point", [0, 0]), "feature 0 is a face"),
            (OUTER, "0 inner faces"),
        ],
    )
    def test_bad_faces_are_refused(self, tmp_path, face, match):
        with pytest.raises(StageError, match=match):
            truth_file.read_true_faces(geojson(tmp_path / "t.geojson", face))

    @pytest.mark.parametrize(
        "text", ["", "{", "[]", '{"features": 3}', '{"features": [1, null]}', "\xff"]
    )
    def test_other_files_are_refused(self, tmp_path, text):
        (tmp_path / "t.geojson").write_text(text, encoding="latin-1")
        with pytest.raises(StageError, match=r"t\.geojson"):
            truth_file.read_true_faces(tmp_path / "t.geojson")

    def test_a_missing_file_is_told(self, tmp_path):
        with refused(file="t.geojson"):
            truth_file.read_true_faces(tmp_path / "t.geojson")


class TestPoses:
    T_NS = np.array([1_700_000_000_000_000_001, 1_700_000_000_100_000_003])

    def test_what_the_simulation_writes_is_read_back(self, tmp_path):
        poses = rover.planar_poses([[1, 2], [3, 4]], [0.1, 0.2], 0.4)
        (tmp_path / "p.tum").write_text(format_tum(self.T_NS, poses))
        read = truth_file.read_true_poses(tmp_path / "p.tum")
        np.testing.assert_array_equal(read.t_ns, self.T_NS)
        np.testing.assert_allclose(
            truth_file.interpolate_true_poses(read, self.T_NS[::-1], "p.tum"),
            poses[::-1],
            atol=1e-8,
        )

    @pytest.mark.parametrize(
        ("text", "match"),
        [
            ("", "0 poses"),
            ("# t x y z\n", "0 poses"),
            ("1 2 3\n", "line 1"),
            ("1 0 0 0 0 0 0 0\n", "1 poses are not finite"),
            ("1 nan 0 0 0 0 0 1\n", "1 poses are not finite"),
            ("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", "do not increase after pose 0"),
        ],
    )
    def test_bad_poses_are_refused(self, tmp_path, text, match):
        (tmp_path / "p.tum").write_text(text)
        with pytest.raises(StageError, match=match):
            truth_file.read_true_poses(tmp_path / "p.tum")

    def test_the_truth_of_another_survey_is_refused(self, tmp_path):
        (tmp_path / "p.tum").write_text("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n")
        read = truth_file.read_true_poses(tmp_path / "p.tum")
        with refused(value=(1, "2 scans")):
            truth_file.interpolate_true_poses(
                read, np.array([1_500_000_000, 9_000_000_000]), "p.tum"
            )


class TestSight:
    def told(self, path, sensor):
        path.write_text(json.dumps({"type": "FeatureCollection", "sensor": sensor, "features": []}))
        return path

    def test_a_simulated_survey_tells_its_sensor(self, tmp_path):
        path = self.told(tmp_path / "t.geojson", {"max_range_m": 8.0, "field_deg": 180.0})
        assert truth_file.read_sensor_view(path, max_range_m=100.0) == visible_faces.SensorView(
            8.0, np.pi
        )
        assert truth_file.read_sensor_view(path, max_range_m=5.0).max_range_m == 5.0

    def test_another_sees_all_around_as_far_as_points_are_used(self, tmp_path):
        path = geojson(tmp_path / "t.geojson", INNER)
        assert truth_file.read_sensor_view(path, max_range_m=30.0) == visible_faces.SensorView(
            30.0, 2 * np.pi
        )

    @pytest.mark.parametrize(
        "sensor", [{"max_range_m": 0}, {"field_deg": "all"}, {"max_range_m": None}]
    )
    def test_nonsense_is_refused(self, tmp_path, sensor):
        with pytest.raises(StageError, match="positive needed"):
            truth_file.read_sensor_view(self.told(tmp_path / "t.geojson", sensor), max_range_m=30.0)
