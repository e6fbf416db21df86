"""What the thesis claims: text and numbers alone, nothing of ours and nothing heavy to import.

Sections, figures and numbers are those of "Pointcloud scan selection for indoor floor plan
generation". A claim that states a number has it under `stated`; the criterion says in words when
ours counts as the same (`room_claims` and `drive_claims` apply it). Numbers that hang on the
building, the sensor or the machine have no criterion: ours stand beside them without a verdict.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field


class Sizes:
    """Sizes, in scans, of the subsets that the thesis shows walls of."""

    SUBSET = 15
    MANY = 60


class Judged:
    """What the words of a claim are taken to mean."""

    ALMOST = 0.9  # "similar", "almost complete", "little loss": at least this share is kept
    SEVERAL = 1.5  # segments per wall on average, every wall shown having one at least
    GROWS = 0.5  # power of the number of points: nearer to growing with it than to being the same
    MUCH = 0.5  # "much better": at most this part of the error of what is compared with
    LOADED = 0.1  # share: other work of the machine shifts the quickest of three calls by less


_OURS = (
    "Iterative RANSAC is ours here, which also cuts walls at gaps, leaves out planes by scatter and"
    " height and drops furniture; the thesis's does not."
)
_PLAIN = (
    "Both as in the thesis: one wall a cluster (3.4), removal of inliers alone (5.3); no gaps, no"
    " furniture."
)
_TIMES = (
    f"by {100 * Judged.LOADED:.0f} % or more (processor time, of each the quickest of three"
    " calls: what a"
    " loaded machine shifts is less)"
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
    otherwise : str
        Where it does not hold, whose doing that is: quantities in braces stand for what was
        measured.
    """

    name: str
    where: str
    states: str
    criterion: str = ""
    stated: Mapping[str, float] = field(default_factory=dict)
    otherwise: str = ""


CLAIMS = (
    Claim(
        "sequential_poorest",
        "5.2, Figure 5.4",
        "Of four orders of the scans, the sequential one performs the poorest.",
        f"most false negatives of the four, mean over the first 1, 2, ... {Sizes.MANY} scans",
        otherwise="The building's: its route decides how soon the recorded order has been"
        " everywhere. As recorded {sequential} are missed, at random {random}.",
    ),
    Claim(
        "sequential_poorest_match",
        "5.2, Figure 5.4",
        "The same by the share of correct matches, which the thesis plots beside it.",
        f"fewest correct matches of the four, mean over the first 1, 2, ... {Sizes.MANY} scans",
        otherwise="The metric's: an order that finds little has little that can be false."
        " {sequential} match as recorded, {random} at random.",
    ),
    Claim(
        "others_similar",
        "5.2, Figure 5.4",
        "The other three orders perform more similarly.",
        "their false negatives differ by less than the worst of them from sequential",
        otherwise="The orders': the other three lie {range of the other three} apart, the worst of"
        " them {sequential behind them} before the recorded one.",
    ),
    Claim(
        "full_hull_overestimates",
        "3.3.2, 5.2, Figure 3.2",
        "One convex hull over-estimates the area that a scan covers.",
        "median area of the hull above the area that the scan truly sees",
        otherwise="The building's: in convex rooms with closed doors a hull is what is seen"
        " ({hull per seen area, median} times as much).",
    ),
    Claim(
        "cluster_hull_closer",
        "3.3.2, Figure 3.2",
        "The union of cluster hulls is a much better approximation.",
        "the error of its area, which is what the algorithm goes by, is no more than"
        f" {100 * Judged.MUCH:.0f} % of that of one hull (medians of the scans); the shape's"
        " agreement is"
        " shown beside it",
        otherwise="The algorithm's: its area is off by {error of the area, cluster hulls, median},"
        " that of one hull by {error of the area, one hull, median}.",
    ),
    Claim(
        "outliers_harm_one_hull",
        "3.3.2",
        "The convex hull is extremely sensitive to outliers; clustering the points first solves"
        " this.",
        "one stray return, as far as the scan's farthest and in a random direction, adds to the"
        f" union of cluster hulls no more than {100 * Judged.MUCH:.0f} % of the share that it"
        " adds to one"
        " hull (mean of the scans)",
        otherwise="The algorithm's, as read here: a stray return joins its nearest centre and"
        " stretches that cluster's hull. It adds {area added by one stray return, cluster hulls} to"
        " them and {area added by one stray return, one hull} to one hull.",
    ),
    Claim(
        "full_hull_sooner",
        "5.2, Figure 5.6",
        "The area by one hull per scan converges sooner than by cluster hulls.",
        "fewer scans for 99 %",
        otherwise="The algorithm's: {one hull} scans against {cluster hulls}.",
    ),
    Claim(
        "slower_is_better",
        "5.2",
        "Quick convergence is not desirable: after it the order is not informative any more.",
        f"the first {Sizes.MANY} scans by cluster hulls find more wall (0.10 m) than the"
        f" first {Sizes.MANY} by"
        " full hulls",
        otherwise="The orders': {walls found by 60, cluster hulls} against"
        " {walls found by 60, one hull}.",
    ),
    Claim(
        "more_clusters_less_area",
        "5.2, Figure 5.7",
        "The more clusters, the less area is covered, for any number of scans.",
        "every larger number of clusters covers less, by the first 1, 2, ... and by all scans",
        otherwise="The algorithm's: it holds for {numbers of scans at which it holds} of the"
        " numbers of scans.",
    ),
    Claim(
        "area_adjustable",
        "5.2",
        "The accuracy of the area can be adjusted by the number of clusters.",
        "the median scan's hulls cover more than it truly sees with one number of clusters and less"
        " with another",
        otherwise="The algorithm's: no number of clusters tried has areas on both sides of the true"
        " one.",
    ),
    Claim(
        "more_clusters_more_time",
        "5.2",
        "The more clusters, the more computation time.",
        "hulls and order take longer with the most clusters than with one, and with no larger"
        f" number less than with a smaller, {_TIMES}",
        otherwise="Our implementation's: its clustering of a sample costs less than what every"
        " scan's points cost whatever their number of clusters.",
    ),
    Claim(
        "clusters_save_time",
        "5.2",
        "A number of clusters above one can minimise the total computation time.",
        f"hulls of all scans, and walls of so many as find {100 * Judged.ALMOST:.0f} % of the"
        " visible"
        f" walls, take less time by the most clusters than by one hull {_TIMES}; walls by cluster"
        " RANSAC as in the thesis",
        otherwise="Of the extraction's speed: hulls of all scans cost more than the walls of the"
        " scans that they save. {time, the most clusters} for"
        " {scans needed, the most clusters} scans against {time, one hull} for"
        " {scans needed, one hull}.",
    ),
    Claim(
        "sample_saves_time",
        "3.3.2",
        "KMeans on a sample of the points is computationally efficient, on all points it is not.",
        f"hulls of the same scans take longer by clustering all points {_TIMES}",
        otherwise="Our implementation's: {all points} against {a sample of the points}.",
    ),
    Claim(
        "fifteen_almost_complete",
        "5.2, Figure 5.5",
        "15 of 273 scans in the order of the algorithm give an almost complete floor plan.",
        f"they find {100 * Judged.ALMOST:.0f} % or more of the true walls that the best 15"
        " scans find"
        " (0.10 m; chosen greedily by one who knows the truth). In a building of 25 rooms no 15"
        " scans show all of it",
        {"of how many scans": 273},
        otherwise="The order's by as much as the best 15 scans find more: {walls found} against"
        " {walls found by the best 15}. The rest is the building's: more rooms than scans.",
    ),
    Claim(
        "tenth_little_loss",
        "1.3, 5",
        "A subset, ten times fewer scans, costs little of the final result.",
        f"the first tenth keeps {100 * Judged.ALMOST:.0f} % or more of the walls found and of"
        " the length"
        " that is wall that all scans have, each (0.10 m, visible walls)",
        otherwise="The order's: {walls found, a tenth} of the walls are found, by the best tenth"
        " {walls found, the best tenth}.",
    ),
    Claim(
        "uneven_harms_random",
        "5.2, Figure 5.9",
        "Depending on the severity of uneven sampling, random selection suffers and area based"
        " selection does not.",
        "in the survey of the rooms, the tenth of the scans nearest to a place (mean of 3 places)"
        " taken 1, 5 and 20 times, each time with clusters drawn anew: of a random order the first"
        " 15 (what is to be expected of all) see less true wall with every step and in the end over"
        f" {100 * (1 - Judged.ALMOST):.0f} % less; the first 15 by cluster hulls never over"
        f" {100 * (1 - Judged.ALMOST):.0f} % less",
        otherwise="The orders': a random one loses {lost, random, crowd 20 times}, that by cluster"
        " hulls {lost, cluster hulls, crowd 20 times}.",
    ),
    Claim(
        "utility_submodular",
        "5",
        "We believe that the data of the scans have a submodular property.",
        "what 15 random scans add one by one to 15 others, summed, is at least"
        f" {Judged.ALMOST} of what they add together (submodularity ratio, mean of 15 draws):"
        " of the walls"
        " found, of the F1 of walls and of the correct match of the bitmaps",
        otherwise="The utility's: the ratio is {ratio, walls found} for the walls found,"
        " {ratio, F1 of walls} for the F1 and {ratio, correct match} for the correct match; false"
        " walls lower the last two by more, the fewer walls there are.",
    ),
    Claim(
        "clusters_are_walls",
        "3.4",
        "Each cluster of projected points contains the points of roughly one wall.",
        f"{100 * Judged.ALMOST:.0f} % or more of a scan's points in clusters lie on the true"
        " wall that"
        " most of their cluster lie on (0.10 m, median of the scans)",
        otherwise="The building's furniture or the algorithm's bandwidth:"
        " {points on their cluster's wall, median scan} of the points lie on their cluster's wall.",
    ),
    Claim(
        "several_per_wall",
        "5.3",
        "Iterative RANSAC finds several candidates for each wall of one scan.",
        f"more than {Judged.SEVERAL} candidates per true wall and scan, mean over eight scans"
        " of the"
        " drive, by lines in space within 50 mm. With planes, the band decides: five, two and one"
        f" standard deviation of a range's noise. {_PLAIN}",
        otherwise="The recording's: lines find {lines, 50 mm} candidates a wall.",
    ),
    Claim(
        "fewer_walls",
        "5.4, Figure 5.10",
        "Cluster RANSAC finds fewer walls than iterative RANSAC.",
        f"fewer walls in the timed scans of the drive. {_PLAIN}",
        otherwise="The algorithms': {walls a scan, cluster RANSAC} against"
        " {walls a scan, iterative RANSAC}.",
    ),
    Claim(
        "fewer_walls_merge_faster",
        "5.4",
        "Fewer walls are desirable, as filtering them and relating them takes time that grows with"
        " their number.",
        "merging the segments of all scans takes longer than those of the fewest of a half, a"
        f" quarter and an eighth of them, {_TIMES}",
        otherwise="Our implementation's: {time to merge the most} against"
        " {time to merge the fewest}.",
    ),
    Claim(
        "steadier_times",
        "3.4, 5.4, Figure 5.10",
        "Its run time is steadier.",
        f"smaller standard deviation per mean, scan by scan on the drive, {_TIMES}. {_PLAIN}",
        otherwise="The algorithms': {deviation per mean, cluster RANSAC} against"
        " {deviation per mean, iterative RANSAC}.",
    ),
    Claim(
        "time_by_size",
        "5.4",
        "The time of iterative RANSAC depends on the size of the cloud, that of cluster RANSAC does"
        " not.",
        "on the same scans whole and thinned to 1/2, 1/4 and 1/8 of their points, time goes with"
        f" the number of points to the power of {Judged.GROWS} or more for iterative RANSAC,"
        " of less for"
        f" cluster RANSAC. {_PLAIN}",
        otherwise="The thesis's: normals and mean shift of its cluster RANSAC see every point, so"
        " that its time goes with the power {exponent of time, cluster RANSAC} of their number"
        " ({exponent of time, iterative RANSAC} for iterative RANSAC). The number of runs of"
        " RANSAC, which its sentence is about, goes with the power"
        " {exponent of walls, cluster RANSAC}.",
    ),
    Claim(
        "fifteen_like_all",
        "5.4, Figures 5.11, 5.12",
        "Cluster RANSAC on 15 scans performs like iterative RANSAC on all.",
        f"of the walls found of the hallways, which the rover surveyed, and of the length that is"
        f" wall it has {100 * Judged.ALMOST:.0f} % or more each of that (0.10 m). {_OURS}",
        otherwise="The order's: {walls of the hallways found, cluster RANSAC, 15 scans} of the"
        " hallways' walls, where 15 scans at random find"
        " {walls of the hallways found, 15 scans at random}.",
    ),
    Claim(
        "tenth_of_drive",
        "1.3, 5",
        "A subset, ten times fewer scans, costs little: the same on the drive.",
        f"the first tenth keeps {100 * Judged.ALMOST:.0f} % or more of the walls of the"
        " hallways found and"
        " of the length that is wall that all scans have, each (0.10 m)",
        otherwise="The order's: {walls of the hallways found, a tenth} against"
        " {walls of the hallways found, all}.",
    ),
    Claim(
        "subset_scales",
        "Abstract, 5.2",
        "Using just a subset of the scans allows the algorithm to scale to larger buildings.",
        "hulls and order of a scan, and walls of a tenth of the scans, take less time than walls of"
        f" all, by either extractor, {_TIMES}. {_PLAIN}",
        otherwise="Of the extraction's speed: hulls and order take {a scan, hulls and order} a"
        " scan, cluster RANSAC {a scan, cluster RANSAC}, so that choosing saves"
        " {time saved, cluster RANSAC} of the time.",
    ),
    Claim(
        "selection_polynomial",
        "5.4, Figure 5.8",
        "Choosing can be lengthy: its time is a polynomial of the number of scans.",
        "the time of algorithm 1, all scans put in order as it is written, grows with their number"
        f" to a power above {1 + Judged.LOADED:.1f} (processor time)",
        otherwise="The algorithm's: the power is {exponent, algorithm 1}.",
    ),
    Claim(
        "full_hull_99",
        "5.2, Figure 5.6",
        "By one hull per scan, 99 % of the area is reached after about 10 scans.",
        stated={"scans for 99 %": 10},
    ),
    Claim(
        "cluster_hull_99",
        "5.2, Figure 5.6",
        "By cluster hulls, 99 % of the area is reached after about 17 scans.",
        stated={"scans for 99 %": 17},
    ),
    Claim(
        "two_percent_survive",
        "3.5",
        "About 2 % of the scans survive registration with its limits (0.96 and 0.99). Within what"
        " distance two points count as the same for its fitness is not stated, and the share hangs"
        " on it: ours is that of config/thesis.yaml on the first drive, others are in the figure of"
        " the gates.",
        stated={"share retained": 0.02, "scans retained": 115},
    ),
    Claim(
        "survey_of_rooms",
        "5.2",
        "The synthetic survey has 273 scans (150 in another place).",
        stated={"scans": 273},
    ),
    Claim(
        "survey_drive",
        "1.3, 5.4, Table 5.1",
        "The drive has 6,070 scans in 6 minutes; a sensor records 1 GB a minute. Ten scans a second"
        " make 3,600 in 6 minutes: the thesis's numbers are not of one drive.",
        stated={"scans": 6070, "minutes": 6, "gigabytes a minute": 1},
    ),
    Claim(
        "first_sixty",
        "5.2, Figures 5.1, 5.3",
        "Walls of the first 60 scans against the truth; no number is stated.",
    ),
    Claim(
        "selection_time",
        "5.4, Table 5.1, Figure 5.8",
        "Choosing 15 of 90 scans takes 4.5 s.",
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
