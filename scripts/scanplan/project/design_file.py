"""The design that a survey is held against: the file that a key names, or that lies beside it.

Standard library only: this runs while the workflow is being parsed.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from scanplan.errors import StageError
from scanplan.project import user_file

if TYPE_CHECKING:
    from scanplan.types import FilePath

SUFFIXES = (".ifc", ".dxf")
"""Of files that designs are read of."""
_REMEDY = "name the design by plan.design.file"


def find_design(named: str | None, folder: FilePath | None) -> str | None:
    """Return the file of a dataset's design; None where there is none.

    Parameters
    ----------
    named : str or None
        What plan.design.file says.
    folder : path-like or None
        The dataset's, of which the only file with such a suffix is it.

    Raises
    ------
    StageError
        If the file is missing or of no such kind, or there are several.
    """
    if named is not None:
        if Path(named).suffix.lower() not in SUFFIXES:
            kinds = " or ".join(SUFFIXES)
            raise StageError(f"plan.design.file: {named} is no {kinds} file; {_REMEDY}")
        if user_file.find_file(named, _REMEDY) is None:
            raise StageError(f"plan.design.file: {named} does not exist; {_REMEDY}")
        return named
    if folder is None or not Path(folder).is_dir():
        return None
    found = sorted(str(f) for f in Path(folder).iterdir() if f.suffix.lower() in SUFFIXES)
    if len(found) > 1:
        names = ", ".join(Path(file).name for file in found)
        raise StageError(f"{folder}: has several designs, {names}; {_REMEDY}")
    return found[0] if found else None
