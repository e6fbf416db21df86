"""What a process says is heard where any stream carries it; odd surroundings are mended."""

import logging
import os
import subprocess
import sys
from pathlib import Path

import pytest

from scanplan import surroundings

ROOT = Path(__file__).resolve().parents[2]
STARTUP = ROOT / "scripts/startup"
SAYS = (
    "import sys; print('fault', file=sys.stderr); print('result');"
    "from scanplan import surroundings; print(surroundings.is_unheard(), file=open('unheard', 'w'))"
)
LED = "scanplan: the error output cannot be written to (%s), and is here"


def shell(line, folder, python="", **env):
    """Run a line of a shell in which $PY is Python with our startup; return the run."""
    env = os.environ | {
        "PYTHONPATH": f"{STARTUP}:{ROOT / 'scripts'}",
        "PY": sys.executable,
        "SAYS": python or SAYS,
        **env,
    }
    return subprocess.run(
        ["bash", "-c", line], cwd=folder, env=env, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize(
    ("streams", "output", "errors", "unheard"),
    [
        ("", ["result"], ["fault"], "False"),
        (">&-", [], ["fault", "result"], "False"),
        ("2>&-", [LED % "closed", "fault", "result"], [], "False"),
        (">/dev/full", [], ["fault", "result"], "False"),
        ("2>/dev/full", [LED % "No space left on device", "fault", "result"], [], "False"),
        (">/dev/full 2>/dev/full", [], [], "True"),
        (">&- 2>&-", [], [], "True"),
        (">&- 2>&- <&-", [], [], "True"),
        (">/dev/full 2>&-", [], [], "True"),
        ("2>/dev/full >&-", [], [], "True"),
        (">&- 2>/dev/null", [], [], "False"),
        ("2> >(exec true)", [LED % "Broken pipe", "fault", "result"], [], "False"),
        # who closes the output has read enough of it
        ("> >(exec true)", [], ["fault"], "False"),
        ("2>&1 > >(exec true) | cat", ["fault"], [], "False"),
        ("2>&1 | exec true", [], [], "True"),
    ],
)
def test_what_is_said_goes_where_it_is_heard(tmp_path, streams, output, errors, unheard):
    # a reader that has gone is seen at the next line alone
    command = '"$PY" -c "import time; time.sleep(0.3); $SAYS"'
    run = shell(f"{command} {streams}", tmp_path)
    assert run.stdout.splitlines() == output and run.stderr.splitlines() == errors
    assert (tmp_path / "unheard").read_text().strip() == unheard


def test_a_stage_says_the_rest_to_its_log(tmp_path):
    says = (
        "import os, sys; from scanplan.stage import log\n"
        "with log.log_to_file('logs/d/stage_a.log'):\n"
        "    print('printed'); os.system('echo native >&2'); log.log_line('stage_a: logged')"
    )
    run = shell('"$PY" -c "$SAYS" 2>/dev/full', tmp_path, says)
    assert run.returncode == 0
    said = (tmp_path / "logs/d/stage_a.log").read_text()
    assert all(word in said for word in ("printed", "native", "stage_a: logged", "stage done"))


def test_warnings_are_no_errors(tmp_path):
    says = "import warnings; warnings.warn('odd'); open('left'); print('on')"
    (tmp_path / "left").touch()
    run = shell('"$PY" -c "$SAYS"', tmp_path, says, PYTHONWARNINGS="error")
    assert (run.stdout, run.stderr) == ("on\n", "")


@pytest.mark.parametrize("home", ["/dev/null", "/nowhere/at/all", "file"])
def test_caches_are_kept_in_the_working_folder_without_a_home(tmp_path, home):
    (tmp_path / "file").touch()
    says = "import os; print(os.environ.get('XDG_CACHE_HOME', ''))"
    run = shell('unset XDG_CACHE_HOME; "$PY" -c "$SAYS"', tmp_path, says, HOME=home)
    is_usable = home == "/nowhere/at/all" and os.access("/", os.W_OK)
    assert run.stdout.strip() == ("" if is_usable else f"{tmp_path}/.snakemake/cache")


def test_a_profile_that_is_nowhere_is_told(tmp_path):
    run = shell('"$PY" -c "$SAYS"', tmp_path, SNAKEMAKE_PROFILE="nowhere")
    (line,) = run.stderr.splitlines()
    assert run.returncode == 1 and run.stdout == ""
    assert line.startswith("scanplan: SNAKEMAKE_PROFILE=nowhere: ") and "unset" in line
    says = "import os; print('SNAKEMAKE_PROFILE' in os.environ)"
    assert shell('"$PY" -c "$SAYS"', tmp_path, says, SNAKEMAKE_PROFILE="").stdout == "False\n"
    (tmp_path / "nowhere").mkdir()
    assert shell('"$PY" -c "$SAYS"', tmp_path, SNAKEMAKE_PROFILE="nowhere").returncode == 0


@pytest.mark.parametrize(
    ("enter", "said"),
    [
        (r"d=$'n\xff'; mkdir $d; cd $d", r"n\xff: the working folder has bytes"),
        ("for i in {1..19}; do mkdir -p {a..a}%s; cd a%s; done" % (("x" * 199,) * 2), "above 3700"),
        ("mkdir gone; cd gone; rmdir ../gone", "the working folder cannot be used"),
    ],
)
def test_a_working_folder_of_no_use_is_told(tmp_path, enter, said):
    run = shell(f'{enter}; "$PY" -c "$SAYS"', tmp_path)
    (line,) = run.stderr.splitlines()[-1:]
    assert run.returncode == 1 and line.startswith("scanplan: ") and said in line
    assert run.stdout == "" and "Traceback" not in run.stderr


def test_a_trace_of_snakemakes_is_a_line_until_rules_are_read(caplog):
    trace = "Traceback (most recent call last):\n  File x\nOSError: no room\n"
    logger = logging.getLogger("snakemake.logging")
    surroundings.shorten_traces()
    logger.error(trace)
    logger.error("in words")
    surroundings.shorten_traces(is_begun=True)
    logger.error(trace)
    said = [record.getMessage() for record in caplog.records]
    assert said[0].startswith("scanplan: Snakemake could not begin (OSError: no room); ")
    assert said[1:] == ["in words", trace]
