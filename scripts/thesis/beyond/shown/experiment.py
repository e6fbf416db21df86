"""An experiment beyond the thesis's, as its page shows it."""

from collections.abc import Callable
from dataclasses import dataclass

import pandas as pd
from matplotlib.figure import Figure


@dataclass(frozen=True)
class Experiment:
    """An experiment.

    Attributes
    ----------
    title : str
    how : str
        What is done, for the page.
    caption : str
        Of its figure.
    draw : callable
        Makes the figure of what was measured, `measurements.read_measurements`.
    conclude : callable
        Makes the sentence of it.
    """

    title: str
    how: str
    caption: str
    draw: Callable[[pd.DataFrame], Figure]
    conclude: Callable[[pd.DataFrame], str]
