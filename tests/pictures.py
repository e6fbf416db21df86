"""Make the manual's pictures: those of README.md from the demo's results, those of real floors.

`make pictures` after `make run`; `make pictures ARGS="results/intel intel"` makes docs/intel.png of
what a sheet draws.
"""

import io
import re
import sys
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from helpers import browser  # noqa: E402

SIZES = {"plan": (1400, 1000), "report": (1400, 900)}
PAGES = {"plan": "plan/plan.svg", "report": "report.html"}
COLOURS = 96  # as many as line drawings need, at a third of the bytes
WIDTH = 1000
SHEET_WIDTH = 900  # of a floor with its room names legible
# keeps the light greys that most of a sheet has: coverage makes them pink
METHOD = Image.Quantize.MEDIANCUT
MARGIN_MM = 12  # on the sheet: door swings and the first dimensions


def make_pictures(results, folder):
    """Photograph the plan and the first screen of the report, small enough to commit."""
    with tempfile.TemporaryDirectory() as profile, browser.Page(profile) as page:
        for name, (width, height) in SIZES.items():
            page.open((results / PAGES[name]).as_uri(), width=width, height=height)
            if name == "plan":
                _fill_window(page)
            picture = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
            _save(picture, WIDTH, folder / f"{name}.png")
    sheet = Image.open(results / "plan/presentation.png").convert("RGB")
    _save(sheet, WIDTH, folder / "presentation.png")


def crop_sheet(results, file):
    """Write what the sheet of a plan draws, without its frame and title block."""
    text = (results / "plan/plan.svg").read_text(encoding="utf-8")
    (sheet,) = re.findall(r'<svg [^>]*viewBox="([^"]+)"', text)
    (drawn,) = re.findall(r'<view id="drawn" viewBox="([^"]+)"', text)
    picture = Image.open(results / "plan/plan.png").convert("RGB")
    x, y, width, height = map(float, drawn.split())
    dots = picture.width / float(sheet.split()[2])
    left, top = round(dots * (x - MARGIN_MM)), round(dots * (y - MARGIN_MM))
    right, bottom = round(dots * (x + width + MARGIN_MM)), round(dots * (y + height + MARGIN_MM))
    _save(picture.crop((left, top, right, bottom)), SHEET_WIDTH, file)


def _save(picture, width, file):
    size = (width, round(width * picture.height / picture.width))
    small = picture.resize(size, Image.Resampling.LANCZOS)
    small.quantize(COLOURS, METHOD).save(file, optimize=True)
    print(f"{file}: {file.stat().st_size / 1000:.0f} kB")


def _fill_window(page):
    """Show a drawing as large as the window, whatever sheet it is made for."""
    page.run(
        "(e => { e.setAttribute('width', '100%'); e.setAttribute('height', '100%');"
        " e.style.background = 'white'; })(document.documentElement)"
    )


def main(place="results/demo", name=None):
    """Make the demo's pictures, or that of a floor."""
    results = ROOT / place
    if not (results / "report.html").is_file():
        sys.exit(f"{results}/report.html: does not exist; make its plan first")
    if name:
        crop_sheet(results, ROOT / f"docs/{name}.png")
        return
    if browser.find() is None:
        sys.exit("pictures: no Chromium on the path; install it, or name one in CHROMIUM")
    make_pictures(results.resolve(), ROOT / "docs")


if __name__ == "__main__":
    main(*sys.argv[1:])
