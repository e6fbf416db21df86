"""Figures as the bytes of files: the same bytes for the same figure."""

import io
import logging
from collections.abc import Sequence

import matplotlib
from matplotlib.figure import Figure

# whatever a matplotlibrc of the user's says: a margin that it cuts off changes the sheet's scale
matplotlib.rcdefaults()
# it logs every table that it leaves out of a font
logging.getLogger("fontTools").setLevel(logging.WARNING)


def format_svg(figure: Figure) -> str:
    """Return a figure as SVG text that is the same for the same figure."""
    # the salt replaces random identifiers, paths replace the fonts of this computer
    with matplotlib.rc_context({"svg.hashsalt": "scanplan", "svg.fonttype": "path"}):
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()


def format_pdf(figures: Sequence[Figure], title: str | None = None, author: str = "") -> bytes:
    """Return figures as the pages of a PDF: bytes that are the same for the same figures."""
    metadata = {"Title": title, "CreationDate": None, "Creator": "scanplan", "Producer": None}
    metadata |= {"Author": author} if author else {}
    from matplotlib.backends.backend_pdf import PdfPages  # 0.3 s, and most figures are SVG

    # 42: TrueType fonts, whose text can be searched
    with matplotlib.rc_context({"pdf.fonttype": 42}):
        file = io.BytesIO()
        with PdfPages(file, metadata=metadata) as pages:
            for figure in figures:
                pages.savefig(figure)
    return file.getvalue()


def format_png(figure: Figure, dots_per_inch: int = 150) -> bytes:
    """Return a figure as PNG bytes that are the same for the same figure.

    By default the smallest letters of a sheet, capitals of 1.8 mm, are ten pixels high: they can be
    read. A sheet of A0, the largest, has 35 million pixels.
    """
    picture = io.BytesIO()
    # hinted, letters are moved to whole pixels, and a line is up to 5 % longer than it was measured
    with matplotlib.rc_context({"text.hinting": "no_hinting"}):
        figure.savefig(picture, format="png", dpi=dots_per_inch, metadata={"Software": None})
    return picture.getvalue()
