"""The command of an installed release, and the command of Snakemake that it stands for."""

import contextlib
import json
import os
import re
import signal
import subprocess
import sys
import time
import urllib.request
import webbrowser

import pytest
from snakemake.cli import get_argument_parser

from helpers.refusals import assert_told, refused
from scanplan import interrupts, surroundings
from scanplan.errors import StageError
from scanplan.project.code_files import state_version
from scanplan.project.run import command
from scanplan.project.run.edit_server import EditServer
from scanplan.project.run.served_run import ServedRun
from scanplan.store import atomic

MAIN = "import sys; from scanplan.project.run.command import main; sys.exit(main())"


def understood(*words):
    """Return what Snakemake reads of the arguments that a command stands for."""
    return get_argument_parser().parse_args(command.form_arguments(words))


def call(folder, *words, **variables):
    places = [str(command.SNAKEFILE.parents[1] / "scripts"), variables.pop("PYTHONPATH", "")]
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, places)), **variables}
    return subprocess.run(
        [sys.executable, "-c", MAIN, *words], cwd=folder, env=env, capture_output=True, text=True
    )


def test_a_recording_is_a_run_of_the_workflow_beside_the_package(project_root):
    asked = understood("my.bag")
    assert asked.snakefile == str(project_root / "workflow/Snakefile")
    assert (asked.config, asked.cores) == (['dataset=["my.bag"]'], 2)
    assert not asked.configfile and not asked.targets


def test_the_demo_is_a_run_without_a_dataset():
    assert command.form_arguments(["demo"]) == [
        "--snakefile",
        str(command.SNAKEFILE),
        "--cores",
        "2",
    ]


def test_a_difference_is_the_target_of_changes_of_the_surveys_in_their_order():
    asked = understood("diff", "before", "my after.bag", "--cores", "1")
    assert list(asked.targets) == ["changes"] and asked.cores == 1
    assert asked.config == ['dataset=["before", "my after.bag"]']
    assert understood("./diff").config == ['dataset=["./diff"]']


def test_options_are_those_of_snakemake():
    asked = understood(
        "Erdgeschoß 1/", "b", "--cores", "4", "--replace", "b", "--configfile", "c.yaml"
    )
    assert asked.config == ['dataset=["Erdgeschoß 1/", "b"]', 'replace=["b"]']
    assert asked.cores == 4 and [file.name for file in asked.configfile] == ["c.yaml"]
    assert understood("a", "--cores", "all").cores == os.cpu_count()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], "no recording is given"),
        (["a", "--cores", "0"], "--cores: 0 is no number"),
        (["a", "--cores", "²"], "--cores: ² is no number"),
        (["a", "--cores"], "--cores: expected one argument"),
        (["demo", "a"], "./demo"),
        (["diff"], "no recording is given"),
        (["diff", "a"], "diff: one survey alone"),
        (
            ["a", "--dry-run"],
            "--dry-run: no option of scanplan; Snakemake's: snakemake --snakefile",
        ),
    ],
)
def test_wrong_calls_are_refused_with_the_word_and_the_remedy(words, told):
    with pytest.raises(StageError) as raised:
        command.form_arguments(words)
    assert told in str(raised.value)


def test_what_snakemake_alone_can_do_is_told_as_its_command():
    with pytest.raises(StageError) as raised:
        command.form_arguments(["a b", "--dry-run", "--until", "x"])
    words = str(raised.value).partition("snakemake ")[2]
    assert words.endswith("--cores 2 --dry-run --until x --config 'dataset=[\"a b\"]'")


@pytest.mark.parametrize("words", [["--cores", "many"], ["open"], ["open", "nowhere"]])
def test_a_fault_is_one_line_and_a_status(tmp_path, words):
    done = call(tmp_path, *words)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("scanplan: ") and done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_the_version_is_that_which_results_state(tmp_path):
    assert call(tmp_path, "--version").stdout == f"{state_version()}\n"


def test_a_run_takes_the_place_of_the_command_and_says_which_it_is(tmp_path, project_root):
    stub = "import os, sys; print(os.getppid(), os.getcwd(), *sys.argv[1:]); sys.exit(7)"
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere/snakemake.py").write_text(stub)
    # the folder of the user's files has no say in what is imported
    (tmp_path / "snakemake.py").write_text("raise SystemExit('the wrong one')")
    done = call(tmp_path, "my.bag", PYTHONPATH=str(tmp_path / "elsewhere"))
    first, second = done.stdout.splitlines()
    expected = command.form_arguments(["my.bag"])
    assert done.returncode == 7 and first.startswith("scanplan: runs snakemake --snakefile ")
    assert second == f"{os.getpid()} {tmp_path} {' '.join(expected)}"


# a run that says who it is and works on
AT_WORK = """
import json, os, sys, time
stage = {"rule": "a", "name": str(os.getpid()), "dataset": "", "took_s": 0.0, "said": ""}
told = {"wanted": {"a": 9}, "ended": [], "failed": [], "at_work": [stage]}
with open(os.environ["SCANPLAN_STATUS"], "w") as file:
    file.write(json.dumps(told))
time.sleep(60)
"""


@pytest.mark.skipif(os.name == "nt", reason="Windows ends a process without a signal")
@pytest.mark.parametrize("sent", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_with_the_server_its_run_ends_and_its_settings_go(tmp_path, sent):
    results, scratch, modules = (tmp_path / p for p in ("results/floor", "scratch", "modules"))
    for folder in (results, scratch, modules):
        folder.mkdir(parents=True)
    (results / "report.html").write_text('<script id="data">{"survey": "floor"}</script>')
    (results / "source.txt").write_text("my.bag\n")
    (tmp_path / "my.bag").touch()
    # a run that says who it is and works on
    (modules / "snakemake.py").write_text(AT_WORK)
    places = [str(command.SNAKEFILE.parents[1] / "scripts"), str(modules)]
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(places), "TMPDIR": str(scratch)}
    # what runs the tests may ignore Ctrl-C or a lost terminal, and what it begins inherits that
    heard = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
        "signal.signal(signal.SIGHUP, signal.SIG_DFL); "
    )
    words = [sys.executable, "-c", heard + MAIN, "open", str(results), "--no-browser"]
    with (
        subprocess.Popen(words, env=env, stdout=subprocess.PIPE, text=True) as opened,
        contextlib.ExitStack() as at_last,
    ):
        at_last.callback(opened.kill)
        page = re.search(r"http://\S+/", opened.stdout.readline())[0]
        origin = page.rpartition("/")[0].rpartition("/")[0]
        asked = json.dumps({"survey": "floor", "revision": "", "entries": []}).encode()
        headers = {"Origin": origin, "Content-Type": "application/json"}
        request = urllib.request.Request(f"{page}api/corrections", asked, headers)
        urllib.request.urlopen(request, timeout=20).close()
        told = {"total": 0, "running": True}
        while told["running"] and not told["total"]:
            time.sleep(0.02)
            told = json.load(urllib.request.urlopen(f"{page}api/run", timeout=20))
        # its settings, and what it tells of its stages
        assert len(list(scratch.iterdir())) == 2
        opened.send_signal(getattr(signal, sent))
        assert opened.wait(timeout=20) == 0
    assert list(scratch.iterdir()) == [] and not atomic.is_process_alive(int(told["line"]))


def test_a_report_is_opened_at_an_address_of_this_computer_alone(tmp_path, monkeypatch, capsys):
    results = tmp_path / "results/floor"
    results.mkdir(parents=True)
    (results / "report.html").touch()
    (results / "source.txt").write_text("my.bag\n")
    (tmp_path / "my.bag").touch()
    seen = []
    monkeypatch.setattr(webbrowser, "open", lambda page: seen.append(page))
    monkeypatch.setattr(EditServer, "serve_forever", lambda _: None)
    monkeypatch.setattr(interrupts, "begin_work", lambda: None)
    monkeypatch.setattr(interrupts, "interrupt_on_end", lambda: None)
    monkeypatch.setattr(surroundings, "mend_surroundings", lambda: None)
    monkeypatch.setattr(interrupts, "end_on_interrupt", lambda: None)
    monkeypatch.setattr(os, "environ", dict(os.environ))
    assert command.main(["open", str(results)]) == 0
    (address,) = seen
    assert re.fullmatch(r"http://127\.0\.0\.1:\d+/[\w-]{32}/report\.html", address)
    said = capsys.readouterr().out
    assert address in said and f"{tmp_path}/my.bag.corrections.yaml" in said
    assert_told(said, value="no browser", remedy="the address")


def test_a_recording_is_opened_while_its_run_makes_the_plan(tmp_path, monkeypatch, capsys):
    begun = []
    for module in (interrupts, surroundings):
        for name in ("begin_work", "interrupt_on_end", "mend_surroundings", "end_on_interrupt"):
            if hasattr(module, name):
                monkeypatch.setattr(module, name, lambda: None)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(os, "environ", dict(os.environ))
    monkeypatch.setattr(EditServer, "serve_forever", lambda _: None)
    monkeypatch.setattr(ServedRun, "begin", lambda _, asked: begun.append(asked))
    (tmp_path / "a").mkdir()
    (tmp_path / "a/my.bag").touch()
    assert command.main(["a/my.bag", "--open", "--no-browser", "--cores", "3"]) == 0
    (asked,) = begun
    assert asked[: len(command._SNAKEMAKE)] == [*command._SNAKEMAKE]
    parsed = get_argument_parser().parse_args(asked[len(command._SNAKEMAKE) :])
    assert (parsed.config, parsed.cores) == (['dataset=["a/my.bag"]'], 3)
    address, runs = capsys.readouterr().out.splitlines()
    assert address.endswith("/report.html") and runs.startswith("scanplan: runs snakemake ")


def test_the_results_of_what_is_opened_bear_its_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert str(command.find_results(["demo"])) == "results/demo"
    (tmp_path / "a/ground floor").mkdir(parents=True)
    assert str(command.find_results(["a/ground floor"])) == "results/ground_floor"
    with refused(file="none.bag", remedy="a recording"):
        command.find_results(["none.bag"])


@pytest.mark.parametrize("given", [["a.bag", "b.bag"], ["diff"], ["floors.tsv"]])
def test_one_floor_is_opened_at_a_time(given):
    with refused(key="--open", remedy="one recording"):
        command.find_results(given)
