"""Merge the walls of the first scans of an ordering into faces, each standing once."""

import numpy as np

from scanplan import faces, stagelog, stopping, tables
from scanplan.errors import StageError


def assemble_plan(walls, selection, output, *, n_scans, area_share, settings):
    """Write the faces of the plan.

    Parameters
    ----------
    walls : path-like
        walls/<extractor>.parquet.
    selection : path-like
        selection/<method>.parquet.
    output : path-like
        plan/faces.parquet, to write.
    n_scans, area_share : int, float or None
        How many scans to use, see `stopping.n_scans`.
    settings : dict
        Keywords of `faces.MergeSettings`.
    """
    seen = tables.read(walls, tables.WALLS, allow_empty=True)
    ordering = tables.read(selection, tables.SELECTION)
    count, reason = stopping.n_scans(ordering, n_scans=n_scans, area_share=area_share)
    used = np.isin(seen["scan_id"], ordering["scan_id"][:count])
    if not used.any():
        raise StageError(
            f"{walls}: no wall in the first {count} scans ({len(used)} in all scans), at least 1 needed;"
            " take more scans (selection.stop) or loosen the wall extractor (walls)"
        )
    merged = faces.merge(_checked(walls, {c: v[used] for c, v in seen.items()}), faces.MergeSettings(**settings))
    if len(merged["face"]) == 0:
        raise StageError(
            f"{walls}: none of {used.sum()} wall segments of {count} scans is supported enough to be drawn;"
            " lower plan.merge min_length_m, min_points_per_m, min_scans or lone_length_m"
        )
    tables.write(output, tables.FACES, merged)
    stagelog.say(f"assemble_plan: {used.sum():,} segments of {count} scans ({reason}) make {faces.summary(merged)}")


def _checked(path, walls):
    wrong = sum(int((~np.isfinite(values)).sum()) for values in walls.values())
    if wrong:
        raise StageError(f"{path}: {wrong} numbers are not finite, 0 allowed; delete it and run again")
    return walls


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        assemble_plan(
            snakemake.input.walls,
            snakemake.input.selection,
            snakemake.output.faces,
            **snakemake.params.stop,
            settings=snakemake.params.settings,
        )
