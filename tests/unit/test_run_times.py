import pytest

from helpers.refusals import refused
from scanplan.stage import run_times


def test_seconds_are_the_column_s(tmp_path):
    path = tmp_path / "job.tsv"
    path.write_text("s\th:m:s\tmax_rss\n2.5\t0:00:02\t100\n")
    assert run_times.read_job_seconds(path) == 2.5


@pytest.mark.parametrize("text", ["", "s\n", "h:m:s\n0:01\n", "s\nfast\n"])
def test_anything_else_is_refused(tmp_path, text):
    path = tmp_path / "job.tsv"
    path.write_text(text)
    with refused(file="job.tsv"):
        run_times.read_job_seconds(path)


def test_files_of_chunks_go_by_the_name_of_the_whole():
    files = ["b/walls_one.tsv", "b/walls_two_1-of-2.tsv", "b/walls_two_2-of-2.tsv"]
    assert run_times.group_by_name(files, "walls") == {"one": files[:1], "two": files[1:]}


def test_what_a_run_did_not_measure_is_left_out_of_the_sums(tmp_path):
    """Snakemake writes NA where a job ended before it was looked at."""
    path = tmp_path / "job.tsv"
    path.write_text("s\tcpu_time\tmax_rss\n2.5\tNA\t100\n1.5\t4.0\tNA\n")
    (cost,) = run_times.read_job_costs([path]).values()
    assert (cost.seconds, cost.cpu_s, cost.memory_mb) == (4.0, 4.0, 100.0)
