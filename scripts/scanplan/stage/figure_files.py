"""Figures as the bytes of files: the same bytes for the same figure."""

import io
import logging

import matplotlib
from matplotlib.figure import Figure

# it logs every table that it leaves out of a font
logging.getLogger("fontTools").setLevel(logging.WARNING)


def format_svg(figure: Figure) -> str:
    """Return a figure as SVG text that is the same for the same figure."""
    # the salt replaces random identifiers, paths replace the fonts of this computer
    with matplotlib.rc_context({"svg.hashsalt": "scanplan", "svg.fonttype": "path"}):
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()


def format_pdf(figure: Figure) -> bytes:
    """Return a figure as PDF bytes that are the same for the same figure."""
    metadata = {"CreationDate": None, "Creator": "scanplan", "Producer": None}
    # 42: TrueType fonts, whose text can be searched
    with matplotlib.rc_context({"pdf.fonttype": 42}):
        page = io.BytesIO()
        figure.savefig(page, format="pdf", metadata=metadata)
    return page.getvalue()
