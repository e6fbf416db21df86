"""Drawings of the thesis's figures 3.1 and 4.1 in our terms: the workflow, and the rover."""

from collections.abc import Mapping

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

_STEP, _INPUT, _CHECK = "#d9e8f5", "#f3e3c8", "#dcefe3"

Boxes = Mapping[str, tuple[float, float, str, str]]
"""Place of the middle, text and colour of boxes by their names, on a grid of unit boxes."""


def draw_system_overview() -> Figure:
    """Draw the steps from a recording to a plan, and the way by a model with known truth (3.1)."""
    boxes = {
        "rover": (0, 1.8, "recording of a rover\n(.bag, .db3, .mcap)", _INPUT),
        "model": (0, 0.8, "model of a building\n(drawing, .stl, .ifc)", _INPUT),
        "simulated": (1, 0.8, "simulated survey", _STEP),
        "registered": (1, 1.8, "poses interpolated,\nscans registered", _STEP),
        "hulls": (1, 2.6, "clusters of points,\nconvex hulls", _STEP),
        "order": (2, 2.6, "scans ordered,\nsubset chosen", _STEP),
        "walls": (2, 1.8, "walls of the chosen scans:\nclusters, RANSAC", _STEP),
        "plan": (3, 1.8, "floor plan: walls,\nopenings, rooms", _STEP),
        "truth": (2, 0.8, "true walls: slice at the\nsensor's height", _CHECK),
        "errors": (3, 0.8, "bitmaps, lengths,\nclaims judged", _CHECK),
    }
    arrows = (
        "rover registered",
        "model simulated",
        "simulated registered",
        "registered hulls",
        "registered walls",
        "hulls order",
        "order walls",
        "walls plan",
        "walls errors",
        "plan errors",
        "simulated truth",
        "truth errors",
    )
    return _draw_diagram(boxes, arrows)


def draw_rover_architecture() -> Figure:
    """Draw the parts of the thesis's rover and what the simulated one has in their place (4.1)."""
    boxes = {
        "lidar": (0, 2, "LiDAR\n(simulated: VLP-16, 0.4 m)", _INPUT),
        "encoders": (0, 0, "wheel encoders\n(simulated: odometry)", _INPUT),
        "sonars": (0, 1, "6 sonars\n(not simulated)", _INPUT),
        "controller": (1.1, 0.5, "microcontroller,\nmotor controller", _STEP),
        "motors": (2.2, 0, "two DC motors\n(simulated: speed, turn rate)", _STEP),
        "laptop": (1.1, 2, "laptop with ROS", _STEP),
        "amcl": (2.2, 2.5, "AMCL: pose in a known map\n(simulated: noise, drift, jumps)", _STEP),
        "move": (2.2, 1.4, "move_base: the way there\n(simulated: planned route)", _STEP),
        "bag": (3.3, 2, "recording:\nclouds, poses, tf", _CHECK),
    }
    arrows = (
        "lidar laptop",
        "encoders controller",
        "sonars controller",
        "controller motors",
        "laptop controller",
        "controller laptop",
        "laptop amcl",
        "laptop move",
        "amcl bag",
        "laptop bag",
    )
    return _draw_diagram(boxes, arrows)


def _draw_diagram(boxes: Boxes, arrows: tuple[str, ...]) -> Figure:
    """Draw boxes and the arrows between them, each the names of the two that it joins."""
    figure = Figure(figsize=(9.6, 3.8), layout="constrained")
    axes = figure.add_subplot()
    texts = {name: _draw_box(axes, *box) for name, box in boxes.items()}
    for arrow in arrows:
        start, end = arrow.split()
        axes.annotate(
            "",
            xy=boxes[end][:2],
            xytext=boxes[start][:2],
            arrowprops={
                "arrowstyle": "-|>",
                "color": "0.3",
                "lw": 1.1,
                "patchA": texts[start],
                "patchB": texts[end],
            },
        )
    axes.autoscale_view()
    axes.set_axis_off()
    return figure


def _draw_box(axes: Axes, x: float, y: float, text: str, colour: str) -> FancyBboxPatch:
    """Draw a box with a text around its middle."""
    width, height = 0.9, 0.5
    corner = (x - width / 2, y - height / 2)
    box = FancyBboxPatch(corner, width, height, boxstyle="round,pad=0.02", fc=colour, ec="0.4")
    axes.add_patch(box)
    axes.text(x, y, text, ha="center", va="center", fontsize=8, zorder=4)
    return box
