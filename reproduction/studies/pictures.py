"""The five pictures of docs/explanation/how-the-model-works.md: four sketches, and a figure of three runs."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch, Polygon, Rectangle

from reproduction.runs import all_runs, shortened
from reproduction.study import ROOT, Job, Place, Study
from thawslide.run_folder import Run

LINES = (
    ("incline-D", "internal deformation alone", "#8A8A8A", "-"),
    ("incline-DL", "melt lubricates the base", "#E69F00", "--"),
    ("incline-DLP", "and pore pressure supports the load", "#0072B2", "-."),
)
BLUE, ORANGE, GREEN, RED, GREY = "#0072B2", "#E69F00", "#009E73", "#B34700", "#8A8A8A"
ROCK, MASS, TEXT = "#D9D2C7", "#F6DCA8", "#222222"


def canvas(height: float, x: tuple[float, float], y: tuple[float, float]) -> tuple[Figure, Axes]:
    """Return a figure 180 mm wide with empty axes of equal scale."""
    figure = Figure(figsize=(7.1, height), layout="constrained")
    axes = figure.subplots()
    axes.set(xlim=x, ylim=y, aspect="equal")
    axes.axis("off")
    return figure, axes


def arrow(axes: Axes, begin: tuple[float, float], end: tuple[float, float], color: str, bend: float = 0.0) -> None:
    """Draw an arrow; bend: curvature of its path."""
    axes.add_patch(
        FancyArrowPatch(
            begin,
            end,
            arrowstyle="-|>",
            mutation_scale=14,
            linewidth=2,
            color=color,
            connectionstyle=f"arc3,rad={bend}",
            shrinkA=0,
            shrinkB=0,
            zorder=4,
        )
    )


def forces() -> Figure:
    """Draw the forces on a slide and the terms of the strength of its base."""
    figure, axes = canvas(3.1, (0, 10), (0, 4.6))
    slope = np.array([[0, 4.2], [7, 1.0], [10, 0.7], [10, 0], [0, 0]])
    axes.add_patch(Polygon(slope, facecolor=ROCK, edgecolor=TEXT))
    along = np.array([7, -3.2]) / np.hypot(7, 3.2)
    out = np.array([3.2, 7]) / np.hypot(7, 3.2)
    foot = np.array([1.2, 4.2 - 3.2 * 1.2 / 7])
    body = np.array([foot, foot + 3.6 * along, foot + 3.2 * along + 0.9 * out, foot + 0.3 * along + 0.9 * out])
    axes.add_patch(Polygon(body, facecolor=MASS, edgecolor=TEXT, zorder=2))
    axes.plot(*np.array([foot, foot + 3.6 * along]).T, color=RED, linewidth=4, zorder=3)
    middle = foot + 1.8 * along + 0.45 * out
    arrow(axes, tuple(middle), tuple(middle - [0, 1.35]), BLUE)
    axes.text(middle[0] + 0.1, middle[1] - 1.55, "weight", color=BLUE, va="top")
    base = foot + 1.2 * along
    arrow(axes, tuple(base + 0.12 * out), tuple(base - 1.1 * along + 0.12 * out), RED)
    axes.text(0.1, 3.05, "strength of the base", color=RED, va="top")
    speed = foot + 3.5 * along + 0.5 * out
    arrow(axes, tuple(speed), tuple(speed + 1.1 * along), GREEN)
    axes.text(speed[0] + 1.15, speed[1] - 0.25, "speed", color=GREEN)
    axes.text(
        9.9,
        4.4,
        "strength = friction × (load − pore pressure) + cohesion\n\n"
        "friction: decreases with melt, or constant\n"
        "load: weight normal to the ground, and bends\n"
        "pore pressure: of water heated in the band\n"
        "cohesion: ice bonds, lost by slip and melting",
        ha="right",
        va="top",
        linespacing=1.35,
    )
    axes.text(8.4, 0.35, "rigid terrain", ha="center", color=TEXT)
    return figure


def feedback() -> Figure:
    """Draw the loop from friction to heat, pressure and speed, with what limits it."""
    figure, axes = canvas(3.0, (0, 10), (0, 4.2))

    def box(x: float, y: float, text: str, color: str) -> None:
        axes.add_patch(
            FancyBboxPatch(
                (x - 1.05, y - 0.42),
                2.1,
                0.84,
                boxstyle="round,pad=0.05",
                facecolor="white",
                edgecolor=color,
                linewidth=2,
            )
        )
        axes.text(x, y, text, ha="center", va="center", linespacing=1.2)

    box(1.5, 3.3, "faster slip", GREEN)
    box(4.7, 3.3, "friction heats\na thin band", RED)
    box(7.9, 3.3, "ice melts,\nwater expands", BLUE)
    box(6.4, 1.7, "pore pressure\nrises", BLUE)
    box(3.0, 1.7, "the base loses\nstrength", RED)
    arrow(axes, (2.65, 3.3), (3.5, 3.3), TEXT)
    arrow(axes, (5.85, 3.3), (6.7, 3.3), TEXT)
    arrow(axes, (8.3, 2.8), (7.6, 1.75), TEXT, -0.35)
    arrow(axes, (5.2, 1.7), (4.2, 1.7), TEXT)
    arrow(axes, (1.85, 1.75), (1.2, 2.8), TEXT, -0.35)
    axes.text(
        5,
        0.62,
        "limits:  water drains  ·  heat is conducted away  ·  water at its load opens a gap  ·  steam escapes",
        ha="center",
        color=GREY,
        fontsize=9,
    )
    return figure


def step() -> Figure:
    """Draw a time step of the material point method in four frames."""
    figure = Figure(figsize=(7.1, 2.35), layout="constrained")
    random = np.random.default_rng(3)
    lattice = np.array([(0.25 + 0.5 * i, 0.25 + 0.5 * j) for i in range(6) for j in range(4 - i // 2)])
    points = lattice + random.uniform(-0.07, 0.07, lattice.shape)
    points[lattice.tolist().index([1.25, 0.75])] = [1.45, 0.55]
    moved = points + np.array([0.45, -0.05]) * (0.5 + points[:, 1:] / 4)
    titles = [
        "1  mass, momentum and\nstress go to the nodes",
        "2  nodes: forces, contact,\nnew velocities",
        "3  velocities go back:\nparticles move and strain",
        "4  a new grid;\nparticles keep the state",
    ]
    for axes, title in zip(figure.subplots(1, 4), titles, strict=True):
        number = int(title[0])
        place = moved if number >= 3 else points
        axes.set(xlim=(-0.3, 4.3), ylim=(-0.75, 3.2), aspect="equal")
        axes.axis("off")
        axes.set_title(title, fontsize=8.5)
        axes.add_patch(Rectangle((-0.3, -0.7), 4.6, 0.7, facecolor=ROCK))
        for line in range(5):
            axes.plot([line, line], [0, 3], color=GREY, linewidth=0.7)
        for line in range(4):
            axes.plot([0, 4], [line, line], color=GREY, linewidth=0.7)
        axes.scatter(*place.T, s=26, color=ORANGE, edgecolor=TEXT, linewidth=0.5, zorder=3)
        nodes = [(x, y) for x in range(5) for y in range(4) if np.abs(place - [x, y]).max(axis=1).min() < 1.0]
        if number == 1:
            for x, y in [(1, 0), (2, 0), (1, 1), (2, 1)]:
                arrow(axes, (1.45, 0.55), (x, y), BLUE)
        if number == 2:
            axes.scatter(*np.array(nodes).T, s=22, color=BLUE, zorder=4)
            for x, y in nodes:
                arrow(axes, (x, y), (x + 0.35 + 0.12 * y, y if y == 0 else y - 0.1), BLUE)
            axes.plot([0, 4], [0, 0], color=RED, linewidth=3, zorder=2)
        if number == 3:
            for begin, end in zip(points, moved, strict=True):
                axes.plot(*np.array([begin, end]).T, color=GREEN, linewidth=1.2, zorder=2)
    return figure


def column() -> Figure:
    """Draw a column of the base with its cells and fluxes."""
    figure, axes = canvas(3.6, (0, 10), (0, 5.0))
    axes.add_patch(Rectangle((0.3, 3.0), 2.6, 1.5, facecolor=MASS, edgecolor=TEXT))
    axes.add_patch(Rectangle((0.3, 0.3), 2.6, 2.6, facecolor=ROCK, edgecolor=TEXT))
    axes.add_patch(Rectangle((0.3, 2.88), 2.6, 0.14, facecolor=RED, edgecolor=RED))
    axes.text(1.6, 3.75, "sliding mass:\ncells of metres", ha="center", va="center")
    axes.text(1.6, 1.6, "ground", ha="center", va="center")
    axes.plot([2.9, 4.3], [3.02, 4.7], color=GREY, linewidth=0.8)
    axes.plot([2.9, 4.3], [2.88, 0.3], color=GREY, linewidth=0.8)
    bottoms = [0.3, 0.95, 1.35, 1.6, 2.1, 2.6, 2.95, 3.5, 4.7]
    colors = [ROCK, ROCK, ROCK, "#E58E63", "#E58E63", MASS, MASS, MASS]
    for low, high, color in zip(bottoms[:-1], bottoms[1:], colors, strict=True):
        axes.add_patch(Rectangle((4.3, low), 1.5, high - low, facecolor=color, edgecolor=TEXT, linewidth=0.8))
    axes.annotate("", (4.1, 1.6), (4.1, 2.6), arrowprops={"arrowstyle": "<->", "color": TEXT})
    axes.text(4.0, 2.1, "e", ha="right", va="center", style="italic")
    arrow(axes, (5.05, 2.35), (5.05, 3.25), RED)
    arrow(axes, (5.05, 1.85), (5.05, 0.95), RED)
    axes.text(6.0, 3.2, "heat is conducted into mass and ground", color=RED, va="center")
    axes.text(
        6.0,
        2.1,
        "band of thickness e (0.01 to 2 m):\nfriction heats it, ice melts,\npore pressure rises to the load at most",
        va="center",
        linespacing=1.25,
    )
    arrow(axes, (5.55, 2.35), (5.55, 4.2), BLUE)
    axes.text(6.0, 4.1, "water drains, steam escapes", color=BLUE, va="center")
    axes.text(6.0, 0.8, "cells widen with distance from the band", color=GREY, va="center")
    return figure


def result(place: Place) -> Figure:
    """Plot the mean velocity of a slide with frozen, melting and pressurized base."""
    figure = Figure(figsize=(7.1, 2.9), layout="constrained")
    axes = figure.subplots()
    for name, label, color, style in LINES:
        history = Run(place.runs / name).series
        axes.plot(history["time_s"], history["mean_velocity_m_s"], style, color=color, label=label, linewidth=1.8)
    axes.set(xlabel="time (s)", ylabel="mean velocity (m/s)", xlim=(0, None), ylim=(0, None))
    axes.grid(color="#DDDDDD", linewidth=0.6)
    axes.legend(frameon=False)
    return figure


def jobs(place: Place) -> list[Job]:
    """Return the runs, which the report of the paper shares."""
    found = [job for job in all_runs() if job.key in [name for name, *_ in LINES]]
    return [shortened(job) for job in found] if place.is_quick else found


def write(place: Place) -> None:
    """Draw all pictures."""
    with mpl.rc_context({"font.size": 9.5, "text.color": TEXT}):
        for name, figure in (
            ("forces", forces()),
            ("feedback", feedback()),
            ("step", step()),
            ("column", column()),
            ("result", result(place)),
        ):
            figure.savefig(place.page(f"docs/explanation/pictures/{name}.png"), dpi=200)


STUDY = Study(
    "pictures",
    ("docs/explanation/how-the-model-works.md (figures)",),
    6.0,
    write,
    (jobs,),
    cases=ROOT / "cases",
    folder="paper",
)
