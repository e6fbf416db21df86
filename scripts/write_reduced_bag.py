"""Write a recording reduced to the scans that show new wall, deciding on each as it comes."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from scanplan.errors import StageError
from scanplan.exports import reduced_bag
from scanplan.geometry import se3
from scanplan.recordings import candidates, frame_edges
from scanplan.recordings.clouds import Scan
from scanplan.recordings.motion.pose_kind import ESTIMATED
from scanplan.recordings.recorded_survey import BagSurvey
from scanplan.recordings.survey import Reading, open_survey
from scanplan.selection import wall_cells
from scanplan.selection.playing import PlayingSelection
from scanplan.selection.wall_cells import WallCellSettings
from scanplan.stage import log
from scanplan.store import atomic
from scanplan.types import FilePath, Settings


def write_reduced_bag(
    recordings: Sequence[str],
    output: FilePath,
    settings: FilePath,
    *,
    reading: Mapping[str, Any],
    poses: Settings,
    cells: Settings,
    playing: Settings,
) -> None:
    """Write the recording, and settings with which a plan is made of it.

    Scans are placed where the localiser says, by the poses before and after them.

    Parameters
    ----------
    recordings : list of str
        The dataset's files.
    output, settings : path-like
        reduced.bag, .mcap or .db3 and reduced.<suffix>.yaml, to write.
    reading, poses : dict
        Sections `input` and `poses`.
    cells, playing : dict
        Keywords of `wall_cells.WallCellSettings` and `min_new_share` of `playing.PlayingSelection`.

    Raises
    ------
    StageError
        If the dataset is a folder of scans or has no poses, or no scan shows a wall.
    """
    limits = {name: poses[name] for name in ("max_gap_s", "max_speed_m_s")}
    spacing = {name: value for name, value in poses.items() if name not in limits}
    selection = PlayingSelection(**playing)
    with open_survey(recordings, Reading(**{**reading, "deskew": False})) as survey:
        if not isinstance(survey, BagSurvey):
            raise StageError(
                f"{output}: not written, as {Path(recordings[0]).parent} holds clouds in files and"
                " no messages, or its scans are of several scanners or sweeps; ask for the plan,"
                " which chooses among them, or for one scanner"
            )
        if survey.pose_kind == ESTIMATED:
            raise StageError(
                f"{output}: not written, as its poses would be estimated from the clouds, which"
                " takes all of them; ask for selected.bag instead"
            )
        known, _, covered = frame_edges.chain_poses(survey.pose_edges(), survey.stamps(), **limits)
        chosen = candidates.choose_candidates(known, **spacing)
        own = WallCellSettings(**cells)
        planar = survey.planar
        axes_deg: int | None = 0 if planar else None

        def is_taken(scan: Scan) -> bool:
            nonlocal axes_deg
            pose = known[scan.scan_id]
            xyz_m = se3.transform_points(pose, scan.xyz_m)
            sensor_m = pose[:3, 3]
            if axes_deg is None:
                # by the first scan that shows a wall: no later one is known yet
                axes_deg = wall_cells.find_main_direction(
                    [(xyz_m, sensor_m)], planar=planar, settings=own
                )
            return selection.take(
                wall_cells.observe_wall_cells(
                    scan.scan_id,
                    xyz_m,
                    sensor_xyz_m=sensor_m,
                    planar=planar,
                    settings=own,
                    axes_deg=axes_deg or 0,
                )
            )

        placed = set(chosen[covered[chosen]].tolist())
        n_taken = reduced_bag.copy_taken_scans(output, survey, placed, is_taken)
        n_scans = len(survey.stamps())
    if not n_taken:
        Path(output).unlink()
        raise StageError(
            f"{output}: not written, as none of {len(placed)} scans with a pose shows a wall; check"
            " input.cloud_topic and poses.max_gap_s"
        )
    own_settings = reduced_bag.reduced_settings(dict(reading), poses)
    # JSON is YAML, too
    atomic.write_text(settings, json.dumps(own_settings, indent=2) + "\n")
    before = np.sum([Path(file).stat().st_size for file in recordings])
    log.log_line(
        f"write_reduced_bag: {n_taken:,} of {n_scans:,} scans, {selection.most_held:,} cells of"
        f" wall kept at most, {Path(output).stat().st_size:,} of {before:,} bytes"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        write_reduced_bag(
            snakemake.input.recordings,
            snakemake.output.recording,
            snakemake.output.settings,
            reading=snakemake.params.reading,
            poses=snakemake.params.poses,
            cells=snakemake.params.cells,
            playing=snakemake.params.playing,
        )
