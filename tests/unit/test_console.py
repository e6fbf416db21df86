"""What the user sees of a run, on a terminal and in a file."""

import io
import logging
from pathlib import Path

import pytest
from snakemake_interface_logger_plugins.common import LogEvent

from scanplan.project.run.console import RunConsole
from scanplan.project.run.terminal import Terminal, tell
from scanplan.project.texts import CONSOLE_WIDTH


class Screen(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "60")
    monkeypatch.setenv("SCANPLAN_WATCHED", "")


def record(event, **values):
    made = logging.LogRecord("snakemake", values.pop("level", logging.INFO), "", 0, "", (), None)
    made.__dict__ |= {"event": event, "msg": "", **values}
    return made


@pytest.fixture
def file():
    return io.StringIO()


@pytest.fixture
def console(file):
    console = RunConsole(Terminal(file), ["floor"])
    stats = {"register_scans": 1, "order_scans": 1, "all": 1, "total": 3}
    console.emit(record(LogEvent.RUN_INFO, stats=stats))
    return console


def begin(console, jobid, rule, text, **wildcards):
    log = Path(f"{rule}.log")
    values = {"rule_name": rule, "log": [str(log)], "wildcards": {"dataset": "floor", **wildcards}}
    console.emit(record(LogEvent.JOB_INFO, jobid=jobid, **values))
    log.write_text(text)


REGISTERED = """12:00 INFO register_scans: 3/9 scans, 5 per s, 1 s left
12:00 INFO register_scans: 8 of 9 candidates retained
12:00 INFO stage done
"""


def test_a_stage_that_ended_is_a_line_of_what_it_found(console, file):
    begin(console, 7, "register_scans", REGISTERED)
    console.emit(record(LogEvent.JOB_FINISHED, job_id=7))
    (line,) = file.getvalue().splitlines()
    assert line.startswith("1/2 floor register_scans: ")
    assert line.endswith(" s  8 of 9 candidates retained")


def test_warnings_are_said_and_a_failed_stage_says_so(console, file):
    begin(console, 1, "order_scans", "12:00 WARNING order_scans: too few\n", method="hull")
    console.emit(record(LogEvent.JOB_ERROR, jobid=1))
    warned, failed = file.getvalue().splitlines()
    assert warned.startswith("0/2 floor order_scans hull: ") and warned.endswith("warning: too few")
    assert failed.endswith(" s  failed")


def test_what_an_interrupted_run_was_at_is_said(console, file):
    begin(console, 7, "register_scans", "")
    console.end()
    assert file.getvalue().startswith("0/2 floor register_scans: ")
    assert file.getvalue().endswith("stopped\n")


def test_targets_and_jobs_without_a_log_are_no_stages(console, file):
    console.emit(record(LogEvent.JOB_INFO, jobid=2, rule_name="all", log=[], wildcards={}))
    console.emit(record(LogEvent.JOB_FINISHED, job_id=2))
    assert file.getvalue() == ""


def test_an_older_log_is_not_read(console, file):
    Path("register_scans.log").write_text("12:00 INFO register_scans: of yesterday\n")
    begin(console, 7, "register_scans", "")
    console.emit(record(LogEvent.JOB_FINISHED, job_id=7))
    assert "yesterday" not in file.getvalue()


def test_snakemakes_own_screen_shows_errors_that_no_stage_has_said(console):
    logger = logging.Logger("snakemake")
    screen = io.StringIO()
    own = logging.StreamHandler(screen)
    own.name = "DefaultStreamHandler"
    logger.addHandler(own)
    console.take_over(logger, lambda: None)
    logger.info("Building DAG of jobs...")
    logger.info("Finished jobid: 7", extra={"event": LogEvent.JOB_FINISHED, "job_id": 7})
    logger.error("a rule", extra={"event": LogEvent.JOB_ERROR, "jobid": 7})
    logger.error("of it", extra={"event": LogEvent.ERROR, "exception": "CalledProcessError"})
    assert screen.getvalue() == ""
    logger.error("a cycle", extra={"event": LogEvent.ERROR, "exception": "CyclicGraphException"})
    logger.warning("a disk")
    assert screen.getvalue() == "a cycle\na disk\n"
    console.end()


@pytest.mark.parametrize(
    ("text", "shown", "said"),
    [
        (
            "WorkflowError:\n    a is older\n    than b\n",
            1,
            "(WorkflowError: a is older than b)",
        ),
        ("Traceback (most recent call last):\n  File x\nOSError: no\n", 0, "(OSError: no)"),
    ],
)
def test_what_snakemake_ends_a_run_by_is_a_line_of_ours(console, file, text, shown, said):
    logger, screen = logging.Logger("snakemake"), io.StringIO()
    own = logging.StreamHandler(screen)
    own.name = "DefaultStreamHandler"
    logger.addHandler(own)
    console.take_over(logger, lambda: None)
    logger.error(text, extra={"event": LogEvent.ERROR, "exception": "WorkflowError"})
    assert bool(screen.getvalue()) == bool(shown)
    (line,) = file.getvalue().splitlines()
    assert line.startswith(f"scanplan: Snakemake could not go on {said}; ")
    assert "same command goes on" in line


def test_with_nothing_to_do_the_results_are_told(console):
    logger, told = logging.Logger("snakemake"), []
    console.take_over(logger, lambda: told.append(1))
    logger.info("Nothing to be done (all requested files are present and up to date).")
    assert told == [1]
    console.end()


def test_lines_in_place_are_written_over():
    screen = Screen()
    terminal = Terminal(screen)
    terminal.show(["one", "two"])
    terminal.show(["one more"])
    assert screen.getvalue() == "one\ntwo\n\x1b[2A\r\x1b[Jone more\n"
    terminal.say("stays")
    assert screen.getvalue().endswith("\x1b[1A\r\x1b[Jstays\none more\n")
    terminal.show([])
    assert screen.getvalue().endswith("\x1b[1A\r\x1b[J")


def test_no_line_that_is_written_over_wraps():
    screen = Screen()
    Terminal(screen).show(["x" * 100])
    assert screen.getvalue() == "x" * 58 + "…\n"


def test_what_stays_on_a_screen_is_folded_to_its_width_and_no_word_is_lost():
    screen = Screen()
    words = ["word"] * 40
    Terminal(screen).say(" ".join(words))
    lines = screen.getvalue().splitlines()
    assert max(map(len, lines)) <= 59 and " ".join(lines).split() == words


def test_why_a_run_ends_is_one_line_of_a_file_and_folded_on_a_screen():
    line = " ".join(["scanplan:", *["word"] * 40])
    file, screen = io.StringIO(), Screen()
    for stream in (file, screen):
        Terminal(stream).refuse(line)
    assert file.getvalue() == f"{line}\n"
    assert max(map(len, screen.getvalue().splitlines())) <= 59


def test_what_is_told_of_a_run_is_folded_on_a_screen_and_one_line_in_a_file(monkeypatch):
    text = f"short\n{' '.join(['word'] * 40)}"
    file, screen = io.StringIO(), Screen()
    for stream in (file, screen):
        monkeypatch.setattr("sys.stderr", stream)
        tell(text)
    assert file.getvalue() == f"{text}\n"
    assert max(map(len, screen.getvalue().splitlines())) <= CONSOLE_WIDTH
    assert screen.getvalue().split() == text.split()


def test_every_line_about_a_stage_fits_and_its_warnings_are_whole(file):
    name = "a_floor_" * 10
    console = RunConsole(Terminal(file), [name])
    console.emit(record(LogEvent.RUN_INFO, stats={"assemble_plan": 123, "total": 123}))
    found = "; ".join(["29 walls (15 with thickness, 1 to verify), 143.8 m"] * 9)
    warned = " ".join(["word"] * 60)
    log = Path("a.log")
    stage = {"rule_name": "assemble_plan", "log": [str(log)], "wildcards": {"dataset": name}}
    console.emit(record(LogEvent.JOB_INFO, jobid=1, **stage))
    log.write_text(f"12:00 WARNING assemble_plan: {warned}\n12:00 INFO assemble_plan: {found}\n")
    console.emit(record(LogEvent.JOB_FINISHED, job_id=1))
    lines = file.getvalue().splitlines()
    assert max(map(len, lines)) <= CONSOLE_WIDTH
    assert sum(line.split().count("word") for line in lines) == 60
    assert " s  29 walls" in lines[-1] and lines[-1].endswith("…")


@pytest.mark.parametrize("term", ["xterm", "dumb"])
def test_a_file_and_a_dumb_terminal_get_whole_lines_and_no_codes(term, monkeypatch):
    monkeypatch.setenv("TERM", term)
    stream = io.StringIO() if term == "xterm" else Screen()
    terminal = Terminal(stream)
    terminal.show(["at work"])
    terminal.say("x" * 100)
    assert stream.getvalue() == "x" * 100 + "\n"


def test_a_stage_that_waits_for_a_cluster_is_not_at_work(console, file, monkeypatch):
    now_s = 0.0
    monkeypatch.setattr("scanplan.project.run.console.time.monotonic", lambda: now_s)
    begin(console, 7, "register_scans", "")
    Path("register_scans.log").unlink()
    now_s = 100.0
    console._tell_progress()
    assert not file.getvalue()
    Path("register_scans.log").write_text(REGISTERED)
    console._tell_progress()
    now_s = 170.0
    console._tell_progress()
    (line,) = file.getvalue().splitlines()
    assert line.startswith("0/2 floor register_scans: ") and "  70.0 s  3/9 scans" in line


LATE = "register_scans: takes long: 120 s, 10 times as long as expected; at 'find narrow places'"


def test_a_stage_that_says_what_it_is_at_is_shown_with_it(console, file):
    later = "12:01 INFO register_scans: 3/9 scans, 2 per s\n"
    begin(console, 7, "register_scans", f"12:00 INFO {LATE}\n{later}")
    for _ in range(3):
        console._tell_progress()
    assert file.getvalue().count(": 120 s, 10 times") == 1
    with Path("register_scans.log").open("a") as log:
        log.write(f"12:09 INFO {LATE.replace('120 s', '240 s')}\n{later}")
    console._tell_progress()
    assert file.getvalue().count("takes long: ") == 2
