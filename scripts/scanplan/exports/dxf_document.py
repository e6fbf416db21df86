"""A DXF document before anything is drawn: layers, line types, blocks, style of dimensions."""

import io
import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from html import escape

import ezdxf
from ezdxf.document import Drawing
from ezdxf.enums import InsertUnits
from ezdxf.filemanagement import new
from ezdxf.layouts.blocklayout import BlockLayout

from scanplan.exports.model_origin import Site
from scanplan.exports.sheet.paper import Page
from scanplan.exports.sheet.styles import DASHES_MM, LAYERS, Letters, Paper
from scanplan.exports.sheet.symbols import BLOCKS

APPLICATION = "SCANPLAN"
"""Of extended data: pairs of a column's name and its value."""
WALL_FACT = "wall_m"
"""Of the extended data of an opening: how thick its wall is drawn."""
DIMENSIONS = "SCANPLAN"
"""The style of dimensions."""
TEXT_STYLE = "SCANPLAN"
STAMP = "ROOM-STAMP"
"""What the name of each room's block begins with."""
TITLE = "TITLE-BLOCK"
STAMP_TAGS = ("NUMBER", "NAME", "AREA", "PERIMETER", "HEIGHT", "CLOSED", "CORRECTED", "USE")
SYMBOL_TAGS = {
    "TAG": "element",
    "WIDTH": "width_m",
    "SILL": "sill_m",
    "LINTEL": "lintel_m",
    "RAYS": "n_rays",
    "CORRECTED": "corrected",
}
"""Attributes of doors, windows and passages, and what of their facts they state."""
UNITS = {"mm": InsertUnits.Millimeters, "m": InsertUnits.Meters}
_DRAWN_BY = (
    *("dimtxt", "dimtsz", "dimexe", "dimexo", "dimgap", "dimlfac"),
    *("dimtad", "dimtih", "dimtoh", "dimdec", "dimzin", "dimdsep"),
)
"""What of a style of dimensions a drawing states as a whole, too."""
_VERSION = "R2010"  # AC1024, which all current CAD programs read
_FONT = "arial.ttf"  # narrower than the font that words were placed by


class Scale:
    """Units of a drawing.

    Parameters
    ----------
    unit : str
        mm or m.

    Attributes
    ----------
    per_m, per_mm : float
        Units for a metre of the building, and for a millimetre on paper.
    locale : Locale
        How dimensions are written.
    """

    def __init__(self, unit: str, page: Page) -> None:
        self.locale = page.locale
        self.per_m = 1000.0 if unit == "mm" else 1.0
        self.per_mm = self.per_m / page.mm_per_m


def open_document(unit: str, scale: Scale) -> Drawing:
    """Return a document without entities, whose letters and dashes are as on paper."""
    document = new(_VERSION, units=UNITS[unit])
    document.header["$MEASUREMENT"] = 1
    document.header["$PSLTSCALE"] = 0
    document.header["$LASTSAVEDBY"] = "scanplan"
    document.appids.add(APPLICATION)
    for name, (dash_mm, gap_mm) in DASHES_MM.items():
        dash, pause = dash_mm * scale.per_mm, gap_mm * scale.per_mm
        document.linetypes.add(name, pattern=[dash + pause, dash, -pause], description=name.title())
    add_layers(document)
    document.styles.add(TEXT_STYLE, font=_FONT)
    _add_dimension_style(document, scale)
    _add_blocks(document, scale)
    return document


def add_layers(document: Drawing) -> None:
    """Add the layers of a plan."""
    for name, layer in LAYERS.items():
        # line weights are hundredths of a millimetre
        made = document.layers.add(
            name,
            lineweight=round(layer.width_mm * 100),
            color=layer.colour,
            linetype=layer.line_type,
            plot=layer.plots,
        )
        if name == "A-WALL-CNTR":
            made.off()


def _add_dimension_style(document: Drawing, scale: Scale) -> None:
    letters = Letters.SMALL * scale.per_mm
    style = document.dimstyles.new(DIMENSIONS)
    style.dxf.dimtxsty = TEXT_STYLE
    style.dxf.dimtxt = letters
    style.dxf.dimtsz = 0.7 * letters
    style.dxf.dimexe = 0.7 * letters
    style.dxf.dimexo = 0.7 * letters
    style.dxf.dimgap = letters / 2
    style.dxf.dimtad = 1
    style.dxf.dimtih = 0
    style.dxf.dimtoh = 0
    style.dxf.dimdec = scale.locale.decimals
    style.dxf.dimzin = 0
    style.dxf.dimdsep = ord(scale.locale.decimal)
    lines = LAYERS["A-ANNO-DIMS"]
    style.dxf.dimlwd = style.dxf.dimlwe = round(100 * lines.width_mm)
    style.dxf.dimclrd = style.dxf.dimclre = lines.colour
    # whatever the drawing's unit, dimensions are read in the sheet's
    style.dxf.dimlfac = scale.locale.per_m / scale.per_m
    style.dxf.dimfxlon = 1
    style.dxf.dimfxl = Paper.EXTENSION * scale.per_mm
    # programs that know no styles of dimensions take the drawing's own values
    document.header["$DIMSTYLE"] = DIMENSIONS
    for name in _DRAWN_BY:
        document.header[f"${name.upper()}"] = style.dxf.get(name)


def _add_blocks(document: Drawing, scale: Scale) -> None:
    """Add the symbols, in unit size, with attributes, and the title block."""
    for name, paths in BLOCKS.items():
        block = document.blocks.new(name)
        for path in paths:
            # x, y and bulge; layer 0 takes the insertion's layer
            block.add_lwpolyline([tuple(p) for p in path.tolist()], format="xyb")
        for tag in SYMBOL_TAGS:
            definition = block.add_attdef(tag, (0, 0), height=Letters.SMALL * scale.per_mm)
            definition.is_invisible = True
    document.blocks.new(TITLE)


def open_stamp_block(document: Drawing, scale: Scale) -> BlockLayout:
    """Add the block of one more room's stamp, with the definitions of its attributes."""
    number = sum(block.name.startswith(STAMP) for block in document.blocks)
    block = document.blocks.new(f"{STAMP}-{number}")
    for tag in STAMP_TAGS:
        definition = block.add_attdef(tag, (0, 0), height=Letters.SMALL * scale.per_mm)
        definition.is_invisible = True
    return block


def rename_layers(document: Drawing, names: Mapping[str, str]) -> None:
    """Give layers other names, and what lies on them; names of layers that are none are left."""
    for name, other in names.items():
        if name in document.layers:
            document.layers.get(name).rename(other)


def state_place(document: Drawing, site: Site) -> None:
    """State where on earth the model space lies, if that is known, as AutoCAD reads it."""
    if not site.is_placed:
        return
    turn_rad = math.radians(site.turn_deg)
    document.modelspace().new_geodata().setup_local_grid(
        design_point=(0, 0),
        reference_point=(site.east_m, site.north_m),
        # of the grid, in the frame of the map
        north_direction=(math.sin(turn_rad), math.cos(turn_rad)),
        crs=_describe_system(site),
    )


def _describe_system(site: Site) -> str:
    """Return a system of the Earth as the dictionary of AutoCAD has it."""
    name = escape(site.crs or "")
    number = (
        ""
        if site.epsg is None
        else (
            f'<Alias id="{site.epsg}" type="CoordinateSystem"><ObjectId>{name}</ObjectId>'
            "<Namespace>EPSG Code</Namespace></Alias>"
        )
    )
    axes = "".join(
        f"<CoordinateSystemAxis><AxisOrder>{order}</AxisOrder><AxisName>{noun}</AxisName>"
        f"<AxisAbbreviation>{noun[0]}</AxisAbbreviation>"
        f"<AxisDirection>{compass}</AxisDirection></CoordinateSystemAxis>"
        for order, noun, compass in ((1, "Easting", "east"), (2, "Northing", "north"))
    )
    return (
        '<?xml version="1.0" encoding="UTF-16" standalone="no" ?>'
        '<Dictionary version="1.0" xmlns="http://www.osgeo.org/mapguide/coordinatesystem">'
        f'<ProjectedCoordinateSystem id="{name}"><Name>{name}</Name>'
        f'<Axis uom="METER">{axes}</Axis></ProjectedCoordinateSystem>{number}</Dictionary>'
    )


def format_document(document: Drawing) -> str:
    """Return a document as text that is the same for the same drawing.

    Raises
    ------
    ValueError
        If it does not pass the audit of ezdxf.
    """
    faults = document.audit().errors
    if faults:
        raise ValueError(f"the drawing has {len(faults)} faults, the first: {faults[0].message}")
    # ezdxf would register these in the order of a set, which differs from run to run
    for name in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(name)
    text = io.StringIO()
    document.write(text)
    return text.getvalue()


@contextmanager
def fix_metadata() -> Iterator[None]:
    """Leave times and random identifiers out of documents."""
    # ezdxf documents its options under this name, but does not declare it
    options = ezdxf.options  # pyright: ignore[reportPrivateImportUsage]
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before
