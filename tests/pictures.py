"""Make the pictures of README.md from the demo's results: `make pictures`, after `make run`."""

import io
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


def make_pictures(results, folder):
    """Photograph the plan and the first screen of the report, small enough to commit."""
    with tempfile.TemporaryDirectory() as profile, browser.Page(profile) as page:
        for name, (width, height) in SIZES.items():
            page.open((results / PAGES[name]).as_uri(), width=width, height=height)
            if name == "plan":
                _fill_window(page)
            picture = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
            picture = picture.resize(
                (WIDTH, round(WIDTH * height / width)), Image.Resampling.LANCZOS
            )
            file = folder / f"{name}.png"
            picture.quantize(COLOURS, Image.Quantize.MAXCOVERAGE).save(file, optimize=True)
            print(f"{file}: {file.stat().st_size / 1000:.0f} kB")


def _fill_window(page):
    """Show a drawing as large as the window, whatever sheet it is made for."""
    page.run(
        "(e => { e.setAttribute('width', '100%'); e.setAttribute('height', '100%');"
        " e.style.background = 'white'; })(document.documentElement)"
    )


if __name__ == "__main__":
    if browser.find() is None:
        sys.exit("pictures: no Chromium on the path; install it, or name one in CHROMIUM")
    results = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "results/demo"
    if not (results / "report.html").is_file():
        sys.exit(f"{results}/report.html: does not exist; `make run` first")
    make_pictures(results.resolve(), ROOT / "docs")
