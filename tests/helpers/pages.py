"""Pages in a headless browser, as a person sees and uses them."""

import contextlib
import time

import pytest

from helpers import browser

_PATIENCE_S = 60  # of a machine that is at other things, too
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
    """Click a button that can be seen, by its words, where it has come to rest."""
    find = (
        f"(b => {{ b.scrollIntoView({{block: 'nearest'}}); const r = b.getBoundingClientRect();"
        " return [r.x + r.width / 2, r.y + r.height / 2]; })"
        f"([...document.querySelectorAll('{within} button, {within} summary')]"
        f".find(b => b.textContent.trim() === {words!r} && b.getClientRects().length))"
    )
    place = page.run(find)
    deadline = time.monotonic() + _PATIENCE_S
    while (after := page.run(find)) != place and time.monotonic() < deadline:
        place = after
        time.sleep(0.025)
    click(page, place)


def on_screen(page, x_m, y_m):
    """Where a place of the map is in the window."""
    matrix = "document.getElementById('plan').getScreenCTM()"
    return page.run(f"(p => [p.x, p.y])(new DOMPoint({x_m}, {-y_m}).matrixTransform({matrix}))")


def tap(page, *places):
    """Click places of the map, one after the other."""
    for place in places:
        click(page, on_screen(page, *place))


def entries(page):
    """What is said of the plan, without when it was."""
    said = page.run("edits.entries()")
    return [{k: v for k, v in entry.items() if k != "when"} for entry in said]


def settle(page, condition):
    """Wait for what a page does by itself; one that is about to be another one says nothing."""
    deadline = time.monotonic() + _PATIENCE_S
    while time.monotonic() < deadline:
        with contextlib.suppress(AssertionError):
            if page.run(condition):
                return
        time.sleep(0.025)
    raise AssertionError(condition)


def type_into(page, selector, words):
    page.run(f"document.querySelector('{selector}').focus()")
    page.type(words)
