"""A building model of rooms of 4 m x 3 m clear, with a door and a window in the south wall."""

import ifcopenshell.api.aggregate
import ifcopenshell.api.context
import ifcopenshell.api.feature
import ifcopenshell.api.geometry
import ifcopenshell.api.project
import ifcopenshell.api.root
import ifcopenshell.api.spatial
import ifcopenshell.api.unit
import numpy as np

THICK_M, HEIGHT_M = 0.2, 2.5
# each wall's body lies on the left of the line from its first to its second end
WALLS = {
    "south": ((-0.2, -0.2), (4.2, -0.2)),
    "east": ((4.0, 3.0), (4.0, 0.0)),
    "north": ((4.2, 3.2), (-0.2, 3.2)),
    "west": ((0.0, 0.0), (0.0, 3.0)),
}
OPENINGS = {"door": ("IfcDoor", 1.0, 1.9, 0.0, 2.0), "window": ("IfcWindow", 2.5, 3.5, 0.9, 2.0)}


def model(storeys=("Ground",), millimetres=False):
    """The bytes of an IFC4 file."""
    made = ifcopenshell.api.project.create_file()
    project = ifcopenshell.api.root.create_entity(made, ifc_class="IfcProject", name="Test")
    prefix = "MILLI" if millimetres else None
    unit = ifcopenshell.api.unit.add_si_unit(made, unit_type="LENGTHUNIT", prefix=prefix)
    ifcopenshell.api.unit.assign_unit(made, units=[unit])
    whole = ifcopenshell.api.context.add_context(made, context_type="Model")
    body = ifcopenshell.api.context.add_context(
        made,
        context_type="Model",
        context_identifier="Body",
        target_view="MODEL_VIEW",
        parent=whole,
    )
    for number, name in enumerate(storeys):
        storey = ifcopenshell.api.root.create_entity(made, ifc_class="IfcBuildingStorey", name=name)
        ifcopenshell.api.aggregate.assign_object(made, products=[storey], relating_object=project)
        place(made, storey, 0, 0, number * (HEIGHT_M + 0.2))
        fill(made, body, storey, number * (HEIGHT_M + 0.2))
    return made.to_string().encode()


def fill(made, body, storey, floor_m):
    """Walls, slab, space, table, and the south wall's openings with what fills them."""
    walls = {}
    for name, (a, b) in WALLS.items():
        walls[name] = product(made, storey, "IfcWall", name)
        shape = ifcopenshell.api.geometry.create_2pt_wall(
            made,
            walls[name],
            body,
            a,
            b,
            elevation=floor_m,
            height=HEIGHT_M,
            thickness=THICK_M,
            is_si=True,
        )
        ifcopenshell.api.geometry.assign_representation(
            made, product=walls[name], representation=shape
        )
    block(
        made,
        body,
        product(made, storey, "IfcSlab", "slab"),
        (-0.2, -0.2, -0.2),
        (4.2, 3.2, 0.0),
        floor_m,
    )
    block(
        made,
        body,
        product(made, storey, "IfcFurniture", "table"),
        (3.2, 2.2, 0.0),
        (4.0, 3.0, 0.7),
        floor_m,
    )
    space = ifcopenshell.api.root.create_entity(made, ifc_class="IfcSpace", name="1")
    space.LongName = "Living"
    ifcopenshell.api.aggregate.assign_object(made, products=[space], relating_object=storey)
    block(made, body, space, (0, 0, 0), (4, 3, HEIGHT_M), floor_m)
    for name, (kind, x0, x1, sill, lintel) in OPENINGS.items():
        hole = ifcopenshell.api.root.create_entity(made, ifc_class="IfcOpeningElement", name=name)
        block(made, body, hole, (x0, -0.3, sill), (x1, 0.1, lintel), floor_m)
        ifcopenshell.api.feature.add_feature(made, feature=hole, element=walls["south"])
        leaf = product(made, storey, kind, name)
        block(made, body, leaf, (x0, -0.12, sill), (x1, -0.08, lintel), floor_m)
        ifcopenshell.api.feature.add_filling(made, opening=hole, element=leaf)


def product(made, storey, ifc_class, name):
    new = ifcopenshell.api.root.create_entity(made, ifc_class=ifc_class, name=name)
    ifcopenshell.api.spatial.assign_container(made, products=[new], relating_structure=storey)
    return new


def block(made, body, thing, low, high, floor_m):
    """Give a product the shape of a box, corners in metres above its storey's floor."""
    x0, y0, z0 = low
    x1, y1, z1 = high
    place(made, thing, x0, y0, z0 + floor_m)
    size = np.array([x1 - x0, y1 - y0, z1 - z0], float)
    vertices = [
        [x, y, z]
        for z in (0, size[2])
        for x, y in ((0, 0), (size[0], 0), (size[0], size[1]), (0, size[1]))
    ]
    faces = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    shape = ifcopenshell.api.geometry.add_mesh_representation(
        made,
        context=body,
        vertices=[[tuple(map(float, v)) for v in vertices]],
        faces=[[list(f) for f in faces]],
    )
    ifcopenshell.api.geometry.assign_representation(made, product=thing, representation=shape)


def place(made, thing, x, y, z):
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    ifcopenshell.api.geometry.edit_object_placement(made, product=thing, matrix=matrix, is_si=True)
