from scanplan import schemas
from scanplan.report import truthwords


def test_every_measure_is_explained():
    unexplained = [c for c in schemas.PLAN_EVALUATION.columns if c != "frame" and not truthwords.meaning(c)]
    assert unexplained == []


def test_a_distance_is_said():
    assert truthwords.meaning("visible_correctness_005m").endswith("that any scan could see, within 0.05 m")
    assert "within" not in truthwords.meaning("room_iou")
    assert truthwords.meaning("hue") == ""
