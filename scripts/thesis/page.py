"""The report of the thesis's experiments: one HTML page that needs nothing beside it."""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from markupsafe import Markup
from scipy.special import stdtrit

from scanplan.report import templates
from scanplan.types import FloatArray
from thesis.claim_measures import COUNT, MARGIN, NUMBER, SHARE
from thesis.shown_figures import FIGURES, STEPS, Figure
from thesis.stated_claims import CLAIMS, Claim
from thesis.thesis_schemas import NOT_WRITTEN

DEVIATIONS = "deviations.md"
"""The file with the table of where the product differs from the thesis."""
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
    margin : str
        By how much the criterion holds, with its interval; empty where nothing was judged.
    otherwise : str
        Whose doing it is that the claim does not hold; empty where it does.
    """

    states: str
    where: str
    criterion: str
    stated: list[tuple[str, str]]
    measured: list[tuple[str, str]]
    verdict: Verdict
    margin: str
    otherwise: str


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
    claims: pd.DataFrame,
    steps: pd.DataFrame,
    limited: pd.DataFrame,
) -> str:
    """Return the page.

    Parameters
    ----------
    sources : dict of str to str
        File name to text of `thesis.html.j2`, of all that it asks for, and of `DEVIATIONS`.
    figures : dict of str to str
        File name to SVG text, of all `FIGURES`.
    own_figures : dict of str to str
        File name to SVG text, of the figures that the thesis has not.
    claims : pandas.DataFrame
        `thesis_schemas.CLAIMS`.
    steps, limited : pandas.DataFrame
        `thesis_schemas.STEPS`, with our limits of registration and with the thesis's.

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
        deviations=read_deviations(sources[DEVIATIONS]),
        own_figures={
            file.removesuffix(".svg"): inline_svg(svg, file.removesuffix(".svg"))
            for file, svg in own_figures.items()
        },
    )


def read_deviations(text: str) -> list[list[str]]:
    """Return the rows of the table in a Markdown text, the head first, without its markup."""
    lines = [line.strip() for line in text.splitlines() if line.startswith("|")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return [[cell.replace("`", "") for cell in row] for row in cells if set(row[0]) - set("-: ")]


def claim_rows(claims: pd.DataFrame, chosen: Sequence[Claim]) -> list[ClaimRow]:
    """Return rows of some claims: what is stated, what was measured, and the verdict."""
    return [_claim_row(claims[claims["claim"] == claim.name], claim) for claim in chosen]


def margin_interval(margins: Sequence[float] | FloatArray) -> tuple[float, float]:
    """Return the 95 % interval of the mean of margins (n,), n >= 1, by Student's t.

    A margin compares what was measured on the same seed, so this is the interval of the paired
    differences. Of a single seed there is none: it is the margin itself, twice.
    """
    mean, n = np.mean(margins), len(margins)
    if n == 1:
        return float(mean), float(mean)
    half = stdtrit(n - 1, 0.975) * np.std(margins, ddof=1) / np.sqrt(n)
    return float(mean - half), float(mean + half)


def verdict_over_seeds(margins: Sequence[float] | FloatArray) -> Verdict:
    """Return the verdict by the margins (n,) of some seeds: by their interval."""
    if not len(margins):
        return Verdict("", "")
    low, high = margin_interval(margins)
    if low > 0:
        return Verdict("holds", "yes")
    if high <= 0:
        return Verdict("does not hold", "no")
    n_yes = int(np.count_nonzero(np.asarray(margins) > 0))
    needed = f"; about {n:,} such seeds would decide" if (n := seeds_to_decide(margins)) else ""
    return Verdict(f"undecided: holds for {n_yes} of {len(margins)} seeds{needed}", "some")


def seeds_to_decide(margins: Sequence[float] | FloatArray) -> int:
    """Return how many seeds would decide, with the mean and the deviation of these margins (n,).

    0 where no thousand seeds would, as their mean is hardly off 0.
    """
    mean, deviation = np.mean(margins), np.std(margins, ddof=1)
    numbers = np.arange(len(margins), 1001)
    half = stdtrit(numbers - 1, 0.975) * deviation / np.sqrt(numbers)
    enough = numbers[half < abs(mean)]
    return int(enough[0]) if len(enough) else 0


def summarise_verdicts(claims: pd.DataFrame) -> str:
    """Return in sentences how many claims hold."""
    rows = claim_rows(claims, [claim for claim in CLAIMS if claim.criterion])
    counts = Counter(row.verdict.css for row in rows)
    n_numbers = sum(not claim.criterion for claim in CLAIMS)
    some = f", {counts['some']} cannot be decided by these seeds" if counts["some"] else ""
    unknown = f", {counts['']} could not be measured" if counts[""] else ""
    return (
        f"Of {len(rows)} claims {counts['yes']} hold, {counts['no']} do not{some}{unknown}."
        f" {n_numbers} more are numbers of another building, sensor or machine, or of a quantity"
        " that the thesis leaves open: ours stand beside them without a verdict."
    )


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


def _claim_row(rows: pd.DataFrame, claim: Claim) -> ClaimRow:
    unit_of = rows.groupby("quantity")["unit"].first()
    measured = {
        quantity: format_values(_known(values), unit_of[quantity])
        for quantity, values in rows.groupby("quantity")["value"]
        if quantity != MARGIN
    }
    stated = [
        (quantity, format_values([value], unit_of.get(quantity, NUMBER)))
        for quantity, value in claim.stated.items()
    ]
    margins = rows.loc[(rows["quantity"] == MARGIN) & (rows["holds"] != ""), "value"].to_numpy()
    verdict = verdict_over_seeds(margins)
    if claim.criterion and not verdict.text:
        verdict = Verdict(_UNKNOWN, "")
    return ClaimRow(
        claim.states,
        claim.where,
        claim.criterion,
        stated,
        [(quantity, measured[quantity]) for quantity in sort_quantities(list(measured))],
        verdict,
        _format_margin(margins, unit_of.get(MARGIN, NUMBER)),
        _fill_in(claim.otherwise, measured) if verdict.css in ("no", "some") else "",
    )


def _known(values: pd.Series) -> FloatArray:
    """Return the values of the seeds that have one; all, where none has."""
    known = values.dropna()
    return (known if len(known) else values).to_numpy()


def _format_margin(margins: FloatArray, unit: str) -> str:
    """Return the mean of margins (n,) with the interval that the verdict goes by."""
    if not len(margins):
        return ""
    interval = margin_interval(margins) if len(margins) > 1 else ()
    return format_values([float(np.mean(margins)), *interval], unit)


def _fill_in(text: str, measured: Mapping[str, str]) -> str:
    """Return a text with what was measured in the place of the quantities in braces."""
    return re.sub(r"\{([^}]+)\}", lambda match: measured.get(match[1], _UNKNOWN), text)


def _shown_figure(figure: Figure, svg: str, claims: pd.DataFrame) -> ShownFigure:
    anchor = f"figure-{figure.number.replace('.', '-')}"
    return ShownFigure(
        anchor,
        figure.number,
        inline_svg(svg, anchor),
        figure.caption,
        figure.ours,
        claim_rows(claims, [claim for claim in CLAIMS if claim.name in figure.claims]),
    )


def inline_svg(svg: str, mark: str) -> Markup:
    """Return an SVG without its prologue, its identifiers marked: two figures may have the same."""
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r'\bid="', f'id="{mark}-', svg)
    svg = re.sub(r"url\(#", f"url(#{mark}-", svg)
    return Markup(re.sub(r'href="#', f'href="#{mark}-', svg))


def _step_rows(steps: pd.DataFrame) -> list[tuple[str, str, str, str]]:
    """Return step, time, scans at its end and size of the data, as table 5.1 has them."""
    return [
        (row.name, _format_seconds(row.seconds), f"{row.n_scans:,}", _format_bytes(row.n_bytes))
        for row in steps[["name", "seconds", "n_scans", "n_bytes"]].itertuples(index=False)
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
