"""One page of the bench: what hurts most, figures by half and kind, a picture of every floor."""

import html
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from realistic import pictures
from scanplan.lab.evaluation.scores import score

if TYPE_CHECKING:
    import pandas as pd

    from scanplan.types import Array

HEADLINES = {
    "wall_correctness_010": "walls correct",
    "lsd_wall_correctness_010": "LSD's correct",
    "wall_completeness_010": "complete",
    "lsd_wall_completeness_010": "LSD's complete",
    "room_iou": "rooms IoU",
    "watershed_room_iou": "the watershed's",
    "room_wrong_flagged": "wrong rooms flagged",
    "leaves_as_wall_share": "leaves as wall",
    "leaves_found_share": "leaves found",
    "doors_driven_recall": "doors driven",
    "doors_seen_recall": "doors seen",
    "door_precision": "doors right",
    "windows_recall": "windows",
    "window_precision": "windows right",
    "column_recall": "columns",
    "thickness_off": "thickness off",
    "room_height_right": "room heights",
    "face_wrong_flagged": "wrong faces flagged",
    "face_right_flagged": "right faces flagged",
    "total_cpu_s": "processor s",
}
"""Measure to its heading; see `scanplan.lab.evaluation.scores`."""
_WHOLE = ("face", "wall")
_NAMES = {"stretch": "wall"}
"""Table to what people call its rows, where they do not call them that."""
_IN_M2 = ("room", "column")
_BAR_PX = 150  # of all there is: two halves beside each other on a laptop
_MOST_SHOWN = 3  # errors of a floor that are named beside its picture
_MEASURED = {"stretch": "wall_drawn_m", "thickness": "thickness_known_m"}
"""Table whose rows are all wrong to the measure that says how many metres there are."""
_READING = (
    "Of all: of the elements of a kind that are drawn or missed; of walls and thicknesses, of the"
    " metres that are drawn. Flagged: of these errors, marked by the plan as to be verified."
)
_MEANING = (
    "Means over floors: shares of what is to be found or (right, correct) of what is drawn. More is"
    " better, but less of leaves as wall, thickness off, right faces flagged and processor seconds."
)
_STYLE = """
body{font:14px/1.45 system-ui,sans-serif;margin:1.5rem;color:#222}
table{border-collapse:collapse;margin:.6rem 0}
td,th{padding:.15rem .5rem;border-bottom:1px solid #ddd;text-align:right}
td:first-child,th:first-child{text-align:left}
.floors,.halves{display:flex;flex-wrap:wrap;gap:1rem 2rem}
.floor{border:1px solid #ddd;padding:.5rem;width:470px}
.key b{display:inline-block;width:1em;height:.6em;margin:0 .3em 0 1em}
.bar{display:inline-block;height:.7em;background:#e41a1c}
svg{background:#fff;max-height:420px}
"""
_SCRIPT = """
function show(){const w=document.getElementById('filter').value.trim().split(/\\s+/);
for(const f of document.querySelectorAll('.floor'))
f.style.display=w.every(x=>f.dataset.words.includes(x))?'':'none'}
"""


def write_page(
    path: Path,
    title: str,
    measures: "pd.DataFrame",
    elements: "pd.DataFrame",
    truths: Mapping[str, Sequence[pictures.TrueFeature]],
) -> None:
    """Write the page of a run.

    Parameters
    ----------
    path : Path
        An HTML file, which opens offline.
    title : str
    measures : DataFrame
        A row a floor: `floor`, `kind`, `half`, `sensor`, `failed` and measures.
    elements : DataFrame
        A row an element, by `floor`.
    truths : dict of str to list of pictures.TrueFeature
        The truth's features of each floor.
    """
    parts = [
        f"<!doctype html><meta charset=utf-8><title>{html.escape(title)}</title>",
        f"<style>{_STYLE}</style><script>{_SCRIPT}</script><h1>{html.escape(title)}</h1>",
        *_list_failures(measures),
        "<h2>What hurts most</h2>",
        f"<p>{_READING}</p><div class=halves>",
        *_list_errors(elements, measures),
        f"</div><p>{_MEANING}</p>",
        _table_of_means(measures, ["half"]),
        "<h2>Floors, the worst first</h2>",
        f"<p class=key>{_key()}</p>",
        '<p>show only <input id=filter oninput=show() placeholder="tuning museum laser"></p>',
        "<div class=floors>",
        *_draw_floors(measures, elements, truths),
        "</div><h2>Means</h2>",
        _table_of_means(measures[measures["half"] != "real"], ["half", "kind"]),
        _table_of_means(measures[measures["half"] != "real"], ["half", "sensor"]),
    ]
    path.write_text("\n".join(parts), encoding="utf-8")


def rank_floors(measures: "pd.DataFrame") -> "pd.DataFrame":
    """Return the rows of floors with the worst first: by wrong walls, missed walls and rooms."""
    bad = sum(
        1 - measures[name].fillna(1.0)
        for name in ("wall_correctness_010", "wall_completeness_010", "room_iou")
        if name in measures
    )
    failed = 10.0 * (measures["failed"] != "")
    order = np.argsort(-(np.asarray(bad, float) + np.asarray(failed, float)), kind="stable")
    return measures.iloc[order]


def _list_errors(elements: "pd.DataFrame", measures: "pd.DataFrame") -> Iterator[str]:
    """Yield a table a half: kinds of errors, by how much of all there is they are.

    Of elements by number; of stretches, and those of a wrong thickness, by length, of all wall that
    is drawn and of all whose thickness is known.
    """
    halves = measures.set_index("floor")["half"]
    of_half = elements["floor"].map(halves)
    for half in dict.fromkeys(measures["half"]):
        rows = _select_shown(elements[of_half == half])
        kinds = _count_errors(rows)
        if kinds.empty:
            continue
        whole = rows.groupby("table").size().to_dict()
        of = measures[measures["half"] == half]
        whole |= {table: of[name].sum() for table, name in _MEASURED.items() if name in of}
        kinds["share"] = [
            row["size" if table in _MEASURED else "n"] / whole[table]
            for (table, _), row in kinds.iterrows()
        ]
        kinds["bar_px"] = _BAR_PX * kinds["share"].clip(upper=1)
        lines = [
            f"<tr><td>{_call(table, verdict)}</td><td>{row['n']:.0f}</td>"
            f"<td>{row['size']:.0f} {'m2' if table in _IN_M2 else 'm'}</td>"
            f"<td>{row['share']:.0%}</td><td>{row['flagged']:.0%}</td><td>{row['floors']:.0f}</td>"
            f'<td style="text-align:left"><i class=bar style="width:{row["bar_px"]:.0f}px;'
            f'background:{pictures.colour_of(verdict)}"></i></td></tr>'
            for (table, verdict), row in kinds.sort_values("share", ascending=False).iterrows()
        ]
        yield (
            f"<div><h3>{half}</h3><table><tr><th>error</th><th>elements</th><th>size</th>"
            "<th>of all</th><th>flagged</th><th>floors</th><th></th></tr>"
        )
        yield "".join(lines) + "</table></div>"


def _select_shown(elements: "pd.DataFrame") -> "pd.DataFrame":
    """Return the elements that count, of faces and walls the stretches alone."""
    is_shown = ~elements["table"].isin(_WHOLE) & ~elements["verdict"].isin(score.UNCOUNTED)
    return elements[is_shown]


def _count_errors(rows: "pd.DataFrame") -> "pd.DataFrame":
    """Return the kinds of errors among elements, by table and verdict."""
    wrong = rows[rows["verdict"] != "right"]
    return wrong.groupby(["table", "verdict"]).agg(
        n=("size", "size"),
        size=("size", "sum"),
        floors=("floor", "nunique"),
        flagged=("flagged", "mean"),
    )


def _call(table: str, verdict: str) -> str:
    """Return what people call an error."""
    return f"{_NAMES.get(table, table)}: {pictures.WORDS.get(verdict, verdict)}"


def _table_of_means(measures: "pd.DataFrame", by: list[str]) -> str:
    names = [name for name in HEADLINES if name in measures]
    heads = "".join(f"<th>{HEADLINES[name]}</th>" for name in names)
    rows = []
    for key, group in measures.groupby(by, sort=False):
        label = html.escape(" ".join(map(str, key)))
        cells = "".join(f"<td>{_number(group[name].mean())}</td>" for name in names)
        rows.append(f"<tr><td>{label}</td><td>{len(group)}</td>{cells}</tr>")
    return f"<table><tr><th></th><th>floors</th>{heads}</tr>{''.join(rows)}</table>"


def _list_failures(measures: "pd.DataFrame") -> Iterator[str]:
    failed = measures[measures["failed"] != ""]
    if len(failed):
        yield f"<h2>{len(failed)} floors without a plan</h2><ul>"
        for _, row in failed.iterrows():
            yield f"<li>{html.escape(row['floor'])}: {html.escape(row['failed'])}</li>"
        yield "</ul>"


def _draw_floors(
    measures: "pd.DataFrame",
    elements: "pd.DataFrame",
    truths: Mapping[str, Sequence[pictures.TrueFeature]],
) -> Iterator[str]:
    by_floor = {str(name): rows for name, rows in elements.groupby("floor")}
    for _, row in rank_floors(measures).iterrows():
        name = row["floor"]
        words = html.escape(f"{name} {row['kind']} {row['half']} {row['sensor']}")
        title = html.escape(f"{name}, {row['half']}")
        figures = "; ".join(
            f"{HEADLINES[key]} {_number(row[key])}" for key in HEADLINES if _is_known(row, key)
        )
        picture = ""
        if name in by_floor:
            columns: dict[str, Array] = {c: by_floor[name][c].to_numpy() for c in by_floor[name]}
            picture = f"{_name_worst(by_floor[name])}{pictures.draw_floor(truths[name], columns)}"
        yield (
            f'<div class=floor data-words="{words}"><b>{title}</b><br>{picture}'
            f"<br><small>{figures}</small>{html.escape(row['failed'])}</div>"
        )


def _name_worst(elements: "pd.DataFrame") -> str:
    """Return the commonest errors of a floor in words, as a line of the page."""
    kinds = _count_errors(_select_shown(elements)).sort_values("n", ascending=False, kind="stable")
    worst = [
        f"{row['n']:.0f} {_call(table, verdict)}"
        for (table, verdict), row in kinds.head(_MOST_SHOWN).iterrows()
    ]
    return f"{'; '.join(worst)}<br>" if worst else ""


def _is_known(row: "pd.Series", key: str) -> bool:
    return key in row and row[key] == row[key]


def _number(value: float) -> str:
    if value != value:
        return "-"
    return f"{value:.3f}" if abs(value) < 10 else f"{value:.1f}"


def _key() -> str:
    entries = pictures.list_colours().items()
    return "".join(f'<b style="background:{colour}"></b>{words}' for colour, words in entries)
