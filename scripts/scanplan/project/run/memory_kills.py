"""Whether the system has killed processes for want of memory, and how much they had.

Nobody else says so: a process that is killed cannot, and Snakemake knows that it ended.
"""

import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import psutil

_AT_BEGINNING = "SCANPLAN_MEMORY_KILLS"
_CGROUPS = Path("/proc/self/cgroup")
_MOUNT = Path("/sys/fs/cgroup")
_OF_SYSTEM = Path("/proc/vmstat")
_KILLS = re.compile(r"^oom_kill (\d+)$", re.MULTILINE)


def note_memory_kills() -> int:
    """Return how many there had been when the run began, which may have begun anew since."""
    return int(os.environ.setdefault(_AT_BEGINNING, str(count_memory_kills())))


def count_memory_kills() -> int:
    """Return how often the system has killed a process for want of memory, of this group of ours.

    Of the whole computer where the group's own number is not to be had, 0 where none is.
    """
    for file in (*_list_counters(), _OF_SYSTEM):
        try:
            found = _KILLS.search(file.read_text(encoding="ascii"))
        except (OSError, UnicodeDecodeError):
            continue
        if found:
            return int(found[1])
    return 0


def _list_counters() -> Iterator[Path]:
    """Yield where Linux may count kills of this process's group, of both versions of cgroups."""
    try:
        lines = _CGROUPS.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return
    for _, kinds, group in (line.split(":", 2) for line in lines if line.count(":") > 1):
        if "memory" in kinds.split(","):
            yield _MOUNT / "memory" / group.lstrip("/") / "memory.oom_control"
        elif not kinds:
            yield _MOUNT / group.lstrip("/") / "memory.events"


def measure_peak_mb() -> int:
    """Return the memory of the largest process that this one and its children have waited for.

    On Windows, which keeps that of no process that has ended, that of this one.
    """
    if sys.platform == "win32":
        return psutil.Process().memory_info().peak_wset >> 20
    import resource

    # macOS counts bytes, others kilobytes
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * unit >> 20
