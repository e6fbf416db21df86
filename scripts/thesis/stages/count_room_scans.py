"""Count the scans that floors drawn at random need, by their number of rooms."""

from collections.abc import Mapping, Sequence

from scanplan.selection.wall_cells import WallCellSettings
from scanplan.stage import log
from scanplan.types import FilePath, Settings
from thesis.beyond import measurements, room_counts
from thesis.beyond.wall_search import make_wall_search


def count_room_scans(
    output: FilePath,
    *,
    n_rooms: Sequence[int],
    seed: int,
    settings: Mapping[str, Settings],
) -> None:
    """Write how many scans of every order find 95 % of the walls.

    Parameters
    ----------
    output : path-like
        results/thesis/floors_<seed>.parquet, to write.
    settings : dict
        `simulation`, `extraction` and `cells`: the settings of the survey, of cluster RANSAC, and
        of the wall that scans show.
    """
    search = make_wall_search(settings["extraction"], planar=False)
    cells = WallCellSettings(**settings["cells"])
    floors = (
        room_counts.measure_floor(number, seed, settings["simulation"], search, cells)
        for number in n_rooms
    )
    told = log.report_progress(floors, "count_room_scans", total=len(n_rooms), unit="floors")
    measurements.write_measurements(output, [row for of_floor in told for row in of_floor])


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        count_room_scans(
            snakemake.output.floors,
            n_rooms=snakemake.params.n_rooms,
            seed=int(snakemake.wildcards.floor_seed),
            settings=snakemake.params.settings,
        )
