"""A few faults of every group that needs no run of the workflow; `make faults` tries all."""

from faults import judging, run_faults


def test_no_fault_is_silent_unexpected_or_without_a_line(tmp_path):
    tally = judging.Tally()
    run_faults.try_in_process(tmp_path, tally, **run_faults.FEW)
    assert tally.wrong == []
    assert sum(counts.total() for counts in tally.counts.values()) >= 500


def test_a_silent_fault_is_noticed():
    tally = judging.Tally()
    judging.judge(judging.Case("toy", "wrong", lambda: 3, lambda n: n == 4), tally)
    judging.judge(judging.Case("toy", "refused", lambda: 3, may_pass=False), tally)
    judging.judge(judging.Case("toy", "failed", lambda: 1 / 0), tally)
    judging.judge(judging.Case("toy", "right", lambda: 4, lambda n: n == 4), tally)
    assert tally.counts["toy"] == {"silent": 2, "unexpected": 1, "sound": 1}
    assert len(tally.wrong) == 3
