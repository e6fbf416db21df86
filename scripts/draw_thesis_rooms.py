"""Draw the thesis's figures 3.2 and 5.1 to 5.7, and all orders beside them, from the survey of the rooms."""

from scanplan.exports import drawing
from scanplan.lab.evaluation import oracle_figure
from scanplan.lab.thesis import room_survey
from scanplan.stage import log
from scanplan.store import atomic


def draw_thesis_rooms(files, evaluated, outputs, orders, *, bitmap_cell_m, max_range_m):
    """Write the figures as SVG.

    Parameters
    ----------
    files : dict of str to path-like
        Tables of one survey, its truth.geojson and truth_poses.tum; see `room_survey.RoomSurvey`.
    evaluated : list of path-like
        evaluation/walls.parquet of every seed.
    outputs : list of path-like
        figure_<number>.svg, to write.
    orders : path-like
        orders.svg, to write: how near every order comes to the oracle's.
    bitmap_cell_m : float
        Of figure 5.1.
    max_range_m : float
        How far a scan can see.
    """
    survey = room_survey.read_room_survey(files, evaluated, max_range_m=max_range_m)
    for path in outputs:
        atomic.write_text(
            path, drawing.format_svg(room_survey.draw_room_figure(survey, path, bitmap_cell_m))
        )
    atomic.write_text(
        orders, drawing.format_svg(oracle_figure.draw_oracle_figure(*survey.evaluated))
    )
    log.log_line(f"draw_thesis_rooms: {len(outputs)} figures")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_thesis_rooms(
            {
                name: path
                for name, path in snakemake.input.items()
                if name not in ("code", "evaluated")
            },
            list(snakemake.input.evaluated),
            snakemake.output.figures,
            snakemake.output.orders,
            bitmap_cell_m=snakemake.params.bitmap_cell_m,
            max_range_m=snakemake.params.max_range_m,
        )
