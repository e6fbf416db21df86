"""Put the scans in the order in which they are worth most for the plan."""

from scanplan import orderings, stagelog, tables
from scanplan.errors import StageError


def order_scans(hulls, output, *, method, seed):
    """Write the table of one method's ordering of a table of hulls."""
    columns = tables.read(hulls, tables.HULLS, ["scan_id", "cluster", "geometry"])
    selection = orderings.order(method, columns, seed=seed)
    if selection["covered_m2"][-1] == 0:
        raise StageError(
            f"{hulls}: {len(selection['rank'])} scans cover 0 m2, more is needed to order them; every cluster of their"
            " points lies on one line: use fewer clusters (n_clusters) or check the recording"
        )
    tables.write(output, tables.SELECTION, selection)
    stagelog.say(f"order_scans: {orderings.summary(method, selection)}")


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        order_scans(
            snakemake.input.hulls,
            snakemake.output.selection,
            method=snakemake.wildcards.method,
            seed=snakemake.params.seed,
        )
