"""Rules of the plan are switched off one at a time, and what they change stands in a table."""

import csv
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))

import ablation
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

BASES = dict.fromkeys(("strays", "tails"), ablation.BASE)
OFF = {
    "strays": make_rule("plan.furniture.fronts:find_strays", find_none, "plan.furniture.strays"),
    "tails": make_rule("plan.faces.trimming:trim_tails", give_back(0)),
}


def plans(base, strays, tails):
    """What two drives are worth: digests of their tables, and how many doors are found."""
    names = (ablation.BASE, *OFF)
    return {
        name: {"tables": tables, "scores": scores}
        for name, (tables, scores) in zip(names, (base, strays, tails), strict=True)
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
    row = ablation_table.row_of("strays", OFF["strays"], ablation.BASE, FOUND)
    assert row["changed"] == 1
    assert row["doors_driven_recall"] == pytest.approx(-0.1)
    assert row["worst"] == "doors -0.200 (one)"
    assert row["lines"] == len(
        Path(find_holder("plan.furniture.strays:x")[0].__file__).read_text().splitlines()
    )


def test_a_plan_that_cannot_be_made_without_a_rule_is_said_to_be_none():
    found = {"one": plans(("a", {"doors_driven_recall": 0.5}), ("none: ValueError()", {}), ("a", {}))}
    row = ablation_table.row_of("strays", OFF["strays"], ablation.BASE, found)
    assert row["worst"] == "no plan of one"


def test_the_table_is_printed_and_written_and_names_what_changes_nothing(tmp_path, capsys):
    ablation_table.report("planar, measured", FOUND, OFF, BASES, tmp_path)
    printed = capsys.readouterr().out
    assert "Changes nothing anywhere: tails" in printed
    assert (tmp_path / "planar_measured.md").read_text() in printed
    rows = list(csv.DictReader((tmp_path / "planar_measured.csv").read_text().splitlines()))
    assert [row["rule"] for row in rows] == ["strays", "tails"]
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
    monkeypatch.setattr(ablation, "BASES", BASES)
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
