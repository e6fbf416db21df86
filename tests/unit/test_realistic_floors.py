"""Which floors of the realistic bench are named by words, and what became of their plans."""

import json
import math
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from helpers.refusals import assert_told

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))

import catalogue
from realistic import floors, plans, recordings, scoring

from scanplan.errors import StageError


def names(chosen):
    return {floor.name for floor in chosen}


@pytest.fixture
def data(tmp_path):
    """Two maps, one without a truth, a log drawn here, one drawn beside it, and one not at all."""
    for folder in ("maps/lab", "maps/bare", "aces", "intel", "undrawn", "truth"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "maps/lab/truth.npz").touch()
    (tmp_path / "truth/intel.geojson").touch()
    (tmp_path / "truth/absent.geojson").touch()
    return tmp_path


@pytest.mark.parametrize("half", floors.HALVES)
def test_a_half_is_all_of_it_and_no_more(data, half):
    chosen = floors.choose_floors(data, [half])
    assert {floor.half for floor in chosen} == {half}
    assert names(chosen) == {f.name for f in floors.list_floors(data) if f.half == half}


def test_without_words_all_floors_are_chosen_each_once(data):
    chosen = floors.choose_floors(data, [])
    assert len(chosen) == len(names(chosen)) == 84 + 3


def test_what_is_tuned_on_is_never_reported_on(data):
    tuning, reporting, real = (floors.choose_floors(data, [half]) for half in floors.HALVES)
    assert not {f.kind for f in tuning} & {f.kind for f in [*reporting, *real]}
    assert not names(tuning) & names([*reporting, *real])
    assert all(floor.half == floor.drive.half for floor in [*tuning, *reporting])
    assert all(floor.drive is None for floor in real)


def test_the_subset_is_twelve_floors_of_both_halves(data):
    chosen = floors.choose_floors(data, ["subset"])
    assert len(chosen) == 12 and names(chosen) == set(catalogue.SUBSET)
    assert {floor.half for floor in chosen} == {"tuning", "reporting"}


def test_words_name_kinds_and_floors_and_add_up(data):
    chosen = floors.choose_floors(data, ["attic", "hall_101_laser360", "attic_203_laser180"])
    assert {floor.kind for floor in chosen} == {"attic", "hall"}
    assert len(chosen) == 6 + 1


def test_real_floors_are_those_with_a_recording_and_a_truth(data):
    chosen = floors.choose_floors(data, ["real"])
    assert {floor.name: floor.kind for floor in chosen} == {
        **{"lab": "map", "aces": "log", "intel": "log"}
    }
    truths = {floor.name: floor.truth for floor in chosen}
    assert truths["intel"] == data / "truth/intel.geojson"
    assert truths["aces"] == floors.find_real_truth(data / "aces")
    assert truths["aces"].is_file() and "benchmarks" in truths["aces"].parts
    assert floors.find_real_truth(data / "undrawn") is None


def test_a_word_that_names_nothing_ends_with_what_there_is(data):
    with pytest.raises(SystemExit) as end:
        floors.choose_floors(data, ["tuning", "castle"])
    words = str(end.value)
    assert "castle;" in words and "tuning, reporting, real" in words
    assert "subset" in words and "museum" in words and "map" in words


def test_without_the_recordings_real_floors_are_left_out_and_that_is_said(tmp_path, capsys):
    chosen = floors.choose_floors(tmp_path / "none", [])
    assert {floor.half for floor in chosen} == {"tuning", "reporting"} and len(chosen) == 84
    assert "no real floor under" in capsys.readouterr().out


PLAN = ("plan/segments", "plan/rooms", "plan/confidence")


class TestPlans:
    """Files as the workflow leaves them."""

    def log(self, folder, stage, words, minute, *, well=True):
        """Write a stage's log, and where it ended well what it took."""
        costs = "s\tmax_rss\tcpu_time\n2.5\t100.5\t1.25\n" if well is True else well
        files = {f"logs/one/{stage}.log": words}
        files |= {f"benchmarks/one/{stage}.tsv": costs} if costs else {}
        for name, text in files.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
            os.utime(path, (60 * minute, 60 * minute))

    def tables(self, folder):
        for table in ("poses", "registration", "scans", *PLAN):
            path = folder / f"results/one/{table}.parquet"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()

    def words(self, folder):
        return plans.last_words(folder / "results", "one")

    def test_a_plan_that_was_made_has_no_last_words(self, tmp_path):
        self.tables(tmp_path)
        self.log(tmp_path, "assemble_plan", "done\n", 1)
        assert self.words(tmp_path) == ""

    def test_a_floor_without_a_plan_says_the_last_line_of_the_stage_that_failed(self, tmp_path):
        self.log(tmp_path, "register_scans", "read\nno scan is kept\n\n", 1, well="")
        self.log(tmp_path, "observe_walls", "done\n", 2)
        assert self.words(tmp_path) == "register_scans: no scan is kept"

    def test_a_plan_of_an_earlier_run_is_none_where_a_stage_before_it_failed(self, tmp_path):
        self.tables(tmp_path)
        self.log(tmp_path, "register_scans", "no scan is kept\n", 1)
        self.log(tmp_path, "validate_plan", "done\n", 2)
        self.log(tmp_path, "register_scans", "no scan is kept\n", 3, well="")
        assert self.words(tmp_path) == "register_scans: no scan is kept"

    def test_a_floor_that_nothing_ran_of_says_so(self, tmp_path):
        assert_told(self.words(tmp_path), remedy="see workflow.log")
        self.log(tmp_path, "interpolate_poses", "\n", 1, well="")
        assert_told(self.words(tmp_path), file="interpolate_poses", remedy="see workflow.log")

    @pytest.mark.parametrize("table", ["registration", *PLAN])
    def test_a_plan_is_none_where_what_it_is_made_of_is_gone(self, tmp_path, table):
        self.tables(tmp_path)
        self.log(tmp_path, "validate_plan", "done\n", 1)
        (tmp_path / f"results/one/{table}.parquet").unlink()
        assert_told(self.words(tmp_path), remedy="see workflow.log")

    def run(self, folder, monkeypatch, *, code, failed):
        """Make plans by a workflow that ends as said, on a floor that an earlier run has made."""
        self.tables(folder)
        self.log(folder, "validate_plan", "done\n", 1)

        def run(command, *, stdout, **_):
            stdout.write("first words\nlast words\n")
            stdout.flush()
            if failed:
                (folder / "logs/one/register_scans.log").write_text("no scan is kept\n")
            return SimpleNamespace(args=command, returncode=code)

        monkeypatch.setattr(plans.subprocess, "run", run)
        monkeypatch.setattr(plans.guard, "check_out", lambda *_: folder)
        recorded = recordings.Recorded(folder / "recorded", folder / "truth.geojson", None)
        return plans.make_plans(folder, "HEAD", folder / "bench", {"one": recorded})

    def test_a_workflow_that_begins_no_stage_ends_the_run_with_its_last_words(
        self, tmp_path, monkeypatch
    ):
        with pytest.raises(SystemExit, match="last words"):
            self.run(tmp_path, monkeypatch, code=1, failed=False)

    def test_a_stage_that_fails_ends_its_floor_alone(self, tmp_path, monkeypatch):
        results = self.run(tmp_path, monkeypatch, code=1, failed=True)
        assert plans.last_words(results, "one") == "register_scans: no scan is kept"

    def test_a_workflow_that_ends_well_leaves_nothing_to_say(self, tmp_path, monkeypatch):
        results = self.run(tmp_path, monkeypatch, code=0, failed=False)
        assert plans.last_words(results, "one") == ""

    def test_a_stage_costs_what_the_workflow_measured(self, tmp_path):
        self.log(tmp_path, "assemble_plan", "", 1)
        self.log(
            tmp_path, "order_scans_wall_length", "", 1, well="s\tmax_rss\tcpu_time\n1\tNA\t-\n"
        )
        self.log(tmp_path, "draw_plan", "", 1)
        costs = plans.stage_costs(tmp_path / "results", "one")
        known = {name: value for name, value in costs.items() if value == value}
        assert known == {
            **{"assemble_plan_s": 2.5, "assemble_plan_cpu_s": 1.25, "assemble_plan_mb": 100.5},
            "order_scans_wall_length_s": 1.0,
        }
        assert len(costs) == 6


class TestRecordings:
    """Two drives, simulated by what stands in for the simulator, in this process."""

    class Here:
        """A pool that does what it is given at once."""

        def __init__(self, *_, **__):
            pass

        def __enter__(self):
            return self

        def __exit__(self, *_):
            return None

        def submit(self, function, *given):
            result = function(*given)
            return SimpleNamespace(result=lambda: result)

    def record(self, folder, monkeypatch, faults):
        """Record floors of which some fail, by name to their fault; return all and the names."""
        chosen = floors.choose_floors(folder / "none", ["dwelling_101_laser270", "attic"])[:2]

        def simulate(building, recording, *_, **__):
            name = recording.parent.name
            if name in faults:
                raise faults[name]
            recording.touch()

        def write(drive, surveys):
            surveys.mkdir(parents=True, exist_ok=True)
            building, survey = surveys / "building.geojson", surveys / f"{drive.name}.yaml"
            building.touch()
            survey.write_text(f"simulate: {{building: {building}}}\n")
            return survey

        # drawn buildings and digests of all code take seconds
        monkeypatch.setattr(recordings.catalogue, "write_survey", write)
        monkeypatch.setattr(recordings.code_files, "digest_helpers", lambda _: "code")
        monkeypatch.setattr(recordings.simulate_survey, "simulate_survey", simulate)
        monkeypatch.setattr(recordings, "ProcessPoolExecutor", self.Here)
        recorded = recordings.record_floors(chosen, folder)
        return chosen, recorded, [floor.name for floor in chosen]

    @pytest.mark.parametrize(
        ("fault", "words"),
        [
            (StageError("walls.geojson: no way"), "simulate: walls.geojson: no way"),
            (ZeroDivisionError("by 0"), "simulate: ZeroDivisionError: by 0"),
        ],
    )
    def test_one_that_fails_says_why_and_ends_no_other(self, tmp_path, monkeypatch, fault, words):
        chosen, recorded, (first, second) = self.record(tmp_path, monkeypatch, {})
        assert recorded[first].failed == recorded[second].failed == ""
        (tmp_path / "truths" / first / "made.json").write_text('{"digest": "of other code"}')
        _, recorded, _ = self.record(tmp_path, monkeypatch, {first: fault})
        assert recorded[first].failed == words and math.isnan(recorded[first].seconds)
        assert recorded[second].failed == "" and recorded[second].seconds >= 0
        # what an earlier run made of the floor is not taken for its plan
        (tmp_path / "results" / first).mkdir(parents=True)
        row, elements = scoring._score(chosen[0], recorded[first], tmp_path / "results")
        assert row["floor"] == first and row["failed"] == words and elements is None

    def test_one_that_failed_is_tried_again(self, tmp_path, monkeypatch):
        _, _, (first, _) = self.record(tmp_path, monkeypatch, {})
        made = tmp_path / "truths" / first / "made.json"
        whole = made.read_text()
        made.write_text('{"digest": "of other code"}')
        self.record(tmp_path, monkeypatch, {first: StageError("no way")})
        assert not made.exists()
        _, recorded, _ = self.record(tmp_path, monkeypatch, {})
        assert recorded[first].failed == ""
        assert json.loads(made.read_text())["digest"] == json.loads(whole)["digest"]

    def test_no_plan_is_made_of_one_that_failed(self, tmp_path, monkeypatch):
        failed = recordings.Recorded(tmp_path, tmp_path, None, failed="simulate: no way")
        monkeypatch.setattr(plans.guard, "check_out", lambda *_: tmp_path)
        monkeypatch.setattr(plans, "_run_workflow", lambda *_: pytest.fail("nothing to run"))
        plans.make_plans(tmp_path, "HEAD", tmp_path, {"one": failed})
