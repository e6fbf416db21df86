"""What is measured of a survey to find whether it can be: each a number with its limit.

A stage measures what its evidence is at hand for. What is beyond its limit is told with what it
means, its likeliest cause and the remedy, and handed on among the doubts of the dataset.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from scanplan.stage import log
from scanplan.stage.witness_table import PLAN, SIGN, WITNESSES, WORTHS
from scanplan.store.doubts import Finding


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
    def written(self) -> tuple[str, str]:
        """The value and the limit, with their unit."""
        known = WITNESSES[self.name]
        return known.unit.format(self.value), known.unit.format(known.limit)

    @property
    def finding(self) -> Finding:
        """What is wrong, why, and the remedy."""
        known = WITNESSES[self.name]
        value, limit = self.written
        said, cause, remedy = (
            words.format(value=value, limit=limit, **self.more)
            for words in (known.means, known.cause, known.remedy)
        )
        # of what no sound survey has any one is enough
        beyond = float(self.value) / known.limit if known.limit else float(1 + self.value)
        return Finding(self.name, beyond, said, cause, remedy)


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


def tell(stage: str, measured: Sequence[Measured]) -> list[Finding]:
    """Log all that was measured, and as warnings what is beyond its limit; return the latter."""
    words = []
    for each in measured:
        value, limit = each.written
        words.append(f"{each.name} {value} (at most {limit})")
    if words:
        log.log_line(f"{stage}: witnesses: {', '.join(words)}")
    found = [each.finding for each in measured if each.is_beyond]
    for finding in found:
        log.log_warning(f"{stage}: {finding.sentence}")
    return found


def rank_findings(findings: Sequence[Finding]) -> list[Finding]:
    """Return findings, the likeliest cause of all of them first.

    What was found by trying it comes before what may be the cause, and that before mere signs; of
    these what is farthest beyond its limit. What leaves a drawing a plan comes behind all that, and
    a witness that a version of the program had and this one has not comes last.
    """

    def rank(finding: Finding) -> tuple[bool, int, float]:
        known = WITNESSES.get(finding.witness)
        if known is None:
            return True, SIGN + 1, -finding.beyond
        return known.leaves == PLAN, known.tells, -finding.beyond

    return sorted(findings, key=rank)


def worth_left(findings: Sequence[Finding]) -> str:
    """Return what of `WORTHS` a drawing is at most with these findings."""
    left = [WITNESSES[f.witness].leaves for f in findings if f.witness in WITNESSES]
    return min(left, key=WORTHS.index, default=PLAN)
