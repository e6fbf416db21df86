from scanplan.registration import batches


def test_batches_follow_each_other_and_look_back():
    assert batches.cut_batches(10, 4, 2) == [(0, 0, 4), (2, 4, 8), (6, 8, 10)]
    assert batches.cut_batches(3, 100, 5) == [(0, 0, 3)]
    assert batches.cut_batches(0, 4, 2) == []
