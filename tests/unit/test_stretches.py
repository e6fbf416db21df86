from scanplan import stretches


def test_stretches_follow_each_other_and_look_back():
    assert stretches.bounds(10, 4, 2) == [(0, 0, 4), (2, 4, 8), (6, 8, 10)]
    assert stretches.bounds(3, 100, 5) == [(0, 0, 3)]
    assert stretches.bounds(0, 4, 2) == []
