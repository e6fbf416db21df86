"""What the experiments show, in a sentence each: the numbers are those measured."""

import pandas as pd

from scanplan.lab.beyond import (
    live_choice,
    outliers,
    point_budgets,
    quality_times,
    registrability,
    room_counts,
    sensitivity,
)
from scanplan.lab.beyond.measurements import mean_by_level
from scanplan.lab.evaluation.evaluation_figure import method_style


def conclude_budgets(measured: pd.DataFrame) -> str:
    """Say what finds most with few points."""
    found = mean_by_level(measured, point_budgets.FOUND_SHARE)
    parts = []
    for size in dict.fromkeys((found.index[len(found) // 3], found.index[-1])):
        whole = found.loc[size].drop([case for case in found if case.startswith("all scans")])
        thinned = found.loc[size].drop(whole.index)
        parts.append(
            f"with the points of {size:.0f} scans, {_percent(whole.max())} of the walls by whole"
            f" scans ({_label(whole.idxmax())}) and {_percent(thinned.max())} by {thinned.idxmax()}"
        )
    return f"Found at best {'; '.join(parts)}."


def conclude_quality_times(measured: pd.DataFrame) -> str:
    """Say how soon each order has a good plan."""
    values = measured.pivot_table(index=["case", "level"], columns="quantity", values="value")
    good = values[values[quality_times.F1] >= quality_times.GOOD].reset_index()
    first = good.sort_values("level").groupby("case", sort=False).first()
    first = first.sort_values(quality_times.SECONDS)
    parts = [
        f"{_label(str(case))} {row[quality_times.SECONDS]:.0f} s with {row['level']:.0f} scans"
        f" (selection {row[quality_times.SELECTING]:.1f} s)"
        for case, row in first.iterrows()
    ]
    never = [_label(case) for case in measured["case"].unique() if case not in first.index]
    missed = f"; not reached: {', '.join(never)}" if never else ""
    return f"To an F1 of {quality_times.GOOD}: {', '.join(parts)}{missed}."


def conclude_room_counts(measured: pd.DataFrame) -> str:
    """Say how many scans a room needs in small and in large floors."""
    counts = mean_by_level(measured, room_counts.NEEDED)
    per_room = counts.div(counts.index, axis="index")
    least, most = counts.index[0], counts.index[-1]
    parts = [
        f"{_label(method)} {per_room.loc[least, method]:.1f} and {per_room.loc[most, method]:.1f}"
        for method in counts
    ]
    return f"Scans per room on floors of {least:.0f} and of {most:.0f} rooms: {', '.join(parts)}."


def conclude_outliers(measured: pd.DataFrame) -> str:
    """Say what the most outliers do to each surrogate."""
    areas = mean_by_level(measured, outliers.AREA_RATIO)
    found = mean_by_level(measured, outliers.FOUND_SHARE)
    share = areas.index[-1]
    parts = []
    for kind in outliers.KINDS:
        own = [case for case in areas if case.startswith(f"{kind}: ")]
        grown = areas.loc[share, own]
        lost = (found.loc[0, own] - found.loc[share, own]).sort_values()
        parts.append(
            f"{kind}: areas {grown.min():.2f} ({_surrogate(grown.idxmin())}) to"
            f" {grown.max():.2f} times ({_surrogate(grown.idxmax())}), walls found"
            f" {100 * lost.iloc[0]:.1f} ({_surrogate(lost.index[0])}) to {100 * lost.iloc[-1]:.1f}"
            f" points fewer ({_surrogate(lost.index[-1])})"
        )
    return f"With {_percent(share)} of {'; '.join(parts)}."


def conclude_registrability(measured: pd.DataFrame) -> str:
    """Say which part of a subset hangs together."""
    parts = mean_by_level(measured, registrability.ALIGNED)
    pairs = mean_by_level(measured, registrability.PAIRS_ALIGNED)
    chosen = parts.index[:-1] if len(parts) > 1 else parts.index
    told = []
    for size in dict.fromkeys((chosen[len(chosen) // 2], chosen[-1])):
        shares = [f"{_label(method)} {_percent(parts.loc[size, method])}" for method in parts]
        told.append(f"of {size:.0f} scans {', '.join(shares)}")
    return (
        f"The largest part that can be registered without the other scans holds {'; '.join(told)};"
        f" of all scans {_percent(parts.iloc[-1].max())}. Where two chosen scans overlap, alignment"
        f" is right in {_percent(pairs.loc[chosen].mean(axis=None))}."
    )


def conclude_live_choice(measured: pd.DataFrame) -> str:
    """Say what one pass loses."""
    found = mean_by_level(measured, live_choice.FOUND_SHARE)
    taken = mean_by_level(measured, live_choice.TAKEN)[live_choice.PLAYING]
    held = mean_by_level(measured, live_choice.HELD)[live_choice.PLAYING].max()
    parts = []
    for share in dict.fromkeys((found.index[0], found.index[-1])):
        others = [
            f"{_label(method)} {_percent(found.loc[share, method])}"
            for method in found
            if method != live_choice.PLAYING
        ]
        parts.append(
            f"{share:.2f} asked for, {taken[share]:.0f} scans find"
            f" {_percent(found.loc[share, live_choice.PLAYING])} (as many by {', '.join(others)})"
        )
    told = "; ".join(parts)
    return f"With a share of new wall of {told}. At most {held:.0f} cells of wall are kept."


def conclude_sensitivity(measured: pd.DataFrame) -> str:
    """Say which claims turn on an unstated number."""
    parts = []
    for claim in (sensitivity.LITTLE_LOSS, sensitivity.POOREST):
        margins = mean_by_level(measured, claim)
        usual = margins.loc[1.0].iloc[0] > 0
        turning = [number for number in margins if ((margins[number] > 0) != usual).any()]
        verdict = (
            f"turns on the {' and the '.join(turning)}" if turning else "turns on none of them"
        )
        parts.append(
            f"that {claim} {verdict} (margins {100 * margins.min().min():.1f} to"
            f" {100 * margins.max().max():.1f} points)"
        )
    return f"Each number halved and doubled: {'; '.join(parts)}."


def _percent(share: float) -> str:
    return f"{100 * share:.1f} %"


def _label(method: str) -> str:
    return method_style(method)[0]


def _surrogate(case: object) -> str:
    return str(case).partition(": ")[2]
