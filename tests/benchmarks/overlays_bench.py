"""Overlays of areas that rounding makes hard, by the hundred thousand."""

import time
from collections import Counter
from collections.abc import Iterator

from helpers import overlay_making
from scanplan.geometry.fallbacks import take_fallbacks
from scanplan.stage import workers

_BATCH = 500  # arrangements, some seconds, so that both cores have work to the end
_TOLD_EVERY = 10_000  # arrangements between lines of progress: about a minute


def bench(count: int, first: int, cores: int) -> None:
    """Print how many arrangements raise or do not add up, of each kind, and how often GEOS failed.

    Parameters
    ----------
    count : int
        Arrangements.
    first : int
        Seed of the first one; the others follow.
    cores : int

    Raises
    ------
    SystemExit
        If any is wrong.
    """
    began_s = time.monotonic()
    seen, fallen_back = Counter(), Counter()
    wrong = 0
    batches = (
        (seed, min(_BATCH, first + count - seed)) for seed in range(first, first + count, _BATCH)
    )
    with workers.open_pool(cores) as run:
        for kinds, fallbacks, faults in run(_check_batch, batches):
            seen.update(kinds)
            fallen_back.update(fallbacks)
            wrong += len(faults)
            if seen.total() % _TOLD_EVERY == 0:
                print(f"overlays: {seen.total()} of {count}, {wrong} wrong", flush=True)
            for fault in faults:
                print(f"overlays, {fault}", flush=True)
    for kind, n in sorted(seen.items()):
        print(f"overlays, {kind}: {n} arrangements, {fallen_back[kind]} overlays done another way")
    seconds = time.monotonic() - began_s
    print(
        f"overlays: {count} arrangements in {seconds:.0f} s, {wrong} raise or do not add up to"
        f" {overlay_making.ADD_UP:g} m2, {sum(fallen_back.values())} overlays done another way"
    )
    if wrong:
        raise SystemExit(1)


def _check_batch(first: int, count: int) -> tuple[Counter[str], Counter[str], list[str]]:
    seen: Counter[str] = Counter()
    fallen_back: Counter[str] = Counter()
    faults = []
    for seed in range(first, first + count):
        kind, areas = overlay_making.arrange(seed)
        seen[kind] += 1
        take_fallbacks()
        faults += [f"seed {seed}, {kind}: {fault}" for fault in _find_faults(areas)]
        fallen_back[kind] += take_fallbacks()
    return seen, fallen_back, faults


def _find_faults(areas: list) -> Iterator[str]:
    try:
        yield from overlay_making.find_faults(areas)
    except Exception as error:
        yield repr(error)
