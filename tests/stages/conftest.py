"""The report of the hand-made plan, as somebody opens it who has said nothing yet."""

import pytest

from helpers import report_making


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    return report_making.written(folder, report_making.files(folder), name="office")


@pytest.fixture
def page(report, chromium):
    chromium.open(report.as_uri())
    # what the page of the test before still has to say is not kept either
    chromium.run("Storage.prototype.setItem = () => {}; localStorage.clear()")
    yield chromium.open(report.as_uri())
    assert chromium.complaints == []
