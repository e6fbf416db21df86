"""The report's tables as HTML."""

from datetime import UTC, datetime
from html import escape

import numpy as np

from scanplan.plan import floorplan
from scanplan.project.settings import iterate_leaves
from scanplan.report import measure_meanings

_NOT_KNOWN = "–"


def html_table(name, heads, rows, *, sortable=False):
    """Return a table.

    Parameters
    ----------
    name : str
        Its id, and what it is called.
    heads : list of str
        A head that begins with `#` stands over numbers.
    rows : list of list
        Numbers are given as (value, text), value NaN or None where not known; a cell of class dict as
        {"class": ..., "text": ...}; all else is text. A row may be (attributes, cells).
    sortable : bool
    """
    cells = [_head(head, sortable) for head in heads]
    parts = [
        f'<div class="scroll" tabindex="0" role="region" aria-label="{escape(name)}"><table id="{escape(name)}">'
    ]
    parts.append(f"<thead><tr>{''.join(cells)}</tr></thead><tbody>")
    for row in rows:
        attributes, values = row if isinstance(row, tuple) else ("", row)
        parts.append(f"<tr{attributes}>{''.join(map(_cell, values))}</tr>")
    parts.append("</tbody></table></div>")
    return "\n".join(parts)


def number_cell(value, digits, unit=""):
    """Return a cell of a number: what sorts it and what is read."""
    if value is None or not np.isfinite(value):
        return None, _NOT_KNOWN
    return float(value), f"{value:,.{digits}f}{unit}"


def wall_table(plan, evidence):
    """Return the table of walls with their evidence, those to verify on site marked."""
    length_m = np.hypot(*np.diff(floorplan.centrelines_m(plan.walls), axis=1)[:, 0].T)
    times = _times(evidence)
    rows = []
    for i, wall in enumerate(plan.walls["wall"].tolist()):
        at = {name: values[i] for name, values in plan.walls.items()}
        verify = {"class": "flag", "text": "verify"} if at["verify"] else ""
        first, last = times.get(wall, (None, None))
        cells = [
            number_cell(wall, 0), verify, str(at["state"]), number_cell(length_m[i], 2), number_cell(1000 * at["thickness_m"], 0),
            number_cell(plan.heights_m[i], 2) if plan.low[i] else (None, ""),
            *(number_cell(1000 * at[c], 1) for c in ("sigma_offset_m", "sigma_end0_m", "sigma_end1_m", "rmse_m")),
            number_cell(at["n_points"], 0), number_cell(at["n_scans"], 0), _moment(first), _moment(last),
        ]  # fmt: skip
        rows.append((f' data-wall="{wall}" tabindex="0"', cells))
    heads = [
        "#wall", "on site", "state", "#length (m)", "#thickness (mm)", "#ends at height (m)", "#σ offset (mm)",
        "#σ start (mm)", "#σ end (mm)", "#residual (mm)", "#points", "#scans", "#first seen", "#last seen",
    ]  # fmt: skip
    return html_table("walls", heads, rows, sortable=True)


def opening_table(plan):
    """Return the table of openings and of the rooms that each joins."""
    rows = [
        [
            number_cell(opening, 0), kind, number_cell(width_m, 2), number_cell(sill_m, 2), number_cell(lintel_m, 2),
            f"{_room(a)} – {_room(b)}", number_cell(n_rays, 0),
        ]
        for opening, kind, width_m, sill_m, lintel_m, a, b, n_rays in zip(
            *(plan.openings[c].tolist() for c in
              ("opening", "type", "width_m", "sill_m", "lintel_m", "room_a", "room_b", "n_rays")), strict=True)
    ]  # fmt: skip
    heads = ["#opening", "type", "#width (m)", "#sill (m)", "#lintel (m)", "joins", "#rays through"]
    return html_table("openings", heads, rows, sortable=True)


def room_table(plan):
    """Return the table of rooms."""
    names = ("room", "area_m2", "perimeter_m", "closed", "n_scans")
    rows = [
        [
            number_cell(room, 0),
            number_cell(area_m2, 2),
            number_cell(perimeter_m, 2),
            "yes" if closed else "no",
            number_cell(n_scans, 0),
        ]
        for room, area_m2, perimeter_m, closed, n_scans in zip(
            *(plan.rooms[c].tolist() for c in names), strict=True
        )
    ]
    return html_table(
        "rooms",
        ["#room", "#area (m²)", "#perimeter (m)", "closed", "#scans that see it"],
        rows,
        sortable=True,
    )


def registration_table(verdicts, shift_m):
    """Return the table of verdicts on the candidate scans.

    Parameters
    ----------
    verdicts : dict of str to (n,) array
        The columns of `schemas.REGISTRATION`.
    shift_m : (n,) float
        How far each scan was moved from where the localiser put it; NaN where not known.
    """
    reasons = verdicts["reason"].astype(str)
    rows = []
    for reason in sorted(set(reasons), key=lambda r: (-np.sum(reasons == r), r)):
        of = reasons == reason
        medians = [_median(verdicts[c][of]) for c in ("prior_fitness", "refined_fitness")]
        kept = (
            "yes"
            if verdicts["kept"][of].all()
            else "no"
            if not verdicts["kept"][of].any()
            else "some"
        )
        rows.append([
            reason, kept, number_cell(of.sum(), 0), number_cell(of.mean() * 100, 1), *(number_cell(m, 3) for m in medians),
            number_cell(1000 * _median(verdicts["rmse_m"][of]), 0), number_cell(1000 * _median(shift_m[of]), 0),
        ])  # fmt: skip
    heads = [
        "verdict", "kept", "#scans", "#share (%)", "#fitness at the localiser's pose", "#fitness after alignment",
        "#residual (mm)", "#shift (mm)",
    ]  # fmt: skip
    return html_table("registration", heads, rows)


def truth_table(measured):
    """Return the table of the plan's agreement with the truth, from the columns of `schemas.PLAN_EVALUATION`."""
    rows = [
        [
            name.replace("_", " "),
            *(number_cell(value, 0 if name.startswith("n_") else 3) for value in values.tolist()),
            measure_meanings.measure_meaning(name),
        ]
        for name, values in measured.items()
        if name != "frame"
    ]
    title = "<details><summary><h3>The plan against the truth</h3></summary>"
    heads = ["measure", *(f"#{frame}" for frame in measured["frame"]), "meaning"]
    return f"{title}{html_table('truth', heads, rows)}</details>"


def stage_table(measured):
    """Return the table of run times: rows of stage, seconds, processor seconds, peak memory in MB."""
    rows = [
        [stage, number_cell(s, 1), number_cell(cpu_s, 1), number_cell(memory_mb, 0)]
        for stage, s, cpu_s, memory_mb in measured
    ]
    total = [
        {"class": "total", "text": "all"},
        *(number_cell(np.nansum([row[i] for row in measured]), 1) for i in (1, 2)),
        (None, ""),
    ]
    return html_table(
        "stages",
        ["stage", "#time (s)", "#processor (s)", "#peak memory (MB)"],
        [*rows, total] if rows else [],
    )


def size_table(files):
    """Return the table of data sizes: rows of what, file, bytes."""
    rows = [[what, file, number_cell(n / 1e6, 3)] for what, file, n in files]
    return html_table("sizes", ["what", "file", "#size (MB)"], rows)


def settings_table(values):
    """Return the table of settings, nested keys joined by dots."""
    return html_table(
        "settings",
        ["key", "value"],
        [[key, "null" if v is None else str(v)] for key, v in iterate_leaves(values)],
    )


def _head(head, sortable):
    css = ' class="number"' if head.startswith("#") else ""
    said = escape(head.removeprefix("#"))
    return f'<th scope="col"{css}>{f"<button>{said}</button>" if sortable else said}</th>'


def _cell(value):
    if isinstance(value, tuple):
        sort = "" if value[0] is None else f' data-sort="{value[0]:.10g}"'
        return f'<td class="number"{sort}>{escape(value[1])}</td>'
    if isinstance(value, dict):
        return f'<td class="{value["class"]}">{escape(value["text"])}</td>'
    return f"<td>{escape(value)}</td>"


def _times(evidence):
    """Return the first and the last moment (ns) at which each wall was seen."""
    seen = {}
    for wall, t_ns in zip(evidence["wall"].tolist(), evidence["t_ns"].tolist(), strict=True):
        first, last = seen.get(wall, (t_ns, t_ns))
        seen[wall] = min(first, t_ns), max(last, t_ns)
    return seen


def _moment(t_ns):
    if t_ns is None:
        return None, _NOT_KNOWN
    return t_ns, datetime.fromtimestamp(t_ns / 1e9, UTC).strftime("%H:%M:%S")


def _room(room):
    return "outside or not known" if room < 0 else f"room {room}"


def _median(values):
    values = values[np.isfinite(values)]
    return float(np.median(values)) if len(values) else np.nan
