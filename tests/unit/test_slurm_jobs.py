"""What is read of Slurm's answers; that they are so is tested on a real one (tests/slurm)."""

from pathlib import Path

import pytest

from helpers.refusals import assert_told, refused
from scanplan.project.run import slurm_jobs
from scanplan.project.run.slurm_jobs import SlurmJob, end_older_jobs, explain_ends, list_jobs

HERE = Path("/survey/of|two")
SHOWN = """\
12|RUNNING|None|1:00:00|2000M|rule_scans|/survey/of|two
9|TIMEOUT|TimeLimit|2:00|500M|rule_register_scans_wildcards_floor|/survey/of|two
10|OUT_OF_MEMORY|OutOfMemory|1:00:00|200M|rule_plan|/survey/of|two
11|COMPLETED|None|1:00:00|2000M|rule_plan|/survey/of|two
8|PENDING|Priority|1:00:00|1G|rule_plan|/survey/other
slurm_load_jobs error
"""


@pytest.fixture
def squeue(monkeypatch):
    """Answer as `squeue` does; give the commands that were asked."""
    answers, asked = [SHOWN], []

    def answer(*command):
        asked.append(command)
        return answers.pop(0) if len(answers) > 1 else answers[0]

    monkeypatch.setattr(slurm_jobs, "_ask", answer)
    return answers, asked


def test_only_this_folders_jobs_are_listed_oldest_first(squeue):
    assert [job.number for job in list_jobs(HERE)] == ["9", "10", "11", "12"]
    assert [job.is_at_work for job in list_jobs(HERE)] == [False, False, False, True]


def test_a_job_is_explained_once_and_not_where_a_second_try_went_well(squeue):
    (line,) = explain_ends(list_jobs(HERE), known=[])
    assert_told(line, file="register_scans floor", value=("job 9", "2:00"))
    assert list(explain_ends(list_jobs(HERE), known=["9"])) == []
    (lost,) = explain_ends(list_jobs(HERE), known=["9", "11", "12"])
    assert_told(lost, value=("job 10", "200M"))


def test_jobs_of_a_killed_run_are_ended_before_another_begins(squeue):
    answers, asked = squeue
    answers[:] = [SHOWN, "", SHOWN.replace("RUNNING", "COMPLETING"), SHOWN.replace("12|R", "12|X")]
    assert end_older_jobs(HERE) == ["12"]
    assert ("scancel", "12") in asked


def test_jobs_that_do_not_end_stop_the_run(squeue, monkeypatch):
    monkeypatch.setattr(slurm_jobs, "_PATIENCE_S", 0.0)
    monkeypatch.setattr(slurm_jobs.time, "sleep", lambda seconds: None)
    with refused(value="jobs 12"):
        end_older_jobs(HERE)


def test_a_cause_names_its_limit():
    job = SlurmJob("1", "TIMEOUT", "TimeLimit", "2:00", "500M", "rule_plan", HERE)
    remedy = "--set-resources RULE:runtime=MIN"
    assert_told(job.explain_end(), value="time limit of 2:00", remedy=remedy)


def test_what_the_profile_lacks_is_said(monkeypatch):
    monkeypatch.setattr(slurm_jobs.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(SystemExit, match="pip install --no-deps --require-hashes"):
        slurm_jobs.find_status_command()
    monkeypatch.setattr(slurm_jobs.importlib.util, "find_spec", lambda name: object())
    monkeypatch.setattr(slurm_jobs.shutil, "which", lambda name: None)
    with pytest.raises(SystemExit, match="no sbatch"):
        slurm_jobs.find_status_command()


@pytest.mark.parametrize(("kept", "command"), [("none", "squeue"), ("slurmdbd", "sacct")])
def test_accounting_is_asked_where_it_is_kept(monkeypatch, kept, command):
    monkeypatch.setattr(slurm_jobs.importlib.util, "find_spec", lambda name: object())
    monkeypatch.setattr(slurm_jobs.shutil, "which", lambda name: name)
    told = (
        f"AccountingStorageTRES = cpu\nAccountingStorageType   = accounting_storage/{kept}\nA = b\n"
    )
    monkeypatch.setattr(slurm_jobs, "_ask", lambda *command: told)
    assert slurm_jobs.find_status_command() == command


def test_a_controller_that_is_down_is_one_line():
    with pytest.raises(SystemExit, match=r"scanplan: false: .*controller"):
        slurm_jobs._ask("false")


def test_without_cgroups_the_jobs_log_tells_of_its_memory(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    job = SlurmJob("9", "FAILED", "JobLaunchFailure", "1:00:00", "100M", "rule_plan", HERE)
    assert list(explain_ends([job], known=[])) == []
    log = tmp_path / slurm_jobs.LOGS / "group_plan/9.log"
    log.parent.mkdir(parents=True)
    log.write_text("slurmstepd: error: StepId=9.batch exceeded memory limit (2 > 1)\n")
    (line,) = explain_ends([job], known=[])
    assert "ran out of its 100M of memory" in line and line.endswith("group_plan/9.log")


def test_a_refused_job_is_told_in_slurms_words(monkeypatch):
    def refuse(*command):
        assert "--partition=nowhere" in command
        raise SystemExit("scanplan: sbatch: invalid partition specified: nowhere")

    monkeypatch.setattr(slurm_jobs, "_ask", refuse)
    assert slurm_jobs.explain_refusal("nowhere").startswith("sbatch: invalid partition")
    monkeypatch.setattr(slurm_jobs, "_ask", lambda *command: "")
    assert slurm_jobs.explain_refusal().startswith("Slurm took no job")
