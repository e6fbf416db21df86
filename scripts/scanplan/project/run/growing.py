"""What a page shows of results that a run is still making; other processes read and draw it.

A picture needs libraries that take a second to import, and a damaged file is to end no server.
"""

import json
import os
import subprocess
import sys
from collections.abc import Generator, Mapping
from pathlib import Path
from typing import IO, cast

from scanplan.errors import StageError

_DRAWN = (
    *("poses.parquet", "registration.parquet", "scans.parquet", "plan/segments.parquet"),
    *("plan/walls.parquet", "plan/corrected/walls.parquet"),
)
"""What a picture is made of, once it is there: a run writes each whole or not at all."""
_PATIENCE_S = 120  # for a picture: of the largest floor it takes some seconds
_PIECE = 2**20  # bytes of points that are sent at once
_SCRIPTS = Path(__file__).absolute().parents[3]
PICTURE, POINTS = "scanplan.report.growing_plan", "scanplan.report.sent_points"


def stamp(results: Path) -> str:
    """Return what differs once there is more to be drawn; empty where there is nothing yet."""
    found = []
    for name in _DRAWN:
        try:
            state = (results / name).stat()
        except OSError:
            continue
        found.append(f"{name} {state.st_mtime_ns:x} {state.st_size:x}")
    return ", ".join(found)


def draw(results: Path, assumed_m: Mapping[str, float]) -> bytes:
    """Return the picture of what there is, as JSON.

    Parameters
    ----------
    assumed_m : mapping of str to float
        See `run_status.RunStatus`.

    Raises
    ------
    StageError
        If what there is cannot be drawn.
    """
    with _begin(PICTURE, results, json.dumps(dict(assumed_m))) as run:
        try:
            drawn, said = run.communicate(timeout=_PATIENCE_S)
        except subprocess.TimeoutExpired:
            run.kill()
            raise StageError(f"it is not drawn, as that takes more than {_PATIENCE_S} s") from None
    if run.returncode:
        raise _explain(said)
    return drawn


def send_points(results: Path) -> Generator[bytes, None, None]:
    """Yield the points of the scans that the plan is made of, piece by piece.

    Raises
    ------
    StageError
        If they cannot be read; before the first piece.
    """
    with _begin(POINTS, results) as run:
        try:
            points, said = cast(IO[bytes], run.stdout), cast(IO[bytes], run.stderr)
            first = points.read(_PIECE)
            if not first:
                raise _explain(said.read())
            yield first
            while piece := points.read(_PIECE):
                yield piece
        finally:
            # a page may leave before the end
            run.kill()


def _begin(module: str, results: Path, *more: str) -> subprocess.Popen[bytes]:
    places = [str(_SCRIPTS), os.environ.get("PYTHONPATH", "")]
    return subprocess.Popen(
        # -P: modules are not looked for among the user's files
        [sys.executable, "-P", "-m", module, str(results), *more],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, places))},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )


def _explain(said: bytes) -> StageError:
    last = said.decode(errors="replace").strip().splitlines()[-1:] or ["it ended without a word"]
    return StageError(f"it cannot be drawn: {last[0][:200]}")
