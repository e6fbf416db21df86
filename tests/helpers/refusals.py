"""What is said of input that cannot be read."""

import pytest

from scanplan.errors import StageError


def refusal(read, place):
    """Return the line that reading a place ends in: it names the place and a remedy."""
    with pytest.raises(StageError) as caught:
        read(place)
    line = str(caught.value)
    assert str(place) in line and "\n" not in line and ";" in line
    return line
