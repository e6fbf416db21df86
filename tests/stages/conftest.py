"""The report of the hand-made plan, as somebody opens it who has said nothing yet."""

import pytest

from helpers import report_making


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    return report_making.written(folder, report_making.files(folder), name="office")


@pytest.fixture
def page(report, chromium):
    yield chromium.open(report.as_uri())
    complaints = list(chromium.complaints)
    # what the page still has to say is not kept for the next test either
    chromium.run("Storage.prototype.setItem = () => {}; localStorage.clear()")
    assert complaints == []
