"""What the thesis claims: text and numbers alone, nothing of ours and nothing heavy to import.

Sections, figures and numbers are those of "Pointcloud scan selection for indoor floor plan
generation". A claim that states a number has it under `stated`; the criterion says in words when
ours counts as the same (`room_claims` and `drive_claims` apply it).
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

SUBSET, MANY = 15, 60
"""Sizes, in scans, of the subsets that the thesis shows walls of."""
ABOUT = 0.25  # a number "about" as stated differs from it by no more than this share of it
ALMOST = 0.9  # "similar", "little loss": at least this share of every measure compared with
SEVERAL = 1.5  # segments per wall on average, every wall shown having one at least
GROWS, STEADY = 0.5, 0.3
"""Time grows with the number of points where it goes with that to the power of the first or a
higher one, and does not where it does to the power of the second or a lower one."""
COMPLETE = 0.9  # "almost complete": at least this share of the visible true walls
MUCH = 0.5  # "much better": at most this part of the error of what is compared with
HARM = 0.05  # an order is harmed where its scans see less by more than this share

_OURS = (
    "Iterative RANSAC is ours here, which also cuts walls at gaps, leaves out planes by scatter and"
    " height and drops furniture; the thesis's does not."
)
_PLAIN = (
    "Both as in the thesis: one wall a cluster (3.4), removal of inliers alone (5.3); no gaps, no"
    " furniture."
)


@dataclass(frozen=True)
class Claim:
    """A claim, or where there is no criterion a number that the thesis states.

    Attributes
    ----------
    name : str
        That of the function which measures it.
    where : str
        Section and figure.
    states : str
    criterion : str
        When it holds; empty for a mere number.
    stated : dict of str to float
        Quantity, as ours is called, to the thesis's number.
    """

    name: str
    where: str
    states: str
    criterion: str = ""
    stated: Mapping[str, float] = field(default_factory=dict)


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
        "what it does not share with the area truly seen (1 - intersection over union, median) is"
        " no more than"
        f" {100 * MUCH:.0f} % of that of one hull",
    ),
    Claim(
        "full_hull_99",
        "5.2, Figure 5.6",
        "By one hull per scan, 99 % of the area is reached after about 10 scans.",
        f"within {100 * ABOUT:.0f} % of it",
        {"scans for 99 %": 10},
    ),
    Claim(
        "cluster_hull_99",
        "5.2, Figure 5.6",
        "By cluster hulls, 99 % of the area is reached after about 17 scans.",
        f"within {100 * ABOUT:.0f} % of it",
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
        "the first 40 scans by cluster hulls find more wall (0.10 m) than the first 40 by full"
        " hulls",
    ),
    Claim(
        "more_clusters_less_area",
        "5.2, Figure 5.7",
        "The more clusters, the less area is covered, for any number of scans.",
        "every larger number of clusters covers less, by the first 1, 2, ... and by all scans",
    ),
    Claim(
        "more_clusters_more_time",
        "5.2",
        "The more clusters, the more computation time.",
        "hulls and order take longer with every larger number of clusters (of each the quickest of"
        " three calls)",
    ),
    Claim(
        "fifteen_almost_complete",
        "5.2, Figure 5.5",
        "15 of 273 scans in the order of the algorithm give an almost complete floor plan.",
        f"they find {100 * COMPLETE:.0f} % or more of the true walls that any scan can see (0.10"
        " m)",
        {"of how many scans": 273},
    ),
    Claim(
        "tenth_little_loss",
        "1.3, 5",
        "A subset, ten times fewer scans, costs little of the final result.",
        f"the first tenth keeps {100 * ALMOST:.0f} % or more of the walls found and of the length"
        " that is wall that all"
        " scans have, each (0.10 m, visible walls)",
    ),
    Claim(
        "uneven_harms_random",
        "5.2, Figure 5.9",
        "Depending on the severity of uneven sampling, random selection suffers and area based"
        " selection does not.",
        "in the survey of the rooms, the tenth of the scans nearest to a place (mean of 3 places)"
        " taken 1, 5 and 20"
        " times, each time with clusters drawn anew: the first 15 of a random order (mean of 200)"
        " see less true wall"
        f" with every step and in the end over {100 * HARM:.0f} % less; the first 15 by cluster"
        " hulls never over"
        f" {100 * HARM:.0f} % less",
    ),
    Claim(
        "several_per_wall",
        "5.3",
        "Iterative RANSAC finds several candidates for each wall of one scan.",
        f"{SEVERAL} or more candidates per true wall and scan, mean over eight scans of the drive,"
        " by lines in space within 50 mm. With planes, the band decides: five, two and one standard"
        f" deviation of a range's noise. {_PLAIN}",
    ),
    Claim(
        "fewer_walls",
        "5.4, Figure 5.10",
        "Cluster RANSAC finds fewer walls than iterative RANSAC.",
        f"fewer walls in the timed scans of the drive. {_PLAIN}",
    ),
    Claim(
        "steadier_times",
        "3.4, 5.4, Figure 5.10",
        "Its run time is steadier.",
        "smaller standard deviation per mean, scan by scan on the drive (of each the quickest of"
        " three calls)."
        f" {_PLAIN}",
    ),
    Claim(
        "time_by_size",
        "5.4",
        "The time of iterative RANSAC depends on the size of the cloud, that of cluster RANSAC does"
        " not.",
        "on the same scans whole and thinned to 1/2, 1/4 and 1/8 of their points, time goes with"
        " the number of points"
        f" to the power of {GROWS} or more for iterative RANSAC, of {STEADY} or less for cluster"
        f" RANSAC. {_PLAIN}",
    ),
    Claim(
        "fifteen_like_all",
        "5.4, Figures 5.11, 5.12",
        "Cluster RANSAC on 15 scans performs like iterative RANSAC on all.",
        f"of the walls found and of the length that is wall it has {100 * ALMOST:.0f} % or more"
        " each of that (0.10 m,"
        f" visible walls), on the drive. {_OURS}",
    ),
    Claim(
        "two_percent_survive",
        "3.5",
        "About 2 % of the scans survive registration with its limits (0.96 and 0.99).",
        f"within {100 * ABOUT:.0f} % of it, with config/thesis.yaml on the drive. The thesis does"
        " not state within what"
        " distance two points count as the same for its fitness: 0.5 m is assumed, and the share"
        " hangs on it",
        {"share retained": 0.02, "scans retained": 115},
    ),
    Claim(
        "survey_of_rooms",
        "5.2",
        "The synthetic survey has 273 scans (150 in another place).",
        stated={"scans": 273},
    ),
    Claim(
        "survey_drive",
        "5.4, Table 5.1",
        "The drive has 6,070 scans in 6 minutes.",
        stated={"scans": 6070, "minutes": 6},
    ),
    Claim(
        "first_sixty",
        "5.2, Figures 5.1, 5.3",
        "Walls of the first 60 scans against the truth; no number is stated.",
    ),
    Claim(
        "selection_time",
        "5.4, Table 5.1, Figure 5.8",
        "Choosing 15 of 90 scans takes 4.5 s, and longer by a polynomial of the number of scans;"
        " its degree is not"
        " stated.",
        stated={"to choose 15 of 90 scans": 4.5},
    ),
    Claim("localiser", "3.5", "The poses of AMCL are fairly accurate; no number is stated."),
    Claim(
        "own_limits",
        "3.5, Table 5.1",
        "130 of 6,070 scans are retained, 90 after refinement.",
        stated={"scans": 90},
    ),
)


def stated_number(name: str, quantity: str) -> float:
    """Return the number that a claim states of a quantity."""
    return next(claim.stated[quantity] for claim in CLAIMS if claim.name == name)
