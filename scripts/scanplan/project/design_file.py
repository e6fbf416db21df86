"""The design that a survey is held against: the file that a key names, or that lies beside it.

Standard library only: this runs while the workflow is being parsed.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from scanplan.errors import StageError
from scanplan.project import user_file

if TYPE_CHECKING:
    from collections.abc import Sequence

    from scanplan.types import FilePath

SUFFIXES = (".ifc", ".dxf")
"""Of files that designs are read of."""
_REMEDY = "name the design by plan.design.file"


def find_designs(named: str | None, folder: FilePath | None) -> tuple[str, ...]:
    """Return the files that may be a dataset's design: the one that is named, or all beside it.

    Parameters
    ----------
    named : str or None
        What plan.design.file says.
    folder : path-like or None
        The dataset's, in which files with such a suffix are designs.

    Raises
    ------
    StageError
        If the file that is named is missing or of no such kind.
    """
    if named is not None:
        if Path(named).suffix.lower() not in SUFFIXES:
            kinds = " or ".join(SUFFIXES)
            raise StageError(f"plan.design.file: {named} is no {kinds} file; {_REMEDY}")
        if user_file.find_file(named, _REMEDY) is None:
            raise StageError(f"plan.design.file: {named} does not exist; {_REMEDY}")
        return (named,)
    if folder is None or not Path(folder).is_dir():
        return ()
    beside = Path(folder).iterdir()
    return tuple(sorted(str(file) for file in beside if file.suffix.lower() in SUFFIXES))


def choose_design(name: str, designs: Sequence[str]) -> str:
    """Return the one design that a dataset of that name is held against.

    Raises
    ------
    StageError
        If there is none, or several.
    """
    if not designs:
        remedy = "put an .ifc or .dxf file into its folder, or name one by plan.design.file"
        raise StageError(f"design: {name} has none to be held against; {remedy}")
    if len(designs) > 1:
        names = ", ".join(Path(file).name for file in designs)
        raise StageError(f"design: {name} has several, {names}; {_REMEDY}")
    return designs[0]
