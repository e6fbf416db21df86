"""What the thesis shows: captions of its figures, the claims each is about, and table 5.1."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Figure:
    """A figure of the thesis.

    Attributes
    ----------
    number : str
    caption : str
        The thesis's own.
    ours : str
        What our figure of the same number shows.
    claims : tuple of str
        Names of the claims it is about.
    """

    number: str
    caption: str
    ours: str
    claims: tuple[str, ...] = ()

    @property
    def file(self) -> str:
        """Name of our figure's file."""
        return f"figure_{self.number.replace('.', '_')}.svg"


FIGURES = (
    Figure(
        "3.1",
        "A high level overview of the system",
        "The steps of the workflow, and the way by a model with known truth.",
    ),
    Figure(
        "3.2",
        "A graphical comparison between the naive solution, our solution and ground truth",
        "A scan's one convex hull, the hulls of its clusters without its outliers, and the area"
        " that it truly sees.",
        ("full_hull_overestimates", "cluster_hull_closer", "outliers_harm_one_hull"),
    ),
    Figure(
        "3.3",
        "The main steps in our proposed wall finding algorithm",
        "The same scan as in Figure 3.2: points and normals, the points projected along their"
        " normals and clustered, one line for every cluster, and what is kept of the lines.",
        ("clusters_are_walls",),
    ),
    Figure(
        "4.1",
        "Rover system architecture.",
        "The parts of the thesis's rover, and what the simulated one has in their place.",
    ),
    Figure(
        "5.1",
        "Overlay of the inferred bitmap and the ground truth bitmap",
        "Bitmaps of the walls by cluster RANSAC in the first 60 scans and of the truth: missed"
        " blue, found purple, invented red. The shares are means over grids that begin at different"
        " parts of a cell; drawn is one of them.",
        ("first_sixty",),
    ),
    Figure(
        "5.2",
        "Ground Truth floor plan with the location of the scans indicated by yellow markers. The"
        " endpoints of planes,"
        " such as doors and windows are shown by red markers",
        "The true wall faces of ring_office at the height of the sensor, their ends, and the places"
        " of the scans.",
        ("survey_of_rooms",),
    ),
    Figure(
        "5.3",
        "Walls extracted from the first 60 scans as selected by the subset selection algorithm",
        "Walls by cluster RANSAC in the first 60 scans by cluster hulls, over the truth.",
        ("first_sixty",),
    ),
    Figure(
        "5.4",
        "Correct match, False positive and False negative",
        "The three shares against the number of scans for every order; mean and range over the"
        " seeds.",
        (
            "sequential_poorest",
            "sequential_poorest_match",
            "others_similar",
            "slower_is_better",
            "utility_submodular",
        ),
    ),
    Figure(
        "5.5",
        "Floor plan extracted with the first 15 scans if analyzed in the order they were collected,"
        " and the order"
        " suggested by our algorithm",
        "Walls by cluster RANSAC in the first 15 scans of both orders.",
        ("fifteen_almost_complete", "tenth_little_loss", "tenth_of_drive"),
    ),
    Figure(
        "5.6",
        "Convergence of area covered. 99% area covered indicated in the plot.",
        "Covered area as a share of what all scans cover, by one hull per scan and by cluster"
        " hulls.",
        ("full_hull_99", "cluster_hull_99", "full_hull_sooner"),
    ),
    Figure(
        "5.7",
        "Relationship between area cover and number of clusters",
        "Covered area against the number of scans for several numbers of clusters, and against that"
        " number.",
        (
            "more_clusters_less_area",
            "area_adjustable",
            "more_clusters_more_time",
            "clusters_save_time",
            "sample_saves_time",
        ),
    ),
    Figure(
        "5.8",
        "Time required to compute the subset selection for different number of scans.",
        "Time to choose 15 scans by cluster hulls and to order all, by algorithm 1 as it is written"
        " and by ours, which looks at few scans in a step and gives the same order, against the"
        " number of scans of the drive.",
        ("selection_polynomial", "selection_time", "subset_scales"),
    ),
    Figure(
        "5.9",
        "Registered scans along with the location of each scan. Darker blue indicates more scans at"
        " that location."
        " Areas with many scans are circled.",
        "The registered scans of the drive and their places, darker where there are more within a"
        " metre; the three densest are circled. The simulated rover turns at corners, but waits at"
        " no door. Numbered, the first 15 scans by cluster hulls.",
        ("uneven_harms_random", "two_percent_survive", "own_limits", "localiser"),
    ),
    Figure(
        "5.10",
        "Time comparison and Cumulative number of walls extracted",
        "Time, cumulative walls and walls a scan of both extractors as in the thesis (3.4, 5.3),"
        " scan by scan of the drive, one process.",
        (
            "fewer_walls",
            "fewer_walls_merge_faster",
            "steadier_times",
            "time_by_size",
            "several_per_wall",
        ),
    ),
    Figure(
        "5.11",
        "Walls extracted superimposed on real data, by selecting a subset of 15 scans",
        "Walls of the first 15 scans by cluster hulls over the registered points of the drive, by"
        " both extractors of"
        " ours.",
        ("fifteen_like_all",),
    ),
    Figure(
        "5.12",
        "Walls extracted superimposed on real data, by using all 90 available scans",
        "Walls of all registered scans of the drive, by both extractors of ours.",
        ("fifteen_like_all", "fewer_walls"),
    ),
)

STEPS = (
    ("Data collection", "6 min", "6070", "4.83 GB"),
    ("Selecting continuous scans", "6 min 29 s", "130", "11.5 MB"),
    ("Registration optimization", "40 s", "90", "6.9 MB"),
    ("Hull creation", "10 s", "90", "6.9 MB"),
    ("Cluster Subset selection", "4.5 s", "15", "1.6 MB"),
)
"""Table 5.1: step, time, scans at its end, size of the data."""

THESIS_SCANS = int(STEPS[-2][2])
"""Scans that the thesis chooses its subset from."""
