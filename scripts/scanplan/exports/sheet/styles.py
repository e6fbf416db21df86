"""How a plan is drawn, on paper and in CAD: layers, strokes and letters, by one table each.

Lines have the widths of ISO 128-2, letters the heights of ISO 3098.
"""

from dataclasses import dataclass

INK = "#000000"
FAINT = "#595959"  # grey of what steps back behind the walls: dimensions, and what is inferred
DOUBT = "#b3001b"  # the one colour of a plan's sheet, for what is to be verified on site
ADDED, CARRIED = "#00704f", "#0b62a8"  # of what changed: new, and moved; what is gone has DOUBT's
STRAYED = "#a05a00"  # of what was built beyond its tolerance


class Letters:
    """The three sizes of letters: heights of capitals on paper, millimetres (ISO 3098)."""

    SMALL = 1.8
    MEDIUM = 2.5
    LARGE = 3.5


class Paper:
    """Distances on paper, millimetres."""

    MARGIN = 10.0  # around the frame; on the left twice as much, to file it (ISO 5457)
    COLUMN = 60.0  # of tables: a third of a title block, which is 180 wide (ISO 7200)
    ROW = 4.0  # of tables: twice the smallest letters and a little
    # of a plan, left, below, right and above: two chains or one, and words beyond the first
    AROUND = (22.0, 22.0, 14.0, 14.0)
    BARE = (10.0, 10.0, 10.0, 10.0)  # of one without dimensions
    GAP = 1.0  # between letters and lines
    SAMPLE = 9.0  # of a legend
    CHAIN = 8.0  # between chains of dimensions: letters above one line and below the next
    LEAST = 4.0  # a shorter part of a chain cannot be read
    TICK = 1.2  # half of an oblique stroke at a dimension's end (ISO 129-1)
    BEYOND = 1.5  # of an extension line over a dimension line; its distance from what is measured
    EXTENSION = 7.0  # of an extension line: a longer one would cross what lies in between
    HATCH = 1.5  # between the lines of a hatch
    NAME = 40.0  # a longer name of a room is cut off


@dataclass(frozen=True)
class Layer:
    """A layer of CAD programs.

    Attributes
    ----------
    width_mm : float
        Of its lines, on paper.
    colour : int
        Of the AutoCAD colour index: 7 is black on paper and white on a black screen.
    line_type : str
        Its name in CAD programs.
    plots : bool
        Whether it is printed.
    """

    width_mm: float
    colour: int = 7
    line_type: str = "CONTINUOUS"
    plots: bool = True


@dataclass(frozen=True)
class Style:
    """How a kind of element is drawn.

    Attributes
    ----------
    layer : str
        Of `LAYERS`; lines are as wide as its.
    meaning : str
        In words, for the legend and for titles; none of what explains itself.
    ink : str
        Colour on paper; none for no line.
    fill : str
        Of what the stroke encloses: grey where a wall is cut (ISO 128-3).
    dashes_mm : tuple of float
        Dash and gap on paper; none for a continuous line.
    """

    layer: str
    meaning: str = ""
    ink: str = INK
    fill: str = "none"
    dashes_mm: tuple[float, ...] = ()

    @property
    def width_mm(self) -> float:
        """Width of the line on paper."""
        return LAYERS[self.layer].width_mm


# Names by the AIA CAD layer guidelines (discipline, major, minor group), as ISO 13567 allows; in
# the order of drawing, so that nothing covers the walls
LAYERS = {
    "A-AREA": Layer(0.13, 9, plots=False),
    "A-AREA-NSEN": Layer(0.13, 9, "DOTTED"),
    "A-AREA-VRFY": Layer(0.18, 1, "DASHED"),
    "A-WALL-PATT": Layer(0.13, 8),
    "A-WALL-CNTR": Layer(0.13, 9, plots=False),
    "A-FURN": Layer(0.13, 9),
    "A-FLOR-PFIX": Layer(0.18),
    "A-FLOR-STRS": Layer(0.18),
    "A-COLS": Layer(0.35),
    "A-WALL-NSEN": Layer(0.25, 8, "DOTTED"),
    "A-WALL-ASMD": Layer(0.18, 8, "DASHED"),
    "A-WALL-INFR": Layer(0.25, 8, "DASHED"),
    "A-WALL-PRHT": Layer(0.25, 9),
    "A-WALL-SURF": Layer(0.35),
    "A-WALL-OPNG": Layer(0.18, 8, "DASHED"),
    "A-DOOR": Layer(0.18, 5),
    "A-GLAZ": Layer(0.18, 4),
    "A-WALL": Layer(0.35),
    "A-WALL-VRFY": Layer(0.25, 1, "DASHED"),
    "A-DOOR-VRFY": Layer(0.25, 1, "DASHED"),
    "A-GLAZ-VRFY": Layer(0.25, 1, "DASHED"),
    "A-AREA-IDEN": Layer(0.18, 7),
    "A-CHNG-SAME": Layer(0.13, 9),
    "A-CHNG-NSEN": Layer(0.18, 8, "DOTTED"),
    "A-CHNG-GONE": Layer(0.35, 1, "DASHED"),
    "A-CHNG-NEWW": Layer(0.35, 3),
    "A-CHNG-MOVD": Layer(0.35, 5),
    "A-CHNG-STAL": Layer(0.25, 1, "DOTTED"),
    "A-CHNG-SWNG": Layer(0.25, 5, "DOTTED"),
    "A-TOLR-WITH": Layer(0.18, 3),
    "A-TOLR-UNDC": Layer(0.18, 9),
    "A-TOLR-BYND": Layer(0.35, 30),
    "A-TOLR-FARB": Layer(0.35, 1),
    "A-ANNO-VRFY": Layer(0.18, 1),
    "A-ANNO-REVS": Layer(0.25, 6, "DASHED"),
    "A-ANNO-DIMS": Layer(0.13, 8),
    "A-ANNO-TEXT": Layer(0.18, 7),
    "A-ANNO-TTLB": Layer(0.18, 7),
    "A-ANNO-BRDR": Layer(0.7, 7),
    "A-ANNO-NPLT": Layer(0.13, 9, plots=False),
}
DASHES_MM = {"DASHED": (2.0, 1.0), "DOTTED": (0.3, 0.9)}
"""Dash and gap of the line types on paper (ISO 128-2)."""
_DASHED, _DOTTED = DASHES_MM["DASHED"], DASHES_MM["DOTTED"]
STYLES = {
    "room": Style("A-AREA", ink="none"),
    "axis": Style("A-WALL-CNTR", ink="none"),
    "recess": Style("A-WALL-CNTR", ink="none"),
    "hidden": Style("A-AREA-NSEN", "ground not seen by the scans used", FAINT, "#f4f4f4", _DOTTED),
    "furniture": Style("A-FURN", "furniture, as far as seen", ink=FAINT),
    "fixture": Style("A-FLOR-PFIX"),
    "stairs": Style("A-FLOR-STRS"),
    "not-seen": Style("A-WALL-NSEN", "outline that was not seen", FAINT, dashes_mm=_DOTTED),
    "assumed": Style("A-WALL-ASMD", "wall, its thickness assumed", FAINT, "#e3e3e3", (1.2, 0.8)),
    "inferred": Style("A-WALL-INFR", "inferred wall", FAINT, "#f4f4f4", _DASHED),
    "low": Style("A-WALL-PRHT", "wall or furniture below the ceiling", FAINT, "#ffffff"),
    "wall": Style("A-WALL", "wall, cut", fill="#7f7f7f"),
    "poche": Style("A-WALL", fill=INK),
    "post": Style("A-COLS", fill=INK),
    "perhaps": Style("A-WALL-VRFY", "wall or furniture, not sure which", FAINT, "#ffffff"),
    "column": Style("A-COLS", "column, cut", fill="#7f7f7f"),
    "leaf": Style("A-DOOR", "open leaf of a door, as it stood", ink=FAINT),
    "surface": Style("A-WALL-SURF", "surface, seen from one side"),
    "surface-inferred": Style("A-WALL-INFR", "inferred surface", FAINT, dashes_mm=_DASHED),
    "passage": Style("A-WALL-OPNG", "passage", FAINT, dashes_mm=(1.2, 0.8)),
    "parting": Style("A-WALL-OPNG", "rooms parted, in no wall", FAINT, dashes_mm=_DASHED),
    "gap": Style("A-WALL-OPNG", "gap, not known what", FAINT, dashes_mm=_DOTTED),
    "glass": Style("A-GLAZ", "glass down to the floor"),
    "door": Style("A-DOOR", "door, its leaf not seen"),
    "swing": Style("A-DOOR"),
    "window": Style("A-GLAZ", "window", fill="#ffffff"),
    "verify": Style("A-ANNO-VRFY", "doubtful (?): verify on site", DOUBT, dashes_mm=(1.2, 0.8)),
    "corrected": Style("A-ANNO-REVS", "corrected by hand *", dashes_mm=(2.5, 0.7, 0.5, 0.7)),
    "unchanged": Style("A-CHNG-SAME", "as in both surveys", FAINT, "#d9d9d9"),
    "stood": Style("A-CHNG-SAME", "furniture, as it stood", "#a0a0a0"),
    "unlooked": Style("A-CHNG-NSEN", "not seen: nothing is told", INK, "#ffffff", _DOTTED),
    "gone": Style("A-CHNG-GONE", "gone: rays go through now", DOUBT, dashes_mm=_DASHED),
    "new": Style("A-CHNG-NEWW", "new: rays went through before", ADDED, "#bfe3d3"),
    "moved": Style("A-CHNG-MOVD", "moved: where it stands now", CARRIED, "#c4dbf0"),
    "swung": Style("A-CHNG-SWNG", "shut, or opened since", CARRIED, "#ffffff", _DOTTED),
    "lately": Style("A-CHNG-NEWW", "seen by the latest survey alone", ADDED, "#bfe3d3"),
    "stale": Style("A-CHNG-STAL", "not seen by the latest survey", DOUBT, "#ffffff", _DOTTED),
    "within": Style("A-TOLR-WITH", "built within tolerance", ADDED, "#bfe3d3"),
    "undecided": Style("A-TOLR-UNDC", "measured too coarsely to tell", FAINT, "#e3e3e3"),
    "beyond": Style("A-TOLR-BYND", "beyond tolerance, or of another kind", STRAYED, "#f6d9a8"),
    "far-beyond": Style("A-TOLR-FARB", "beyond twice its tolerance", DOUBT, "#f0a9a9"),
    "missing": Style("A-CHNG-GONE", "designed, not built", DOUBT, "#ffffff", _DASHED),
    "additional": Style("A-CHNG-NEWW", "built, not designed", CARRIED, "#c4dbf0"),
    "way": Style("A-CHNG-MOVD", ink=CARRIED, fill=CARRIED),
    "leader": Style("A-ANNO-DIMS", ink=FAINT),
    "dimension": Style("A-ANNO-DIMS", "~ about, an end is not known", ink=FAINT),
    "tick": Style("A-ANNO-TEXT"),
    "stamp": Style("A-AREA-IDEN"),
    "width": Style("A-ANNO-TEXT"),
    "note": Style("A-ANNO-TEXT", ink=FAINT),
    "title": Style("A-ANNO-TTLB"),
    "scale-bar": Style("A-ANNO-TTLB", fill=INK),
    "frame": Style("A-ANNO-BRDR"),
}
"""By the kind of a mark or word; in the order of drawing."""
DOUBT_LAYERS = {
    "A-WALL": "A-WALL-VRFY",
    "A-DOOR": "A-DOOR-VRFY",
    "A-GLAZ": "A-GLAZ-VRFY",
    "A-AREA": "A-AREA-VRFY",
}
"""Where doubt about an element lies, by the first two parts of its layer's name."""


def doubt_layer(layer: str) -> str:
    """Return the layer for doubt about an element of a layer."""
    return DOUBT_LAYERS["-".join(layer.split("-")[:2])]
