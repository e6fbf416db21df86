"""What a stage is at that takes much longer than it is expected to, in one line."""

import math
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import CodeType, FrameType

_PACKAGE = Path(__file__).parents[1]
_OWN = Path(__file__).parent

# of the time that a stage's rule asks a cluster for, which grows with the recording: stages of six
# real logs take up to a hundredth of it
_EXPECTED = 0.01
LATE = 10.0
"""Times as long as expected: from then on a stage says what it is at."""
_AGAIN = 2.0  # times as long as when it last said so
_MORE = "more --cores or a shorter recording"
_LOOKS_EVERY_S = 1.0  # a step that is not there for two looks has no line of its own

LOWERED_BY = {
    "interpolate_poses": "a higher poses.keep_every",
    "register_scans": "a higher poses.keep_every or poses.max_step_m",
    "assemble_plan": "a lower selection.stop.area_share",
    "validate_plan": "a lower advanced.plan.validation.max_scans",
    "plan_next_visit": "a higher advanced.plan.next_visit.spacing_m",
    "measure_crispness": "a lower advanced.crispness.most_points",
    "export_cloud": "a higher plan.export.cloud.cell_m",
}
"""Stage to the change of a setting that makes it shorter."""


def expected_s() -> float:
    """Return how long the stage that this process is may take; NaN where no run has started it."""
    of_run = getattr(sys.modules["__main__"], "snakemake", None)
    minutes = getattr(getattr(of_run, "resources", None), "runtime", None)
    return minutes * 60 * _EXPECTED if isinstance(minutes, (int, float)) else math.nan


@contextmanager
def tell_overtime(stage: str, expected_s: float, tell: Callable[[str], None]) -> Iterator[None]:
    """Tell what the calling thread is at, where it takes ten times as long as expected, or twenty.

    Parameters
    ----------
    expected_s : float
        NaN: nothing is ever told.
    tell : callable
        Takes the line.
    """
    if math.isnan(expected_s):
        yield
        return
    is_over = threading.Event()
    watcher = _Watcher(stage, expected_s, threading.get_ident())
    threading.Thread(target=watcher.watch, args=(is_over, tell), daemon=True).start()
    try:
        yield
    finally:
        is_over.set()


class _Watcher:
    """Looks at a thread every second.

    Parameters
    ----------
    thread : int
        Its identifier.
    """

    def __init__(self, stage: str, expected_s: float, thread: int) -> None:
        self._stage, self._expected_s, self._thread = stage, expected_s, thread
        self._began_s = time.monotonic()
        # calls of the package by frame, the outermost first, with when each was first seen
        self._calls: dict[int, tuple[CodeType, float]] = {}

    def watch(self, is_over: threading.Event, tell: Callable[[str], None]) -> None:
        """Look at the thread until it is over."""
        due_s = LATE * self._expected_s
        while not is_over.wait(min(_LOOKS_EVERY_S, due_s)):
            self._look()
            elapsed_s = time.monotonic() - self._began_s
            if elapsed_s >= due_s and not is_over.is_set():
                tell(self._describe(elapsed_s))
                due_s = _AGAIN * elapsed_s

    def _look(self) -> None:
        now_s = time.monotonic()
        known = self._calls
        self._calls = {}
        for frame in reversed(_own_frames(sys._current_frames().get(self._thread))):
            code, since_s = known.get(id(frame), (frame.f_code, now_s))
            # a frame's place in memory is used again
            since_s = since_s if code is frame.f_code else now_s
            self._calls[id(frame)] = (frame.f_code, since_s)

    def _describe(self, elapsed_s: float) -> str:
        now_s = time.monotonic()
        steps = [
            (code.co_name.replace("_", " "), now_s - since_s)
            for code, since_s in self._calls.values()
            if now_s - since_s >= _LOOKS_EVERY_S
        ]
        # of a recording in chunks each is a stage: register_scans_1-of-5
        remedies = [how for of, how in LOWERED_BY.items() if self._stage.startswith(of)]
        step, seconds = steps[-1] if steps else ("its own script", elapsed_s)
        times = elapsed_s / self._expected_s
        return (
            f"{self._stage}: takes long: {elapsed_s:.0f} s, {times:.0f} times as long as expected"
            f" (at work for {time.process_time():.0f} s of them); at '{step}' for {seconds:.0f} s;"
            f" less with {' or '.join([*remedies, _MORE])}"
        )


def _own_frames(frame: FrameType | None) -> list[FrameType]:
    """Return the calls of the package's public helpers that a thread is in, the innermost first."""
    frames = []
    while frame is not None:
        file = Path(frame.f_code.co_filename)
        is_helper = _PACKAGE in file.parents and _OWN not in file.parents
        if is_helper and frame.f_code.co_name[0] not in "_<":
            frames.append(frame)
        frame = frame.f_back
    return frames
