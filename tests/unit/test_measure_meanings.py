from scanplan.report import measure_meanings
from scanplan.store import schemas


def test_every_measure_is_explained():
    unexplained = [
        c
        for c in schemas.PLAN_EVALUATION.columns
        if c != "frame" and not measure_meanings.measure_meaning(c)
    ]
    assert unexplained == []


def test_a_distance_is_said():
    assert measure_meanings.measure_meaning("visible_correctness_005m").endswith(
        "that any scan could see, within 0.05 m"
    )
    assert "within" not in measure_meanings.measure_meaning("room_iou")
    assert measure_meanings.measure_meaning("hue") == ""
