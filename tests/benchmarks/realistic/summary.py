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
