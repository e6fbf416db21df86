"""The page of the experiments that go beyond the thesis's own."""

from collections.abc import Mapping

import pandas as pd

from scanplan.report import templates
from thesis.claim_measures import SHARE
from thesis.comparison.evaluation_figure import method_style
from thesis.page import format_values, inline_svg
from thesis.stated_claims import Sizes


def more_page(
    sources: Mapping[str, str],
    figures: Mapping[str, str],
    found: pd.DataFrame,
    experiments: Mapping[str, Mapping[str, str]],
) -> str:
    """Return the page.

    Parameters
    ----------
    sources : dict of str to str
        File name to text of `thesis_more.html.j2` and of its style.
    figures : dict of str to str
        SVG text by name: `confidence`, `surrogates`, and those of the further experiments.
    found : pandas.DataFrame
        As in `more_figures.join_orders`.
    experiments : dict of str to dict of str to str
        Further ones: `title`, `how`, `caption` and `shows` by the names of their figures.

    Returns
    -------
    str
    """
    by_method = found.groupby("method", sort=False)
    rows = [
        (k, [format_values(shares.to_numpy(), SHARE) for _, shares in by_method[k]])
        for k in found.columns
    ]
    return templates.render_template(
        sources,
        "thesis_more.html.j2",
        figures={name: inline_svg(svg, name) for name, svg in figures.items()},
        methods=[method_style(method)[0] for method in by_method.groups],
        found=rows,
        n_seeds=found.index.get_level_values("seed").nunique(),
        n_scans=Sizes.SUBSET,
        experiments=experiments,
    )
