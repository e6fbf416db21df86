"""The command `scanplan` of an installed release: a short way to a run of Snakemake's own."""

import argparse
import json
import os
import shlex
import subprocess
import sys
import webbrowser
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

from scanplan import interrupts, surroundings
from scanplan.errors import StageError
from scanplan.project import dataset_files, dataset_list
from scanplan.project.code_files import state_version
from scanplan.project.run.edit_server import EditServer
from scanplan.project.run.edit_session import EditSession

SNAKEFILE = Path(__file__).absolute().parents[4] / "workflow/Snakefile"
"""The workflow that lies beside this package, in a checkout and in a wheel alike."""
DEMO = "demo"
DIFF = "diff"
TAKE = "take"
OPEN = "open"

_SNAKEMAKE = (sys.executable, "-P", "-m", "snakemake")
"""Snakemake; -P: modules are not looked for among the user's files."""
_WRONG_CALL = 2  # the exit status of shells' own commands where their arguments are wrong


def main(words: Sequence[str] | None = None) -> int:
    """Do what a command says, and return the exit status; a run takes this process's place.

    Parameters
    ----------
    words : sequence of str, optional
        What follows the command's name; those of this process if None.
    """
    surroundings.mend_surroundings()
    interrupts.end_on_interrupt()
    given = list(sys.argv[1:] if words is None else words)
    try:
        if given[:1] == [OPEN]:
            asked = _read_open(given[1:])
            return serve_results(Path(asked.results), asked)
        if given[:1] == [TAKE]:
            return take_edits(given[1:])
        arguments = form_arguments(given)
        asked, _ = _make_parser().parse_known_args(given)
        if asked.open:
            return serve_results(find_results(asked.recording), asked, arguments)
    except StageError as error:
        print(f"scanplan: {error}", file=sys.stderr)
        return _WRONG_CALL
    print(f"scanplan: runs {_show(arguments)}", flush=True)
    return _begin_snakemake(arguments)


def form_arguments(words: Sequence[str]) -> list[str]:
    """Return the arguments of Snakemake that a command stands for.

    Parameters
    ----------
    words : sequence of str
        Recordings and options, as `scanplan --help` lists them.

    Raises
    ------
    StageError
        If the words are no such command; where they could be of Snakemake, with its command.
    SystemExit
        Once the help or the version is told.
    """
    asked, further = _make_parser().parse_known_args(words)
    # what changed from each survey to the next
    is_diff = asked.recording[:1] == [DIFF]
    targets = ["changes"] if is_diff else []
    asked.recording = asked.recording[len(targets) :]
    if not asked.recording:
        raise StageError(f"no recording is given; name one, a folder of them, or `{DEMO}`")
    if is_diff and len(asked.recording) < 2:
        raise StageError(f"{DIFF}: one survey alone; name the earlier one, then the later one")
    datasets = [] if asked.recording == [DEMO] else asked.recording
    if DEMO in datasets:
        raise StageError(f"{DEMO}: is made alone; ./{DEMO} is a folder of that name")
    settings = {"dataset": datasets, "replace": asked.replace or []}
    config = [f"{k}={json.dumps(v, ensure_ascii=False)}" for k, v in settings.items() if v]
    arguments = [
        *targets,
        *("--snakefile", str(SNAKEFILE), "--cores", asked.cores, *further),
        *(("--configfile", asked.configfile) if asked.configfile else ()),
        *(("--config", *config) if config else ()),
    ]
    if further:
        raise StageError(f"{further[0]}: no option of scanplan; Snakemake's: {_show(arguments)}")
    return arguments


def find_results(recordings: Sequence[str]) -> Path:
    """Return the folder of the results of a command's only recording.

    Raises
    ------
    StageError
        If there is not one alone, it has no name, or is not there.
    """
    if len(recordings) > 1 or recordings[0] == DIFF or dataset_list.is_list(recordings[0]):
        raise StageError("--open shows one floor; name one recording, or a folder of one floor's")
    is_demo = recordings == [DEMO]
    if not is_demo and not Path(recordings[0]).exists():
        raise StageError(f"{recordings[0]}: does not exist; name a recording, or their folder")
    return Path("results", DEMO if is_demo else dataset_files.dataset_name(recordings[0]))


def serve_results(
    results: Path, asked: argparse.Namespace, first: Sequence[str] | None = None
) -> int:
    """Show a report in the browser and take corrections, until Ctrl-C.

    A signal to end does the same; a run that is at work ends with it.

    Parameters
    ----------
    results : pathlib.Path
        Its folder.
    asked : argparse.Namespace
        `cores`, and `no_browser`.
    first : sequence of str, optional
        The arguments of Snakemake's that make the results first, while the page shows how far.

    Raises
    ------
    StageError
        If there is no report, or nothing says what it is of.
    """
    _prepare_environment()
    snakemake = [*_SNAKEMAKE, "--snakefile", str(SNAKEFILE), "--cores", asked.cores]
    session = EditSession(results, snakemake, None if first is None else [*_SNAKEMAKE, *first])
    with EditServer(session) as server:
        print(f"scanplan: the report is at {server.address}", flush=True)
        if first is None:
            print(f"scanplan: corrections go to {session.find_place()}; Ctrl-C ends", flush=True)
        else:
            print(f"scanplan: runs {_show(first)}; Ctrl-C ends it", flush=True)
        if not asked.no_browser and not webbrowser.open(server.address):
            print("scanplan: no browser could be started; open the address in one", flush=True)
        try:
            with suppress(KeyboardInterrupt):
                interrupts.begin_work()
                interrupts.interrupt_on_end()
                if first is not None:
                    session.go_on()
                server.serve_forever()
        finally:
            session.end()
    return 0


def take_edits(words: Sequence[str]) -> int:
    """Take what was changed of a plan elsewhere as corrections, in a process of its own.

    Its libraries are none that a run begins with.

    Parameters
    ----------
    words : sequence of str
        The edited file and options, as `scanplan take --help` lists them.
    """
    scripts = SNAKEFILE.parents[1] / "scripts"
    folders = [str(scripts), os.environ.get("PYTHONPATH", "")]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, folders))}
    command = [sys.executable, "-P", "-m", "scanplan.edited.take", *words]
    return subprocess.run(command, check=False, env=environment).returncode


class _Parser(argparse.ArgumentParser):
    """A parser that tells faults in one line."""

    def error(self, message: str) -> NoReturn:
        raise StageError(f"{message}; see `{self.prog} --help`")


def _make_parser() -> _Parser:
    parser = _Parser(
        prog="scanplan",
        description="Makes floor plans of LiDAR recordings, in results/ of the folder it runs in.",
        epilog="`scanplan diff BEFORE AFTER` tells what changed between two surveys of a floor;"
        " `scanplan open results/NAME` shows a report and takes corrections; `scanplan take FILE`"
        " those of a plan that was edited elsewhere. A run says which"
        " command of Snakemake it is; whatever else Snakemake can do is added to that one.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=state_version())
    parser.add_argument(
        "recording",
        nargs="*",
        help=f"a recording, a folder with those of one floor, or `{DEMO}`: a simulated drive",
    )
    parser.add_argument(
        "--cores", type=_read_cores, default="2", metavar="N", help="`all` or a number (2)"
    )
    parser.add_argument("--configfile", metavar="FILE", help="settings, see config/settings.md")
    _add_no_browser(parser)
    parser.add_argument(
        "--open",
        action="store_true",
        help="show in the browser how the plan comes about, then its report, until Ctrl-C",
    )
    parser.add_argument(
        "--replace",
        action="append",
        metavar="NAME",
        help="take the place of results/NAME, made of another recording",
    )
    return parser


def _read_cores(word: str) -> str:
    if word != "all" and not (word.isascii() and word.isdigit() and int(word)):
        raise argparse.ArgumentTypeError(f"{word} is no number of cores; give 1 or more, or `all`")
    return word


def _add_no_browser(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--no-browser", action="store_true", help="tell the page's address alone")


def _read_open(words: Sequence[str]) -> argparse.Namespace:
    parser = _Parser(
        prog=f"scanplan {OPEN}",
        description="Shows a report in the browser, saves what is corrected there beside the"
        " recording, and makes the plan anew; on this computer alone, until Ctrl-C.",
    )
    parser.add_argument("results", help="a folder with results, such as results/demo")
    _add_no_browser(parser)
    parser.add_argument("--cores", type=_read_cores, default="2", metavar="N", help="(2)")
    return parser.parse_args(words)


def _show(arguments: Sequence[str]) -> str:
    return shlex.join(["snakemake", *arguments])


def _begin_snakemake(arguments: Sequence[str]) -> int:
    """Run Snakemake as `make run` does: in this process's place, where the system knows that."""
    _prepare_environment()
    command = [*_SNAKEMAKE, *arguments]
    if os.name != "nt":
        os.execv(sys.executable, command)
    return subprocess.run(command, check=False).returncode


def _prepare_environment() -> None:
    """Have the stages of a run find the programs of this environment, and compiled modules."""
    interrupts.prepare_children()
    folders = [str(Path(sys.executable).parent), os.environ.get("PATH", "")]
    os.environ["PATH"] = os.pathsep.join(filter(None, folders))
    # every stage is a process, which would compile the package anew
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
