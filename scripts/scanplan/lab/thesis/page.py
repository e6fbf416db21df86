"""The report of the thesis's experiments: one HTML page that needs nothing beside it."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from scanplan.lab.thesis.claim_measures import COUNT, NUMBER, SHARE
from scanplan.lab.thesis.shown_figures import FIGURES, STEPS, Figure
from scanplan.lab.thesis.stated_claims import CLAIMS, Claim
from scanplan.report import templates
from scanplan.store.schemas import NOT_WRITTEN
from scanplan.types import Columns, FloatArray

_UNKNOWN = "not measured"
_WITH_NEXT = "with the next"


@dataclass(frozen=True)
class Verdict:
    """A verdict over the seeds, and its CSS class; both empty where nothing was judged."""

    text: str
    css: str


@dataclass(frozen=True)
class ClaimRow:
    """A claim as the page shows it.

    Attributes
    ----------
    states, where, criterion : str
        As the claim has them; the criterion of a mere number is empty.
    stated, measured : list of (str, str)
        Quantities and their values, the thesis's and ours.
    verdict : Verdict
    """

    states: str
    where: str
    criterion: str
    stated: list[tuple[str, str]]
    measured: list[tuple[str, str]]
    verdict: Verdict


@dataclass(frozen=True)
class ShownFigure:
    """A figure as the page shows it.

    Attributes
    ----------
    anchor : str
        Where links lead to.
    number : str
    svg : Markup
    caption, ours : str
        The thesis's own caption, and what ours shows.
    claims : list of ClaimRow
        Those that it is about.
    """

    anchor: str
    number: str
    svg: Markup
    caption: str
    ours: str
    claims: list[ClaimRow]


def thesis_page(
    sources: Mapping[str, str],
    figures: Mapping[str, str],
    own_figures: Mapping[str, str],
    claims: Columns,
    steps: Columns,
    limited: Columns,
) -> str:
    """Return the page.

    Parameters
    ----------
    sources : dict of str to str
        File name to text of `thesis.html.j2` and of all that it asks for.
    figures : dict of str to str
        File name to SVG text, of all `FIGURES`.
    own_figures : dict of str to str
        File name to SVG text, of the figures that the thesis has not.
    claims : dict of str to (n,) array
        The columns of `schemas.CLAIMS`.
    steps, limited : dict of str to (5,) array
        The columns of `schemas.STEPS`, with our limits of registration and with the thesis's.

    Returns
    -------
    str
    """
    return templates.render_template(
        sources,
        "thesis.html.j2",
        score=summarise_verdicts(claims),
        judged=claim_rows(claims, [claim for claim in CLAIMS if claim.criterion]),
        stated=claim_rows(claims, [claim for claim in CLAIMS if not claim.criterion]),
        steps={"thesis": STEPS, "ours": _step_rows(steps), "limited": _step_rows(limited)},
        figures=[_shown_figure(figure, figures[figure.file], claims) for figure in FIGURES],
        own_figures={
            file.removesuffix(".svg"): _inline_svg(svg, file.removesuffix(".svg"))
            for file, svg in own_figures.items()
        },
    )


def claim_rows(claims: Columns, chosen: Sequence[Claim]) -> list[ClaimRow]:
    """Return rows of some claims: what is stated, what was measured, and the verdict."""
    return [_claim_row(_rows_of(claims, claim), claim) for claim in chosen]


def verdict_over_seeds(holds: Sequence[str]) -> Verdict:
    """Return the verdict over some seeds of `yes` and `no`."""
    n_seeds, n_yes = len(holds), list(holds).count("yes")
    if not n_seeds:
        return Verdict("", "")
    if n_yes == n_seeds:
        return Verdict("holds", "yes")
    if n_yes == 0:
        return Verdict("does not hold", "no")
    return Verdict(f"holds for {n_yes} of {n_seeds} seeds", "some")


def summarise_verdicts(claims: Columns) -> str:
    """Return in a sentence how many claims hold."""
    judged = [claim for claim in CLAIMS if claim.criterion]
    kinds = [verdict_over_seeds(_judgements(_rows_of(claims, claim))).css for claim in judged]
    some = f", {kinds.count('some')} hold for some seeds only" if "some" in kinds else ""
    unknown = f", {kinds.count('')} could not be measured" if "" in kinds else ""
    n_yes, n_no = kinds.count("yes"), kinds.count("no")
    return f"Of {len(kinds)} claims {n_yes} hold, {n_no} do not{some}{unknown}."


def format_values(values: Sequence[float] | FloatArray, unit: str = NUMBER) -> str:
    """Return the mean of values, and their range where they differ, as suits their unit.

    Shares are per cent, counts whole, and the largest number has three figures at most; see
    `claim_measures` for the units.
    """
    numbers = np.array([np.mean(values), np.min(values), np.max(values)])
    if unit == SHARE:
        numbers = numbers * 100
    if not np.isfinite(numbers).all():
        return _UNKNOWN
    is_whole = unit == COUNT or (numbers == numbers.round()).all()
    decimals = 0 if is_whole else _decimals(np.abs(numbers).max())
    mean, least, most = (f"{value + 0.0:,.{decimals}f}" for value in numbers.round(decimals))
    text = mean if least == most else f"{mean} ({least} to {most})"
    return text if unit in (COUNT, NUMBER) else f"{text} {unit}"


def sort_quantities(quantities: Sequence[str]) -> list[str]:
    """Return quantities by their names, `2 clusters` before `10 clusters`."""
    return sorted(quantities, key=_number_key)


def _number_key(text: str) -> list[tuple[int, str]]:
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", text)]


def _decimals(value: float) -> int:
    """Return how many decimals give a positive number three figures."""
    return max(0, 2 - int(np.floor(np.log10(value))))


def _claim_row(rows: Columns, claim: Claim) -> ClaimRow:
    unit_of = dict(zip(rows["quantity"].tolist(), rows["unit"].tolist(), strict=True))
    stated = [
        (quantity, format_values([value], unit_of.get(quantity, NUMBER)))
        for quantity, value in claim.stated.items()
    ]
    measured = [
        (quantity, format_values(rows["value"][rows["quantity"] == quantity], unit_of[quantity]))
        for quantity in sort_quantities(list(unit_of))
    ]
    verdict = verdict_over_seeds(_judgements(rows))
    if claim.criterion and not verdict.text:
        verdict = Verdict(_UNKNOWN, "")
    return ClaimRow(claim.states, claim.where, claim.criterion, stated, measured, verdict)


def _rows_of(claims: Columns, claim: Claim) -> Columns:
    of_claim = claims["claim"] == claim.name
    return {name: values[of_claim] for name, values in claims.items()}


def _judgements(rows: Columns) -> list[str]:
    """Return `yes` or `no` of every survey that a claim could be judged by."""
    by_survey = dict(zip(rows["survey"].tolist(), rows["holds"].tolist(), strict=True))
    return [holds for holds in by_survey.values() if holds]


def _shown_figure(figure: Figure, svg: str, claims: Columns) -> ShownFigure:
    anchor = f"figure-{figure.number.replace('.', '-')}"
    return ShownFigure(
        anchor,
        figure.number,
        _inline_svg(svg, anchor),
        figure.caption,
        figure.ours,
        claim_rows(claims, [claim for claim in CLAIMS if claim.name in figure.claims]),
    )


def _inline_svg(svg: str, mark: str) -> Markup:
    """Return an SVG without its prologue, its identifiers marked: two figures may have the same."""
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r'\bid="', f'id="{mark}-', svg)
    svg = re.sub(r"url\(#", f"url(#{mark}-", svg)
    return Markup(re.sub(r'href="#', f'href="#{mark}-', svg))


def _step_rows(steps: Columns) -> list[tuple[str, str, str, str]]:
    """Return step, time, scans at its end and size of the data, as table 5.1 has them."""
    names = ("name", "seconds", "n_scans", "n_bytes")
    rows = zip(*(steps[name].tolist() for name in names), strict=True)
    return [
        (name, _format_seconds(seconds), f"{n_scans:,}", _format_bytes(n_bytes))
        for name, seconds, n_scans, n_bytes in rows
    ]


def _format_seconds(seconds: float) -> str:
    if not np.isfinite(seconds):
        return _WITH_NEXT
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes else f"{seconds:.2g} s"


def _format_bytes(n_bytes: int) -> str:
    if n_bytes == NOT_WRITTEN:
        return _WITH_NEXT
    for unit, factor, digits in (("GB", 1e9, 2), ("MB", 1e6, 1)):
        if n_bytes >= factor:
            return f"{n_bytes / factor:.{digits}f} {unit}"
    return f"{n_bytes / 1e3:.0f} kB"
