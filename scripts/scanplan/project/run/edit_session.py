"""Corrections from the report's page: saved beside the recording, and carried out by a run."""

import contextlib
import hashlib
import json
import os
import re
import tempfile
import threading
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import yaml

from scanplan.errors import StageError
from scanplan.project import corrections_file, run_note
from scanplan.project.dataset_files import is_survey_file
from scanplan.project.run import growing
from scanplan.project.run.served_run import ServedRun
from scanplan.store import atomic

PAGE = "report.html"
_BY_HAND = ".by_hand"  # added to the name of a file that a person wrote, to keep it
_DATA = re.compile(rb'id="data">(.*?)</script>', re.DOTALL)
"""What a page states of the plan that it shows, as JSON."""
_OF_PAGE = re.compile(rb"(survey: [^#\n]*\n|corrections:( \[\])?\n|- \{[^#\n]*\}\n)*")
"""A file of corrections in which nothing stands but entries, a line each: no comment is lost."""


class ConflictError(Exception):
    """Corrections that were saved from elsewhere since a page has read them."""


class EditSession:
    """The results of a dataset, its corrections, and the run that carries them out.

    Parameters
    ----------
    results : pathlib.Path
        A folder below results/.
    command : sequence of str
        What begins Snakemake, without the dataset's own settings.
    first : sequence of str, optional
        A command whose run makes the results first.

    Raises
    ------
    StageError
        If there is no report, or nothing says what the results are of, and no run makes them.
    """

    def __init__(
        self, results: Path, command: Sequence[str], first: Sequence[str] | None = None
    ) -> None:
        self.results = results.absolute()
        if self.results.parent.name != "results":
            self.results = results.resolve()  # a link to it
        self._command = command
        self._first = first
        self._root = self.results.parents[1]
        self._guard = threading.Lock()
        self.run = ServedRun(self._root, self.results.name)
        self._drawing = threading.Lock()
        self._picture: tuple[str, bytes] = "", b"{}"
        if first is None:
            page = results / PAGE
            if not page.is_file() or self.results.parent.name != "results":
                raise StageError(f"{page}: there is no such report; name a folder below results/")
            self.find_place()

    @property
    def is_made(self) -> bool:
        """Whether there is a report to show: not while the run that makes it first is not over."""
        return self._first is None and (self.results / PAGE).is_file()

    def find_place(self) -> Path:
        """Return where corrections are saved.

        Raises
        ------
        StageError
            If nothing says what the results are of, or that is not there.
        """
        made = run_note.read_note(self.results)
        dataset = None if made.dataset is None else self._root / made.dataset
        is_simulated = dataset is None or is_survey_file(dataset)
        place = self._root / corrections_file.place_corrections(
            self.results.name, dataset, is_simulated=is_simulated
        )
        beside = place.parent if is_simulated or dataset is None else dataset
        if not beside.exists():
            raise StageError(f"{beside}: does not exist; put it back, or run it where it is now")
        return place

    def state(self) -> dict[str, Any]:
        """Return the corrections that are saved, and which plan the newest page shows.

        Raises
        ------
        StageError
            If the file of corrections has a mistake, or is a corrections.geojson, or there is no
            page.
        """
        entries, revision = self._read()
        page = self._read_page()
        return {
            "entries": entries,
            "revision": revision,
            "page": page.get("made"),
            "running": self.run.is_running,
            "broken": self.run.is_broken,
        }

    def save(self, asked: Mapping[str, Any]) -> dict[str, Any]:
        """Save corrections and begin the run that carries them out.

        Parameters
        ----------
        asked : dict
            `survey` that they are of, `revision` of the file that they follow, `entries`.

        Raises
        ------
        StageError
            If an entry is wrong, they are of another survey, or a run is at work.
        ConflictError
            If the file has changed since.
        """
        with self._guard:
            if self.run.is_running:
                raise StageError("a run is at work; save once it has ended, changes are kept here")
            survey = self._read_page().get("survey", "")
            if asked.get("survey") != survey:
                told = str(asked.get("survey"))[:80]
                raise StageError(f"these corrections are of {told}, the results are of {survey}")
            before, revision = self._read()
            if asked.get("revision") != revision:
                raise ConflictError("Another page has saved meanwhile.")
            entries = asked.get("entries")
            if not isinstance(entries, list):
                raise StageError("entries: expected a list")
            place = self.find_place()
            _write(place, entries, survey)
            _note(place, before, entries)
            self._begin()
        return {"revision": self._read()[1]}

    def take(self, entries: Sequence[Any]) -> None:
        """Save corrections that follow those that `state` tells, without a run.

        Raises
        ------
        StageError
            If an entry is wrong, or a run is at work here.
        """
        with self._guard:
            if self.run.is_running:
                raise StageError("a run is at work; take them once it has ended")
            before, _ = self._read()
            place = self.find_place()
            _write(place, entries, self._read_page().get("survey", ""))
            _note(place, before, entries)

    def tell_run(self) -> dict[str, Any]:
        """Return how far the run is, as `ServedRun.tell` says, and what is `drawn` of the plan.

        `made` says whether there is a report; `drawn` differs once there is more to be shown; an
        `error` comes with the `entries` of the file that it may name.
        """
        with self._guard:
            if self.run.is_done:
                self._first = None
            said = self.run.tell()
            if self.run.is_done and not self.is_made:
                said["error"] = f"the run has made no {self.results.name}/{PAGE}"
            if "error" in said:
                said["entries"] = self._list_entries()
            return said | {"made": self.is_made, "drawn": growing.stamp(self.results)}

    def go_on(self) -> dict[str, Any]:
        """Begin the run that makes the results, or go on with one that was stopped or failed.

        Raises
        ------
        StageError
            If there is none to go on with, or it cannot begin.
        """
        with self._guard:
            if self.run.is_running:
                raise StageError("a run is at work already")
            if self._first is None and not self.run.is_broken and self.is_made:
                raise StageError("no run was stopped; save corrections to begin one")
            self._begin()
        return {}

    def stop(self) -> dict[str, Any]:
        """Stop the run, if one is at work; what it has made stays, and `go_on` goes on with it."""
        # what is being saved has begun its run first
        with self._guard:
            self.run.stop()
        return {}

    def end(self) -> None:
        """Stop the run for good, as nobody looks at it any more."""
        with self._guard:
            self.run.end()

    def draw(self) -> bytes:
        """Return the picture of what the run has made so far, as JSON; drawn once for all pages.

        Raises
        ------
        StageError
            If what there is cannot be drawn.
        """
        with self._drawing:
            stamp = growing.stamp(self.results)
            if stamp and stamp != self._picture[0]:
                self._picture = stamp, growing.draw(self.results, self.run.find_assumed())
            return self._picture[1]

    def _read_page(self) -> dict[str, Any]:
        page = self.results / PAGE
        try:
            found = _DATA.search(page.read_bytes())
            return json.loads(found[1]) if found else {}
        except OSError as error:
            fault = f"cannot be read ({error.strerror})"
        except ValueError:
            fault = "is damaged"
        raise StageError(f"{page}: {fault}; wait for a run that is at work, or run it again")

    def _read(self) -> tuple[list[dict[str, Any]], str]:
        """Return the entries of the file, and a digest of it."""
        place = self.find_place()
        found = corrections_file.find_beside(place)
        if found is None:
            return [], ""
        if found != place:
            raise StageError(f"{found}: is not written here; move it away, or edit it by hand")
        # what a page cannot be told is a mistake, too: a date without quotes, a number that is none
        corrections_file.read_corrections(found)
        entries = corrections_file.read_entries(found)
        return entries, hashlib.sha256(found.read_bytes()).hexdigest()

    def _list_entries(self) -> list[Any]:
        """Return the entries of the file as they are, none where it cannot be read."""
        with contextlib.suppress(StageError):
            found = corrections_file.find_beside(self.find_place())
            return [] if found is None else corrections_file.read_entries(found)
        return []

    def _begin(self) -> None:
        """Run the stages that the corrections change, or all where nothing is made yet."""
        settings = None
        try:
            if self._first is not None:
                self.run.begin(self._first)
                return
            made = run_note.read_note(self.results)
            datasets = made.storeys or [made.dataset] * (made.dataset is not None)
            asked = ["--config", f"dataset={json.dumps(datasets)}"] if datasets else []
            with tempfile.NamedTemporaryFile("w", suffix=".yaml", delete=False) as file:
                settings = Path(file.name)
                yaml.safe_dump(made.settings, file)
            given = ["--configfile", file.name] if made.settings else []
            self.run.begin([*self._command, *given, *asked], settings)
        except OSError as error:
            if settings is not None:
                settings.unlink(missing_ok=True)
            fault = f"what was said is saved, but no run begins ({error.strerror})"
            raise StageError(f"{fault}; run the dataset again") from None


def _write(place: Path, entries: Sequence[Any], survey: str) -> None:
    lines = [f"- {json.dumps(entry, ensure_ascii=False)}\n" for entry in entries]
    head = f"survey: {json.dumps(survey, ensure_ascii=False)}\ncorrections:"
    text = f"{head}\n{''.join(lines)}" if lines else f"{head} []\n"
    try:
        content = text.encode()
    except UnicodeEncodeError as error:
        fault = f"has {text[error.start]!r}, half of a character; write both or none"
        raise StageError(f"what is said {fault}") from None
    with atomic.replace_file(place) as temporary:
        temporary.write_bytes(content)
        try:
            corrections_file.read_corrections(temporary)
        except StageError as error:
            raise StageError(str(error).replace(f"{temporary}: ", "")) from None
        _keep_written(place)


def _keep_written(place: Path) -> None:
    """Keep the file that a person wrote beside it, once, as comments are not written anew."""
    kept = place.with_name(f"{place.name}{_BY_HAND}")
    if not place.exists() or os.path.lexists(kept):
        return
    content = place.read_bytes()
    if not _OF_PAGE.fullmatch(content):
        atomic.write_bytes(kept, content)


def _note(place: Path, before: Sequence[Any], after: Sequence[Any]) -> None:
    """Add to the log what was said and taken back, and when."""
    now = datetime.now(UTC).isoformat(timespec="seconds")
    lines = [("said", entry) for entry in after if entry not in before]
    lines += [("taken back", entry) for entry in before if entry not in after]
    # by the recording's name: another one in its folder has a log of its own
    log_path = place.with_suffix(".log")
    with atomic.explain_unwritable(log_path), log_path.open("a", encoding="utf-8") as log:
        for what, entry in lines:
            log.write(json.dumps({"saved": now, what: entry}, ensure_ascii=False) + "\n")
