"""A copy of a building model whose elements have one more set of properties."""

from collections.abc import Mapping
from typing import Any

import ifcopenshell
import ifcopenshell.util.unit

from scanplan.errors import StageError
from scanplan.exports.data.element_ids import derive_id
from scanplan.types import FilePath

Properties = Mapping[str, str | float | bool]
"""By name: names end in `_m` where their values are metres, which the model states in its unit."""


def annotate_model(
    path: FilePath,
    name: str,
    values: Mapping[str, Properties],
    carried: Mapping[str, str] | None = None,
) -> str:
    """Return the text of a model with a set of properties of some of its elements.

    Parameters
    ----------
    name : str
        Of the set.
    values : dict of str to dict
        By GlobalId.
    carried : dict of str to str, optional
        GlobalIds that elements bear in the copy, by those that they bear in the model.

    Returns
    -------
    str
        The same for the same model and values: GlobalIds of the sets follow from its elements'.

    Raises
    ------
    StageError
        If the model is damaged, or has no such element.
    """
    try:
        model: Any = ifcopenshell.open(str(path))
        scale_m = ifcopenshell.util.unit.calculate_unit_scale(model)
        for guid, properties in values.items():
            _add_set(model, model.by_guid(guid), name, properties, scale_m)
        renamed = [(model.by_guid(guid), wanted) for guid, wanted in (carried or {}).items()]
        for element, wanted in renamed:
            element.GlobalId = wanted
        return model.to_string()
    except (RuntimeError, ifcopenshell.Error) as error:
        fault = f"cannot be read as IFC ({str(error).strip()[:120]})"
        raise StageError(f"{path}: {fault}; export it again, and run again") from None


def _add_set(model: Any, product: Any, name: str, properties: Properties, scale_m: float) -> None:
    listed = []
    for key, value in properties.items():
        if isinstance(value, bool):
            stated = model.create_entity("IfcBoolean", value)
        elif isinstance(value, str):
            stated = model.create_entity("IfcLabel", value)
        elif key.endswith("_m"):
            stated = model.create_entity("IfcLengthMeasure", value / scale_m)
        else:
            stated = model.create_entity("IfcReal", value)
        label = key.removesuffix("_m").title().replace("_", "")
        listed.append(model.create_entity("IfcPropertySingleValue", label, None, stated, None))
    key = f"{name}/{product.GlobalId}"
    # an owner is wanted of IFC2X3's relations
    owner = product.OwnerHistory
    added = model.create_entity("IfcPropertySet", derive_id(key), owner, name, None, listed)
    model.create_entity(
        "IfcRelDefinesByProperties", derive_id(f"{key}/of"), owner, None, None, [product], added
    )
