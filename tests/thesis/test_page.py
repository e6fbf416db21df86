"""The page of the thesis's experiments: every figure and claim, one file, honest verdicts."""

import re

import numpy as np
import pandas as pd
import pytest
from markupsafe import escape

from helpers import claim_making as made
from thesis import judging
from thesis import page as page_module
from thesis.page import Verdict
from thesis.shown_figures import FIGURES
from thesis.stated_claims import CLAIMS

(DEVIATIONS,) = (path for path in made.PAGE if path.suffix == ".md")
SVG = (
    '<?xml version="1.0"?>\n<svg id="a"><defs><path id="b"/></defs>'
    '<use href="#b" fill="url(#c)"/></svg>'
)


OWN_FIGURES = dict.fromkeys(("orders.svg", "gates.svg", "alignments.svg"), SVG)


def claims(**changes):
    rows = judging.judge_claims(judging.ROOMS, "seed 1", made.rooms(**changes))
    rows += judging.judge_claims(judging.ROOMS, "seed 2", made.rooms())
    rows += judging.judge_claims(judging.DRIVE, "seed 1", made.drive())
    return pd.DataFrame(rows)


def page(**changes):
    drawn = {figure.file: SVG for figure in FIGURES}
    strict, ours = made.steps(3600, 130, 76, 76, 15), made.steps(3600, 710, 700, 700, 15)
    sources = {path.name: path.read_text() for path in made.PAGE}
    return page_module.thesis_page(sources, drawn, OWN_FIGURES, claims(**changes), ours, strict)


def test_every_figure_and_claim_is_there():
    text = page()
    numbers = ["3.1", "3.2", "3.3", "4.1", *(f"5.{i}" for i in range(1, 13))]
    assert [figure.number for figure in FIGURES] == numbers
    for number in numbers:
        assert f"<h3>Figure {number}</h3>" in text
    for claim in CLAIMS:
        assert escape(claim.states) in text
    assert (
        "4.83 GB" in text
        and "4.00 GB" in text
        and "6 min 29 s" in text
        and "<td>Data collection</td>" in text
    )


def test_it_needs_no_other_file():
    text = page()
    assert (
        not re.search(r'(src|href)="(?!#)', text) and "@import" not in text and "<?xml" not in text
    )


def test_identifiers_of_two_figures_do_not_meet():
    found = re.findall(r'\bid="([^"]+)"', page())
    assert len(found) == len(set(found))
    text = page()
    assert all(f'id="{target}"' in text for target in re.findall(r'href="#([^"]+)"', text))


def test_the_interval_is_students():
    # deviation 1, of three: 4.303 (t of 2 degrees of freedom at 97.5 %) / sqrt(3)
    low, high = page_module.margin_interval([4.0, 5.0, 6.0])
    assert (low, high) == pytest.approx((5 - 4.3027 / 3**0.5, 5 + 4.3027 / 3**0.5), abs=1e-4)
    assert page_module.margin_interval([0.3]) == (0.3, 0.3)


@pytest.mark.wording
def test_a_verdict_goes_by_the_interval_of_all_seeds():
    verdict = page_module.verdict_over_seeds
    assert verdict([0.2, 0.21, 0.2]) == Verdict("holds", "yes")
    assert verdict([-0.2, -0.21, -0.2]) == verdict([-0.1]) == Verdict("does not hold", "no")
    assert verdict([0.1]) == Verdict("holds", "yes")
    # all three hold, but so far apart that a fourth might not
    # mean 0.1433, deviation 0.2223: 2.201 x 0.2223 / sqrt(12) is 0.1413, with 11 seeds 0.1494
    decided = "; about 12 such seeds would decide"
    told = f"undecided: holds for 3 of 3 seeds{decided}"
    assert verdict([0.01, 0.02, 0.4]) == Verdict(told, "some")
    # of a mean of 0 no number of seeds decides
    assert verdict([0.1, -0.1]) == Verdict("undecided: holds for 1 of 2 seeds", "some")
    assert verdict([]) == Verdict("", "")
    assert "undecided: holds for 1 of 2 seeds" in page(rooms_hull=made.growing(40))


@pytest.mark.wording
def test_what_does_not_hold_says_whose_doing_it_is_with_what_was_measured():
    table = claims()
    tenth = next(claim for claim in CLAIMS if claim.name == "tenth_little_loss")
    (row,) = page_module.claim_rows(table, [tenth])
    assert row.verdict.css == "no"
    assert row.otherwise == ("The order's: 80 % of the walls are found, by the best tenth 90 %.")
    assert row.margin == "-10.00 %"
    holding = next(claim for claim in CLAIMS if claim.name == "full_hull_overestimates")
    assert page_module.claim_rows(table, [holding])[0].otherwise == ""


@pytest.mark.parametrize("claim", [claim for claim in CLAIMS if claim.criterion], ids=str)
def test_whose_doing_it_is_goes_by_quantities_that_are_measured(claim):
    table = claims()
    measured = set(table.loc[table["claim"] == claim.name, "quantity"])
    assert claim.otherwise and set(re.findall(r"\{([^}]+)\}", claim.otherwise)) <= measured


@pytest.mark.wording
def test_what_could_not_be_measured_is_counted_apart():
    table = claims()
    n = sum(bool(claim.criterion) for claim in CLAIMS)
    assert "could not be measured" not in page()
    unknown = table["claim"].isin(["fewer_walls", "full_hull_sooner"])
    table["holds"] = table["holds"].mask(unknown, "")
    score = page_module.summarise_verdicts(table)
    first, rest = score.split(". ", 1)
    assert first.endswith(", 2 could not be measured")
    assert sum(map(int, re.findall(r"\d+", first))) == 2 * n
    assert rest.startswith(f"{len(CLAIMS) - n} more are numbers of another building")
    fewer = next(claim for claim in CLAIMS if claim.name == "fewer_walls")
    assert page_module.claim_rows(table, [fewer])[0].verdict.text == "not measured"


def test_the_table_of_deviations_is_on_the_page():
    head, *rows = page_module.read_deviations(DEVIATIONS.read_text())
    assert head[:3] == ["Section", "The thesis", "Here"] and len(rows) >= 20
    assert all(len(row) == len(head) for row in rows)
    text = page()
    assert all(escape(cell) in text for row in rows for cell in row)


def test_files_that_deviations_name_exist():
    root = DEVIATIONS.parents[1]
    places = re.findall(r"`((?:tests|lab|config)/[\w./]+)`", DEVIATIONS.read_text())
    found = [root / place for place in places if not place.startswith("lab/")]
    found += [root / "scripts/scanplan" / place for place in places if place.startswith("lab/")]
    assert places and [path for path in found if not path.exists()] == []


@pytest.mark.parametrize(
    ("values", "unit", "text"),
    [
        ([2, 2], "number", "2"),
        ([0.5, 0.7], "s", "0.600 (0.500 to 0.700) s"),
        ([1234.5, 1234.9], "m", "1,235 (1,234 to 1,235) m"),
        ([0.001592, 0.001406, 0.001686], "%", "0.156 (0.141 to 0.169) %"),
        ([-0.007, 0.007], "%", "0.000 (-0.700 to 0.700) %"),
        ([0.66, 1.0], "%", "83 (66 to 100) %"),
        ([0.661, 1.0], "%", "83 (66 to 100) %"),
        ([5, 6, 6], "count", "6 (5 to 6)"),
        ([0.0000123], "s", "0.0000123 s"),
        ([np.nan], "m", "not measured"),
    ],
)
def test_means_come_with_their_range(values, unit, text):
    assert page_module.format_values(values, unit) == text


def test_every_claim_belongs_to_figures_that_there_are():
    names = {claim.name for claim in CLAIMS}
    assert {name for figure in FIGURES for name in figure.claims} <= names


def test_numbers_of_clusters_come_in_their_order():
    ordered = ["a", "m, 1 c", "m, 2 c", "m, 10 c"]
    assert page_module.sort_quantities(["m, 10 c", "m, 2 c", "m, 1 c", "a"]) == ordered
