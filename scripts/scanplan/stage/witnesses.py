"""What is measured of a survey to find whether it can be: each a number with its limit.

A stage measures what its evidence is at hand for. What is beyond its limit is told as a sentence,
with what it means and what remedies it, and handed on among the doubts of the dataset.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from scanplan.stage import log


class Witness(NamedTuple):
    """What is asked of every survey.

    Attributes
    ----------
    limit : float
        The most that a sound survey may have.
    unit : str
        A format of the value and of the limit.
    means : str
        What is wrong beyond it: a sentence with `{value}`, `{limit}` and what else is measured.
    remedy : str
        What to do, likewise.
    """

    limit: float
    unit: str
    means: str
    remedy: str


@dataclass(frozen=True)
class Measured:
    """A witness and what a survey has of it; `more` is what its sentence names besides."""

    name: str
    value: float
    more: dict[str, object]

    def add(self, **more: object) -> "Measured":
        """Return it with more that its sentence names."""
        return replace(self, more={**self.more, **more})

    @property
    def is_beyond(self) -> bool:
        """Whether it speaks against the survey; what is not known (NaN) does not."""
        return self.value > WITNESSES[self.name].limit

    @property
    def sentence(self) -> str:
        """What is wrong, and the remedy."""
        known = WITNESSES[self.name]
        value, limit = (known.unit.format(number) for number in (self.value, known.limit))
        said = known.means.format(value=value, limit=limit, **self.more)
        return f"{said}: {known.remedy.format(**self.more)}"


def state_witness(name: str, value: float, **more: object) -> Measured:
    """Return what a survey has of a witness.

    Parameters
    ----------
    name : str
        Of `WITNESSES`.
    value : float
        NaN where it is not known.
    **more
        What its sentence names besides.
    """
    return Measured(name, value, more)


def tell(stage: str, measured: Sequence[Measured]) -> list[str]:
    """Log all that was measured; return what speaks against the survey, in sentences."""
    words = []
    for each in measured:
        known = WITNESSES[each.name]
        value, limit = (known.unit.format(number) for number in (each.value, known.limit))
        words.append(f"{each.name} {value} (at most {limit})")
    if words:
        log.log_line(f"{stage}: witnesses: {', '.join(words)}")
    return [each.sentence for each in measured if each.is_beyond]


_SHARE, _METRES, _DEGREES, _COUNT = "{:.1%}", "{:.2f} m", "{:.1f} degrees", "{:.0f}"
_FOLDED = (
    "record a localiser's poses, or lower advanced.registration.drift if the odometry is better"
    " than it says"
)
_OTHER_MAP = (
    "where the localiser lost its map or the robot was carried, cut the recording there; make each"
    " storey, and each part with a map of its own, a dataset of its own"
)

# the most that sound surveys have stands beside each: 72 simulated drives of the bench, but for
# those whose localiser did err by as much by their truth, and 12 real or public ones
WITNESSES = {
    # 9 % in 28 sound surveys, ten of them recorded
    "misfit": Witness(
        0.15,
        _SHARE,
        "only {n_kept:,} of {n_asked:,} scans fit one another where their poses put them",
        "{cause}",
    ),
    # a sensor that did stand still loses none
    "standstill": Witness(
        0,
        _COUNT,
        "all recorded poses are the same, and {value} scans do not fit one another there",
        "the sensor moved, and its poses (input.pose_topic) do not say so",
    ),
    # a localiser that begins late or ends early; recordings that overlap lose nine tenths
    "no pose": Witness(
        0.5,
        _SHARE,
        "{value} of the scans to register have no pose ({n_without:,} of {n_asked:,})",
        "recordings may overlap in time, whose poses are dropped there, or the localiser was not at"
        " work; set their clocks, or make each recording a dataset of its own",
    ),
    # candidates, between which the sensor has moved: noise alone makes them differ
    "repeats": Witness(
        0.01,
        _SHARE,
        "{value} of the scans ({n_repeated:,} of {n_asked:,}) are an earlier one again, bit by bit",
        "a driver or a relay sent its last cloud again and again, and nobody knows what was seen"
        " meanwhile; cut the recording there, or record it anew",
    ),
    "map jump": Witness(
        0.2,
        _METRES,
        "the map jumps by {value} and {turn_deg:.0f} degrees before scan {scan_id}, {after_s:.0f} s"
        " after the first, according to {by} (jumps in all: {n_jumps})",
        _OTHER_MAP,
    ),
    "map turn": Witness(
        5.0,
        _DEGREES,
        "the map turns by {value} before scan {scan_id}, {after_s:.0f} s after the first, according"
        " to {by} (turns in all: {n_jumps})",
        _OTHER_MAP,
    ),
    "scale": Witness(
        0.02,
        _SHARE,
        "ranges are {scale:.3f} times as long as the poses have them (known to {sigma:.3f})",
        "check the unit and the scale of ranges and poses, and which of them was calibrated;"
        " lengths in the plan are off by up to as much",
    ),
    "lean": Witness(
        1.5,
        _DEGREES,
        "the plane that the sensor was carried in leans by {value} against the map's z",
        "give poses in a map whose z is up, not in a camera's axes; a map that bends needs loops,"
        " or gravity",
    ),
    "storeys": Witness(
        1.8,
        _METRES,
        "the sensor moves up and down by {value}",
        "more than one storey was driven through, which one plan cannot show; make each storey a"
        " dataset of its own (building.yaml joins them)",
    ),
    "other place": Witness(
        0.2,
        _SHARE,
        "of {n_places:,} places that the drive passed twice one looks different each time ({value}"
        " of what was seen contradicts, at x = {x_m:.1f} m, y = {y_m:.1f} m): two maps or storeys"
        " lie on one another",
        _OTHER_MAP,
    ),
    "loose scans": Witness(
        0,
        _COUNT,
        "{value} of {n_scans:,} scans, in {n_parts} parts of the drive, hang on the odometry alone:"
        " no scan ties them to the others",
        "they may lie elsewhere (a robot that was carried, or nothing to see on the way)",
    ),
    # chairs that moved leave nine tenths; rooms laid over one another about half
    "drifting other place": Witness(
        0.2,
        _SHARE,
        "of {n_places:,} places that the drive passed twice one does not look the same ({value} of"
        " what was seen contradicts, most at x = {x_m:.1f} m, y = {y_m:.1f} m), so the plan may be"
        " folded there",
        _FOLDED,
    ),
    "moved walls": Witness(
        0.1,
        _SHARE,
        "{n_moved:,} of {n_places:,} places that the drive passed twice do not look the same (walls"
        " where floor was free), most at x = {x_m:.1f} m, y = {y_m:.1f} m, so the plan may be"
        " folded there",
        _FOLDED,
    ),
    # 0.36 to 1.0 in 16 sound surveys, furnished ones and recorded ones among them
    "returns off walls": Witness(
        0.8,
        _SHARE,
        "only {near:.0%} of the returns lie on the walls that are drawn",
        "scans may not fit one another, or the unit or the mounting may be wrong",
    ),
    # of the steps: none in 17 sound surveys; a missed door is crossed by few
    "way through walls": Witness(
        0.05,
        "{:.0%}",
        "{value} of the way that was driven leads through walls that are drawn",
        "poses and scans do not belong together; the mounting or the clock may be wrong",
    ),
    # 55 % in an office of glass, 47 % in another; folded maps 62 % and more
    "contradicted rays": Witness(
        0.6,
        _SHARE,
        "most rays of scans that were not used contradict the plan, only {share:.0%} of them end"
        " where it says",
        "a part of the drive may be out of place: see the report's pictures of the registration",
    ),
    # 9.9 % in csail, which is recorded; two storeys on one another have 14 to 28 %
    "rays through walls": Witness(
        0.13,
        _SHARE,
        "{value} of the rays of scans that were not used pass through walls that are drawn",
        "two maps or storeys may lie on one another; cut the recording where the map changed",
    ),
    # 3.1 % in a museum; a mirror of 2.8 m on a wall of a small floor has 3.7 and 4.3 %
    "mirrored rays": Witness(
        0.035,
        _SHARE,
        "what {value} of the rays show behind a wall at {where} is the room before it, mirrored",
        "a mirror hangs there: cover it and record again, or remove what is drawn behind it by"
        " corrections.yaml",
    ),
    # 0.64 m at a college
    "narrowest place": Witness(
        1.0,
        _METRES,
        "the way leads through several rooms and nowhere nearer to a wall than {value}",
        "doors are narrower than that; ranges and poses may be in feet: they are to be in metres",
    ),
    # 1.98 m of one that hangs from a mast
    "sensor height": Witness(
        2.5,
        _METRES,
        "the sensor was carried {value} above the floor",
        "ranges and poses may be in feet, or another storey's floor was seen",
    ),
    # 0.59 of the same one
    "head room": Witness(
        0.66,
        "{:.2f}",
        "the sensor moved only {above_m:.2f} m below the ceiling, {value} of the way up from the"
        " floor",
        "floor and ceiling may have been exchanged, and the plan with them mirrored: a map of a"
        " sensor that hung upside down has z down; give poses in a map whose z is up",
    ),
}
