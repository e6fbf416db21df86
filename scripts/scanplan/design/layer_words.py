"""What is drawn on a layer of a CAD file, by the words of its name."""

import re

_LETTER = r"[^\W\d_]"
KINDS = {
    "wall": r"<(walls?|wand|wände|waende|mauern?|mauerwerk)|murs?",
    "door": r"doors?|<(tür|tuer)(en)?|tur(en)?|portes?",
    "window": r"wind|windows?|glaz(ing)?|<fenster|fen[eê]tres?",
    "column": r"cols|columns?|<(stütze|stuetze|stutze)n?|poteaux?",
    "room": r"rooms?|spaces?|<(raum|räume|raeume|zimmer)|areas?(?!-)|pi[eè]ces?",
}
"""Words in names of layers, by the AIA's guidelines and as German and French offices name them.

They are whole, but for those after `<`, which words may end in: Innenwand, Haustür.
"""
_WORDS = {
    kind: re.compile(f"(?<!{_LETTER})({named.replace('<', _LETTER + '*')})(?!{_LETTER})")
    for kind, named in KINDS.items()
}


def kind_of_layer(layer: str) -> str | None:
    """Return what is drawn on a layer, by words of its name.

    >>> kind_of_layer("A-WALL"), kind_of_layer("Haustüren"), kind_of_layer("Furniture")
    ('wall', 'door', None)
    """
    # WallsExt is of two words
    words = re.sub(r"(?<=[^\W\d_A-Z])(?=[A-Z])", "_", layer).casefold()
    return next((kind for kind, named in _WORDS.items() if named.search(words)), None)
