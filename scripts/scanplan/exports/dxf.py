"""The sheet of a plan as DXF, for CAD programs."""

import re
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import shapely
from ezdxf import zoom
from ezdxf.document import Drawing
from ezdxf.entities.dxfgfx import DXFGraphic
from ezdxf.entities.insert import Insert
from ezdxf.entities.viewport import Viewport
from ezdxf.enums import TextEntityAlignment
from ezdxf.layouts.base import BaseLayout
from ezdxf.layouts.layout import Modelspace, Paperspace

from scanplan.exports import dxf_document
from scanplan.exports.dxf_document import APPLICATION, Scale
from scanplan.exports.model_origin import NOWHERE, Site
from scanplan.exports.sheet.composition import Sheet, surround_symbol
from scanplan.exports.sheet.lettering import clean_text, rotation
from scanplan.exports.sheet.marks import Dimension, Facts, Mark, Stamp, Symbol, Word
from scanplan.exports.sheet.paper import Page
from scanplan.exports.sheet.styles import INK, LAYERS, STYLES, Letters, Paper, doubt_layer
from scanplan.exports.sheet.symbols import block_scales, choose_block, symbol_angle_deg
from scanplan.exports.sheet.title import TITLE_TAG
from scanplan.types import FloatArray

_HATCHES = {
    "wall": "SOLID",
    "poche": "SOLID",
    "post": "SOLID",
    "assumed": "ANSI31",
    "scale-bar": "SOLID",
}
_INK_COLOUR = 7  # of the index of colours of CAD: black on white, white on black
_ALIGNMENTS = {
    0.0: TextEntityAlignment.MIDDLE_LEFT,
    0.5: TextEntityAlignment.MIDDLE_CENTER,
    1.0: TextEntityAlignment.MIDDLE_RIGHT,
}


def format_dxf(
    sheet: Sheet,
    unit: str = "mm",
    layers: Mapping[str, str] | None = None,
    site: Site = NOWHERE,
) -> str:
    """Return a sheet as the text of a DXF R2010 file.

    The model space holds the plan in the frame of the map: hatched outlines of walls, blocks with
    attributes for openings and room stamps, dimensions, and what is doubtful on layers of its own;
    rooms, lines of walls (a layer that is off) and openings carry what is known of them as extended
    data. The layout holds the sheet: its frame, title block and tables, and a viewport in which the
    plan is turned and to scale.

    Parameters
    ----------
    unit : str
        mm or m: of the model space.
    layers : dict of str to str, optional
        Other names of layers, by ours.
    site : Site
        Where the map lies: the model space states it, and stays in the frame of the map.

    Returns
    -------
    str
        The same for the same sheet: no time, no random identifier.

    Raises
    ------
    ValueError
        If the drawing does not pass the audit of ezdxf.
    """
    scale = Scale(unit, sheet.page)
    with dxf_document.fix_metadata():
        document = dxf_document.open_document(unit, scale)
        draw_plan(document, sheet, scale)
        draw_layout(document, "Sheet", sheet, scale)
        document.layouts.delete("Layout1")
        state_extent(document, sheet_corners_m(sheet) * scale.per_m)
        dxf_document.rename_layers(document, layers or {})
        dxf_document.state_place(document, site)
        return dxf_document.format_document(document)


def draw_plan(document: Drawing, sheet: Sheet, scale: Scale) -> None:
    """Draw the plan of a sheet into the model space, in the frame of the map."""
    _Plan(document.modelspace(), sheet.page, scale).draw(sheet)


class _Plan:
    """The plan in the model space."""

    def __init__(self, space: Modelspace, page: Page, scale: Scale) -> None:
        self._space = space
        self._page = page
        self._scale = scale

    def draw(self, sheet: Sheet) -> None:
        """Add all of the plan, what others must not cover last."""
        order = list(STYLES)
        marks = sorted(sheet.marks, key=lambda mark: order.index(mark.kind))
        for mark in marks:
            if mark.kind in _HATCHES:
                _add_hatch(self._space, mark, self._scale.per_m, self._scale.per_mm)
        for mark in marks:
            _add_mark(self._space, mark, self._scale.per_m)
        for symbol in sheet.symbols:
            self._add_symbol(symbol)
        for dimension in sheet.dimensions:
            self._add_dimension(dimension)
        for stamp in sheet.stamps:
            self._add_stamp(stamp)
        for word in sheet.words:
            _add_text(self._space, word, self._scale.per_m, self._scale.per_mm)

    def _add_symbol(self, symbol: Symbol) -> None:
        layer = STYLES[symbol.kind].layer
        along, across = np.array(block_scales(symbol)) * self._scale.per_m
        insert = self._space.add_blockref(
            choose_block(symbol),
            self._point(symbol.ends_m[0]),
            dxfattribs={
                "layer": doubt_layer(layer) if symbol.verify else layer,
                "xscale": along,
                "yscale": across,
                "zscale": along,
                "rotation": symbol_angle_deg(symbol),
            },
        )
        own: Facts = {"element": symbol.element, "width_m": symbol.width_m}
        facts: Facts = {"corrected": "no", **symbol.facts, **own}
        middle = self._point(symbol.ends_m.mean(axis=0))
        for tag, fact in dxf_document.SYMBOL_TAGS.items():
            text = self._state_fact(fact, facts.get(fact))
            self._add_attribute(insert, tag, text, middle, "A-ANNO-TEXT")
        _attach_facts(insert, {**symbol.facts, dxf_document.WALL_FACT: symbol.thickness_m})
        for kind in symbol.surrounded_by:
            around = surround_symbol(self._page, symbol) * self._scale.per_m
            drawn = {"layer": doubt_layer(layer) if kind == "verify" else STYLES[kind].layer}
            self._space.add_lwpolyline(around.tolist(), close=True, dxfattribs=drawn)

    def _add_attribute(
        self, insert: Insert, tag: str, text: str, place: tuple[float, float], layer: str
    ) -> None:
        size = Letters.SMALL * self._scale.per_mm
        drawn = {"layer": layer, "height": size, "style": dxf_document.TEXT_STYLE}
        attribute = insert.add_attrib(tag, _plain_text(text), place, dxfattribs=drawn)
        attribute.is_invisible = True

    def _add_stamp(self, stamp: Stamp) -> None:
        """Add a room's words as a block of its own, whose attributes are not shown.

        Not every program shows attributes, all show the text of a block.
        """
        if not stamp.words:
            return
        origin = stamp.words[0].place
        document = self._space.doc
        assert document is not None
        block = dxf_document.open_stamp_block(document, self._scale)
        for word in stamp.words:
            leader = None if word.leader is None else word.leader - origin
            moved = replace(word, place=word.place - origin, leader=leader)
            _add_text(block, moved, self._scale.per_m, self._scale.per_mm)
        layer = STYLES["stamp"].layer
        place = self._point(origin)
        insert = self._space.add_blockref(block.name, place, dxfattribs={"layer": layer})
        for tag in dxf_document.STAMP_TAGS:
            text = self._state_fact(tag.casefold(), stamp.facts[tag])
            self._add_attribute(insert, tag, text, place, layer)
        _attach_facts(insert, {"room": stamp.room})

    def _state_fact(self, name: str, value: str | float | None) -> str:
        """Return a fact in the sheet's unit and language, a person's words as they are."""
        locale = self._page.locale
        if isinstance(value, float):
            return locale.length(value)
        if name in ("number", "name", "use", "element"):
            return str(value)
        if name == "corrected":
            return locale.credit(str(value))
        return locale.say("not seen" if value is None else str(value))

    def _add_dimension(self, dimension: Dimension) -> None:
        start, end = dimension.ends_m
        line = dimension.line_m
        x, y = line[1] - line[0]
        # a line on what it measures has no extension lines
        is_bare = int(np.allclose(line, dimension.ends_m))
        made = self._space.add_linear_dim(
            base=self._point(line[0]),
            p1=self._point(start),
            p2=self._point(end),
            angle=float(np.degrees(np.arctan2(y, x))),
            location=self._point(dimension.word.place),
            dimstyle=dxf_document.DIMENSIONS,
            text=self._state_length(dimension.word.text),
            override={"dimse1": is_bare, "dimse2": is_bare},
            dxfattribs={"layer": STYLES["dimension"].layer},
        )
        made.render()

    def _state_length(self, text: str) -> str:
        """Return the text of a dimension: what CAD measures, with the sign for about before it.

        Of feet and inches as it stands on the sheet, which not every program writes alike.
        """
        if self._page.locale.is_imperial:
            return text
        return "~<>" if text.startswith("~") else "<>"

    def _point(self, place_m: FloatArray) -> tuple[float, float]:
        x, y = (place_m * self._scale.per_m).tolist()
        return x, y


def draw_layout(document: Drawing, name: str, sheet: Sheet, scale: Scale) -> Viewport:
    """Add a layout with what stands beside a plan; return its view of the plan."""
    page = sheet.page
    layout = document.layouts.new(name)
    assert isinstance(layout, Paperspace)
    layout.page_setup(size=page.size_mm, margins=(0, 0, 0, 0), units="mm")
    for mark in sheet.paper_marks:
        if mark.kind in _HATCHES:
            _add_hatch(layout, mark, 1.0, 1.0)
    for mark in sheet.paper_marks:
        for entity in _add_mark(layout, mark, 1.0):
            # line types are made for the model
            entity.dxf.ltscale = 1 / scale.per_mm
    title = layout.add_blockref(dxf_document.TITLE, (0, 0), dxfattribs={"layer": "A-ANNO-TTLB"})
    for word in sheet.paper_words:
        if word.element.startswith(TITLE_TAG):
            _add_word_attribute(title, word.element.removeprefix(TITLE_TAG), word, 1.0, 1.0)
        else:
            _add_text(layout, word, 1.0, 1.0)
    x0, y0, x1, y1 = page.drawing_mm
    middle_mm = np.array([x0 + x1, y0 + y1]) / 2
    # a view is turned about the origin, and its centre is told in what it shows
    middle_m = page.to_plan(middle_mm) @ rotation(page.turn_deg).T
    port = layout.add_viewport(
        center=tuple(middle_mm.tolist()),
        size=(x1 - x0, y1 - y0),
        view_center_point=tuple((middle_m * scale.per_m).tolist()),
        view_height=(y1 - y0) * scale.per_mm,
        status=2,
        dxfattribs={"layer": "A-ANNO-NPLT"},
    )
    port.dxf.view_twist_angle = page.turn_deg
    for viewport in layout.viewports():
        viewport.dxf.layer = port.dxf.layer
    return port


def state_extent(document: Drawing, corners: FloatArray) -> None:
    """State that the drawing lies within corners (n, 2), and open its view there."""
    space = document.modelspace()
    low, high = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    space.reset_extents((*low, 0), (*high, 0))
    space.reset_limits(low, high)
    zoom.window(space, low, high)


def sheet_corners_m(sheet: Sheet) -> FloatArray:
    """Return the corners (5, 2) of the part of the map that a sheet shows."""
    corners_mm = shapely.get_coordinates(shapely.box(*sheet.page.drawing_mm))
    return sheet.page.to_plan(corners_mm)


def _add_mark(space: BaseLayout, mark: Mark, factor: float) -> list[DXFGraphic]:
    layer = STYLES[mark.kind].layer
    if mark.verify:
        layer = doubt_layer("A-WALL" if mark.kind == "verify" else layer)
    entities: list[DXFGraphic] = []
    for path in mark.bent_paths:
        corners = path * [factor, factor, 1]
        if mark.closed:
            corners = corners[:-1]
        points = [tuple(corner) for corner in corners.tolist()]
        entity = space.add_lwpolyline(
            points, format="xyb", close=mark.closed, dxfattribs={"layer": layer}
        )
        _attach_facts(entity, mark.facts)
        entities.append(entity)
    return entities


def _add_hatch(space: BaseLayout, mark: Mark, factor: float, per_mm: float) -> None:
    hatch = space.add_hatch(dxfattribs={"layer": "A-WALL-PATT"})
    pattern = _HATCHES[mark.kind]
    if pattern == "SOLID":
        is_ink = STYLES[mark.kind].fill == INK
        hatch.set_solid_fill(color=_INK_COLOUR if is_ink else LAYERS["A-WALL-PATT"].colour)
    else:
        hatch.set_pattern_fill(
            pattern, scale=Paper.HATCH * per_mm / 3.175
        )  # the pattern's own distance
    for number, path in enumerate(mark.paths):
        corners = path[:-1, :2] * factor
        # the first path is the outline, others are holes
        hatch.paths.add_polyline_path(corners.tolist(), flags=1 if number == 0 else 16)


def _add_text(space: BaseLayout, word: Word, factor: float, per_mm: float) -> None:
    text = space.add_text(
        _plain_text(word.text),
        height=word.size_mm * per_mm,
        rotation=word.turn_deg,
        dxfattribs={"layer": STYLES[word.kind].layer, "style": dxf_document.TEXT_STYLE},
    )
    place = (word.place * factor).tolist()
    text.set_placement(place, align=_ALIGNMENTS[word.align])
    if word.leader is not None:
        leader = (word.leader * factor).tolist()
        space.add_lwpolyline(leader, dxfattribs={"layer": STYLES["leader"].layer})


def _add_word_attribute(insert: Insert, tag: str, word: Word, factor: float, per_mm: float) -> None:
    drawn = {
        "layer": STYLES[word.kind].layer,
        "style": dxf_document.TEXT_STYLE,
        "height": word.size_mm * per_mm,
        "rotation": word.turn_deg,
    }
    place = (word.place * factor).tolist()
    attribute = insert.add_attrib(tag, _plain_text(word.text), dxfattribs=drawn)
    attribute.set_placement(place, align=_ALIGNMENTS[word.align])


def _attach_facts(entity: DXFGraphic, facts: Facts) -> None:
    """Attach what is known of an element as extended data: names, each with its value.

    A string of extended data has at most 255 bytes; of a longer one the end is left out.
    """
    tags: list[tuple[int, str | float | int]] = []
    for name, value in facts.items():
        tags.append((1000, name))
        if isinstance(value, str):
            tags.append((1000, _escape(clean_text(value)).encode()[:255].decode(errors="ignore")))
        elif isinstance(value, float):
            tags.append((1040, value))
        else:
            tags.append((1071, int(value)))
    if tags:
        entity.set_xdata(APPLICATION, tags)


def _plain_text(text: str) -> str:
    """Return a text as it is written where CAD programs would take parts of it for commands.

    What such programs show, and ezdxf reads, is the text again: `%%c` would be a sign for
    diameters, and three percent signs are one.
    """
    return re.sub("%{2,}", lambda found: 3 * found[0], _escape(clean_text(text)))


def _escape(text: str) -> str:
    r"""Return a string as DXF has it: `^J` would be a line break, `\U+0041` a letter."""
    return re.sub(r"\\(?=[UM]\+)", r"\\U+005C", text.replace("^", "^ "))
