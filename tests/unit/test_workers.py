import os
import signal
import sys

import pytest

from scanplan.errors import StageError
from scanplan.geometry import fallbacks
from scanplan.stage import workers

_known = None


def learn(value, other):
    global _known
    _known = value + other


def use(factor):
    return factor * _known, os.getpid()


@pytest.mark.parametrize("threads", [1, 2])
def test_every_process_is_set_up_before_its_first_job_and_results_keep_their_order(threads):
    with workers.open_pool(threads, learn, 2, 3) as run:
        results = list(run(use, ((i,) for i in range(20))))
    assert [result for result, _ in results] == [5 * i for i in range(20)]
    here = {pid for _, pid in results} == {os.getpid()}
    assert here == (threads == 1)


def test_without_a_set_up():
    with workers.open_pool(1) as run:
        assert list(run(pow, [(2, 3), (3, 2)])) == [8, 9]


def touch_or_fail(path, name):
    if name == "0":
        raise ValueError("the first job")
    (path / name).touch()


def test_a_failed_job_leaves_the_waiting_ones_undone(tmp_path):
    jobs = ((tmp_path, str(i)) for i in range(100))
    with pytest.raises(ValueError, match="the first job"), workers.open_pool(2) as run:
        list(run(touch_or_fail, jobs))
    assert len(list(tmp_path.iterdir())) < 20


def end_yourself(sent):
    os.kill(os.getpid(), sent)


def test_a_worker_that_is_killed_ends_the_stage_in_one_line():
    with (
        pytest.raises(StageError, match="memory"),
        workers.open_pool(2) as run,
    ):
        list(run(end_yourself, [(signal.SIGKILL,)]))


def refuse():
    raise ValueError("no mesh")


@pytest.mark.parametrize("threads", [1, 2])
def test_a_setup_that_fails_is_no_killed_worker(threads):
    with pytest.raises(ValueError, match="no mesh"), workers.open_pool(threads, refuse) as run:
        list(run(abs, [(1,)]))


def list_own_modules():
    return sorted(name for name in sys.modules if name.startswith("script"))


def test_workers_do_not_import_the_script(tmp_path, monkeypatch):
    script = tmp_path / "script_of_stage.py"
    script.write_text("import sys\nsys.modules['script_was_imported'] = sys\n")
    monkeypatch.setattr(sys.modules["__main__"], "__file__", str(script), raising=False)
    monkeypatch.setattr(sys.modules["__main__"], "__spec__", None, raising=False)
    with workers.open_pool(2) as run:
        assert list(run(list_own_modules, [()])) == [[]]
    assert sys.modules["__main__"].__file__ == str(script)


@pytest.mark.parametrize("threads", [1, 2])
def test_threads_share_the_memory_and_keep_the_order(threads):
    seen = []

    def square(number):
        seen.append(number)
        return number**2

    assert workers.map_in_threads(square, iter(range(5)), threads) == [0, 1, 4, 9, 16]
    assert sorted(seen) == [0, 1, 2, 3, 4]


@pytest.mark.parametrize("threads", [1, 2])
def test_what_a_job_in_a_thread_raises_is_raised(threads):
    with pytest.raises(ZeroDivisionError):
        workers.map_in_threads(lambda number: 1 / number, [1, 0], threads)


@pytest.mark.parametrize("threads", [1, 2])
def test_work_begun_in_a_thread_is_done_once_and_waited_for(threads):
    seen = []
    wait = workers.begin_in_thread(
        lambda *numbers: seen.append(numbers) or 6, 2, 3, threads=threads
    )
    assert [wait(), wait()] == [6, 6]
    assert seen == [(2, 3)]


@pytest.mark.parametrize("threads", [1, 2])
def test_what_work_begun_in_a_thread_raises_is_raised_where_it_is_waited_for(threads):
    wait = workers.begin_in_thread(lambda number: 1 / number, 0, threads=threads)
    with pytest.raises(ZeroDivisionError):
        wait()


def fall_back(count):
    fallbacks.note_fallbacks(count)
    return count


@pytest.mark.parametrize("threads", [1, 2])
def test_overlays_done_another_way_are_counted_wherever_the_work_is_done(threads):
    fallbacks.take_fallbacks()
    with workers.open_pool(threads) as run:
        assert list(run(fall_back, ((n,) for n in (2, 0, 3)))) == [2, 0, 3]
    assert fallbacks.take_fallbacks() == 5
