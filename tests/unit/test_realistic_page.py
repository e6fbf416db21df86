"""What the realistic bench shows of its scores: pictures, a page, figures, and what changed."""

import sys
import xml.etree.ElementTree
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import shapely
from shapely import LineString

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))

import realistic
from realistic import comparing, page, pictures, scoring, summary

from scanplan.lab.evaluation.scores import false_walls, score
from scanplan.lab.evaluation.scores.score import Element

ROOM = shapely.box(0, 0, 6, 4)
LINE = LineString([(1, 0), (3, 0)])
TRUTH = [("room", ROOM, {}), ("wall", LINE, {"thickness_m": 0.2})]
VERDICTS = [*false_walls.KINDS[1:], *score.UNCOUNTED]
VERDICTS += ["missed", "wrong_type", "merged", "part", "outside", "wall"]


def columns(*elements):
    return score.element_columns(elements)


def paths(*elements, truth=TRUTH):
    """Return the class, style and data of the paths that elements are drawn as, in their order."""
    picture = xml.etree.ElementTree.fromstring(pictures.draw_floor(truth, columns(*elements)))
    drawn = [(path.get("class"), path.get("style"), path.get("d")) for path in picture]
    return [path for path in drawn if path[0]]


class TestPicture:
    @pytest.mark.parametrize("verdict", VERDICTS)
    def test_every_error_has_a_colour_that_the_key_names(self, verdict):
        colour = pictures.COLOURS[verdict]
        for table in ("stretch", "room", "column"):
            shape = LINE if table == "stretch" else ROOM
            ((kind, style, _),) = paths(Element(table, shape, verdict))
            assert kind == f"{table} {verdict}" and f"stroke:{colour}" in style
        named = page._key().partition(f'"background:{colour}"></b>')[2].partition("<b")[0]
        assert pictures.WORDS.get(verdict, verdict) in named.split(", ")

    def test_what_is_right_is_dark_and_lies_below_what_is_wrong_and_rooms_below_all(self):
        drawn = paths(
            *(Element("stretch", LINE, "leaf"), Element("face", LINE, "right")),
            *(Element("room", ROOM, "merged"), Element("room", ROOM, "right")),
        )
        order = ["room right", "room merged", "face right", "stretch leaf"]
        assert [kind for kind, _, _ in drawn] == order
        dark = pictures.colour_of("right")
        assert dark not in pictures.COLOURS.values()
        assert f"stroke:{dark}" in drawn[0][1] and f"stroke:{dark}" in drawn[2][1]

    def test_what_is_missed_alone_is_dashed(self):
        dashed = {v: "dasharray" in paths(Element("stretch", LINE, v))[0][1] for v in VERDICTS}
        assert [verdict for verdict in dashed if dashed[verdict]] == ["missed"]

    def test_y_points_upwards(self):
        ((_, _, data),) = paths(Element("face", LineString([(1, 0), (3, 2)]), "right"))
        assert data == "M1.00,-0.00 3.00,-2.00"
        picture = xml.etree.ElementTree.fromstring(pictures.draw_floor(TRUTH, columns()))
        # 6 m by 4 m and 0.7 m around
        assert picture.get("viewBox") == "-0.70 -4.70 7.40 5.40"

    def test_holes_and_parts_are_rings_of_one_path(self):
        ring = shapely.box(0, 0, 4, 4) - shapely.box(1, 1, 2, 2)
        data = pictures.path_data(shapely.union(ring, shapely.box(6, 0, 7, 1)))
        assert data.count("M") == data.count("Z") == 3


def measured(name, correctness, failed="", half="tuning", **more):
    return {
        **{"floor": name, "kind": "museum", "half": half, "sensor": "laser270", "failed": failed},
        **{"wall_correctness_010": correctness, "wall_drawn_m": 20.0},
        **more,
    }


GOOD = [Element("room", ROOM, "right"), Element("face", LINE, "right")]
BAD = [
    *(Element("room", ROOM, "merged", flagged=True), Element("room", ROOM, "right")),
    *(Element("room", ROOM, "not_entered"), Element("opening", LINE, "unknown")),
    *(Element("face", LINE, "leaf"), Element("stretch", LINE, "leaf")),
]


class TestPage:
    def write(self, folder, rows, of_floors):
        measures, elements = pd.DataFrame(rows), scoring.stack_floors(of_floors)
        truths = {row["floor"]: TRUTH for row in rows}
        page.write_page(folder / "index.html", "Plans of <this>", measures, elements, truths)
        return (folder / "index.html").read_text(encoding="utf-8")

    def two(self, folder):
        rows = [measured("good", 1.0), measured("bad", 0.5)]
        return self.write(folder, rows, {"good": columns(*GOOD), "bad": columns(*BAD)})

    def test_it_opens_offline(self, tmp_path):
        text = self.two(tmp_path)
        assert all(word not in text for word in ("http", "src=", "href=", "@import", "url("))
        assert "<title>Plans of &lt;this&gt;</title>" in text

    @pytest.mark.wording
    def test_the_worst_floor_is_first_and_one_without_a_plan_before_it(self, tmp_path):
        text = self.two(tmp_path)
        assert text.index("<b>bad, tuning") < text.index("<b>good, tuning")
        rows = [measured("good", 1.0), measured("bad", 0.5), measured("none", np.nan, "a < b")]
        of_floors = {"good": columns(*GOOD), "bad": columns(*BAD)}
        text = self.write(tmp_path, rows, of_floors)
        assert text.index("<b>none, tuning") < text.index("<b>bad, tuning")
        assert "1 floors without a plan" in text and "<li>none: a &lt; b</li>" in text
        assert text.count("<svg") == 2

    @pytest.mark.wording
    def test_errors_are_told_by_how_much_of_all_there_is_is_wrong(self, tmp_path):
        text = self.two(tmp_path)
        # one of three rooms that count; 2 m of the 40 m of wall that both plans draw
        assert (
            "<td>room: several in one</td><td>1</td><td>24 m2</td><td>33%</td><td>100%</td>" in text
        )
        assert "<td>wall: open leaf</td><td>1</td><td>2 m</td><td>5%</td><td>0%</td>" in text
        assert text.index("room: several in one") < text.index("wall: open leaf")

    @pytest.mark.wording
    def test_a_floor_is_told_by_its_commonest_errors(self, tmp_path):
        more = [Element("stretch", LINE, "furniture")] * 3 + [Element("room", ROOM, "part")] * 2
        more += [Element("column", ROOM, "missed")] * 4
        text = self.write(tmp_path, [measured("bad", 0.5)], {"bad": columns(*BAD, *more)})
        of_floor = text.partition("<b>bad, tuning</b><br>")[2].partition("<br>")[0]
        assert of_floor == "4 column: missed; 3 wall: furniture; 2 room: part of one"

    def test_what_is_not_known_is_no_error_and_a_face_is_told_by_its_stretches(self, tmp_path):
        text = self.two(tmp_path)
        assert "room: not entered" not in text and "opening: unknown" not in text
        assert "face: open leaf" not in text

    def test_halves_are_apart(self, tmp_path):
        rows = [measured("one", 1.0), measured("other", 0.5, half="reporting")]
        of_floors = {"one": columns(*BAD), "other": columns(*BAD)}
        text = self.write(tmp_path, rows, of_floors)
        assert text.index("<h3>tuning</h3>") < text.index("<h3>reporting</h3>")
        assert "<td>tuning</td><td>1</td><td>1.000</td>" in text
        assert "<td>reporting museum</td><td>1</td><td>0.500</td>" in text

    @pytest.mark.wording
    def test_a_run_without_any_plan_has_a_page(self, tmp_path):
        row = measured("none", 0.0, "no stage has run")
        del row["wall_correctness_010"]
        assert "none: no stage has run" in self.write(tmp_path, [row], {})

    def test_the_filter_finds_the_words_that_it_proposes(self, tmp_path):
        text = self.two(tmp_path)
        proposed = text.partition('placeholder="')[2].partition('"')[0].split()
        words = text.partition('data-words="')[2].partition('"')[0]
        assert proposed and all(word in words for word in proposed)


@pytest.mark.wording
def test_figures_are_means_of_what_is_known_and_failures_are_named(capsys):
    rows = [measured("a", 1.0), measured("b", 0.5), measured("c", np.nan, "no scan is kept")]
    rows.append(measured("d", 0.25, half="reporting"))
    summary.print_summary(pd.DataFrame(rows))
    told = capsys.readouterr().out
    assert "tuning: 3 floors, 1 without a plan" in told and "c: no scan is kept" in told
    assert "walls correct: mean 0.750, least 0.500, most 1.000 (2 floors)" in told
    assert "reporting: 1 floors, 0 without a plan" in told and "mean 0.250" in told


def test_means_are_tables_by_half_kind_sensor_and_real_floor():
    rows = [
        {"floor": "a", "half": "tuning", "kind": "hall", "sensor": "laser", "room_iou": 0.5},
        {"floor": "b", "half": "tuning", "kind": "attic", "sensor": "laser", "room_iou": 1.0},
        {"floor": "c", "half": "real", "kind": "map", "sensor": "", "room_iou": np.nan},
    ]
    tables = summary.format_tables(pd.DataFrame(rows)).split("\n\n")
    heads = [table.split(" ")[1] for table in tables]
    assert heads == ["half", "kind", "sensor", "floor"]
    assert "| tuning | 2 | .750 |" in tables[0] and "| real | 1 | - |" in tables[0]
    assert "| tuning hall | 1 | .500 |" in tables[1] and "| laser | 2 | .750 |" in tables[2]


class TestChanges:
    def compare(self, folder, capsys, old, new):
        """Compare two runs, each its rows of measures and elements by floor."""
        for name, (rows, of_floors) in (("old", old), ("new", new)):
            (folder / name).mkdir()
            pd.DataFrame(rows).to_parquet(folder / name / "measures.parquet")
            elements = scoring.stack_floors(of_floors)
            elements.to_parquet(folder / name / "elements.parquet")
        comparing.compare(folder / "old", folder / "new")
        return capsys.readouterr().out

    def one(self, *elements):
        return {"one": columns(*elements)}

    def test_a_healed_error_a_new_one_and_one_that_stays_are_told_apart(self, tmp_path, capsys):
        far = LineString([(1, 4), (1, 1)])
        moved = shapely.transform(LINE, lambda xy: xy + 0.05)
        stays = Element("stretch", shapely.transform(LINE, lambda xy: xy + 9), "leaf")
        old = [Element("stretch", LINE, "missed"), stays, Element("room", ROOM, "right")]
        new = [
            *(Element("stretch", moved, "bridge"), Element("opening", far, "wrong_type"), stays),
            *(Element("room", ROOM, "not_entered"), Element("opening", LINE, "unknown")),
        ]
        rows = [measured("one", 0.5)]
        told = self.compare(tmp_path, capsys, (rows, self.one(*old)), (rows, self.one(*new)))
        changes = [line.strip() for line in told.splitlines() if "elements" in line]
        assert sorted(changes) == [
            "healed: stretch missed: 1 elements, 2.0 m or m2",
            "new: opening wrong_type: 1 elements, 3.0 m or m2",
            "new: stretch bridge: 1 elements, 2.0 m or m2",
        ]
        assert "worse on 1 floors: one 2" in told and "better on 1 floors: one 1" in told

    def test_an_error_that_is_drawn_a_little_elsewhere_is_the_same(self, tmp_path, capsys):
        moved = shapely.transform(LINE, lambda xy: xy + 0.1)
        runs = [
            ([measured("one", 0.5)], self.one(Element("stretch", line, "leaf")))
            for line in (LINE, moved)
        ]
        assert "elements" not in self.compare(tmp_path, capsys, *runs)

    def test_measures_that_changed_are_told_by_half_and_no_others(self, tmp_path, capsys):
        def run(first, other):
            rows = [measured("a", first, room_iou=0.8), measured("b", 1.0, room_iou=0.6)]
            rows.append(measured("c", other, half="reporting", room_iou=0.5))
            return rows, {}

        told = self.compare(tmp_path, capsys, run(0.5, 0.25), run(0.7, 0.2))
        assert "tuning: 2 floors\n  wall_correctness_010: 0.7500 -> 0.8500" in told
        assert "reporting: 1 floors\n  wall_correctness_010: 0.2500 -> 0.2000" in told
        assert "room_iou" not in told

    def test_times_that_differ_as_they_do_from_run_to_run_are_not_told(self, tmp_path, capsys):
        old, new = (
            ([measured("a", 0.5, total_cpu_s=10.0, assemble_plan_mb=mb)], {}) for mb in (100, 150)
        )
        new[0][0]["total_cpu_s"] = 10.5
        told = self.compare(tmp_path, capsys, old, new)
        assert "total_cpu_s" not in told and "assemble_plan_mb: 100.0000 -> 150.0000" in told

    def test_a_plan_that_is_lost_is_told_and_changes_no_mean(self, tmp_path, capsys):
        old = [measured("a", 0.5), measured("b", 1.0)]
        new = [measured("a", 0.5), measured("b", np.nan, "no scan is kept")]
        bad = self.one(Element("stretch", LINE, "leaf"))
        told = self.compare(tmp_path, capsys, (old, bad), (new, bad))
        assert "plans lost: b" in told and "->" not in told

    def test_floors_of_both_runs_alone_are_compared(self, tmp_path, capsys):
        old = [measured("a", 0.5), measured("b", 1.0)], self.one(Element("room", ROOM, "off"))
        new = [measured("a", 0.5)], {"a": columns(Element("room", ROOM, "off"))}
        told = self.compare(tmp_path, capsys, old, new)
        assert "tuning: 1 floors" in told and "elements" not in told and "->" not in told


def test_a_run_has_a_folder_and_a_title_by_its_commit_and_words(tmp_path, monkeypatch, capsys):
    measures = pd.DataFrame([measured("one", 0.5)])
    elements = scoring.stack_floors({"one": columns(*BAD)})
    floor = realistic.floors.Floor("one", "museum", "laser270", "tuning")
    asked = {}
    stands_in = {
        (realistic.floors, "choose_floors"): lambda _, words: asked.update(words=words) or [floor],
        (realistic.recordings, "record_floors"): lambda *_: {"one": SimpleNamespace(failed="")},
        (realistic.plans, "make_plans"): lambda *given: asked.update(settings=given[4]),
        (realistic.scoring, "score_floors"): lambda *_: (measures, elements),
        (realistic.scoring, "read_true_features"): lambda *_: TRUTH,
        (realistic.guard, "name_commit"): lambda *_: "0123456789abcdef",
    }
    for (module, name), function in stands_in.items():
        monkeypatch.setattr(module, name, function)
    for words, name in (((), "0123456789ab"), (("subset", "a.b=c"), "0123456789ab+subset+a.b=c")):
        realistic.run(tmp_path, tmp_path, tmp_path, "HEAD", words)
        home = tmp_path / "scores" / name
        assert f"<h1>Plans of {name}</h1>" in (home / "index.html").read_text(encoding="utf-8")
        for table in ("measures", "elements"):
            assert len(pd.read_parquet(home / f"{table}.parquet")) == len(
                pd.read_csv(home / f"{table}.csv")
            )
        assert str(home) in capsys.readouterr().out
    assert asked == {"words": ["subset"], "settings": ["a.b=c"]}
