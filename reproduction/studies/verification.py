"""The pages of verification: runs the verification tests and writes their results with figures.

Each test appends its problem, solution, errors and orders to a file of JSON lines, below the folder of the runs.
`./test --full` writes one such file for all tests.
"""

from __future__ import annotations

import json
import math
import subprocess
import textwrap
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reproduction.engine import Task
from reproduction.study import ROOT, Place, Study, StudyError

Record = dict[str, Any]
TESTS = ROOT / "build" / "release" / "tests"
DETAILS = "verification-details.md"  # in the folder of the runs
# Programs, and their tests that write reports.
PROGRAMS = (
    ("test_verification", "*"),
    (
        "test_sim",
        "FreeFall.*:Incline.*:Bar.*:AdiabaticBand.*:BlockModel.Agrees*:VelocityFilter.DampsAWave*",
    ),
    ("test_physics", "MohrCoulomb.ReturnSolves*:Softening.*"),
    ("test_gis", "ReleaseVolume.*"),
    (
        "test_long",
        "WholeIncline.*:FineVibration.*:PlanesOnDem.*:VChannelsOnDem.*:RoughDems.*:CylindricalColumns.*:"
        "FineCylinderSection.*:FineBarCollapse.*:SpreadingBlock.*:SofteningSlope.*:FollowingChannels.*",
    ),
)
QUICK = (("test_physics", "MohrCoulomb.ReturnSolves*"), ("test_gis", "ReleaseVolume.*"))
# Topics: their comparisons, and the suites of tests that belong to them.
TOPICS = {
    "Motion and stress": (
        "manufactured solutions, vibration and impact of elastic bars, patch tests, rotation, filtered velocities",
        "Vibration FineVibration Bar VelocityFilter ElasticImpact Rotation Patch FreeFall MohrCoulomb RestNoise",
    ),
    "Friction on terrain": (
        "rigid blocks on slopes, in bends and bowls; terminal velocity of Voellmy friction; invariance under rotation",
        "Incline AngleSweep Bonds Substrates Voellmy RestingBlock TiltedTerrain TurnedTerrain MirroredTerrain "
        "BendPressure CurvedTerrain Bowl HelicalChannel",
    ),
    "Terrain from a DEM": (
        "planes, V and U channels, rough terrain, the edge of a DEM; volume of a release",
        "PlaneOnDem PlanesOnDem VChannelOnDem VChannelsOnDem UChannelOnDem ExtrudedProfile RuggedDem RoughDem "
        "RoughDems LeavingDem ReleaseVolume",
    ),
    "Cells that follow the ground": (
        "linear fields and rigid translation; slabs and spreading blocks on planes; channels, walls, a cliff; the "
        "default viscosity",
        "FollowingCells FollowingPlane FollowingBand FollowingTerrain FollowingChannels DefaultViscosity",
    ),
    "Spreading and collapse": (
        "thin-layer solutions of Ritter and of Savage and Hutter; laboratory experiments with bars and sand",
        "DamBreak ParabolicPile WideningSection GranularColumn CylindricalColumn CylindricalColumns "
        "CylinderSection FineCylinderSection BarCollapse FineBarCollapse SpreadingBlock",
    ),
    "Softening": (
        "strength of a sheared element; blocks on a surface that softens over a slip, on any cell",
        "Softening SofteningSlab SofteningSlope",
    ),
    "Heat and freezing": (
        "half space, two layers, solutions of Neumann and Lunardini, manufactured melting, heat budget",
        "Conduction Freezing HeatBudget",
    ),
    "Pore pressure": (
        "undrained heating, diffusion, manufactured solution",
        "PorePressure UndrainedHeating Consolidation",
    ),
    "Basal layer": (
        "slip with thermal pressurization (Rice), arrest or runaway, independence of the mesh, rigid-block model",
        "SlipOnPlane ArrestOrRunaway BandColumnsVerification AdiabaticBand BlockModel",
    ),
    "Entrainment": ("balance of momentum and energy of a block that entrains its bed", "Entrainment"),
    "Energy budget": ("order of the residual in the time step", "InclineEnergy WholeIncline"),
}

OVERVIEW = """# Verification

This page lists the parts of the solver that are compared with exact solutions. The [appendix](verification-details.md)
has each problem with its solution, errors, orders of convergence and plots.

Tests assert all results. They are in `tests/cpp/verification`, and some are in `sim`, `physics`, `terrain` and `gis`.
Closed forms are in `tests/cpp/exact`. `./test` runs these tests, and `./test --full` also those of `tests/cpp/long`.
If a result differs by more than is allowed, the test fails.

- An *order* is that of the error between two neighbouring resolutions. The test asserts that the last order agrees with
  theory within the stated difference, in both directions unless the page states "at least".
- A *value* is compared with its exact or measured value.
- By default, steps are proportional to the square of the cell (heat, pore pressure) or to the cell (motion).

Verification shows that the equations are solved correctly. It does not show that they describe an event. [Laboratory
experiments](laboratory.md), [AvaFrame](comparison.md), the [Frank slide](frank.md) and
[Lamplugh](../cases/lamplugh-columns/README.md) are compared on separate pages.

| topic | compared with | problems | orders | values |
|---|---|---|---|---|
"""

OPENING = """# Verification: details

This appendix of the [verification](verification.md) contains each problem, its solution and its results.
`scripts/pages --only verification` generates both pages from the reports of tests. The appendix is in
`runs/pages/verification` and not in the repository.

"""

STAND_IN = """# Verification: details

This build of the site has no reports of the verification tests, which have each problem with its solution, errors and
orders. To add them, run the tests (about 25 minutes on one core), and build the site again:

```text
scripts/pages --only verification
scripts/site build
```

The figures are those that the repository contains. The name of a figure is the name of its test.

"""

ELSEWHERE = """## Other tests

- Mohr-Coulomb returns admissible, on the surface and idempotent, triaxial paths, apex:
  `tests/cpp/physics/mohr_coulomb_test.cpp`.
- Thickness of the slide wherever the grid cuts it: `tests/cpp/band/flow_depth_test.cpp`.
- Contact areas and the momentum budget: `tests/cpp/sim/contact_test.cpp`.
- A column between rollers under its weight, and the order of its energy budget: `tests/cpp/sim/boundary_test.cpp`.
- Strain and rotation of a particle: `tests/cpp/physics/kinematics_test.cpp`.
- One band column with heating, draining, slip on a plane, a freezing front, thaw consolidation and boiling:
  `tests/cpp/physics/band_column_test.cpp`. [Band columns](theory/band-columns.md#exact-solutions) gives the solutions
  and tolerances.
- Intake, merging and losses of columns: `tests/cpp/physics/band_column_balance_test.cpp`.
- Height of columns below a slide: `tests/cpp/physics/band_column_balance_test.cpp` and
  `tests/cpp/band/segment_step_test.cpp`.
- Experiments on friction at speed: not compared, because no published numbers are available.
"""


def number(value: float, digits: int = 3) -> str:
    """Return a number with significant digits, without an exponent from 0.001 to 1e6."""
    text = f"{value:.{digits}g}"
    if not 1e-3 <= abs(value) < 1e6:
        return text
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(float(text)))))
    text = f"{float(text):,.{decimals}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def digits_of(value: Record) -> int:
    """Return the significant digits of a value: three, or up to six if the allowed difference is smaller."""
    size = max(abs(value["found"]), abs(value["expected"]))
    if size == 0.0 or value["allowed"] <= 0.0:
        return 3
    return min(6, max(3, 1 + math.floor(math.log10(size)) - math.floor(math.log10(value["allowed"]))))


def programs(place: Place) -> tuple[tuple[str, str], ...]:
    """Return the programs, and their tests that are on the page."""
    return QUICK if place.is_quick else PROGRAMS


def names_of(program: str, tests: str) -> list[str]:
    """Return the names of a program's tests, in order."""
    command = [str(TESTS / program), "--gtest_list_tests", f"--gtest_filter={tests}"]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    names, suite = [], ""
    for line in listed.splitlines():
        if line.startswith("  "):
            names.append(suite + line.split()[0])
        else:
            suite = line.strip()
    return names


def records_in(place: Place) -> list[Record]:
    """Return the records of tests that have run, in the order of their tests."""
    order = {name: number for number, name in enumerate(n for each in programs(place) for n in names_of(*each))}
    lines = [line for file in sorted(place.runs.glob("*.jsonl")) for line in file.read_text().splitlines()]
    found = [json.loads(line) for line in lines]
    return sorted((each for each in found if each["test"] in order), key=lambda each: order[each["test"]])


def tests(place: Place) -> list[Task]:
    """Return the test programs; each writes a file of records."""
    if place.runs.is_dir():  # those of ./test --full contain the same tests
        (place.runs / "all.jsonl").unlink(missing_ok=True)
    return [
        Task(
            program,
            (str(TESTS / program), "--gtest_brief=1", f"--gtest_filter={names}"),
            place.runs / f"{program}.jsonl",
            inputs=(TESTS / program,),
            cost=5.0 if program in ("test_long", "test_verification") else 1.0,
            environment={"THAWSLIDE_VERIFICATION": str(place.runs / f"{program}.jsonl")},
        )
        for program, names in programs(place)
    ]


COLOURS = ("#D55E00", "#009E73", "#CC79A7", "#0072B2", "#E69F00")
WIDTH, HEIGHT, DPI = 9.0, 3.6, 100  # inches, inches, dots per inch: figures are 900 dots wide


def draw_curve(axis: Axes, curve: Record) -> None:
    """Plot computed values as points, and the exact curve."""
    points = sorted(zip(curve["x"], curve["computed"], curve["exact"], strict=True))
    x, computed, exact = zip(*points, strict=True)
    axis.plot(x, computed, "o", markersize=4, markerfacecolor="none", color=COLOURS[3], label="Thawslide")
    axis.plot(x, exact, color="#222222", linewidth=1.2, label=curve["reference"])
    axis.set_xlabel(curve["x_label"])
    axis.set_ylabel(curve["y_label"])


def draw_orders(axis: Axes, orders: list[Record]) -> None:
    """Plot errors over resolution, with dotted lines of the expected order through the finest."""
    short = [order["error"].split(":")[0] for order in orders]
    for order, words, colour in zip(orders, short, COLOURS, strict=False):
        sizes, errors = order["resolutions"], order["errors"]
        label = words if short.count(words) == 1 else order["error"]
        axis.loglog(sizes, errors, "o-", markersize=4, color=colour, label=label)
        line = [errors[-1] * (size / sizes[-1]) ** order["expected"] for size in sizes]
        axis.loglog(sizes, line, ":", color=colour, label=f"order {order['expected']:.3g}")
    sizes = sorted({size for order in orders for size in order["resolutions"]})
    axis.set_xticks(sizes, [f"{size:.3g}" for size in sizes])
    axis.xaxis.set_minor_formatter(mpl.ticker.NullFormatter())
    axis.set_xlabel(orders[0]["resolution"])
    axis.set_ylabel("error")


def draw(record: Record, path: Path) -> bool:
    """Plot curves and convergence of a record; return whether it has any."""
    curves, orders = record.get("curves") or [], record.get("orders") or []
    panels = len(curves) + (1 if orders else 0)
    if panels == 0:
        return False
    entries = max(2, 2 * len(orders))
    tall = HEIGHT + (0.2 * entries if panels > 1 else 0.0)
    figure = Figure(figsize=(WIDTH, tall), layout="constrained")
    axes = figure.subplots(1, panels, squeeze=False)
    for axis, curve in zip(axes[0], curves, strict=False):
        draw_curve(axis, curve)
    if orders:
        draw_orders(axes[0][-1], orders)
    for axis in axes[0]:
        axis.tick_params(labelsize=8)
        axis.grid(True, color="#E4E4E4", linewidth=0.6)
        where, anchor = ("upper center", (0.5, -0.16)) if panels > 1 else ("upper left", (1.01, 1.0))
        axis.legend(frameon=False, fontsize=8, loc=where, bbox_to_anchor=anchor)
    figure.savefig(path, dpi=DPI)
    return True


def section(record: Record, name: str, place: Place) -> str:
    """Return the page's section of one record."""
    lines = [f"### {record['title']}", ""]
    by = f" Source: {record['source']}." if record["source"] else ""
    source = f"Solution: {record['solution']}.{by} Test: `{record['test']}`."
    lines += [*textwrap.wrap(record["problem"], 118), "", *textwrap.wrap(source, 118), ""]
    for order in record.get("orders") or []:
        lines += [f"| {order['resolution']} | {order['error']} | order |", "|---|---|---|"]
        for k, (size, error) in enumerate(zip(order["resolutions"], order["errors"], strict=True)):
            found = f"{order['found'][k - 1]:.2f}" if k > 0 else ""
            lines.append(f"| {number(size, 4)} | {number(error)} | {found} |")
        lines += [
            "",
            f"Expected order {'at least ' if order['at_least'] else ''}{order['expected']:.3g}; "
            f"allowed difference: {order['allowed']:g}.",
            "",
        ]
    if "explanation" in record:
        lines += [*textwrap.wrap(record["explanation"], 118), ""]
    values = record.get("values") or []
    if values:
        lines += ["| value | found | expected | allowed difference |", "|---|---|---|---|"]
        for value in values:
            found, expected = (number(value[key], digits_of(value)) for key in ("found", "expected"))
            lines.append(f"| {value['what']} | {found} | {expected} | {number(value['allowed'])} |")
        lines.append("")
    if draw(record, place.page(f"docs/verification/{name}.png")):
        lines += [f"![errors and curves](verification/{name}.png)", ""]
    return "\n".join(lines) + "\n"


def topic_of(record: Record) -> str:
    """Return the topic of a record."""
    suite = record["test"].split(".")[0]
    for topic, (_, suites) in TOPICS.items():
        if suite in suites.split():
            return topic
    raise StudyError(f"{suite}: this suite has no topic. Add it to TOPICS in reproduction/studies/verification.py.")


def overview(records: list[Record]) -> str:
    """Return the page with a row for each topic."""
    rows = []
    for topic, (compared, _) in TOPICS.items():
        own = [record for record in records if topic_of(record) == topic]
        counts = [len(own), *(sum(len(record.get(kind) or []) for record in own) for kind in ("orders", "values"))]
        anchor = topic.lower().replace(" ", "-")
        cells = " | ".join(map(str, counts))
        rows.append(f"| [{topic}](verification-details.md#{anchor}) | {compared} | {cells} |\n")
    return OVERVIEW + "".join(rows)


def appendix(records: list[Record], place: Place) -> str:
    """Plot the figures; return the page with a section for each record."""
    texts: dict[str, list[str]] = {topic: [] for topic in TOPICS}
    seen: dict[str, int] = {}
    for record in records:
        seen[record["test"]] = seen.get(record["test"], 0) + 1
        name = record["test"].replace(".", "-") + (f"-{seen[record['test']]}" if seen[record["test"]] > 1 else "")
        texts[topic_of(record)].append(section(record, name, place))
    topics = (f"## {topic}\n\n" + "".join(sections) for topic, sections in texts.items() if sections)
    return OPENING + "".join(topics) + ELSEWHERE


def stand_in(figures: Path) -> str:
    """Return the appendix without reports: each topic with its comparisons and the existing figures of its tests."""
    text = STAND_IN
    for topic, (compared, suites) in TOPICS.items():
        found = [file.stem for suite in suites.split() for file in sorted(figures.glob(f"{suite}-*.png"))]
        text += f"## {topic}\n\nCompared: {compared}.\n\n"
        text += "".join(f"![{name}](verification/{name}.png)\n\n" for name in found)
    return text


def details_for_site() -> str:
    """Return the appendix of the last run of this study on this machine; without one, that without reports."""
    made = ROOT / "runs" / "pages" / "verification" / DETAILS
    return made.read_text(encoding="utf-8") if made.exists() else stand_in(ROOT / "docs" / "verification")


def write(place: Place) -> None:
    """Write the pages and their figures from existing records."""
    records = records_in(place)
    if not records:
        raise StudyError(f"{place.runs}: no records of tests. Repeat without --draw-only.")
    topics, details = overview(records), appendix(records, place)
    place.page("docs/verification.md").write_text(topics, encoding="utf-8")
    place.runs.mkdir(parents=True, exist_ok=True)
    (place.runs / DETAILS).write_text(details, encoding="utf-8")
    for figure in place.page("docs/verification/none.png").parent.glob("*.png"):
        if f"(verification/{figure.name})" not in details:
            figure.unlink()


STUDY = Study(
    "verification",
    ("docs/verification.md",),
    25.0,
    write,
    (tests,),
    lambda place: [TESTS / program for program, _ in programs(place)],
    "Build them with cmake --build build/release.",
)
