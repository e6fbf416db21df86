"""Corrections from the report's page: saved beside the recording, and carried out by a run."""

import hashlib
import json
import os
import re
import subprocess
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
from scanplan.store import atomic

PAGE = "report.html"
_BY_HAND = ".by_hand"  # added to the name of a file that a person wrote, to keep it
_DATA = re.compile(rb'id="data">(.*?)</script>', re.DOTALL)
"""What a page states of the plan that it shows, as JSON."""
_OF_PAGE = re.compile(rb"(survey: [^#\n]*\n|corrections:( \[\])?\n|- \{[^#\n]*\}\n)*")
"""A file of corrections in which nothing stands but entries, a line each: no comment is lost."""
_STAGE = re.compile(r"^ *(\d+)/(\d+) (.*)$")
"""A line of a run on a stage that has ended: how many have, of how many."""
_MOST_LETTERS = 200  # of a line of the run that a page shows


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

    Raises
    ------
    StageError
        If there is no report, or nothing says what the results are of.
    """

    def __init__(self, results: Path, command: Sequence[str]) -> None:
        self.results = results.absolute()
        if self.results.parent.name != "results":
            self.results = results.resolve()  # a link to it
        page = results / PAGE
        if not page.is_file() or self.results.parent.name != "results":
            raise StageError(f"{page}: there is no such report; name a folder below results/")
        self._command = command
        self._root = self.results.parents[1]
        self._made = run_note.read_note(self.results)
        dataset = None if self._made.dataset is None else self._root / self._made.dataset
        is_simulated = dataset is None or is_survey_file(dataset)
        self.place = self._root / corrections_file.place_corrections(
            self.results.name, dataset, is_simulated=is_simulated
        )
        beside = self.place.parent if is_simulated or dataset is None else dataset
        if not beside.exists():
            raise StageError(f"{beside}: does not exist; put it back, or run it where it is now")
        self._guard = threading.Lock()
        self._run: subprocess.Popen[str] | None = None
        self._listener = threading.Thread()
        self._lines: list[str] = []

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
            "running": self._is_running(),
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
            if self._is_running():
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
            self._write(entries, survey)
            self._note(before, entries)
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
            if self._is_running():
                raise StageError("a run is at work; take them once it has ended")
            survey = self._read_page().get("survey", "")
            before, _ = self._read()
            self._write(entries, survey)
            self._note(before, entries)

    def tell_run(self) -> dict[str, Any]:
        """Return how far the run is: `running`, `ended` of `total` stages, a `line`, an `error`."""
        with self._guard:
            stages = [found for line in self._lines if (found := _STAGE.match(line))]
            said = {
                "running": self._is_running(),
                "ended": 0,
                "total": 0,
                "line": "Working out what changes",
            }
            if stages:
                said |= {"ended": int(stages[-1][1]), "total": int(stages[-1][2])}
                said["line"] = stages[-1][3][:_MOST_LETTERS]
            if self._run is not None and self._run.poll():
                told = [line for line in self._lines if line.startswith("scanplan: ")]
                fault = told[-1] if told else "the run ended without a word"
                said["error"] = fault.removeprefix("scanplan: ")[:_MOST_LETTERS]
            return said

    def end(self) -> None:
        """End the run, if one is at work; what it has made stays."""
        # what is being saved has begun its run first
        with self._guard:
            if self._is_running() and self._run is not None:
                self._run.terminate()
                self._listener.join()

    def _is_running(self) -> bool:
        return self._listener.is_alive()

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
        found = corrections_file.find_beside(self.place)
        if found is None:
            return [], ""
        if found != self.place:
            raise StageError(f"{found}: is not written here; move it away, or edit it by hand")
        # what a page cannot be told is a mistake, too: a date without quotes, a number that is none
        corrections_file.read_corrections(found)
        entries = corrections_file.read_entries(found)
        return entries, hashlib.sha256(found.read_bytes()).hexdigest()

    def _write(self, entries: Sequence[Any], survey: str) -> None:
        lines = [f"- {json.dumps(entry, ensure_ascii=False)}\n" for entry in entries]
        head = f"survey: {json.dumps(survey, ensure_ascii=False)}\ncorrections:"
        text = f"{head}\n{''.join(lines)}" if lines else f"{head} []\n"
        try:
            content = text.encode()
        except UnicodeEncodeError as error:
            fault = f"has {text[error.start]!r}, half of a character; write both or none"
            raise StageError(f"what is said {fault}") from None
        with atomic.replace_file(self.place) as temporary:
            temporary.write_bytes(content)
            try:
                corrections_file.read_corrections(temporary)
            except StageError as error:
                raise StageError(str(error).replace(f"{temporary}: ", "")) from None
            self._keep_written()

    def _keep_written(self) -> None:
        """Keep the file that a person wrote beside it, once, as comments are not written anew."""
        kept = self.place.with_name(f"{self.place.name}{_BY_HAND}")
        if not self.place.exists() or os.path.lexists(kept):
            return
        content = self.place.read_bytes()
        if not _OF_PAGE.fullmatch(content):
            atomic.write_bytes(kept, content)

    def _note(self, before: Sequence[Any], after: Sequence[Any]) -> None:
        """Add to the log what was said and taken back, and when."""
        now = datetime.now(UTC).isoformat(timespec="seconds")
        lines = [("said", entry) for entry in after if entry not in before]
        lines += [("taken back", entry) for entry in before if entry not in after]
        # by the recording's name: another one in its folder has a log of its own
        place = self.place.with_suffix(".log")
        with atomic.explain_unwritable(place), place.open("a", encoding="utf-8") as log:
            for what, entry in lines:
                log.write(json.dumps({"saved": now, what: entry}, ensure_ascii=False) + "\n")

    def _begin(self) -> None:
        """Run the stages that the corrections change."""
        made = self._made
        datasets = made.storeys or [made.dataset] * (made.dataset is not None)
        asked = [f"dataset={json.dumps(datasets)}"] if datasets else []
        settings = None
        try:
            with tempfile.NamedTemporaryFile("w", suffix=".yaml", delete=False) as file:
                settings = Path(file.name)
                yaml.safe_dump(made.settings, file)
            given = ["--configfile", file.name] if made.settings else []
            self._run = subprocess.Popen(
                [*self._command, *given, *(["--config", *asked] if asked else [])],
                cwd=self._root,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="replace",
            )
        except OSError as error:
            if settings is not None:
                settings.unlink(missing_ok=True)
            fault = f"the corrections are saved, but no run begins ({error.strerror})"
            raise StageError(f"{fault}; run the dataset again") from None
        self._lines = []
        self._listener = threading.Thread(target=self._listen, args=(self._run, settings))
        self._listener.daemon = True
        self._listener.start()

    def _listen(self, run: subprocess.Popen[str], settings: Path) -> None:
        with run:
            self._lines.extend(line.rstrip() for line in run.stdout or ())
        settings.unlink(missing_ok=True)
