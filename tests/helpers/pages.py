"""Pages in a headless browser, as a person sees and uses them."""

import pytest

from helpers import browser

needs_browser = pytest.mark.skipif(
    browser.find() is None,
    reason="no Chromium on the path (Debian: apt-get install chromium; or name one in CHROMIUM)",
)


def in_sight(page, selector):
    """How many of the elements a person could see."""
    return page.run(
        f"[...document.querySelectorAll('{selector}')].filter(e => e.getClientRects().length"
        " && e.getBoundingClientRect().width + e.getBoundingClientRect().height > 0).length"
    )


def middle_of(page, selector):
    return page.run(
        "(r => [r.x + r.width / 2, r.y + r.height / 2])"
        f"(document.querySelector('{selector}').getBoundingClientRect())"
    )


def click(page, place):
    page.mouse("mousePressed", *place, button="left", clickCount=1)
    page.mouse("mouseReleased", *place, button="left", clickCount=1)


def text_of(page, selector):
    return page.run(f"document.querySelector('{selector}').innerText")


def press(page, words, within="body"):
    """Click a button that can be seen, by its words."""
    place = page.run(
        f"(b => {{ b.scrollIntoView({{block: 'nearest'}}); const r = b.getBoundingClientRect();"
        " return [r.x + r.width / 2, r.y + r.height / 2]; })"
        f"([...document.querySelectorAll('{within} button, {within} summary')]"
        f".find(b => b.textContent.trim() === {words!r} && b.getClientRects().length))"
    )
    click(page, place)
