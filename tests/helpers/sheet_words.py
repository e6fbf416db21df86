"""What of a sheet stays English where another language is asked for."""

from scanplan.exports.sheet.composition import paper_words
from scanplan.exports.sheet.locale import ENGLISH, make_locale
from scanplan.project.words_file import read_words

LANGUAGES = ("de", "fr", "es")
# what is the same in every language: names, letters of axes, sizes of paper, words that are alike
ALIKE = {"office", "scanplan", "A4", "A3", "x", "y", "p", "passage", "Notes", "2 m", "Element"}


def texts(sheet):
    return [word.text for word in paper_words(sheet)]


def find_english(compose, language):
    """Words of sheets that are the same in a language as in English, of those that have letters.

    Parameters
    ----------
    compose : callable
        Of a locale, returns the sheet.
    """
    english = {text for text in texts(compose(ENGLISH)) if any(map(str.isalpha, text))}
    other = {*texts(compose(make_locale("m", read_words(language))))}
    return {text for text in (english & other) - ALIKE if not text.startswith("1:")}
