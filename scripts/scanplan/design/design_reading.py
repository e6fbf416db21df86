"""The storeys of a design, of whatever format its file is."""

from pathlib import Path

from scanplan.design.drawn_storey import DrawnStorey
from scanplan.errors import StageError, name_extra
from scanplan.types import FilePath


def read_design(path: FilePath) -> list[DrawnStorey]:
    """Read the storeys of an IFC or DXF file in which walls stand, from below.

    Raises
    ------
    StageError
        If it is damaged, or none has walls.
    """
    if Path(path).suffix.lower() == ".dxf":
        from scanplan.design import dxf_design

        return dxf_design.read_storeys(path)
    try:
        from scanplan.design import ifc_design, ifc_file
    except ModuleNotFoundError:
        raise StageError(f"{path}: {name_extra('ifcopenshell')}") from None
    model = ifc_file.parse_ifc(Path(path).read_bytes(), path)
    storeys = ifc_design.list_storeys(model)
    if not storeys:
        raise StageError(f"{path}: no wall stands in any of its storeys; export walls with a shape")
    return storeys
