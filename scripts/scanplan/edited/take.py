"""`scanplan take`: what was changed of a plan in another program becomes corrections."""

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path

from scanplan.edited import base, differences, entries
from scanplan.edited.elements import Drawing
from scanplan.edited.openplan_reading import read_openplan
from scanplan.errors import EXTRAS, MOST_NAMED, StageError, name_extra
from scanplan.plan.floorplan import say_count
from scanplan.project import corrections_file, texts
from scanplan.project.run.edit_session import EditSession
from scanplan.types import FilePath

_JSON, _DXF = ".json", ".dxf"
_WRONG_CALL = 2  # the exit status of shells' own commands where their arguments are wrong


def take_edits(path: Path, results: Path | None, by: str = "") -> list[str]:
    """Add what was changed in an edited file to the corrections beside the recording.

    Parameters
    ----------
    path : pathlib.Path
        plan.openplan3d.json, plan.ifc, presentation.ifc, plan.dxf or presentation.dxf of the
        results as another program has saved it, under any name.
    results : pathlib.Path, optional
        The folder below results/; that of the survey that the file names, if not given.
    by : str
        Who has edited it.

    Returns
    -------
    list of str
        Lines that tell what was taken, what was not, and what to do.

    Raises
    ------
    StageError
        If the file cannot be read, is of another survey or an older plan, or the corrections that
        there are have a mistake.
    """
    suffix = path.suffix.casefold()
    if suffix not in base.FILES:
        expected = ", ".join(base.FILES)
        raise StageError(f"{path}: is no {expected}; save the edited plan as one of these")
    if not path.exists():
        raise StageError(f"{path}: does not exist; name the edited file")
    read = _READERS[suffix]
    edited = read(path)
    folder = results if results is not None else Path("results", edited.survey or "?")
    if results is None and not folder.is_dir():
        remedy = f"name them: `scanplan take {path} results/NAME`"
        raise StageError(f"{path}: names no results that are here; {remedy}")
    session = EditSession(folder, [])
    before = session.state()["entries"]
    places = [session.results / "plan" / name for name in base.FILES[suffix]]
    bases = {place: read(place) for place in places if place.exists()}
    if not bases:
        names = " or ".join(base.FILES[suffix])
        raise StageError(f"{folder}/plan: has no {names}; run it with that format")
    chosen = base.choose_base(path, edited, bases)
    if suffix == _DXF:
        edited = _follow_sides(chosen, path, bases[chosen], edited)
    found = differences.find_changes(bases[chosen], edited)
    changes = [change for change in found if not entries.is_named_by_itself(change)]
    lost = [change for change in changes if suffix == _JSON and entries.is_lost_room(change)]
    changes = [change for change in changes if change not in lost]
    plan = base.read_edited_plan(session.results)
    changes = [change.divide_places(plan.factor) for change in changes]
    now = datetime.now(UTC).isoformat(timespec="seconds").replace("+00:00", "Z")
    stamp = {"when": now} | ({"by": texts.check_text("--by", by)} if by else {})
    there = corrections_file.find_beside(session.find_place())
    said = [] if there is None else corrections_file.read_corrections(there)
    taken = entries.take_changes(plan, changes, entries.Said(before, said, stamp))
    if taken.entries != before:
        session.take(taken.entries)
    kept = f"{say_count(len(lost), 'room')} that the editor lost with walls stay as they are"
    told = [*_tell_other(edited, bases[chosen]), *([kept] if lost else [])]
    return [*_tell(taken, session.find_place(), chosen), *told]


def main(words: Sequence[str] | None = None) -> int:
    """Do what the command says, and return its exit status."""
    parser = argparse.ArgumentParser(
        prog="scanplan take",
        description="Takes what was changed of a plan in another program (openPlan3D's JSON, IFC or"
        " DXF) as corrections, beside the recording. The next run carries them out.",
    )
    parser.add_argument("file", type=Path, help="the edited file")
    parser.add_argument("results", type=Path, nargs="?", help="results/NAME that it is of")
    parser.add_argument("--by", default="", metavar="NAME", help="who has edited it")
    asked = parser.parse_args(words)
    try:
        lines = take_edits(asked.file, asked.results, asked.by)
    except StageError as error:
        print(f"scanplan: {error}", file=sys.stderr)
        return _WRONG_CALL
    for line in lines:
        print(f"scanplan: {line}")
    return 0


def _tell(taken: entries.Taken, place: Path, chosen: Path) -> list[str]:
    n = taken.n_changes
    head = f"{say_count(n, 'change')} of {chosen.name} taken"
    lines = [f"{head} into {place}; run the dataset again" if n else f"{head}: nothing differs"]
    if taken.told:
        lines.append(f"{say_count(len(taken.told), 'change')} not understood:")
        lines += [f"  {line}" for line in taken.told[:MOST_NAMED]]
        more = len(taken.told) - MOST_NAMED
        lines += [f"  and {more} more"] if more > 0 else []
    return lines


def _tell_other(edited: Drawing, before: Drawing) -> list[str]:
    """Return a line on what another program has added that is no element of a plan."""
    more = {n: k - before.other.get(n, 0) for n, k in edited.other.items()}
    told = ", ".join(f"{k} {name}" for name, k in sorted(more.items()) if k > 0)
    return [f"not taken, as no correction says it: {told}"] if told else []


def _follow_sides(chosen: Path, path: Path, base_drawing: Drawing, edited: Drawing) -> Drawing:
    from scanplan.edited.dxf_reading import list_sides
    from scanplan.edited.side_strips import follow_sides

    return follow_sides(base_drawing, edited, (list_sides(chosen), list_sides(path)))


def _read_ifc(path: FilePath) -> Drawing:
    try:
        from scanplan.edited.ifc_reading import read_ifc
    except ModuleNotFoundError as error:
        if error.name not in EXTRAS:
            raise
        raise StageError(f"{path}: {name_extra(error.name)}") from None
    return read_ifc(path)


def _read_dxf(path: FilePath) -> Drawing:
    from scanplan.edited.dxf_reading import read_dxf  # half a second, for one format

    return read_dxf(path)


_READERS: Mapping[str, Callable[[FilePath], Drawing]] = {
    _JSON: read_openplan,
    ".ifc": _read_ifc,
    _DXF: _read_dxf,
}

if __name__ == "__main__":
    sys.exit(main())
