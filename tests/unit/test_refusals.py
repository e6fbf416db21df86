"""What a message must name is asked of one of its lines, word by word, and of no other words."""

import pytest

from helpers.refusals import assert_told, refused
from scanplan.errors import StageError

LINE = "a.bag: 3 of 5 poses lack a stamp (at most 2); raise poses.max_gap_s, or run `make poses`"


def test_what_is_named_is_found_whatever_stands_around_it():
    assert_told(f"INFO begins\n{LINE}", file="a.bag", value=("3 of 5", 2), key="poses.max_gap_s")
    with refused(file="a.bag", remedy="make poses") as caught:
        raise StageError(LINE)
    assert caught.value.args == (LINE,)


@pytest.mark.parametrize(
    "named",
    [
        {"file": "b.bag"},
        {"value": 13},
        {"value": "of 5", "key": "poses.max_gap"},
        {"remedy": ("make poses", "make walls")},
        {"file": "a.ba"},
        {"file": "a.bag", "key": "INFO"},
        {},
    ],
)
def test_what_is_not_named_whole_or_in_another_line_is_missed(named):
    with pytest.raises(AssertionError):
        assert_told(f"INFO begins\n{LINE}", **named)


def test_what_is_refused_is_an_error_for_the_user():
    with pytest.raises(ValueError, match="poses"), refused(file="a.bag"):
        raise ValueError(f"poses {LINE}")
