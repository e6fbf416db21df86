"""The plan as a building model: IFC4, one storey."""

from collections.abc import Mapping
from typing import Any

from scanplan.exports import envelope
from scanplan.exports.data import element_ids
from scanplan.exports.data.element_ids import ElementIds
from scanplan.exports.ifc_elements import columns, furniture, joints, openings, spaces, walls
from scanplan.exports.ifc_elements.storey_plan import StoreyPlan
from scanplan.exports.ifc_model import IfcModel
from scanplan.exports.model_origin import ModelOrigin
from scanplan.plan.floorplan import FloorPlan


def format_ifc(
    plan: FloorPlan,
    ids: ElementIds | None = None,
    origin: ModelOrigin | None = None,
    *,
    catalogue: Mapping[str, Any] | None = None,
) -> str:
    """Return a plan as the text of an IFC4 file in metres.

    Project, site, building and storey; an IfcWall of every wall, as high as the storey or up to
    where it was seen to end below the ceiling, with a type, a layer of material, and what is known
    of it as properties; an IfcOpeningElement with IfcDoor or IfcWindow in its wall; an IfcSpace of
    every room; an IfcColumn of every column; an IfcSlab where the floor was seen and an
    IfcCovering where the ceiling was; which walls meet, and what bounds each space.

    Parameters
    ----------
    ids : dict of str to sequence of str, optional
        The GlobalIds of walls, openings and rooms; those that follow from their places alone by
        default.
    origin : ModelOrigin, optional
    catalogue : mapping, optional
        Of a regular plan, see `regular_plan.draft_plan` and `catalogue_file.read_catalogue`: the
        model is for a modeller to go on with. It has the catalogue's types with their codes, by
        how much each element differs from what was measured, symbols in plan, how doors open, and
        furniture.

    Returns
    -------
    str
        The same for the same plan, ids and origin. GlobalIds of all else follow from the plan's
        name and from the elements that it belongs to.
    """
    floor_m, _ = plan.storey_m
    is_editable = catalogue is not None
    model = IfcModel(plan.name, floor_m, origin or ModelOrigin(), is_editable=is_editable)
    external = envelope.find_external_walls(plan)
    storey = StoreyPlan(plan, ids or element_ids.ids_from_places(plan), external, catalogue)
    _add_storey(model, storey)
    return model.text()


def _add_storey(model: IfcModel, storey: StoreyPlan) -> None:
    drawn_walls = walls.add_walls(model, storey)
    drawn_openings = openings.add_openings(model, storey, drawn_walls)
    rooms = spaces.add_spaces(model, storey)
    floors = spaces.add_floors(model, storey)
    ceilings = spaces.add_ceilings(model, storey, rooms)
    fillings = [opening.filling for opening in drawn_openings if opening.filling is not None]
    drawn_columns = columns.add_columns(model, storey)
    pieces = furniture.add_furniture(model, storey) if model.is_editable else []
    model.contain([*drawn_walls, *fillings, *drawn_columns, *pieces, *floors, *ceilings])
    model.aggregate(model.storey, rooms)
    joints.connect_walls(model, storey, drawn_walls)
    joints.bound_spaces(model, storey, rooms, drawn_walls, drawn_openings)
    joints.bound_levels(model, storey, rooms, floors, ceilings)
