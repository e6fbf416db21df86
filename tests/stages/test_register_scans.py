import re

import numpy as np
import pytest

from helpers import bag_making
from helpers.default_settings import SETTINGS
from helpers.refusals import assert_told, refused
from interpolate_poses import interpolate_poses
from register_scans import register_scans
from register_scans_chunk import register_scans_chunk
from scanplan.errors import StageError
from scanplan.project import dataset_files
from scanplan.project.settings import merge_settings
from scanplan.project.stage_settings import select_section
from scanplan.project.yaml_file import read_yaml
from scanplan.recordings import small_messages
from scanplan.registration import mapping
from scanplan.registration.candidates.chunk_files import ChunkFiles
from scanplan.store import doubts, schemas, tables

STEP_NS = 100_000_000


def register_chunks(files, poses, folder, n_chunks, **given):
    """Register the chunks of a survey; return their files."""
    names = [f"{number}-of-{n_chunks}" for number in range(1, n_chunks + 1)]
    chunks = [
        ChunkFiles(*(folder / f"{what}_{name}.parquet" for what in ChunkFiles._fields))
        for name in names
    ]
    for name, chunk in zip(names, chunks, strict=True):
        register_scans_chunk(files, poses, chunk, chunk=name, **given)
    return chunks


@pytest.fixture
def run(tmp_path):
    def run_on(entries, name="a", threads=1, n_chunks=0, with_motion=False, **changes):
        folder = tmp_path / name
        bag_making.Maker().write(folder / "run", entries)
        files = dataset_files.find_files(folder)
        reading = SETTINGS["input"] | changes.pop("reading", {})
        topics = {key: value for key, value in reading.items() if key != "max_damaged_share"}
        moved = folder / "motion.parquet" if with_motion else None
        spacing = SETTINGS["poses"] | {"keep_every": 1}
        interpolate_poses(files, folder / "poses.parquet", moved=moved, **spacing, **topics)
        limits = select_section(SETTINGS, "registration") | changes
        outputs = (
            folder / "scans.parquet",
            folder / "registration.parquet",
            folder / "edges.parquet",
        )
        given = {"reading": reading, "settings": limits, "threads": threads}
        poses = folder / "poses.parquet"
        chunks = register_chunks(files, poses, folder, n_chunks, **given)
        register_scans(files, poses, *outputs, moved=moved, chunks=chunks, **given)
        return outputs

    return run_on


def hall(n=4000, seed=0):
    """Points on floor and walls of a hall of 6 m by 4 m by 2.5 m, in the map."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(0, 1, (n, 3)) * (6, 4, 2.5)
    side = rng.integers(0, 5, n)
    for s, (axis, value) in enumerate([(0, 0), (0, 6), (1, 0), (1, 4), (2, 0)]):
        points[side == s, axis] = value
    return points


def survey(n_scans=5, empty=(), moved=(), off_m=0.04):
    """Clouds of a drive through the hall, 0.1 m a scan, some empty; poses, some off by 4 cm."""
    maker, entries = bag_making.Maker(), []
    for i in range(n_scans):
        t_ns, place = bag_making.START_NS + i * STEP_NS, np.array([1 + 0.1 * i, 2, 0.5])
        seen = np.full((5, 3), np.nan) if i in empty else hall(seed=i) - place
        entries.append(
            ("/amcl_pose", t_ns, maker.amcl(t_ns, (place[0] + off_m * (i in moved), *place[1:])))
        )
        entries.append(("/points", t_ns + 1, maker.cloud(t_ns, seen.astype(np.float32))))
    return entries


def test_retained_scans_lie_in_the_map(run):
    scans, registered, _ = run(survey(moved=[2]))
    verdicts = tables.read_table(registered, schemas.REGISTRATION)
    assert verdicts["reason"].tolist() == ["anchor"] + ["kept"] * 4
    np.testing.assert_allclose(verdicts["x_m"], [1.0, 1.1, 1.2, 1.3, 1.4], atol=0.015)
    for name in ("cov_x_x_m2", "cov_y_y_m2"):
        assert (verdicts[name] > 1e-8).all() and (verdicts[name] < 0.01**2).all()
    store = tables.ScanStore(scans)
    assert store.scan_ids.tolist() == [0, 1, 2, 3, 4] and not store.planar
    for scan_id, xyz_m in store.scans():
        assert len(xyz_m) == 4000
        assert np.abs(np.sort(xyz_m[:, 0])[[0, -1]] - (0, 6)).max() < 0.03, scan_id


def test_poses_and_transforms_are_not_read_again(run, monkeypatch):
    read, n_read = small_messages.read_small_messages, []
    monkeypatch.setattr(
        small_messages, "read_small_messages", lambda *of: n_read.append(1) or read(*of)
    )
    run(survey())
    assert len(n_read) == 1


@pytest.mark.parametrize("kind", ["localiser", "odometry"])
@pytest.mark.parametrize("is_recorded", [False, True])
def test_odometry_beside_a_localiser_says_how_the_sensor_moved(run, monkeypatch, is_recorded, kind):
    """Of five scans the third is empty: of odometry the step over it is twice as long."""
    maker, entries = bag_making.Maker(), survey(empty=[2])
    for i in range(5 if is_recorded else 0):
        t_ns = bag_making.START_NS + i * STEP_NS
        entries.append(("/odom", t_ns, maker.odometry(t_ns, (0.125 * i, 0, 0))))
    given = []
    optimise_map = mapping.optimise_map

    def spy(*args):
        given.append(args[-1])
        return optimise_map(*args)

    monkeypatch.setattr(mapping, "optimise_map", spy)
    reading = {"pose_topic": "/amcl_pose", "pose_kind": kind}
    run(entries, with_motion=True, reading=reading)
    (odometry,) = given
    assert (odometry is not None) == (is_recorded and kind == "localiser")
    if odometry is not None:
        steps = odometry(np.array([0, 1, 3, 4]))
        np.testing.assert_allclose(steps[:, 0, 3], [0.125, 0.25, 0.125], atol=1e-9)


def jumping(off_m):
    """Twelve scans, from the seventh on in a map that is off, and odometry that goes on."""
    maker, entries = bag_making.Maker(), survey(12, moved=range(6, 12), off_m=off_m)
    for i in range(12):
        t_ns = bag_making.START_NS + i * STEP_NS
        entries.append(("/odom", t_ns, maker.odometry(t_ns, (0.1 * i, 0, 0))))
    return entries


@pytest.mark.parametrize("off_m", [0.0, 1.5])
def test_a_map_that_jumps_is_laid_back_where_odometry_goes_on(run, off_m):
    _, registered, _ = run(jumping(off_m), with_motion=True)
    found = tables.read_table(registered, schemas.REGISTRATION)
    x_m = 1.0 + 0.1 * np.arange(12)
    np.testing.assert_allclose(found["x_m"][found["kept"]], x_m[found["kept"]], atol=0.02)
    told = doubts.read_doubts(registered, schemas.REGISTRATION).findings
    # the scans behind the jump fit the others no more
    assert [each.witness for each in told] == (["misfit", "mended map"] if off_m else [])
    assert not off_m or "by odometry" in told[1].said


def test_a_part_is_asked_for_by_number(run):
    with pytest.raises(StageError, match=re.escape("registration.part: is 2")):
        run(survey(), "second", part=2)
    whole, first = run(survey()), run(survey(), "first", part=1)
    assert [path.read_bytes() for path in whole] == [path.read_bytes() for path in first]


def test_scans_without_points_are_named_and_left_out(run):
    scans, registered, _ = run(survey(empty=[1, 3]))
    verdicts = tables.read_table(registered, schemas.REGISTRATION)
    assert verdicts["reason"].tolist() == [
        "anchor",
        "too_few_points",
        "kept",
        "too_few_points",
        "kept",
    ]
    assert tables.ScanStore(scans).scan_ids.tolist() == [0, 2, 4]
    for name in schemas.COVARIANCE:
        assert np.isnan(verdicts[name]).tolist() == [False, True, False, True, False]


def test_the_number_of_cores_changes_no_byte(run):
    one, two = run(survey(), "one", threads=1), run(survey(), "two", threads=2)
    assert [path.read_bytes() for path in one] == [path.read_bytes() for path in two]


@pytest.mark.parametrize(
    ("entries", "changes", "most_chunks"),
    [
        (survey(7, empty=[2, 3], moved=[4]), {}, 9),
        (survey(5, moved=[3]), {"reading": {"pose_kind": "odometry"}}, 2),
        (survey(5, empty=[4]), {"icp_method": "none"}, 2),
    ],
)
def test_chunks_give_the_bytes_of_one_job(run, entries, changes, most_chunks):
    """Of four batches; nine chunks leave some with none, and one of them keeps nothing."""
    changes = {"batch_size": 2, "anchor_after": 1, "n_previous": 2} | changes
    whole = [path.read_bytes() for path in run(entries, "whole", **changes)]
    for n_chunks in {2, 3, most_chunks}:
        joined = run(entries, f"{n_chunks}", n_chunks=n_chunks, **changes)
        assert [path.read_bytes() for path in joined] == whole, n_chunks


def damaged_survey(damaged, n_scans=6):
    """Clouds of a drive, some of which state more points than they have."""
    maker, entries = bag_making.Maker(), survey(n_scans)
    clouds = [row for row, entry in enumerate(entries) if entry[0] == "/points"]
    for row in (clouds[scan_id] for scan_id in damaged):
        topic, t_ns, _ = entries[row]
        entries[row] = topic, t_ns, maker.cloud(t_ns - 1, bag_making.room_points(), width=10**6)
    return entries


def test_damage_is_told_once_however_many_chunks_read_it(run, caplog):
    """Scan 3 is the last of the second batch, and what the third looks back to."""
    changes = {"batch_size": 2, "reading": {"max_damaged_share": 0.4}}
    entries = damaged_survey([1, 3])
    whole = run(entries, "whole", **changes)
    caplog.clear()
    joined = run(entries, "joined", n_chunks=3, **changes)
    assert [path.read_bytes() for path in joined] == [path.read_bytes() for path in whole]
    told = [line for line in caplog.messages if line.endswith("left out")]
    assert [re.search(r"scan \d", line)[0] for line in told[:-1]] == ["scan 1", "scan 3"]
    found = doubts.read_doubts(joined[1], schemas.REGISTRATION).damage
    assert_told(*found, value="2 of 6 scans")
    assert told[2:] == [f"register_scans: {found[0]}"]


def test_too_much_damage_in_all_chunks_together_is_refused(run):
    said = r"scan 3 .*2 of 6 scans are damaged so far, more than advanced.input.max_damaged_share"
    with pytest.raises(StageError, match=said):
        run(damaged_survey([0, 3]), n_chunks=3, batch_size=2, reading={"max_damaged_share": 0.2})


def test_chunks_of_another_survey_are_refused(run, tmp_path):
    run(survey(5), "five", n_chunks=2, batch_size=2)
    run(survey(6), "six", n_chunks=2, batch_size=2)
    chunks = [
        ChunkFiles(*(tmp_path / f"five/{what}_{n}-of-2.parquet" for what in ChunkFiles._fields))
        for n in (1, 2)
    ]
    outputs = [tmp_path / f"{name}.parquet" for name in ("scans", "registration", "edges")]
    settings = select_section(SETTINGS, "registration")
    reading = {"max_damaged_share": 0.0}
    with refused(file="poses.parquet", value="other candidates"):
        register_scans(
            [],
            tmp_path / "six/poses.parquet",
            *outputs,
            reading=reading,
            settings=settings,
            chunks=chunks,
        )


@pytest.mark.parametrize(
    ("entries", "changes"),
    [
        (survey(empty=range(5)), {}),
        (survey(), {"reading": {"min_range_m": 50.0}}),
        (survey(), {"min_points": 10_000}),
    ],
)
def test_nothing_to_retain_is_one_line_and_no_table(run, tmp_path, entries, changes):
    with pytest.raises(
        StageError, match=r"run\S*: 0 of 5 candidates retained \(5 too_few_points\).*min_range_m"
    ):
        run(entries, **changes)
    assert sorted(p.name for p in (tmp_path / "a").iterdir()) == ["poses.parquet", "run.bag"]


def sparse(n_scans=8):
    """Clouds of a drive whose scans have too few points to lie near one another's."""
    maker, entries = bag_making.Maker(), []
    for i in range(n_scans):
        t_ns, place = bag_making.START_NS + i * STEP_NS, np.array([1 + 0.1 * i, 2, 0.5])
        seen = hall(n=40, seed=i) - place
        entries.append(("/amcl_pose", t_ns, maker.amcl(t_ns, place)))
        entries.append(("/points", t_ns + 1, maker.cloud(t_ns, seen.astype(np.float32))))
    return entries


def test_where_the_preset_keeps_nothing_the_distance_named_keeps_some(run, project_root, tmp_path):
    preset = merge_settings(SETTINGS, read_yaml(project_root / "config/thesis.yaml"))
    limits = select_section(preset, "registration")
    with pytest.raises(StageError) as caught:
        run(sparse(), **limits)
    text = str(caught.value)
    assert "\n" not in text and "of 7 scans 0.0 %" in text
    assert "0 % the second" in text and "leave config/thesis.yaml out" in text
    assert sorted(p.name for p in (tmp_path / "a").iterdir()) == ["poses.parquet", "run.bag"]
    (named,) = re.findall(r"set registration.fitness_distance_m to ([\d.]+),", text)
    _, registered, _ = run(sparse(), "wider", **limits | {"fitness_distance_m": float(named)})
    assert tables.read_table(registered, schemas.REGISTRATION)["kept"].sum() > 1


def test_a_map_too_far_from_its_origin_is_refused(run):
    maker = bag_making.Maker()
    entries = [
        entry
        if entry[0] == "/points"
        else (entry[0], entry[1], maker.amcl(entry[1], (500_000.0, 0, 0)))
        for entry in survey()
    ]
    with pytest.raises(StageError, match=r"500\d* m from the map's origin.*local map frame"):
        run(entries)
