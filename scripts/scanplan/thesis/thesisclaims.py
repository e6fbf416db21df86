"""What the thesis claims: text and numbers alone, nothing of ours.

Sections, figures and numbers are those of "Pointcloud scan selection for indoor floor plan generation". A claim that
states a number has it under `stated`; the criterion says in words when ours counts as the same (`claims` applies it).
"""

from dataclasses import dataclass, field

ABOUT = 0.25
"""A number "about" as stated differs from it by no more than this share of it."""
ALMOST = 0.9
""""Almost complete", "similar" and "little loss": this share or more of what is compared with."""

SEVERAL = 1.5
"""Several segments per wall: as many or more on average, every wall shown having one at least."""

CLEAR, SLIGHT = 0.5, 0.3
"""A correlation from the first up shows that one depends on the other; one of no more than the second that it does not.

Cohen 1988 calls 0.5 large and 0.3 medium.
"""


@dataclass(frozen=True)
class Claim:
    """A claim, or where there is no criterion a number that the thesis states.

    Attributes
    ----------
    name : str
        Under which `claims` measures it.
    where : str
        Section and figure.
    states : str
    criterion : str
        When it holds; empty for a mere number.
    stated : dict of str to float
        Quantity, as `claims` calls ours, to the thesis's number.
    """

    name: str
    where: str
    states: str
    criterion: str = ""
    stated: dict = field(default_factory=dict)


CLAIMS = (
    Claim(
        "sequential_poorest",
        "5.2, Figure 5.4",
        "Of four orders of the scans, the sequential one performs the poorest.",
        "most false negatives of the four, mean over the first 1, 2, ... 80 scans",
    ),
    Claim(
        "sequential_poorest_match",
        "5.2, Figure 5.4",
        "The same by the share of correct matches, which the thesis plots beside it.",
        "fewest correct matches of the four, mean over the first 1, 2, ... 80 scans",
    ),
    Claim(
        "others_similar",
        "5.2, Figure 5.4",
        "The other three orders perform more similarly.",
        "their false negatives differ by less than the worst of them from sequential",
    ),
    Claim(
        "full_hull_overestimates",
        "3.3.2, 5.2, Figure 3.2",
        "One convex hull over-estimates the area that a scan covers.",
        "median area of the hull above the area that the scan truly sees",
    ),
    Claim(
        "cluster_hull_closer",
        "3.3.2, Figure 3.2",
        "The union of cluster hulls is a much better approximation.",
        "median relative error of the area smaller than with one hull",
    ),
    Claim(
        "full_hull_99",
        "5.2, Figure 5.6",
        "By one hull per scan, 99 % of the area is reached after about 10 scans.",
        f"within {ABOUT:.0%} of it",
        {"scans for 99 %": 10},
    ),
    Claim(
        "cluster_hull_99",
        "5.2, Figure 5.6",
        "By cluster hulls, 99 % of the area is reached after about 17 scans.",
        f"within {ABOUT:.0%} of it",
        {"scans for 99 %": 17},
    ),
    Claim(
        "full_hull_sooner",
        "5.2, Figure 5.6",
        "The area by one hull per scan converges sooner than by cluster hulls.",
        "fewer scans for 99 %",
    ),
    Claim(
        "slower_is_better",
        "5.2",
        "Quick convergence is not desirable: after it the order is not informative any more.",
        "the first 40 scans by cluster hulls find more wall than the first 40 by full hulls",
    ),
    Claim(
        "more_clusters_less_area",
        "5.2, Figure 5.7",
        "The more clusters, the less area is covered, for any number of scans.",
        "every larger number of clusters covers less, by 15 scans and by all",
    ),
    Claim(
        "more_clusters_more_time",
        "5.2",
        "The more clusters, the more computation time.",
        "hulls and order take longest with the most clusters and shortest with the fewest",
    ),
    Claim(
        "fifteen_almost_complete",
        "5.2, Figure 5.5",
        "15 of 273 scans in the order of the algorithm give an almost complete floor plan.",
        f"they find {ALMOST:.0%} or more of what all scans find (0.10 m)",
        {"of how many scans": 273},
    ),
    Claim(
        "tenth_little_loss",
        "1.3, 5",
        "A subset, ten times fewer scans, costs little of the final result.",
        f"the first tenth finds {ALMOST:.0%} or more of what all scans find (0.10 m)",
    ),
    Claim(
        "uneven_harms_random",
        "5.2, Figure 5.9",
        "Depending on the severity of uneven sampling, random selection suffers and area based selection does not.",
        "by proxy: at 15 scans cluster hulls lead random by more on the drive (uneven, hallways) than in the rooms,"
        " which differ in more than their places",
    ),
    Claim(
        "several_per_wall",
        "5.3",
        "Iterative RANSAC finds several candidates for each wall of one scan.",
        f"{SEVERAL} or more segments per true wall and scan, mean over every scan of the drive",
    ),
    Claim(
        "fewer_walls",
        "5.4, Figure 5.10",
        "Cluster RANSAC finds fewer walls than iterative RANSAC.",
        "fewer segments in all scans of the drive",
    ),
    Claim(
        "steadier_times",
        "3.4, 5.4, Figure 5.10",
        "Its run time is steadier.",
        "smaller standard deviation per mean, scan by scan on the drive (of each the quickest of three calls)",
    ),
    Claim(
        "time_by_size",
        "5.4",
        "The time of iterative RANSAC depends on the size of the cloud, that of cluster RANSAC does not.",
        f"time and number of points correlate (r) by {CLEAR} or more for iterative RANSAC, and by {SLIGHT} or less, in"
        " either direction, for cluster RANSAC",
    ),
    Claim(
        "fifteen_like_all",
        "5.4, Figures 5.11, 5.12",
        "Cluster RANSAC on 15 scans performs like iterative RANSAC on all.",
        f"it finds {ALMOST:.0%} or more of what that finds (0.10 m), on the drive",
    ),
    Claim(
        "two_percent_survive",
        "3.5",
        "About 2 % of the scans survive registration with its limits (0.96 and 0.99).",
        f"within {ABOUT:.0%} of it, with config/thesis.yaml on the drive",
        {"share retained": 0.02, "scans retained": 115},
    ),
    Claim(
        "survey_of_rooms", "5.2", "The synthetic survey has 273 scans (150 in another place).", stated={"scans": 273}
    ),
    Claim(
        "survey_drive",
        "5.4, Table 5.1",
        "The drive has 6,070 scans in 6 minutes.",
        stated={"scans": 6070, "minutes": 6},
    ),
    Claim(
        "first_sixty", "5.2, Figures 5.1, 5.3", "Walls of the first 60 scans against the truth; no number is stated."
    ),
    Claim(
        "selection_time",
        "5.4, Table 5.1, Figure 5.8",
        "Choosing 15 of 90 scans takes 4.5 s.",
        stated={"seconds for 90 scans": 4.5},
    ),
    Claim("localiser", "3.5", "The poses of AMCL are fairly accurate; no number is stated."),
    Claim(
        "own_limits", "3.5, Table 5.1", "130 of 6,070 scans are retained, 90 after refinement.", stated={"scans": 90}
    ),
)


def stated(name, quantity):
    """Return the number that a claim states of a quantity."""
    return next(claim.stated[quantity] for claim in CLAIMS if claim.name == name)
