"""The manual's lists of columns, written from the schemas of the tables."""

import re
import textwrap
from pathlib import Path

from scanplan.store import schemas

_MANUAL = Path(__file__).parents[3] / "config/outputs.md"
_MARKED = re.compile(r"(?ms)^<!-- columns (\S+) -->\n.*?^<!-- end -->$")
_COLUMNS = 100  # as of the code's lines


def list_schemas() -> dict[str, schemas.Schema]:
    """Return the schemas of all tables, by the names of their constants."""
    constants = vars(schemas).items()
    return {name: value for name, value in constants if isinstance(value, schemas.Schema)}


def fill_columns(manual: str) -> str:
    """Return the manual with every list of columns written anew.

    Parameters
    ----------
    manual : str
        Where it says `<!-- columns POSES -->`, the columns of that schema stand up to
        `<!-- end -->`.

    Raises
    ------
    KeyError
        If there is no schema of that name.
    """
    known = list_schemas()

    def write(found: re.Match[str]) -> str:
        names = ", ".join(f"`{column}`" for column in known[found[1]].columns)
        lines = textwrap.fill(names, _COLUMNS, break_long_words=False, break_on_hyphens=False)
        return f"<!-- columns {found[1]} -->\n{lines}\n<!-- end -->"

    return _MARKED.sub(write, manual)


if __name__ == "__main__":
    _MANUAL.write_text(fill_columns(_MANUAL.read_text(encoding="utf-8")), encoding="utf-8")
