"""The models of storeys put into one IFC file: one project, site and building, a storey of each."""

from collections.abc import Sequence

import ifcopenshell
from ifcopenshell import entity_instance
from ifcopenshell.util import element as elements

from scanplan.exports.building.placed_storey import PlacedStorey

_TREE = ("IfcProject", "IfcSite", "IfcBuilding")


def merge_ifc(name: str, storeys: Sequence[PlacedStorey]) -> str:
    """Return the text of the building's file.

    Parameters
    ----------
    name : str
        Of project and building.
    storeys : sequence of PlacedStorey, at least one
        Each the text of an IFC file with one storey. Everything in it keeps its GlobalId; project,
        site and building are those of the first.

    Raises
    ------
    ValueError
        If two of the files share a GlobalId of anything else.
    """
    model = ifcopenshell.file.from_string(storeys[0].text)
    whole = {ifc_class: model.by_type(ifc_class)[0] for ifc_class in _TREE}
    drawn = [model.by_type("IfcBuildingStorey")[0]]
    for storey in storeys[1:]:
        drawn.append(_add_file(model, ifcopenshell.file.from_string(storey.text), whole))
    whole["IfcProject"].Name = whole["IfcBuilding"].Name = name
    (relation,) = [r for r in whole["IfcBuilding"].IsDecomposedBy if drawn[0] in r.RelatedObjects]
    relation.RelatedObjects = drawn
    for entity, storey in zip(drawn, storeys, strict=True):
        _place(model, entity, storey, whole["IfcBuilding"])
    _check_identifiers(model)
    return model.to_string()


def _add_file(
    model: ifcopenshell.file, other: ifcopenshell.file, whole: dict[str, entity_instance]
) -> entity_instance:
    """Add all of another file, hung into the tree of the first; return its storey."""
    tree = {ifc_class: other.by_type(ifc_class)[0] for ifc_class in _TREE}
    relations = [r for part in tree.values() for r in part.IsDecomposedBy]
    copies = {entity.id(): model.add(entity) for entity in other}
    units = copies[tree["IfcProject"].UnitsInContext.id()]
    _share_contexts(
        copies[tree["IfcProject"].id()].RepresentationContexts,
        whole["IfcProject"].RepresentationContexts,
        model,
    )
    for relation in relations:
        model.remove(copies[relation.id()])
    for ifc_class, part in tree.items():
        copy = copies[part.id()]
        elements.replace_element(copy, whole[ifc_class])
        model.remove(copy)
    model.remove(units)
    _share_application(model)
    return copies[other.by_type("IfcBuildingStorey")[0].id()]


def _share_application(model: ifcopenshell.file) -> None:
    """Let all be made by one and the same program: no two may be of one name."""
    kept, *others = model.by_type("IfcApplication")
    for other in others:
        elements.replace_element(other, kept)
        model.remove(other)


def _share_contexts(
    contexts: Sequence[entity_instance],
    kept: Sequence[entity_instance],
    model: ifcopenshell.file,
) -> None:
    """Let shapes lie in the contexts of the first file that have the same names."""

    def named(given: Sequence[entity_instance]) -> dict[tuple[str, str], entity_instance]:
        inner = [sub for context in given for sub in context.HasSubContexts]
        return {(c.ContextType, c.ContextIdentifier): c for c in (*given, *inner)}

    known = named(kept)
    for key, context in reversed(named(contexts).items()):
        if key in known:
            elements.replace_element(context, known[key])
            model.remove(context)


def _place(
    model: ifcopenshell.file,
    entity: entity_instance,
    storey: PlacedStorey,
    building: entity_instance,
) -> None:
    """Put a storey where it lies in the building: all its products are placed relative to it."""
    point = model.create_entity("IfcCartesianPoint", (storey.x_m, storey.y_m, storey.elevation_m))
    up = model.create_entity("IfcDirection", (0.0, 0.0, 1.0))
    along = model.create_entity("IfcDirection", (*storey.along, 0.0))
    axes = model.create_entity("IfcAxis2Placement3D", point, up, along)
    entity.ObjectPlacement.PlacementRelTo = building.ObjectPlacement
    entity.ObjectPlacement.RelativePlacement = axes
    entity.Elevation = storey.elevation_m
    entity.Name = storey.name


def _check_identifiers(model: ifcopenshell.file) -> None:
    guids = [root.GlobalId for root in model.by_type("IfcRoot")]
    if len(set(guids)) < len(guids):
        raise ValueError("two storeys share GlobalIds")
