"""Words that a person gives: pairs that are joined, characters and lengths that are refused."""

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.project.texts import (
    check_path,
    check_text,
    cut_line,
    find_unfit,
    fold_line,
    join_pairs,
)


@given(st.text(st.characters(exclude_categories=["Cs"])))
def test_whatever_is_no_half_stays_when_pairs_are_joined(text):
    halves = text.encode("utf-16-be", "surrogatepass")
    units = [chr(int.from_bytes(halves[i : i + 2])) for i in range(0, len(halves), 2)]
    assert join_pairs(text) == join_pairs("".join(units)) == text


@pytest.mark.parametrize("half", ["\ud83c", "a\udfe0", "\udfe0\ud83c"])
def test_half_of_a_pair_is_refused(half):
    with pytest.raises(UnicodeDecodeError):
        join_pairs(half)


@given(st.characters())
def test_letters_marks_numbers_and_symbols_are_fit(character):
    is_shown = unicodedata.category(character)[0] in "LMNPS"
    if is_shown or character == " ":
        assert find_unfit(character) is None
    if unicodedata.category(character) in ("Cc", "Cs", "Zl", "Zp"):
        assert find_unfit(f"a{character}") == character


@pytest.mark.parametrize("unfit", ["\uffff", "\U0010fffe", "\ufdd0", "\u202e", "\u2066", "\x85"])
def test_what_is_no_character_or_turns_a_line_is_found(unfit):
    assert find_unfit(f"hall {unfit}2") == unfit


def test_characters_that_join_others_are_fit():
    family, persian = "👨\u200d👩\u200d👧", "می\u200cخواهم"
    assert find_unfit(family) is find_unfit(persian) is None


def test_a_text_has_its_limit_in_the_line():
    assert check_text("a.yaml: name", " Foyer ") == "Foyer"
    assert check_text("a.yaml: name", "x" * 80) == "x" * 80
    with pytest.raises(StageError, match=r"a\.yaml: name has 81 characters, expected .* 1 to 80"):
        check_text("a.yaml: name", "x" * 81)
    for other in (None, 5, ["a"], False):
        with refused(value="1 to 80"):
            check_text("a.yaml: name", other)
    for empty in ("", "  ", "\u200b", "\u200d\u00ad"):
        with refused(file="a.yaml", key="name", remedy="write letters"):
            check_text("a.yaml: name", empty)


@given(st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=50))
def test_a_path_is_refused_for_what_cannot_be_shown_alone(path):
    if find_unfit(path) is None:
        check_path(path)
    else:
        with pytest.raises(StageError, match="rename it"):
            check_path(path)


WORDS = st.lists(st.text("abc(,;:) ", min_size=1, max_size=12), max_size=30).map(" ".join)


@given(WORDS, st.integers(20, 60), st.integers(0, 8))
def test_a_folded_line_has_all_words_and_fits(text, width, indent):
    lines = fold_line(text, width=width, indent=indent)
    assert " ".join(lines).split() == text.split()
    assert max(map(len, lines), default=0) <= width


def test_a_word_that_is_longer_than_a_line_stays_whole():
    path = "a" * 30 + "-" + "b" * 30
    folded = fold_line(f"see {path} for more", width=20, indent=2)
    assert folded == ["see", f"  {path}", "  for more"]


@given(WORDS, st.integers(0, 60))
def test_a_cut_line_fits_and_is_the_beginning_of_the_text(text, width):
    cut = cut_line(text, width)
    assert len(cut) <= max(width, 20)
    assert cut == text or text.startswith(cut.removesuffix("…").rstrip())


@pytest.mark.parametrize(
    ("text", "cut"),
    [
        ("8 walls (2 to verify), 19.4 m; 13 faces", "8 walls (2 to verify), 19.4 m …"),
        ("8 walls (2 to verify, 3 not; all in a row)", "8 walls …"),
        ("nothing in it is a clause that ends before", "nothing in it is a clause that …"),
        ("nothing in it is a clause somewhere in it", "nothing in it is a clause …"),
        ("x" * 40, "x" * 31 + "…"),
    ],
)
def test_a_line_is_cut_between_clauses_and_never_within_brackets(text, cut):
    assert cut_line(text, 32) == cut
