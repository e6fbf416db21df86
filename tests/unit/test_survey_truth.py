"""What the scans of a box could see of its walls, and poses as text."""

import numpy as np
import pytest

from helpers import simple_rooms as drawn
from scanplan.lab.buildings.truth import truth_features
from scanplan.lab.evaluation import visible_faces
from scanplan.lab.simulation import rover, survey_truth
from scanplan.store import tum


def of_kind(features, kind):
    return [(g, values) for g, values in features if values["kind"] == kind]


def test_tum_keeps_whole_nanoseconds():
    t_ns = np.array([1_704_067_200_000_000_001, 1_704_067_200_123_456_789])
    text = tum.format_tum(t_ns, rover.planar_poses([[1, 2], [3, 4]], [0.0, np.pi], 0.4))
    first, second = text.splitlines()
    assert (
        first
        == "1704067200.000000001 1.000000000 2.000000000 0.400000000"
        + " 0.000000000" * 3
        + " 1.000000000"
    )
    assert second.split()[0] == "1704067200.123456789"
    np.testing.assert_allclose(np.abs(np.array(second.split()[4:], float)), [0, 0, 1, 0], atol=1e-9)


class TestSight:
    """What one place of the box, 4 m by 3 m, shows of its walls: the middle, forward along x."""

    HERE = np.eye(4) + np.array([[0, 0, 0, 2.0], [0, 0, 0, 1.5], [0, 0, 0, 0.4], [0, 0, 0, 0]])

    def visible(self, *more, survey=HERE[None], **sight):
        features = truth_features(drawn.plan(*more), 0.4)
        marked = survey_truth.mark_visible(features, survey, visible_faces.SensorView(**sight))
        walls = [values["visible_m"] for _, values in of_kind(marked, "wall")]
        faces = sum(
            values["visible_m"]
            for _, values in of_kind(marked, "face")
            if values["side"] == "inside"
        )
        assert faces == pytest.approx(sum(walls), abs=0.01)
        assert all(
            "visible_m" not in values for g, values in marked if values.get("side") == "outside"
        )
        return walls

    def test_all_around(self):
        assert self.visible(max_range_m=100.0) == pytest.approx([4, 3, 4, 3], abs=0.03)

    def test_as_far_as_the_sensor_sees(self):
        half_m = (1.6**2 - 1.5**2) ** 0.5
        assert self.visible(max_range_m=1.6) == pytest.approx(
            [2 * half_m, 0, 2 * half_m, 0], abs=0.03
        )

    def test_only_in_its_field(self):
        assert self.visible(max_range_m=100.0, field_rad=np.pi / 2) == pytest.approx(
            [0.5, 3, 0.5, 0], abs=0.03
        )

    @pytest.mark.parametrize(("height_m", "hidden_m"), [(1.9, 1.0), (0.8, 0.0)])
    def test_not_behind_tall_furniture(self, height_m, hidden_m):
        # from the middle its width of 0.5 m, 1 m away, hides twice that of the wall 2 m away
        corners = [[3.0, 1.25], [3.4, 1.25], [3.4, 1.75], [3.0, 1.75], [3.0, 1.25]]
        cupboard = drawn.feature("furniture", "Polygon", [corners], height_m=height_m)
        assert self.visible(cupboard, max_range_m=100.0) == pytest.approx(
            [4, 3 - hidden_m, 4, 3], abs=0.03
        )

    def test_of_no_scan_nothing(self):
        assert self.visible(survey=np.empty((0, 4, 4)), max_range_m=100.0) == [0, 0, 0, 0]
