"""Which of a building's storeys is meant."""

from collections.abc import Sequence

from scanplan.errors import StageError
from scanplan.types import FilePath


def find_storey(
    storeys: Sequence[tuple[str, float]], chosen: str | int | None, source: FilePath, key: str
) -> int:
    """Return the index of a storey by its name or its index from below.

    None stands for the only one.

    Parameters
    ----------
    storeys : sequence of (str, float)
        From below: name, height of the floor in metres.
    source : path-like
        The file, for messages.
    key : str
        The setting that chooses it.

    Raises
    ------
    StageError
        Listing the storeys, if none or several are meant.
    """
    names = [name for name, _ in storeys]
    if chosen is None and len(names) == 1:
        return 0
    if isinstance(chosen, int) and 0 <= chosen < len(names):
        return chosen
    if isinstance(chosen, str) and names.count(chosen) == 1:
        return names.index(chosen)
    fault = f"storey {chosen!r} is none or several of its storeys"
    if chosen is None:
        fault = "no storey is chosen"
    listed = ", ".join(f"{i} {name!r} at {z_m:.2f} m" for i, (name, z_m) in enumerate(storeys))
    raise StageError(f"{source}: {fault}; set {key} to a name or index of: {listed}")
