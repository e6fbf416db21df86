"""The bench's figures in the terminal: means by half, and by kind of building."""

from typing import TYPE_CHECKING

from realistic import page

if TYPE_CHECKING:
    import pandas as pd


def print_summary(measures: "pd.DataFrame") -> None:
    """Print the means of the headline measures."""
    names = [name for name in page.HEADLINES if name in measures]
    for half, group in measures.groupby("half", sort=False):
        failed = group[group["failed"] != ""]
        print(f"{half}: {len(group)} floors, {len(failed)} without a plan", flush=True)
        for _, row in failed.iterrows():
            print(f"  {row['floor']}: {row['failed']}", flush=True)
        for name in names:
            known = group[name].dropna()
            if len(known):
                print(
                    f"  {page.HEADLINES[name]}: mean {known.mean():.3f}, least {known.min():.3f},"
                    f" most {known.max():.3f} ({len(known)} floors)",
                    flush=True,
                )


def format_tables(measures: "pd.DataFrame") -> str:
    """Return Markdown tables of the headline measures: means by half, by kind, and real floors."""
    drives = measures[measures["half"] != "real"]
    real = measures[measures["half"] == "real"]
    parts = [("half", measures, ["half"]), ("kind", drives, ["half", "kind"])]
    parts += [("sensor", drives, ["sensor"]), ("floor", real, ["floor"])]
    return "\n\n".join(_format_table(*part) for part in parts if len(part[1])) + "\n"


def _format_table(head: str, measures: "pd.DataFrame", by: list[str]) -> str:
    names = [n for n in page.HEADLINES if n in measures and measures[n].notna().any()]
    heads = [head, "floors", *(page.HEADLINES[name] for name in names)]
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for key, group in measures.groupby(by, sort=False):
        cells = [" ".join(map(str, key)), str(len(group))]
        cells += [_format_mean(group[name].mean()) for name in names]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _format_mean(value: float) -> str:
    if value != value:
        return "-"
    return f"{value:.1f}" if abs(value) >= 10 else f"{value:.3f}".removeprefix("0")
