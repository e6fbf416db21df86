"""Rules of the plan are switched off one at a time, and what they change stands in a table."""

import contextlib
import csv
import sys
from math import nan
from pathlib import Path
from types import SimpleNamespace

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))

import ablation
import ablation_scores
import ablation_table
from ablation_rules import RULES
from ablation_switches import (
    Rule,
    answer,
    ask_with,
    find_holder,
    find_none,
    give_alone,
    give_back,
    make_rule,
    put,
    switched_off,
)

from scanplan.lab.evaluation.scores import score_files
from scanplan.lab.evaluation.scores.score import Score

OFF = {
    "pillars": make_rule("plan.planning:cut_off_pillars", find_none, "plan.furniture.pillars"),
    "tails": make_rule("plan.faces.trimming:trim_tails", give_back(0)),
}


def plans(base, pillars, tails):
    """What two drives are worth: digests of their tables, and how many doors are found."""
    names = (ablation.BASE, *OFF)
    return {
        name: {"tables": tables, "scores": scores}
        for name, (tables, scores) in zip(names, (base, pillars, tails), strict=True)
    }


HALF, FEWER, ALL = ({"doors_driven_recall": share} for share in (0.5, 0.3, 1.0))
FOUND = {
    "one": plans(("a", HALF), ("b", FEWER), ("a", HALF)),
    "other": plans(("c", ALL), ("c", ALL), ("c", ALL)),
}


@pytest.mark.parametrize("name", RULES)
def test_every_rule_is_off_as_long_as_it_is_said_and_on_again(name):
    places = [find_holder(place) for place in RULES[name].switches]
    before = [getattr(*place) for place in places]
    with switched_off(RULES[name]):
        assert all(getattr(*place) is not on for place, on in zip(places, before, strict=True))
    assert [getattr(*place) for place in places] == before
    assert ablation_table.count_lines(RULES[name]) > 0


def test_a_rule_is_on_again_after_an_error():
    holder, name = find_holder("plan.faces.trimming:trim_tails")
    before = getattr(holder, name)
    with pytest.raises(KeyError), switched_off(OFF["tails"]):
        raise KeyError
    assert getattr(holder, name) is before


def test_at_least_thirty_rules_can_be_switched_off():
    assert len(RULES) >= 30


def test_switches_answer_what_would_be_there_without_the_rule():
    def add(one, other=1, *, more=0):
        return one + other + more

    assert answer(7)(add)(1, 2) == 7
    assert find_none(add)(1) == []
    assert give_back(1)(add)(1, 2) == 2
    assert give_alone(0)(add)(1, 2) == [1]
    assert ask_with(more=5)(add)(1, 2, more=3) == 8
    assert put(1, 9)(add)(1, 2, more=3) == 13


def test_a_row_says_what_changes_in_the_mean_and_at_worst():
    row = ablation_table.row_of("pillars", OFF["pillars"], ablation.BASE, FOUND)
    assert row["changed"] == 1
    assert row["doors_driven_recall"] == pytest.approx(-0.1)
    assert row["worst"] == "doors -0.200 (one)"
    assert row["lines"] == len(
        Path(find_holder("plan.furniture.pillars:x")[0].__file__).read_text().splitlines()
    )


def test_the_worst_is_a_share_as_one_room_more_is_none_to_compare_it_with():
    before = {"room_iou": 0.9, "rooms_above_08": 5.0, "thickness_off": 0.1}
    after = {"room_iou": 0.85, "rooms_above_08": 4.0, "thickness_off": 0.2}
    found = {"one": plans(("a", before), ("b", after), ("a", before))}
    row = ablation_table.row_of("pillars", OFF["pillars"], ablation.BASE, found)
    assert row["worst"] == "thickness off -0.100 (one)" and row["rooms_above_08"] == -1


def test_a_plan_that_cannot_be_made_without_a_rule_is_said_to_be_none():
    found = {
        "one": plans(("a", {"doors_driven_recall": 0.5}), ("none: ValueError()", {}), ("a", {}))
    }
    row = ablation_table.row_of("pillars", OFF["pillars"], ablation.BASE, found)
    assert row["worst"] == "no plan of one"


def test_the_table_is_printed_and_written_and_names_what_changes_nothing(tmp_path, capsys):
    ablation_table.report("planar, measured", FOUND, OFF, ablation.BASE, tmp_path)
    printed = capsys.readouterr().out
    assert "Changes nothing anywhere: tails" in printed
    assert (tmp_path / "planar_measured.md").read_text() in printed
    rows = list(csv.DictReader((tmp_path / "planar_measured.csv").read_text().splitlines()))
    assert [row["rule"] for row in rows] == ["pillars", "tails"]
    assert float(rows[0]["doors_driven_recall"]) == pytest.approx(-0.1)


def test_measures_stand_in_one_order_whichever_they_come_in():
    scores = {"room_iou": 0.9, "doors_driven_recall": 0.5}
    orders = (scores, dict(sorted(scores.items())))
    one, other = ({"drive": {ablation.BASE: {"scores": of}}} for of in orders)
    assert list(ablation_table.row_of_base(one)) == list(ablation_table.row_of_base(other))


def test_what_is_kept_is_read_again_and_other_code_makes_it_anew(tmp_path, monkeypatch):
    results = tmp_path / "results/drive"
    for name in ("plan", "selection"):
        (results / name).mkdir(parents=True)
    for name in (
        *("registration.parquet", "plan/segments.parquet", "poses.parquet", "scans.parquet"),
        "selection/wall_length.parquet",
    ):
        (results / name).write_bytes(b"")
    (results / "source.txt").write_text(f"{tmp_path}/drive.yaml\n")
    made = []

    def measure(_results, _settings, rule, _found):
        made.append(rule)
        return {"tables": str(len(rule.switches)), "scores": {}}

    monkeypatch.setattr(ablation, "_measure", measure)
    monkeypatch.setattr(ablation.tables, "ScanStore", lambda _: SimpleNamespace(planar=True))
    monkeypatch.setattr(ablation, "RULES", OFF)
    settings = {"plan": {"method": "wall_length"}}
    first = ablation.ablate(results, tmp_path / "kept", list(OFF), settings)
    assert (
        len(made) == 3 and ablation.ablate(results, tmp_path / "kept", list(OFF), settings) == first
    )
    assert len(made) == 3
    monkeypatch.setattr(ablation, "code_digest", lambda: "other")
    ablation.ablate(results, tmp_path / "kept", list(OFF), settings)
    assert len(made) == 6
    assert isinstance(made[0], Rule)


def finish(home, *names):
    """Return the results of drives as a bench leaves them, of recordings that are not there."""
    found = []
    for name in names:
        results = home / "code/results" / name
        (results / "plan").mkdir(parents=True)
        (results / "plan/segments.parquet").touch()
        (results / "source.txt").write_text(f"{home}/recordings/{name}\n")
        found.append(results)
    return found


def touch(path):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch()
    return path


def test_the_truth_lies_with_a_survey_a_drive_of_the_bench_or_a_real_recording(tmp_path):
    survey, drive, lab, log, aces, none = finish(
        tmp_path, *("survey", "drive", "lab", "log", "aces", "none")
    )
    truths = {
        survey: touch(survey / "survey/truth.geojson"),
        drive: touch(tmp_path / "truths/drive/truth.geojson"),
        lab: touch(tmp_path / "recordings/lab/truth.npz"),
        log: touch(tmp_path / "recordings/truth/log.geojson"),
        aces: Path(ablation.__file__).parent / "truth/aces.geojson",
    }
    for results, truth in truths.items():
        found = ablation_scores.find_truth(results)
        assert found.truth == truth and found.truth.is_file()
        is_simulated = results in (survey, drive)
        assert found.true_poses == (truth.parent / "truth_poses.tum" if is_simulated else None)
    assert ablation_scores.find_truth(none) is None


@pytest.mark.parametrize(
    ("words", "measured"),
    [
        ((), {"hall_101_laser360", "demo_1"}),
        (("reporting",), {"attic_203_laser180"}),
        (("real",), {"aces"}),
        (("hall", "aces"), {"hall_101_laser360", "aces"}),
        (("subset", "tails"), {"attic_203_laser180"}),
    ],
)
def test_what_is_only_reported_on_is_measured_where_it_is_named_alone(
    tmp_path, monkeypatch, words, measured
):
    names = ("hall_101_laser360", "attic_203_laser180", "aces", "demo_1")
    finish(tmp_path, *names)
    made = {}
    monkeypatch.setattr(ablation, "ablate", lambda results, *_: made.setdefault(results.name, {}))
    monkeypatch.setattr(ablation.workers, "open_pool", run_here)
    monkeypatch.setattr(ablation, "_by_kind", lambda *_: {})
    ablation.bench(tmp_path, words, {})
    assert set(made) == measured


@contextlib.contextmanager
def run_here(_):
    yield lambda function, jobs: [function(*job) for job in jobs]


def test_a_folder_with_nothing_to_tune_on_and_a_word_for_nothing_end_in_one_line(tmp_path):
    finish(tmp_path, "attic_203_laser180")
    with pytest.raises(SystemExit, match="to tune"):
        ablation.bench(tmp_path, [], {})
    with pytest.raises(SystemExit, match=r": castle"):
        ablation.bench(tmp_path, ["castle", "tails"], {})


def test_halves_have_tables_apart(tmp_path, monkeypatch):
    drives = finish(tmp_path, *("hall_101_laser360", "attic_203_laser180", "aces", "demo_1"))
    monkeypatch.setattr(ablation.tables, "ScanStore", lambda _: SimpleNamespace(planar=True))
    kinds = ablation._by_kind(drives, {path.name: {} for path in drives})
    assert {kind: list(of) for kind, of in kinds.items()} == {
        "planar, tuning": ["hall_101_laser360"],
        "planar, reporting": ["attic_203_laser180"],
        "planar, real": ["aces"],
        "planar, without a truth": ["demo_1"],
    }


def test_a_plan_is_placed_once_for_all_rules_and_its_own_tables_are_scored(tmp_path, monkeypatch):
    (drive,) = finish(tmp_path, "drive")
    touch(tmp_path / "truths/drive/truth.geojson")
    placed, scored = [], []

    def place(folder, recorded):
        placed.append((folder, recorded.truth))
        return score_files.Placed(folder, None, None, None)

    def score(of):
        scored.append(of.folder)
        measures = dict.fromkeys(ablation_scores.HEADLINES, 0.5) | {"column_recall": nan}
        del measures["leaves_as_wall"]
        return Score(measures, {})

    monkeypatch.setattr(ablation_scores.scoring, "place_floor", place)
    monkeypatch.setattr(ablation_scores.score_files, "score_results", score)
    ablation_scores.place.cache_clear()
    for rule in ("one", "other"):
        found = ablation_scores.score(tmp_path / rule / "plan", drive, {})
        assert set(found) == set(ablation_scores.HEADLINES) - {"column_recall", "leaves_as_wall"}
    assert placed == [(drive, tmp_path / "truths/drive/truth.geojson")]
    assert scored == [tmp_path / "one", tmp_path / "other"]
