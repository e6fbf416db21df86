"""The licences of all packages that are installed, held against the project's own (MIT).

What fits may be used and passed on together with it: permissive licences, and weak copyleft (LGPL,
MPL) of packages that are used as they are. What does not: licences that would have to cover the
project as well (GPL, AGPL), and packages that state none, unless `KNOWN` says why.
"""

import re
import sys
from importlib.metadata import Distribution, distributions
from pathlib import Path

FITTING = re.compile(
    r"\b(MIT|BSD|0BSD|Apache|ISC|PSF|Python Software Foundation|Zlib|CC0|HPND|Unlicense|any-OSI"
    r"|Public Domain|MPL|Mozilla|LGPL|Lesser General Public|Kiwi)",
    re.IGNORECASE,
)
FITTING_TEXT = re.compile(
    r"Permission is hereby granted, free of charge|Redistribution and use in source and binary"
    r"|Apache License|Permission to use, copy, modify"
)
KNOWN = {
    "bcf-client": "GPL, comes with ifcopenshell's tester; nothing of the project imports it",
    "evo": "GPL, a tool to compare trajectories with; nothing of the project imports it",
}


def find_licence(package: Distribution) -> tuple[str, bool]:
    """Return what a package says of its licence, and whether that fits."""
    metadata = package.metadata
    stated = metadata.get_all("License-Expression") or []
    parts = " AND ".join(stated).split(" AND ") if stated else []
    if parts and not all(map(FITTING.search, parts)):
        return " AND ".join(parts), False
    labels = metadata.get_all("Classifier") or []
    stated += [label.rpartition(" :: ")[2] for label in labels if label.startswith("License ::")]
    stated += [text.strip().partition("\n")[0] for text in metadata.get_all("License") or []]
    named = sorted({words for words in stated if words and words != "UNKNOWN"})
    if any(map(FITTING.search, named)):
        return ", ".join(named)[:80], True
    # some name none, and have its text beside their code
    files = [f for f in package.files or () if re.match(r"(LICEN[CS]E|COPYING)", f.name, re.I)]
    texts = [Path(file.locate()) for file in files]
    for text in texts:
        if FITTING_TEXT.search(text.read_text(encoding="utf-8", errors="replace")):
            return f"{', '.join(named) or 'not named'}; its {text.name} fits", True
    return ", ".join(named)[:80] or "not stated", False


def main() -> int:
    """Print a line a package; return 1 where one does not fit."""
    unfit = []
    for package in sorted(distributions(), key=lambda package: package.name.lower()):
        licence, is_fitting = find_licence(package)
        known = KNOWN.get(package.name, "")
        if not is_fitting and not known:
            unfit.append(package.name)
        mark = "" if is_fitting else known or "DOES NOT FIT"
        print(f"{package.name:<40}{package.version:<14}{licence:<60}{mark}".rstrip())
    print(f"{len(unfit)} do not fit{': ' * bool(unfit)}{', '.join(unfit)}")
    return 1 if unfit else 0


if __name__ == "__main__":
    sys.exit(main())
