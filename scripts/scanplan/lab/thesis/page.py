"""The report of the thesis's experiments: one HTML page that needs nothing beside it."""

import re
from html import escape

import numpy as np

from scanplan.lab.thesis.claim_measures import COUNT, NUMBER, SHARE
from scanplan.lab.thesis.shown_figures import FIGURES, STEPS
from scanplan.lab.thesis.stated_claims import CLAIMS

_STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; max-width: 68rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
table { border-collapse: collapse; margin: .6rem 0; font-size: 13.5px; }
th, td { border-bottom: 1px solid #ddd; padding: .3rem .6rem; text-align: left; vertical-align: top; }
td:nth-child(3) { min-width: 25rem; }
td:nth-child(4), .value { white-space: nowrap; }
td.number { min-width: 0 !important; text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
figure { margin: 1.2rem 0 2.4rem; } figcaption { font-size: 13.5px; }
svg { max-width: 100%; height: auto; }
.yes { color: #04703c; } .no { color: #b3261e; } .some { color: #8a5a00; } .yes, .no, .some { font-weight: 600; }
nav { font-size: 13.5px; }
"""


_UNKNOWN = "not measured"
_BEYOND = (
    "What the first scans of every order find of the visible walls (0.10 m) per what the oracle's find: mean over the"
    " seeds of the survey of the rooms, in brackets their range. The oracle knows what extraction finds in every scan"
    " and takes greedily what adds most: at least 63 % (1 - 1/e) of what the best choice of as many scans finds. The"
    " thesis's orders are cluster hulls, one hull per scan, random and as recorded."
)


def thesis_page(figures, beyond, claims, steps, limited):
    """Write the page.

    Parameters
    ----------
    figures : dict of str to str
        File name to SVG text, of all `FIGURES`.
    beyond : str
        SVG text of the orders of ours beside the thesis's.
    claims : dict of str to (n,) array
        The columns of `schemas.CLAIMS`.
    steps, limited : dict of str to (4,) array
        The columns of `schemas.STEPS`, with our limits of registration and with the thesis's.

    Returns
    -------
    str
    """
    links = " · ".join(f'<a href="#{_anchor(figure)}">{figure.number}</a>' for figure in FIGURES)
    body = [
        "<h1>The experiments of the thesis</h1>",
        "<p>Every figure, the table and every claim of “Pointcloud scan selection for indoor floor plan generation”,"
        " repeated on simulated surveys with known truth: <i>ring_rooms</i>, registered scans of the rooms of an office"
        " (thesis, 5.2), and <i>ring_hallways</i>, a drive through its hallways (5.4; the thesis's is a recording of a"
        " real building). Our numbers are means over the seeds with their range in brackets. Run times are of the"
        " machine that made this page and differ from run to run; those of single calls are processor time.</p>",
        f'<nav><a href="#claims">Claims</a> · <a href="#table">Table 5.1</a> · Figures {links} ·'
        ' <a href="#beyond">Beyond the thesis</a></nav>',
        '<h2 id="claims">Claims</h2>',
        f"<p>{_score(claims)}</p>",
        claims_table(claims, [claim for claim in CLAIMS if claim.criterion]),
        "<h3>Numbers that the thesis states without a claim</h3>",
        claims_table(claims, [claim for claim in CLAIMS if not claim.criterion]),
        '<h2 id="table">Table 5.1: computation time required for each step</h2>',
        steps_table(steps, limited),
        "<p><small>First seed. Our times are of whole jobs: starting Python and reading and writing tables is in them,"
        " and the last orders all scans, of which the first 15 are the subset;"
        " the data after the hulls are the table of hulls.</small></p>",
        "<h2>Figures</h2>",
        *(_figure(figure, figures[figure.file], claims) for figure in FIGURES),
        '<h2 id="beyond">Beyond the thesis</h2>',
        f"<figure>{_inline(beyond, 'orders')}<figcaption>{_BEYOND}</figcaption></figure>",
    ]
    head = (
        f'<meta charset="utf-8"><title>The experiments of the thesis</title><style>{_STYLE}</style>'
    )
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head>{head}</head><body>\n'
        + "\n".join(body)
        + "\n</body></html>\n"
    )


def claims_table(claims, chosen):
    """Return the table of some claims: what is stated, what was measured, and the verdict."""
    rows = [
        f"<tr><td>{escape(claim.states)}<br><small>{escape(claim.where)}</small></td>"
        f"<td>{_criterion(claims, claim)}</td><td>{_measured(claims, claim)}</td>"
        f"<td>{_verdict(claims, claim)}</td></tr>"
        for claim in chosen
    ]
    head = (
        "<tr><th>The thesis</th><th>Criterion, stated number</th><th>Ours</th><th>Verdict</th></tr>"
    )
    return f"<table>{head}{''.join(rows)}</table>"


def steps_table(steps, limited):
    """Return table 5.1: the thesis's rows and ours, whose one step both selects continuous scans and registers them."""
    theirs = "".join(_row(step, [time, scans, size]) for step, time, scans, size in STEPS)
    ours = [
        f'<tr><th colspan="4">{title}</th></tr>'
        + "".join(_row(*_step(table, i)) for i in range(len(table["step"])))
        for title, table in (
            ("Ours, with our limits", steps),
            ("Ours, with the thesis's limits", limited),
        )
    ]
    head = "<tr><th>Step</th><th>Time</th><th># scans at end of step</th><th>Data size</th></tr>"
    return f'<table>{head}<tr><th colspan="4">The thesis</th></tr>{theirs}{"".join(ours)}</table>'


def verdict_over_seeds(holds):
    """Return the verdict over some seeds of `yes` and `no`, and its class; nothing where there are none."""
    n, n_yes = len(holds), list(holds).count("yes")
    if not n:
        return "", ""
    if n_yes in (0, n):
        return ("holds", "yes") if n_yes else ("does not hold", "no")
    return f"holds for {n_yes} of {n} seeds", "some"


def format_values(values, unit=NUMBER):
    """Return the mean of values, and their range where they differ, as suits their unit (see `claims`).

    Shares are per cent, counts whole, and the largest number has three figures at most.
    """
    told = np.array([np.mean(values), np.min(values), np.max(values)]) * (
        100 if unit == SHARE else 1
    )
    if not np.isfinite(told).all():
        return _UNKNOWN
    decimals = 0 if unit == COUNT or (told == told.round()).all() else _decimals(np.abs(told).max())
    shown = [f"{value + 0.0:,.{decimals}f}" for value in told.round(decimals)]
    text = shown[0] if shown[1] == shown[2] else f"{shown[0]} ({shown[1]} to {shown[2]})"
    return text if unit in (COUNT, NUMBER) else f"{text} {unit}"


def _decimals(value):
    """Return how many decimals give a positive number three figures."""
    return max(0, 2 - int(np.floor(np.log10(value))))


def _figure(figure, svg, claims):
    about = [claim for claim in CLAIMS if claim.name in figure.claims]
    return (
        f'<figure id="{_anchor(figure)}"><h3>Figure {figure.number}</h3>{_inline(svg, _anchor(figure))}'
        f"<figcaption><b>The thesis:</b> {escape(figure.caption)}<br><b>Ours:</b> {escape(figure.ours)}</figcaption>"
        f"{claims_table(claims, about) if about else ''}</figure>"
    )


def _inline(svg, mark):
    """An SVG without its prologue, its identifiers marked: those of two figures may be the same."""
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r'\bid="', f'id="{mark}-', svg)
    svg = re.sub(r"url\(#", f"url(#{mark}-", svg)
    return re.sub(r'href="#', f'href="#{mark}-', svg)


def _anchor(figure):
    return f"figure-{figure.number.replace('.', '-')}"


def _rows(claims, claim):
    of_it = claims["claim"] == claim.name
    return {name: values[of_it] for name, values in claims.items()}


def _criterion(claims, claim):
    units = _units(claims, claim)
    stated = [
        f"{escape(quantity)}: {format_values([value], units.get(quantity, NUMBER))}"
        for quantity, value in claim.stated.items()
    ]
    return "<br>".join([escape(claim.criterion)] * bool(claim.criterion) + stated)


def _measured(claims, claim):
    rows = _rows(claims, claim)
    units = _units(claims, claim)
    quantities = sorted(units, key=_by_number)
    values = {q: format_values(rows["value"][rows["quantity"] == q], units[q]) for q in quantities}
    return "<br>".join(
        f'{escape(q)}: <span class="value">{escape(value)}</span>' for q, value in values.items()
    )


def _units(claims, claim):
    """Return the unit of every quantity of a claim."""
    rows = _rows(claims, claim)
    return dict(zip(rows["quantity"].tolist(), rows["unit"].tolist(), strict=True))


def _by_number(text):
    """A key that sorts `2 clusters` before `10 clusters`."""
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", text)]


def _judged(claims, claim):
    rows = _rows(claims, claim)
    by_survey = {
        s: h for s, h in zip(rows["survey"].tolist(), rows["holds"].tolist(), strict=True) if h
    }
    return list(by_survey.values())


def _verdict(claims, claim):
    text, kind = verdict_over_seeds(_judged(claims, claim))
    if claim.criterion and not text:
        return _UNKNOWN
    return f'<span class="{kind}">{text}</span>'


def _score(claims):
    kinds = [verdict_over_seeds(_judged(claims, claim))[1] for claim in CLAIMS if claim.criterion]
    some = f", {kinds.count('some')} hold for some seeds only" if "some" in kinds else ""
    unknown = f", {kinds.count('')} could not be measured" if "" in kinds else ""
    return f"Of {len(kinds)} claims {kinds.count('yes')} hold, {kinds.count('no')} do not{some}{unknown}."


def _row(step, cells):
    return (
        f"<tr><td>{escape(step)}</td>"
        + "".join(f'<td class="number">{cell}</td>' for cell in cells)
        + "</tr>"
    )


def _step(table, i):
    seconds, n_bytes = float(table["seconds"][i]), int(table["n_bytes"][i])
    minutes, rest = divmod(round(seconds), 60)
    time = f"{minutes} min {rest} s" if minutes else f"{seconds:.2g} s"
    return str(table["name"][i]), [time, f"{table['n_scans'][i]:,}", _size(n_bytes)]


def _size(n_bytes):
    for unit, factor, digits in (("GB", 1e9, 2), ("MB", 1e6, 1)):
        if n_bytes >= factor:
            return f"{n_bytes / factor:.{digits}f} {unit}"
    return f"{n_bytes / 1e3:.0f} kB"
