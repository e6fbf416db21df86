"""What verdicts advise, carried out: of the drives that raised them nothing is left to tell.

`make faults` tries all of them, in space too.
"""

from faults import drives, judging, lying_drives, remedies

FEW = (
    "map jumps by 3 m, 1 m and 5 degrees",
    "map jumps by 3 m, 1 m and 5 degrees, no odometry",
    "quaternion w first",
    "sensor turned by 90 degrees",
    "all in centimetres",
)


def test_what_is_advised_mends_the_drive(tmp_path):
    laser = lying_drives.SENSORS["in the plane"]
    rooms = drives.drive_through(tmp_path / "rooms", settings=laser)
    tally = judging.Tally()
    remedies.try_remedies(tmp_path, {"rooms": rooms}, planar=True, tally=tally, names=FEW)
    assert tally.wrong == []
    assert tally.counts["remedies of lies"][judging.SOUND] == len(FEW)
