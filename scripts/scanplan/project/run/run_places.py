"""The places that a run works in: whether it can write there, and dates that it can go by.

What Snakemake itself would fail at, with a traceback, is tried before it works anything out.
"""

import os
import stat
import time
from collections.abc import Iterable
from contextlib import suppress
from datetime import datetime
from pathlib import Path

from scanplan.errors import StageError
from scanplan.store import atomic

_MOST_AHEAD_S = 60.0  # by which the clock of a server of files may differ


def check_places(names: Iterable[str]) -> None:
    """Refuse to begin where a folder of results, or of what goes with them, cannot be written to.

    Parameters
    ----------
    names : iterable of str
        Of the datasets.

    Raises
    ------
    StageError
    """
    of_all = [Path(name) for name in ("results", "logs", "benchmarks", ".snakemake")]
    of_each = [place / name for name in names for place in of_all[:3]]
    for folder in (Path(), *of_all, *of_each):
        # what is not there yet is made where another was tried
        if os.path.lexists(folder):
            try:
                _try_place(folder)
            except OSError as error:
                raise atomic.describe_unwritable(folder, error) from None
    for folder in of_each:
        for path in folder.rglob("*"):
            if path.is_symlink() and not path.exists():
                raise StageError(f"{path}: is a link that leads nowhere; remove it")


def check_dates(names: Iterable[str], sources: Iterable[str]) -> None:
    """Refuse files dated in the future: Snakemake takes all that is made of them for outdated.

    Parameters
    ----------
    names : iterable of str
        Of the datasets, whose results are looked at.
    sources : iterable of str
        Other files that results are made of.

    Raises
    ------
    StageError
    """
    now_s = time.time()
    made = (path for name in names for path in Path("results", name).rglob("*"))
    ahead: list[tuple[Path, float]] = []
    for path in (*made, *map(Path, sources)):
        with suppress(FileNotFoundError):
            dated_s = path.stat().st_mtime
            if dated_s > now_s + _MOST_AHEAD_S and not path.is_dir():
                ahead.append((path, dated_s))
    if ahead:
        path, dated_s = ahead[0]
        others = f", {len(ahead) - 1} others likewise" if ahead[1:] else ""
        raise StageError(
            f"{path}: is dated {_format_time(dated_s)}{others}, and this computer's clock says"
            f" {_format_time(now_s)}: what is made of it would count as older; set the clock, or"
            " run `touch` on what is dated ahead"
        )


def _format_time(since_1970_s: float) -> str:
    try:
        return datetime.fromtimestamp(since_1970_s).isoformat(" ", "seconds")
    except (OverflowError, ValueError, OSError):
        return f"{since_1970_s:.0f} s after 1970"


def _try_place(folder: Path) -> None:
    """Make a file in a folder, set its permissions and remove it, as a run does."""
    probe = folder / f".scanplan.{os.getpid()}.part"
    probe.touch()
    try:
        # other ones a stick has none of
        probe.chmod(stat.S_IMODE(probe.stat().st_mode))
    finally:
        probe.unlink()
