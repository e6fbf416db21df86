"""Licences that do not fit the project's are told from those that do."""

from email.message import Message
from pathlib import Path
from types import SimpleNamespace

import pytest

import audit_licences

ROOT = Path(__file__).resolve().parents[2]


def package(**fields):
    metadata = Message()
    for name, value in fields.items():
        metadata[name.replace("_", "-")] = value
    return SimpleNamespace(metadata=metadata, files=[])


@pytest.mark.parametrize(
    ("fields", "is_fitting"),
    [
        ({"License_Expression": "MIT"}, True),
        ({"License_Expression": "BSD-3-Clause AND Zlib"}, True),
        ({"License_Expression": "Apache-2.0 AND GPL-3.0-only"}, False),
        ({"License_Expression": "AGPL-3.0-or-later"}, False),
        ({"License_Expression": "LGPL-3.0-or-later"}, True),
        ({"Classifier": "License :: OSI Approved :: GNU General Public License v3 (GPLv3)"}, False),
        ({"Classifier": "License :: OSI Approved :: ISC License (ISCL)"}, True),
        ({"License": "Proprietary"}, False),
        ({}, False),
    ],
)
def test_a_licence_fits_or_not(fields, is_fitting):
    assert audit_licences.find_licence(package(**fields))[1] == is_fitting


def test_a_text_beside_the_code_stands_for_a_name(tmp_path):
    (tmp_path / "LICENSE").write_text("Permission is hereby granted, free of charge, to any")
    file = SimpleNamespace(name="LICENSE", locate=lambda: tmp_path / "LICENSE")
    found = SimpleNamespace(metadata=Message(), files=[file])
    assert audit_licences.find_licence(found) == ("not named; its LICENSE fits", True)


def test_nothing_of_the_project_imports_what_does_not_fit():
    text = "\n".join(p.read_text(encoding="utf-8") for p in (ROOT / "scripts").rglob("*.py"))
    for name in audit_licences.KNOWN:
        module = name.replace("-client", "")
        assert f"import {module}" not in text and f"from {module}" not in text


def test_all_packages_that_are_installed_fit():
    assert audit_licences.main() == 0


def test_every_pinned_package_has_hashes():
    lock = (ROOT / "environment.lock").read_text(encoding="utf-8")
    pins = [block for block in lock.split("\n") if "==" in block]
    assert pins and all(pin.rstrip().endswith("\\") for pin in pins)
    assert lock.count("--hash=sha256:") >= len(pins)
