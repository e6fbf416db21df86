"""What verdicts advise, carried out: of the drives that raised them nothing is left to tell.

One of each kind of setting; `make faults` tries all of them, in space too.
"""

from dataclasses import replace

import numpy as np
import pytest

from faults import drives, judging, lying_drives, making, remedies
from scanplan.stage.witness_table import PLAN, SKETCH

FEW = (
    "two storeys on one another",
    "sensor turned by 90 degrees",
    "all in centimetres",
)

LASER = lying_drives.SENSORS["in the plane"]


def drive_through(folder, *storey):
    """Every second scan of a drive: each contradicts as much, and takes as long."""
    return drives.drive_through(folder, *storey, settings=LASER).take(slice(None, None, 2))


@pytest.fixture(scope="module")
def rooms(tmp_path_factory):
    return drive_through(tmp_path_factory.mktemp("rooms"))


def test_a_sketch_becomes_a_plan_where_its_rooms_are_looked_into(rooms, tmp_path):
    """A scanner of 120 degrees has seen parts of two rooms after a quarter of its way."""
    ahead = [np.abs(np.arctan2(cloud[:, 1], cloud[:, 0])) <= np.pi / 3 for cloud in rooms.clouds]
    taken = [cloud[is_ahead] for cloud, is_ahead in zip(rooms.clouds, ahead, strict=True)]
    narrow = replace(rooms, clouds=taken)
    verdicts = []
    for share in (0.25, 1.0):
        place = tmp_path / f"{share}"
        place.mkdir()
        making.make_plan(place, [str(narrow.take(narrow.share <= share).write(place / "run"))])
        verdicts.append(making.read_verdict(place))
    assert [verdict.worth for verdict in verdicts] == [SKETCH, PLAN]
    assert "look into Room" in verdicts[0].remedy


def test_what_is_advised_mends_the_drive(rooms, tmp_path):
    tally = judging.Tally()
    above = drive_through(tmp_path / "above", "storey above")
    driven = {"rooms": rooms, "storey above": above}
    remedies.try_remedies(tmp_path, driven, planar=True, tally=tally, names=FEW)
    assert tally.wrong == []
    assert tally.counts["remedies of lies"][judging.SOUND] == len(FEW)
