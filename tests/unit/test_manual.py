"""The manual's pages: what they link to is there."""

import re
from pathlib import Path

import pytest

from scanplan.store import column_lists

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("config/*.md"), *ROOT.glob("docs/*.md")])
SCHEMA = ROOT / "workflow/schemas/config.schema.yaml"
_LINK = re.compile(r"\]\(([^)\s]+)\)")
_CODE = re.compile(r"`[^`\n]*`|^ {4}[^\n]*$|^```.*?^```", re.M | re.S)


def slug(heading: str) -> str:
    """Return the anchor that GitHub gives a heading."""
    letters = re.sub(r"[^\w\- ]", "", heading.strip().lower())
    return letters.replace(" ", "-")


def anchors(page: Path) -> set[str]:
    return {slug(found) for found in re.findall(r"(?m)^#+ (.+)$", page.read_text("utf-8"))}


def find_dead(text: str, folder: Path) -> list[str]:
    """Return links of a page that lead to no file, or to no heading of one."""
    dead = []
    for link in _LINK.findall(_CODE.sub("", text)):
        name, _, anchor = link.partition("#")
        target = folder / name if name else None
        if link.startswith(("http:", "https:", "mailto:")) or target is None:
            continue
        if not target.exists() or (anchor and anchor not in anchors(target)):
            dead.append(link)
    return dead


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_link_of_a_page_leads_somewhere(page):
    assert find_dead(page.read_text("utf-8"), page.parent) == []


def test_every_link_of_a_setting_leads_somewhere():
    assert find_dead(SCHEMA.read_text("utf-8"), ROOT / "config") == []


def test_a_link_to_no_file_or_heading_is_found(tmp_path):
    (tmp_path / "a.md").write_text("# One `two`: three\n")
    text = "[a](a.md) [b](b.md) [c](a.md#one-two-three) [d](a.md#four) `[e](e.md)`"
    assert find_dead(text, tmp_path) == ["b.md", "a.md#four"]


def test_every_page_of_the_manual_is_reached_from_its_first():
    reached, ahead = set(), [ROOT / "README.md"]
    while ahead:
        page = ahead.pop()
        if page in reached or page.suffix != ".md":
            continue
        reached.add(page)
        links = _LINK.findall(_CODE.sub("", page.read_text("utf-8")))
        names = (link.partition("#")[0] for link in links if "://" not in link)
        ahead += [(page.parent / name).resolve() for name in names if name]
    assert [page.name for page in PAGES if page not in reached] == []


def test_columns_of_tables_are_those_of_their_schemas():
    text = (ROOT / "config/outputs.md").read_text("utf-8")
    assert column_lists.fill_columns(text) == text, "run `make settings`"


def test_every_table_that_outlasts_a_run_has_its_columns_in_the_manual():
    text = (ROOT / "config/outputs.md").read_text("utf-8")
    listed = re.findall(r"(?m)^<!-- columns (\S+) -->$", text)
    of_chunks = {name for name in column_lists.list_schemas() if name.startswith("CHUNK_")}
    assert sorted(listed) == sorted(column_lists.list_schemas().keys() - of_chunks)


def test_a_list_of_columns_is_written_between_its_marks():
    text = "a\n<!-- columns ELEMENT_IDS -->\nold\n<!-- end -->\nb\n"
    names = "`kind`, `number`, `global_id`"
    filled = f"a\n<!-- columns ELEMENT_IDS -->\n{names}\n<!-- end -->\nb\n"
    assert column_lists.fill_columns(text) == filled


def test_tests_that_a_page_names_are_there():
    named = set(re.findall(r"`(test_\w+)`", (ROOT / "docs/inputs.md").read_text("utf-8")))
    files = (ROOT / "tests").rglob("test_*.py")
    known = {name for path in files for name in re.findall(r"def (test_\w+)", path.read_text())}
    assert len(named) > 20 and named <= known, named - known
