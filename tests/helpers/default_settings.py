"""The settings as they are by default, for tests that run stages with them."""

from pathlib import Path

from scanplan.project.settings import LABORATORY_FILE, SCHEMA_FILE
from scanplan.project.settings_schema import default_settings, read_schema

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = read_schema(SCHEMA_FILE, LABORATORY_FILE)
SETTINGS = default_settings(SCHEMA)
