"""The page cases/lamplugh/assumptions.md: one assumption changed at a time, and a search for causes of braking.

assumptions.txt next to the case contains the text of the page.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from reproduction.bars import bars
from reproduction.lamplugh import (
    base_traction,
    block_measures,
    figure_blocks,
    figure_deposit,
    near_ground,
    zone_fractions,
    zones,
)
from reproduction.one_at_a_time import Outcome, end_of, outcome, table
from reproduction.runs import LAMPLUGH_BLOCKS
from reproduction.sentences import filled
from reproduction.study import ROOT, Job, Place, Study
from reproduction.tables import rewrapped, with_marks
from thawslide.run_folder import Run

CASE = ROOT / "cases" / "lamplugh"
# The valley extends to 24 km in every run, so that none leaves the domain. The engine ends a run at rest, by the mean
# velocity: some of these slides rest for half a minute and then move again.
COMMON = ("time.stop_at_rest=0", "terrain.extend=true", "grid.max=[24000.0, 2400.0]", "time.output_interval=10")
SPREAD = "n-weak10-phi20-k500"
LEFT = 120.0  # kPa: the case's residual cohesion
BASE = Job("case", "the case")
ONE = (
    ("Cohesion along the ground", (
        Job("cohesion-kept", "permanent cohesion of 0.6 MPa", ("basal.cohesion_law=constant",)),
        Job("cohesion-none-left", "no residual cohesion", ("basal.residual_cohesion=0.0",)),
        Job("cohesion-ice", "cohesion in proportion to the ice", ("basal.cohesion_law=ice",)),
        Job("cohesion-time", "cohesion lost at 40 s, to 0.12 MPa",
            ("basal.cohesion_law=time", "basal.cohesion_loss_time=40.0")),
        Job("clamp-joint", "excess pressure cancels cohesion", ("basal.clamp=joint",)),
        Job("clamp-joint-kept", "permanent 0.6 MPa, excess pressure cancels it",
            ("basal.clamp=joint", "basal.cohesion_law=constant")),
        Job("cap", "pressure limited to the normal stress", ("basal.cap_pressure=true",)),
    )),
    ("Pore pressure", (
        Job("no-advection", "seeping water carries no heat", ("heat.advection=false",)),
        Job("seepage-off", "no seepage", ("pressure.seepage=false",)),
        Job("h-vertical", "H along the vertical", ("pressure.thickness_direction=vertical",)),
        Job("h-frozen", "H as at t = 0", ("pressure.thickness_update=frozen",)),
        Job("volumetric", "with the volumetric term of Eq. 8", ("pressure.volumetric_term=true",)),
    )),
    ("Shear band and heat", (
        Job("first-layer", "xi on the first layer of cells", ("band.region=first_layer",)),
        Job("no-jump", "band 0.05 m thick throughout", ("band.thickness=0.05",)),
        Job("apparent", "apparent heat capacity", ("heat.update=apparent_capacity",)),
    )),
    ("Body", (
        Job("no-viscosity", "no viscosity", ("material.rock_ice.viscosity_time=0.0",)),
        Job("early-contact", "contact up to a cell early", ("basal.distance_check=false",)),
        Job("thick", "209,975 m2 of section, about 150 m thick", (), "thick-body.toml"),
        Job("effective", "effective stress inside", ("mechanics.effective_stress=true",)),
        Job("slope-shear", "slope shear in the initial stress", ("mechanics.slope_shear=true",)),
        Job("apic", "APIC transfer", ("mechanics.transfer=apic",)),
    )),
    ("Mechanisms", (
        Job("no-pressurization", "thermal pressurization off", (), "no-pressurization.toml"),
        Job("no-pore-pressure", "all pore pressure off", (), "no-pore-pressure.toml"),
        Job("no-lubrication", "lubrication off", ("mechanisms.lubrication=false",)),
        Job("no-softening", "softening off: 1.0 MPa inside", ("material.rock_ice.residual_cohesion=1.0e6",)),
        Job("no-deformation", "no yielding: elastic", ("mechanisms.deformation=false",)),
    )),
)  # fmt: skip

# The search is on cells of 20 m, at an eighth of the cost. The first row of each table is the case on these cells.
COARSE = ("grid.cell=20.0",)
RESIDUAL, DISTANCE = "basal.residual_cohesion", "basal.slip_distance"
SEEPS = "material.rock_ice.hydraulic_conductivity"
WEAK, INSIDE = "material.rock_ice.cohesion", "material.rock_ice.residual_cohesion"
GAPS = "material.rock_ice.gaps_close_first=true"  # weak bodies separate
ANGLE = "material.rock_ice.friction_angle"
NO_RESIDUAL = f"{RESIDUAL}=0.0"
SEARCH = (
    ("Residual cohesion", (
        Job("c050", "c_r 0.05 MPa", (f"{RESIDUAL}=5.0e4",)),
        Job("c075", "c_r 0.075 MPa", (f"{RESIDUAL}=7.5e4",)),
        Job("c100", "c_r 0.10 MPa", (f"{RESIDUAL}=1.0e5",)),
        Job("c175", "c_r 0.175 MPa", (f"{RESIDUAL}=1.75e5",)),
        Job("c250", "c_r 0.25 MPa", (f"{RESIDUAL}=2.5e5",)),
        Job("d200", "d_c 200 m", (f"{DISTANCE}=200.0",)),
        Job("d1500", "d_c 1,500 m", (f"{DISTANCE}=1500.0",)),
        Job("c100-d1500", "c_r 0.10 MPa, d_c 1,500 m", (f"{RESIDUAL}=1.0e5", f"{DISTANCE}=1500.0")),
    )),
    ("Friction alone, c_r 0", (
        Job("f", "as it is", (NO_RESIDUAL,)),
        Job("f-k7", "k_L 1e-7 m/s", (NO_RESIDUAL, f"{SEEPS}=1.0e-7")),
        Job("f-cap", "P limited to N", (NO_RESIDUAL, "basal.cap_pressure=true")),
        Job("f-e500", "e 0.5 m throughout", (NO_RESIDUAL, "band.thickness=0.5")),
        Job("f-e500-k200", "e 0.5 m throughout, k_L 2e-7 m/s", (NO_RESIDUAL, "band.thickness=0.5", f"{SEEPS}=2.0e-7")),
        Job("f-e500-k500", "e 0.5 m throughout, k_L 5e-7 m/s", (NO_RESIDUAL, "band.thickness=0.5", f"{SEEPS}=5.0e-7")),
        Job("f-e500-k1000", "e 0.5 m throughout, k_L 1e-6 m/s", (NO_RESIDUAL, "band.thickness=0.5", f"{SEEPS}=1.0e-6")),
        Job("f-e500-k6", "e 0.5 m throughout, k_L 2e-6 m/s", (NO_RESIDUAL, "band.thickness=0.5", f"{SEEPS}=2.0e-6")),
        Job("f-e200-k500", "e 0.2 m throughout, k_L 5e-7 m/s", (NO_RESIDUAL, "band.thickness=0.2", f"{SEEPS}=5.0e-7")),
        Job("f-e500-k5", "e 0.5 m throughout, k_L 1e-5 m/s", (NO_RESIDUAL, "band.thickness=0.5", f"{SEEPS}=1.0e-5")),
        Job("f-dry-melt", "no thermal pressurization", (NO_RESIDUAL, "pressure.thermal_pressurization=false")),
        Job("f-phi20", "phi_f 20 degrees, no thermal pressurization",
            (NO_RESIDUAL, "basal.friction_angle=20.0", "pressure.thermal_pressurization=false")),
    )),
    ("Seepage and band with the fitted cohesion", (
        Job("k7", "k_L 1e-7 m/s", (f"{SEEPS}=1.0e-7",)),
        Job("k5", "k_L 2e-5 m/s", (f"{SEEPS}=2.0e-5",)),
        Job("e350", "e 0.35 m throughout", ("band.thickness=0.35",)),
        Job("e500-k5", "e 0.5 m throughout, k_L 1e-5 m/s", ("band.thickness=0.5", f"{SEEPS}=1.0e-5")),
        Job("omega05", "lubrication exponent 0.5", ("basal.lubrication_exponent=0.5",)),
        Job("heat1", "all friction work heats", ("basal.heat_fraction=1.0",)),
    )),
    ("A body that spreads", (
        Job("inside10", "c_f 10 kPa inside", (f"{INSIDE}=1.0e4",)),
        Job("weak", "0.1 MPa inside from the start", (GAPS, f"{WEAK}=1.0e5", f"{INSIDE}=1.0e5")),
        Job("weak10", "10 kPa inside from the start", (GAPS, f"{WEAK}=1.0e4", f"{INSIDE}=1.0e4")),
        Job("weak10-phi20", "10 kPa and 20 degrees inside",
            (GAPS, f"{WEAK}=1.0e4", f"{INSIDE}=1.0e4", f"{ANGLE}=20.0")),
        Job("weak10-phi20-c075", "10 kPa and 20 degrees inside, c_r 0.075 MPa",
            (GAPS, f"{WEAK}=1.0e4", f"{INSIDE}=1.0e4", f"{ANGLE}=20.0", f"{RESIDUAL}=7.5e4")),
        Job("weak10-phi5", "10 kPa and 5 degrees inside", (GAPS, f"{WEAK}=1.0e4", f"{INSIDE}=1.0e4", f"{ANGLE}=5.0")),
        Job("weak10-phi20-k500", "10 kPa and 20 degrees inside, c_r 0, e 0.5 m throughout, k_L 5e-7 m/s",
            (GAPS, f"{WEAK}=1.0e4", f"{INSIDE}=1.0e4", f"{ANGLE}=20.0", NO_RESIDUAL, "band.thickness=0.5",
             f"{SEEPS}=5.0e-7")),
        Job("weak10-phi5-k500", "10 kPa and 5 degrees inside, c_r 0, e 0.5 m throughout, k_L 5e-7 m/s",
            (GAPS, f"{WEAK}=1.0e4", f"{INSIDE}=1.0e4", f"{ANGLE}=5.0", NO_RESIDUAL, "band.thickness=0.5",
             f"{SEEPS}=5.0e-7")),
        Job("weak10-effective", "10 kPa inside, effective stress",
            (GAPS, f"{WEAK}=1.0e4", f"{INSIDE}=1.0e4", "mechanics.effective_stress=true")),
    )),
)  # fmt: skip

# Selected runs of the search on the cells of the case, 10 m.
FINE = (
    Job("n-e500-k600", "c_r 0, e 0.5 m throughout, k_L 6e-7 m/s",
        (NO_RESIDUAL, "band.thickness=0.5", f"{SEEPS}=6.0e-7")),
    Job("n-e500-k1000", "c_r 0, e 0.5 m throughout, k_L 1e-6 m/s",
        (NO_RESIDUAL, "band.thickness=0.5", f"{SEEPS}=1.0e-6")),
    Job("n-c080", "c_r 0.08 MPa", (f"{RESIDUAL}=8.0e4",)),
    Job("n-weak10-phi20-k500", "10 kPa and 20 degrees inside, c_r 0, e 0.5 m throughout, k_L 5e-7 m/s",
        (GAPS, f"{WEAK}=1.0e4", f"{INSIDE}=1.0e4", f"{ANGLE}=20.0", NO_RESIDUAL, "band.thickness=0.5",
         f"{SEEPS}=5.0e-7")),
)  # fmt: skip


def searched() -> list[tuple[str, list[Job]]]:
    """Return the groups of the search, on coarse cells, the case first in each."""
    case = Job("case", "the case")
    return [
        (name, [Job(f"s-{row.key}", row.words, (*COARSE, *row.sets), row.case) for row in (case, *rows)])
        for name, rows in SEARCH
    ]


def every_row() -> list[Job]:
    """Return each run once."""
    one, search = ([row for _, rows in groups for row in rows] for groups in (ONE, searched()))
    return list({row.key: row for row in (BASE, *one, *FINE, *search)}.values())


def picture(found: dict[str, Outcome], path: Path) -> None:
    """Plot the effect of each assumption; mark runs that did not stop, did not start or failed."""
    rows = [BASE, *(row for _, rows in ONE for row in rows)]
    ends = [end_of(found[row.key]) for row in rows]
    results = [Outcome() if found[row.key].failure else found[row.key] for row in rows]
    quantities = (
        ("peak mean velocity (m/s)", [each.peak for each in results]),
        ("stop (s)", [each.stop_time for each in results]),
        ("mean displacement (km)", [each.displacement / 1e3 for each in results]),
        ("runout (km)", [each.runout / 1e3 for each in results]),
    )
    bars([row.words for row in rows], quantities, ends).savefig(path, dpi=150)


def blocks_table(run: Run) -> str:
    """Return the rigid blocks of the case as a table."""
    found = block_measures(run)
    header = "| run | safety factor at t = 0 | peak [m/s] | at [s] | stops at [s] | displacement [m] | set |"
    lines = [header, "|---" * 7 + "|"]
    for block in LAMPLUGH_BLOCKS:
        key = block.key.replace("-", "_")
        cells = [found[f"{key}_{name}"] for name in ("peak", "peak_time", "stop", "displacement")]
        numbers = f"{found[key + '_safety']:.3f} | {cells[0]:.1f} | {cells[1]:.0f} | {cells[2]:.0f} | {cells[3]:,.0f}"
        lines.append(f"| {block.words} | {numbers} | {' '.join(f'`{each}`' for each in block.sets)} |")
    return "\n".join(lines) + "\n"


def zones_table(run: Run, spread: Run | None) -> str:
    """Return the text on each zone and the deposit there, of the case and of a body that spreads."""
    shares, others = zone_fractions(run), zone_fractions(spread) if spread else {}
    header = (
        "| zone | text of the paper | assumed place [km] | volume [%] | mean thickness [m] "
        "| weak body: volume [%] | weak body: thickness [m] |"
    )
    lines = [header, "|---" * 7 + "|"]
    for zone in zones(run):
        share, thickness = shares[zone.letter]
        place = f"{zone.start / 1e3:.1f} to {zone.end / 1e3:.1f}"
        other = "{:.0f} | {:.1f}".format(*others[zone.letter]) if others else "not run |"
        lines.append(f"| {zone.letter} | {zone.text} | {place} | {share:.0f} | {thickness:.1f} | {other} |")
    return "\n".join(lines) + "\n"


def jobs(place: Place) -> list[Job]:
    """Return all runs; with --quick half a second of each on coarse cells."""
    short = (*COARSE, "time.end=0.5") if place.is_quick else ()
    rows = [replace(row, sets=(*COMMON, *row.sets, *short), until_rest=True, cost=cost_of(row)) for row in every_row()]
    return [*rows, *(replace(block, case="case.toml") for block in LAMPLUGH_BLOCKS)]


def cost_of(row: Job) -> float:
    """Return the relative run time: coarse cells take an eighth."""
    return 0.125 if COARSE[0] in row.sets else 1.0


def write(place: Place) -> None:
    """Write the page and its figures from existing runs."""
    found = {row.key: outcome(place.runs / row.key) for row in every_row()}
    figures = place.page("cases/lamplugh/figures/assumptions.png").parent
    run = Run(place.runs / BASE.key)
    picture(found, figures / "assumptions.png")
    figure_blocks({"lamplugh": run}).savefig(figures / "block.png", dpi=150)
    figure_deposit({"lamplugh": run}).savefig(figures / "deposit.png", dpi=150)
    spread = Run(place.runs / SPREAD) if (place.runs / SPREAD / "run.json").is_file() else None
    figure_deposit({"lamplugh": spread or run}).savefig(figures / "deposit-spread.png", dpi=150)
    numbers = {
        f"{key}_{name}".replace("-", "_"): value
        for key, each in found.items()
        for name, value in vars(each).items()
        if name != "failure"
    }
    traction = base_traction(run)
    numbers |= block_measures(run) | {
        "traction": traction,
        "traction_share": 100.0 * traction / LEFT,
        "near_start": near_ground(run, 0.0),
        "near_end": near_ground(run, 120.0),
    }
    parts = {
        "one": "\n".join(f"### {name}\n\n{table((BASE, *rows), found)}" for name, rows in ONE),
        "fine": table((BASE, *FINE), found),
        "search": "\n".join(f"### {name}\n\n{table(rows, found, COARSE)}" for name, rows in searched()),
        "program": f"version {run.facts.get('version')}, commit {run.facts.get('commit')}",
        "blocks": blocks_table(run),
        "zones": zones_table(run, spread),
    }
    text = filled((CASE / "assumptions.txt").read_text(encoding="utf-8"), numbers)
    text = with_marks(text, {name: part.strip() for name, part in parts.items()})
    place.page("cases/lamplugh/assumptions.md").write_text(rewrapped(text), encoding="utf-8")


STUDY = Study(
    "assumptions", ("cases/lamplugh/assumptions.md",), 120.0, write, (jobs,), cases=CASE, tolerates_failures=True
)
