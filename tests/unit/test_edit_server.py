"""The server behind the report's page: what it shows, saves and runs, and who may ask it."""

import http.client
import json
import os
import subprocess
import sys
import tempfile
import threading
import time

import pytest

from helpers.refusals import assert_told, refused
from helpers.serving import serving as serve
from scanplan.errors import StageError
from scanplan.project.corrections_file import read_corrections
from scanplan.project.run import growing
from scanplan.project.run.edit_server import EditServer
from scanplan.project.run.edit_session import EditSession
from scanplan.report import result_links

SURVEY = "floor 0123"
WALL = {"element": "wall", "at": [1.0, 2.0], "action": "remove"}
ROOM = {"element": "room", "at": [3.0, 2.0], "name": "Küche </script> \u2028"}
# what a run tells of its stages
STATUS = {
    "wanted": {"correct_plan": 1, "write_report": 1},
    "ended": [
        {"rule": "correct_plan", "name": "correct_plan", "dataset": "floor", "took_s": 1.0,
         "said": "1 of 1"},
    ],
    "at_work": [],
    "failed": [],
}  # fmt: skip
TELL = f"import json, os; open(os.environ['SCANPLAN_STATUS'], 'w').write(json.dumps({STATUS}))"
RUN = f"{TELL}; import sys; print(sys.argv[1:])"
SLOW = f"{TELL}; import time; time.sleep(60)"
FAILED = "import sys; print('scanplan: correct_plan: entry 1: fault; remedy'); sys.exit(1)"
DATA = {"made": "abc", "survey": SURVEY, "corrections": [{"name": '"made": "no"'}]}


@pytest.fixture
def folder(tmp_path):
    results = tmp_path / "results/floor"
    (results / "plan").mkdir(parents=True)
    (tmp_path / "rec").mkdir()
    data = json.dumps(DATA)
    page = f'<script type="application/json" id="data">{data}</script>'
    (results / "report.html").write_text(page)
    (results / "plan/plan.pdf").write_bytes(b"%PDF")
    (results / "poses.parquet").write_bytes(b"PAR1")
    (results / ".hidden.html").write_text("no")
    (tmp_path / "secret.txt").write_text("no")
    (results / "link.txt").symlink_to(tmp_path / "secret.txt")
    (results / "source.txt").write_text("rec\n")
    note = {"storeys": [], "settings": {"plan": {"merge": {"min_scans": 3}}}}
    (results / "run.json").write_text(json.dumps(note))
    return results


def serving(folder, run=RUN):
    return serve(EditSession(folder, [sys.executable, "-c", run]))


@pytest.fixture
def server(folder):
    with serving(folder) as made:
        yield made


def ask(server, place, body=None, token=None, method=None, **headers):
    """Status and content of an answer; with a body it is a page of ours that asks."""
    host = f"127.0.0.1:{server.server_port}"
    sent = {"Host": host}
    if body is not None:
        sent |= {"Origin": f"http://{host}", "Content-Type": "application/json"}
        body = body if isinstance(body, bytes) else json.dumps(body).encode()
    sent |= {name.replace("_", "-"): value for name, value in headers.items()}
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=20)
    path = f"/{server.token if token is None else token}/{place}"
    method = method or ("GET" if body is None else "POST")
    kept = {name: value for name, value in sent.items() if value is not None}
    connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
    if body is not None:
        kept.setdefault("Content-Length", str(len(body)))
    for name, value in kept.items():
        connection.putheader(name, value)
    connection.endheaders(body)
    answer = connection.getresponse()
    content = answer.read()
    connection.close()
    is_json = answer.headers.get_content_type() == "application/json"
    return answer.status, json.loads(content) if is_json else content


def save(server, *entries, **changed):
    asked = {"survey": SURVEY, "revision": "", "entries": list(entries)} | changed
    return ask(server, "api/corrections", asked)


def wait(server):
    for _ in range(400):
        status, said = ask(server, "api/run")
        assert status == 200
        if not said["running"]:
            return said
        time.sleep(0.02)
    raise AssertionError("the run does not end")


def test_results_are_served_on_a_port_of_their_own_and_a_second_server_on_another(folder):
    with serving(folder) as first, serving(folder) as second:
        assert second.server_port != first.server_port
    with serving(folder) as again:
        assert again.server_port == first.server_port


def test_results_are_found_by_a_link_to_their_folder(folder, tmp_path):
    (tmp_path / "linked").symlink_to(folder.parent)
    assert EditSession(tmp_path / "linked/floor", []).results == folder


def test_the_page_and_the_files_that_it_links_are_shown(server, folder):
    assert ask(server, "report.html") == (200, (folder / "report.html").read_bytes())
    assert ask(server, "plan/plan.pdf") == (200, b"%PDF")


def test_every_file_that_a_report_may_link_is_shown(server, folder):
    for name in result_links._WORDS:
        (folder / name).write_bytes(b"{}")
    assert [name for name in result_links._WORDS if ask(server, name)[0] != 200] == []


@pytest.mark.parametrize(
    "place",
    [
        *("", "nothing.html", "plan", "plan/", "poses.parquet", ".hidden.html", "link.txt"),
        *("../source.txt", "../../secret.txt", "%2e%2e/%2e%2e/secret.txt", "..%2f..%2fsecret.txt"),
        *(
            "plan/../../../secret.txt",
            "//etc/passwd.txt",
            "%2fetc%2fhosts.txt",
            "plan%5c..%5cx.txt",
        ),
        *("report.html%00.txt", "%ff%fe.html", "a" * 3000 + ".html", "api/none", "run.json/x.txt"),
    ],
)
def test_nothing_else_is(server, place):
    status, said = ask(server, place)
    assert status == 404 and said.keys() == {"error"}


def test_what_is_saved_is_a_file_beside_the_recording_and_begins_a_run(server, folder):
    assert save(server, WALL, ROOM)[0] == 200
    path = folder.parents[1] / "rec/corrections.yaml"
    wall, room = read_corrections(path)
    assert (wall.action, wall.at_m) == ("remove", (1.0, 2.0))
    # two characters that end a line elsewhere are refused
    assert room.name == ROOM["name"].strip()
    # what a run told of its stages is gone with it, where it has ended well
    said = wait(server)
    assert (said["ended"], said["total"], "error" in said) == (0, 0, False)


def test_a_hostile_name_is_refused_and_nothing_is_written(server, folder):
    hostile = {**ROOM, "name": "a\nb: {{ 1 }}"}
    status, said = save(server, hostile)
    assert status == 400 and said["error"].startswith("entry 1: name has")
    assert list((folder.parents[1] / "rec").iterdir()) == []


def test_the_run_gets_the_dataset_and_the_settings_that_made_the_results(folder):
    run = "import sys; print(sys.argv[1:]); print(open(sys.argv[2]).read())"
    with serving(folder, run) as server:
        save(server, WALL)
        wait(server)
        told = "\n".join(server.session.run.lines)
    assert "'--configfile'" in told and "min_scans: 3" in told
    assert """'--config', 'dataset=["rec"]'""" in told


def test_storeys_of_a_building_are_made_together(folder):
    note = {"storeys": ["cellar", "rec"], "settings": {}}
    (folder / "run.json").write_text(json.dumps(note))
    with serving(folder) as server:
        save(server, WALL)
        wait(server)
        assert server.session.run.lines[-1] == """['--config', 'dataset=["cellar", "rec"]']"""


def test_a_run_that_fails_is_told_in_one_line(folder):
    with serving(folder, FAILED) as server:
        save(server, WALL)
        said = wait(server)
        assert said["error"] == "correct_plan: entry 1: fault; remedy"
        # which it names is what a page can show
        assert said["entries"] == [WALL] and ask(server, "api/state")[1]["broken"]


def test_entries_that_cannot_be_read_are_none(folder):
    with serving(folder, FAILED) as server:
        save(server, WALL)
        wait(server)
        (folder.parents[1] / "rec/corrections.yaml").write_text("corrections: [")
        assert wait(server)["entries"] == []


def test_while_a_run_is_at_work_nothing_is_saved(folder):
    with serving(folder, SLOW) as server:
        save(server, WALL)
        status, said = save(server, ROOM)
        assert status == 400
        assert_told(said["error"], value="at work")


def test_a_run_is_told_stopped_and_resumed(folder):
    with serving(folder, SLOW) as server:
        save(server, WALL)
        said = settle(server, lambda said: said["total"])
        assert said["running"] and said["name"] == "floor" and said["made"]
        assert [(s["name"], s["state"]) for s in said["stages"]] == [
            ("correct_plan", "done"), ("write_report", "to come"),
        ]  # fmt: skip
        status, said = ask(server, "api/go", {})
        assert status == 400
        assert_told(said["error"], value="at work already")
        assert ask(server, "api/stop", {})[0] == 200
        said = ask(server, "api/run")[1]
        assert (said["running"], said["stopped"], "error" in said) == (False, True, False)
        assert ask(server, "api/go", {})[0] == 200
        assert settle(server, lambda said: said["running"])["stopped"] is False


def test_what_was_not_stopped_is_not_resumed(server):
    status, said = ask(server, "api/go", {})
    assert status == 400
    assert_told(said["error"], value="no run")


def settle(server, is_so):
    for _ in range(400):
        status, said = ask(server, "api/run")
        assert status == 200
        if is_so(said):
            return said
        time.sleep(0.02)
    raise AssertionError(said)


@pytest.fixture
def begun(folder):
    """A server of results that a run makes first: it waits for a file, then writes the report."""
    page = (folder / "report.html").read_text()
    (folder / "report.html").unlink()
    there = folder / "there.txt"
    make = (
        f"import pathlib, time\nwhile not pathlib.Path({str(there)!r}).exists(): time.sleep(0.01)\n"
        f"pathlib.Path({str(folder / 'report.html')!r}).write_text({page!r})"
    )
    session = EditSession(folder, [], [sys.executable, "-c", f"{TELL}\n{make}"])
    with EditServer(session) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        session.go_on()
        try:
            yield server, there
        finally:
            server.shutdown()
            thread.join()
            session.end()


def test_until_there_is_a_report_its_place_tells_of_the_run(begun, folder):
    server, there = begun
    assert b"A plan is being made" in ask(server, "report.html")[1]
    assert not settle(server, lambda said: said["total"])["made"]
    # a plan that others look at is one that was made before
    assert ask(server, "api/state")[0] == 400
    there.touch()
    assert settle(server, lambda said: not said["running"])["made"]
    assert ask(server, "report.html")[1] == (folder / "report.html").read_bytes()
    assert ask(server, "api/state")[1]["page"] == "abc"


def test_the_report_of_an_earlier_run_is_not_shown_while_one_makes_it_anew(begun, folder):
    server, there = begun
    (folder / "report.html").write_text("old")
    assert b"A plan is being made" in ask(server, "report.html")[1]
    there.touch()
    settle(server, lambda said: not said["running"])
    assert ask(server, "report.html")[1] != b"old"


def test_a_first_run_that_is_stopped_goes_on(begun):
    server, there = begun
    ask(server, "api/stop", {})
    assert b"A plan is being made" in ask(server, "report.html")[1]
    assert ask(server, "api/go", {})[0] == 200
    there.touch()
    assert settle(server, lambda said: not said["running"])["made"]


def test_points_and_pictures_are_made_by_processes_of_their_own(server, folder, monkeypatch):
    monkeypatch.setattr(growing, "_begin", lambda module, results: echo(f"{module} {results}"))
    assert ask(server, "api/points") == (200, f"{growing.POINTS} {folder}".encode())
    (folder / "poses.parquet").rename(folder / "other.parquet")
    # nothing is there to be drawn
    assert ask(server, "api/drawn") == (200, {})
    (folder / "plan/walls.parquet").touch()
    monkeypatch.setattr(growing, "_begin", lambda *_: echo(json.dumps({"svg": "<svg/>"})))
    assert ask(server, "api/drawn") == (200, {"svg": "<svg/>"})


def test_what_cannot_be_drawn_is_told_in_one_line(server, folder, monkeypatch):
    (folder / "plan/walls.parquet").touch()
    broken = "import sys; sys.exit('more\\nwalls.parquet: is damaged')"
    monkeypatch.setattr(growing, "_begin", lambda *_: begin(broken))
    for place in ("api/points", "api/drawn"):
        told = {"error": "it cannot be drawn: walls.parquet: is damaged"}
        assert ask(server, place) == (400, told)


def test_a_picture_that_takes_too_long_is_given_up(server, folder, monkeypatch):
    (folder / "plan/walls.parquet").touch()
    monkeypatch.setattr(growing, "_PATIENCE_S", 0.1)
    monkeypatch.setattr(growing, "_begin", lambda *_: begin("import time; time.sleep(60)"))
    status, said = ask(server, "api/drawn")
    assert status == 400 and "takes more than" in said["error"]


def begin(code):
    return subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )


def echo(text):
    return begin(f"import sys; sys.stdout.write({text!r})")


@pytest.mark.parametrize("place", ["api/run", "api/drawn", "api/points", "api/state"])
def test_what_is_told_is_told_to_our_own_page_alone(server, place):
    assert ask(server, place, token="x" * 32)[0] == 403
    assert ask(server, place, Host=f"evil.example:{server.server_port}")[0] == 403
    assert ask(server, place, Origin="http://evil.example")[0] == 403
    assert ask(server, f"{place}/..")[0] == 404


@pytest.mark.parametrize("place", ["api/stop", "api/go"])
@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Origin": "http://evil.example"}, 403),
        ({"Origin": "null"}, 403),
        ({"Origin": None}, 403),
        ({"Host": "evil.example"}, 403),
        ({"Content_Type": "text/plain"}, 415),
        ({"Content_Type": "application/x-www-form-urlencoded"}, 415),
    ],
)
def test_a_page_of_another_site_neither_stops_nor_begins_a_run(folder, place, headers, status):
    with serving(folder, SLOW) as server:
        save(server, WALL)
        assert ask(server, place, {}, **headers)[0] == status
        assert ask(server, place, {}, token="x" * 32)[0] == 403
        assert ask(server, place)[0] == 404  # a GET does nothing
        assert ask(server, place, b"[]")[0] == 400
        assert ask(server, "api/run")[1]["running"]


def test_what_another_page_saved_meanwhile_is_not_overwritten(server, folder):
    _, first = save(server, WALL)
    wait(server)
    status, said = save(server, {**ROOM, "name": "Hall"})
    assert status == 409 and said["entries"] == [WALL] and said["revision"] == first["revision"]
    status, _ = save(server, WALL, {**ROOM, "name": "Hall"}, revision=said["revision"])
    assert status == 200
    assert len(read_corrections(folder.parents[1] / "rec/corrections.yaml")) == 2


def test_each_change_is_in_a_log_with_the_time(server, folder):
    _, first = save(server, WALL)
    wait(server)
    save(server, revision=first["revision"])
    lines = (folder.parents[1] / "rec/corrections.log").read_text().splitlines()
    said, taken = map(json.loads, lines)
    assert said["said"] == WALL and taken["taken back"] == WALL and said["saved"].endswith("+00:00")
    assert read_corrections(folder.parents[1] / "rec/corrections.yaml") == []


def test_the_state_says_what_is_saved_and_which_plan_is_shown(server):
    assert ask(server, "api/state")[1] == {
        "entries": [], "revision": "", "page": "abc", "running": False, "broken": False,
    }  # fmt: skip
    save(server, WALL)
    wait(server)
    assert ask(server, "api/state")[1]["entries"] == [WALL]


def test_corrections_of_another_survey_are_refused(server):
    status, said = save(server, WALL, survey="hall 99")
    assert status == 400
    assert_told(said["error"], value=("hall 99", SURVEY))


@pytest.mark.parametrize(
    ("body", "status"),
    [
        (b"{", 400), (b"[]", 400), (b"[" * 100000, 400), (b"\xff", 400), (b"null", 400),
        ({"survey": SURVEY, "revision": "", "entries": 5}, 400),
        ({"survey": SURVEY, "revision": "", "entries": [5]}, 400),
        ({"survey": SURVEY, "revision": "", "entries": [WALL | {"at": [1e999, 0]}]}, 400),
        ({"survey": SURVEY, "revision": "", "entries": [{**ROOM, "name": "\ud83c"}]}, 400),
        ({"survey": {"a": 1}, "revision": "", "entries": []}, 400),
        (b" " * (2**18 + 1), 413),
    ],
)  # fmt: skip
def test_malformed_and_huge_corrections_are_refused(server, folder, body, status):
    found, said = ask(server, "api/corrections", body)
    assert found == status and said["error"]
    assert list((folder.parents[1] / "rec").iterdir()) == []


@pytest.mark.parametrize("length", [None, "-1", "1e3", "²", "9" * 40])
def test_a_length_that_is_none_is_refused(server, length):
    # http.client writes one where none is given: a chunked body has none
    headers = {"Content_Length": length} if length else {}
    if length == "²":
        headers = {"Content_Length": "\xb2"}
    body = b"" if length else None
    method = "POST"
    origin = f"http://127.0.0.1:{server.server_port}"
    status, _ = ask(
        server, "api/corrections", body, method=method,
        **({"Origin": origin, "Content_Type": "application/json"} | headers),
    )  # fmt: skip
    assert status in (411, 413)


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Origin": "http://evil.example"}, 403),
        ({"Origin": "null"}, 403),
        ({"Origin": None}, 403),
        ({"Origin": "https://127.0.0.1"}, 403),
        ({"Content_Type": "text/plain"}, 415),
        ({"Content_Type": "application/x-www-form-urlencoded"}, 415),
    ],
)
def test_a_page_of_another_site_saves_nothing(server, folder, headers, status):
    asked = {"survey": SURVEY, "revision": "", "entries": [WALL]}
    assert ask(server, "api/corrections", asked, **headers)[0] == status
    assert list((folder.parents[1] / "rec").iterdir()) == []


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "127.0.0.1.evil.example:1", None])
def test_a_name_that_was_led_here_gets_nothing(server, host):
    port = server.server_port
    rebound = host and (f"{host}:{port}" if ":" not in host and "evil" in host else host)
    status, said = ask(server, "report.html", Host=rebound)
    assert status == 403 and said.keys() == {"error"}
    asked = {"survey": SURVEY, "revision": "", "entries": [WALL]}
    origin = f"http://{rebound}"
    assert ask(server, "api/corrections", asked, Host=rebound, Origin=origin)[0] == 403


@pytest.mark.parametrize("token", ["", "x", "%00", "report.html", "a" * 32, "ü".encode().hex()])
def test_without_the_token_nothing_is_shown(server, token):
    status, said = ask(server, "report.html", token=token)
    assert status == 403 and "token" in said["error"]
    assert ask(server, "api/state", token=server.token.swapcase())[0] == 403


def test_tokens_differ_and_it_listens_on_this_computer_alone(folder):
    with serving(folder) as one, serving(folder) as two:
        assert one.token != two.token and len(one.token) >= 32
        assert one.server_address[0] == "127.0.0.1"


@pytest.mark.parametrize("method", ["PUT", "DELETE", "OPTIONS", "TRACE"])
def test_nothing_else_may_be_asked(server, method):
    assert ask(server, "report.html", method=method)[0] == 501


def test_no_other_page_may_keep_frame_or_guess_an_answer(server):
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port)
    connection.request("GET", f"/{server.token}/report.html")
    headers = connection.getresponse().headers
    assert headers["X-Frame-Options"] == "DENY" and headers["Cache-Control"] == "no-store"
    assert (
        headers["Referrer-Policy"] == "no-referrer" and "Access-Control-Allow-Origin" not in headers
    )
    assert headers["X-Content-Type-Options"] == "nosniff"


def test_a_page_that_leaves_before_its_answer_is_no_word_worth(server, capfd):
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port)
    connection.putrequest("POST", f"/{server.token}/api/corrections")
    connection.endheaders()
    connection.close()
    assert ask(server, "report.html")[0] == 200
    assert capfd.readouterr().err == ""


def test_corrections_as_geojson_are_left_alone(server, folder):
    other = folder.parents[1] / "rec/corrections.geojson"
    other.write_text("{}")
    status, said = save(server, WALL)
    assert status == 400
    assert_told(said["error"], file="corrections.geojson", remedy="move it")
    assert other.read_text() == "{}" and not other.with_suffix(".yaml").exists()


@pytest.mark.parametrize(
    ("file", "content", "told"),
    [
        ("results/floor/report.html", None, "report.html: cannot be read"),
        ("results/floor/report.html", b'id="data">{</script>', "report.html: is damaged"),
        (
            "rec/corrections.yaml",
            b"corrections:\n- {element: room, at: [3, 2], name: Hall, when: 2026-03-01}\n",
            "corrections.yaml: entry 1: when is datetime.date(2026, 3, 1)",
        ),
        ("rec/corrections.yaml", b"\xff", "corrections.yaml: is no text in UTF-8"),
    ],
)
def test_a_file_that_a_page_cannot_be_told_of_is_told_in_one_line(
    server, folder, capfd, file, content, told
):
    path = folder.parents[1] / file
    if content is None:
        path.unlink()
    else:
        path.write_bytes(content)
    for status, said in (ask(server, "api/state"), save(server, WALL)):
        assert status == 400 and told in said["error"] and "\n" not in said["error"]
    assert capfd.readouterr().err == ""


def test_what_nobody_has_thought_of_is_answered_all_the_same(server, monkeypatch, capfd):
    monkeypatch.setattr(server.session, "state", lambda: {"entries": [object()]})
    status, said = ask(server, "api/state")
    assert status == 500 and said["error"].startswith("TypeError: ")
    assert capfd.readouterr().err == ""


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_cannot_be_written_to_is_told(server, folder):
    place = folder.parents[1] / "rec"
    place.chmod(0o500)
    try:
        status, said = save(server, WALL)
    finally:
        place.chmod(0o700)
    assert status == 400 and "cannot be written" in said["error"]


def test_a_lone_recording_has_its_corrections_and_their_log_beside_it(folder):
    (folder / "source.txt").write_text("rec/my.bag\n")
    recording = folder.parents[1] / "rec/my.bag"
    recording.touch()
    with serving(folder) as server:
        assert server.session.find_place() == recording.with_name("my.bag.corrections.yaml")
        save(server, WALL)
    # another recording in the folder has a log of its own
    found = sorted(path.name for path in recording.parent.iterdir())
    assert found == ["my.bag", "my.bag.corrections.log", "my.bag.corrections.yaml"]


BY_HAND = """corrections:
# the cupboard, says the caretaker
- {element: wall, at: [1.0, 2.0], action: remove}
"""


def test_what_a_person_wrote_is_kept_once_before_it_is_written_anew(server, folder):
    place = folder.parents[1] / "rec/corrections.yaml"
    kept = place.with_name("corrections.yaml.by_hand")
    place.write_text(BY_HAND)
    for entries in ([WALL, ROOM], [WALL]):
        assert save(server, *entries, revision=ask(server, "api/state")[1]["revision"])[0] == 200
        wait(server)
        assert kept.read_text() == BY_HAND and "caretaker" not in place.read_text()


def test_what_a_page_wrote_is_kept_nowhere_else(server, folder):
    for entries in ([WALL], [WALL, ROOM], []):
        assert save(server, *entries, revision=ask(server, "api/state")[1]["revision"])[0] == 200
        wait(server)
    names = {path.name for path in (folder.parents[1] / "rec").iterdir()}
    assert names == {"corrections.yaml", "corrections.log"}


def test_a_run_that_cannot_begin_is_told_and_leaves_no_settings(folder, tmp_path, monkeypatch):
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))
    session = EditSession(folder, [str(tmp_path / "no_program")])
    with refused(value="is saved"):
        session.save({"survey": SURVEY, "revision": "", "entries": [WALL]})
    assert list(scratch.iterdir()) == [] and not session.state()["running"]
    assert session.state()["entries"] == [WALL]


def test_a_simulated_one_has_them_beside_its_recording_in_the_results(folder):
    (folder / "source.txt").write_text("the simulated demo\n")
    (folder / "survey").mkdir()
    assert EditSession(folder, []).find_place() == folder / "survey/corrections.yaml"


@pytest.mark.parametrize(
    ("break_it", "told"),
    [
        (lambda f: (f / "report.html").unlink(), "there is no such report"),
        (
            lambda f: (f / "source.txt").unlink(),
            "source.txt: does not exist; run the dataset again",
        ),
        (lambda f: (f / "run.json").write_text("[]"), "does not say how the results were made"),
        (
            lambda f: (f.parents[1] / "rec").rename(f / "elsewhere"),
            "rec: does not exist; put it back",
        ),
    ],
)
def test_results_that_cannot_be_made_again_are_told(folder, break_it, told):
    break_it(folder)
    with pytest.raises(StageError, match=told):
        EditSession(folder, [])
