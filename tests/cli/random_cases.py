"""Random valid cases: any terrain, release, path, probes and domain. The program may refuse them with a message.

`RANDOM_CASES=FIRST:LAST pytest tests/cli/cases_test.py -k random` tests these seeds, and keeps their folders.
"""

import os
import resource
import signal
import subprocess
from pathlib import Path

import numpy as np
from terrain_files import CRS_NAME, EAST, NORTH, place, toml, turn_rows, write_line, write_raster, write_release

Generator = np.random.Generator
Corners = list[tuple[float, float]]
Commands = list[list[str]]
EXPECTED_CODES = {0, 2, 3, -signal.SIGXCPU}  # done, refused, a run that failed with a message, and one cut off
LONGEST = 60  # s of processor time of one command, which is then ended
FEW_THREADS = {"OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive"}

MATERIAL = toml("""
[material.rock] law = "{law}" | youngs_modulus = 5.0e7 | poisson_ratio = 0.2 | friction_angle = 32.0
  cohesion = 1.0e3 | viscosity_time = 0.02 | hydraulic_conductivity = 1.0e-6
""")
DRY = toml("""
[basal] friction = "constant" | friction_angle = {angle:.3g}
[heat] enabled = false
[pressure] enabled = false
""")
MELTING = toml("""
[basal] friction = "lubricated" | friction_angle = {angle:.3g}
[band] thickness = 0.1
""")
TIMES = toml("""
[case] title = "random" | dimension = {dimension} | gravity_tilt = {tilt:.4g}
[time] end = {end:.4g} | stepping = "adaptive" | output_interval = {end:.4g} | history_interval = 0.01
""")


def _physics(random: Generator) -> str:
    law = random.choice(["elastic", "mohr_coulomb"])
    base = random.choice([DRY, MELTING])
    return MATERIAL.format(law=law) + base.format(angle=random.uniform(2.0, 40.0))


def _chance(random: Generator, share: float) -> bool:
    return bool(random.random() < share)


# Elevations [m] of a slope from its highest point downward, with many variations.
def _relief(random: Generator, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    length = max(np.ptp(x), np.ptp(y))
    azimuth = random.choice([0.0, 0.5, 1.0, 1.5, random.uniform(0.0, 2.0)]) * np.pi
    along, across = x * np.cos(azimuth) + y * np.sin(azimuth), y * np.cos(azimuth) - x * np.sin(azimuth)
    across = across - np.mean(across)
    fall = random.choice([0.0, random.uniform(0.05, 1.5)])
    foot = np.quantile(along, random.uniform(0.2, 1.0))
    beyond = random.uniform(-1.0, 0.3)
    heights = 1000.0 - fall * np.minimum(along, foot) - beyond * np.maximum(0.0, along - foot)
    sides = random.choice([0.0, random.uniform(-0.5, 1.5)])
    heights = heights + sides * np.where(_chance(random, 0.5), np.abs(across), across**2 / length)
    return heights + random.choice([0.0, random.uniform(0.0, 3.0)]) * random.standard_normal(x.shape)


def _write_raster(file: Path, values: np.ndarray, cell: float, south_up: bool) -> None:
    """Write a raster; rows of the values are from the south."""
    write_raster(file, values[::-1], EAST, NORTH, cell, CRS_NAME, -9999.0)
    if south_up:
        turn_rows(file)


def _place_near(random: Generator, size: tuple[float, float], share: float) -> tuple[float, float]:
    """Return a position on the DEM, or with a probability `share` possibly one slightly outside."""
    margin = 0.3 if _chance(random, share) else -0.1
    return tuple(float(random.uniform(-margin * side, (1.0 + margin) * side)) for side in size)  # type: ignore[return-value]


def _polygon(random: Generator, centre: tuple[float, float], radius: float, points_apart: float) -> Corners:
    """Return a ring around a centre: star-shaped, or a rectangle along the points, in either direction."""
    if _chance(random, 0.3):
        sides = [points_apart * max(1.0, round(random.uniform(0.5, 1.0) * radius / points_apart)) for _ in range(2)]
        x, y = (points_apart * round(c / points_apart) for c in centre)
        square = [(x - sides[0], y - sides[1]), (x + sides[0], y - sides[1]), (x + sides[0], y + sides[1])]
        return [*square, (x - sides[0], y + sides[1])][:: int(random.choice([-1, 1]))]
    angles = np.sort(random.uniform(0.0, 2.0 * np.pi, random.integers(3, 9)))
    angles = angles if np.diff(angles, append=angles[0] + 2.0 * np.pi).max() < np.pi else np.array([0.3, 2.4, 4.5])
    radii = radius * random.uniform(0.4, 1.0, angles.size)
    ring = [(centre[0] + r * np.cos(a), centre[1] + r * np.sin(a)) for r, a in zip(radii, angles, strict=True)]
    return ring if _chance(random, 0.5) else ring[::-1]


def _line(random: Generator, size: tuple[float, float], centre: tuple[float, float], points_apart: float) -> Corners:
    """Return a line with any start, in most cases through the release; it may turn back."""
    corners = [_place_near(random, size, 0.2) for _ in range(random.integers(1, 5))]
    if _chance(random, 0.7):
        corners.insert(int(random.integers(0, len(corners) + 1)), centre)
    if _chance(random, 0.4):  # along a row or column of points, or halfway between two
        step, axis = 0.5 * points_apart, int(random.integers(0, 2))
        first = [step * round(c / step + random.integers(-20, 21) * (a == axis)) for a, c in enumerate(centre)]
        last = list(first)
        last[axis] = step * random.integers(1, int(size[axis] / step))
        corners = [(first[0], first[1]), (last[0], last[1])]
    corners = corners if len(corners) > 1 else [*corners, _place_near(random, size, 0.2)]
    return _degenerate(random, corners) if _chance(random, 0.15) else corners


def _degenerate(random: Generator, corners: Corners) -> Corners:
    """Return a line of no length, one with a repeated corner, or one that returns along itself."""
    kind, at = int(random.integers(0, 3)), int(random.integers(0, len(corners)))
    if kind == 0:
        return [corners[0]] * 2
    return [*corners[:at], corners[at], *corners[at:]] if kind == 1 else [*corners, *corners[-2::-1]]


def _in_space(random: Generator, folder: Path, commands: Commands) -> str:
    columns, rows = (int(n) for n in random.integers(12, 50, 2))
    points_apart = float(random.choice([1.0, 5.0, 10.0, random.uniform(1.0, 20.0)]))
    size = (columns * points_apart, rows * points_apart)
    middles = [(np.arange(n) + 0.5) * points_apart for n in (columns, rows)]
    heights = _relief(random, *np.meshgrid(*middles))
    if _chance(random, 0.2):
        row, column = random.integers(0, rows), random.integers(0, columns)
        heights[row : row + 3, column : column + 3] = -9999.0
    known = heights[heights > -9000.0]
    south_up = _chance(random, 0.3)
    _write_raster(folder / "dem.tif", heights, points_apart, south_up)
    radius = random.uniform(0.1, 0.3) * min(size)
    middle = 0.0 if _chance(random, 0.05) else 1.1 * radius + 2.5 * points_apart  # from the edge of the domain
    centre = tuple(float(random.uniform(middle, side - middle)) if side > 2.0 * middle else side / 2.0 for side in size)
    write_line(folder / "line.geojson", _line(random, size, centre, points_apart))
    cell = radius / random.uniform(3.0, 9.0)
    thickness = random.uniform(0.9, 4.0) * cell
    ring = _polygon(random, centre, radius, points_apart)
    write_release(folder / "release.geojson", ring)
    body = f'release = "release.geojson" | thickness = {thickness:.6g}'
    if _chance(random, 0.3):
        x, y = np.meshgrid(*middles)
        inside = np.hypot(x - centre[0], y - centre[1]) < radius
        values = np.where(inside, thickness * random.uniform(0.2, 1.0, inside.shape), 0.0)
        _write_raster(folder / "thickness.tif", values, points_apart, _chance(random, 0.3))
        body = 'thickness = { raster = "thickness.tif" }'
    inset = [random.uniform(0.5, 2.0 if _chance(random, 0.9) else 0.4 * min(columns, rows)) for _ in range(4)]
    lower = [EAST + inset[0] * points_apart, NORTH + inset[1] * points_apart, known.min() - 5.0 * cell]
    sides = [size[0] - (inset[0] + inset[2]) * points_apart, size[1] - (inset[1] + inset[3]) * points_apart]
    cells = [max(1.0, np.floor(side / cell)) for side in sides]
    cells.append(np.ceil((np.ptp(known) + thickness) / cell) + 12.0)
    upper = [low + n * cell for low, n in zip(lower, cells, strict=True)]
    numbers = [", ".join(f"{value:.17g}" for value in corner) for corner in (lower, upper)]
    text = toml(f"""
[grid] cell = {cell:.17g} | min = [{numbers[0]}] | max = [{numbers[1]}]
  leaving = "{random.choice(["stop", "remove"])}"
[terrain] type = "dem" | file = "dem.tif"
[body.slide] material = "rock" | shape = "release" | {body} | placement = "{random.choice(["on_top", "cut"])}"
  taper = {random.choice([0.0, random.uniform(0.0, 0.5) * radius]):.6g} | temperature = -1.0
""")
    if _chance(random, 0.3):
        text += f"velocity = [{', '.join(f'{v:.4g}' for v in random.uniform(-15.0, 15.0, 3))}]\n"
    if _chance(random, 0.8):
        text += f'[maps]\npath = "line.geojson"\n{"cell = %.6g" % (2.0 * cell) if _chance(random, 0.2) else ""}\n'
    for number in range(random.integers(0, 3)):
        corner = place(*_place_near(random, size, 0.1))
        name = f"across{number}.geojson"
        section = [_place_near(random, size, 0.1) for _ in range(random.integers(2, 4))]
        write_line(folder / name, _degenerate(random, section) if _chance(random, 0.15) else section)
        value = f'line = "{name}"' if _chance(random, 0.6) else f"point = [{corner[0]:.17g}, {corner[1]:.17g}]"
        text += f"[probe.p{number}]\n{value}\n"
    maps = ["--dem", f"{folder}/dem.tif", "--release", f"{folder}/release.geojson", "--thickness", f"{thickness:.6g}"]
    maps.append(str(random.choice(["--cut", "--on-top"])))
    commands.append(["section", f"{folder}/section", *maps, "--line", f"{folder}/line.geojson"])
    if _chance(random, 0.3):
        commands.append(["new", f"{folder}/new", *maps])
    return text


def _in_plane(random: Generator, folder: Path) -> str:
    length = random.uniform(100.0, 1000.0)
    count = int(random.integers(2, 60))
    x = np.sort(random.uniform(0.0, length, count))
    x = np.unique(np.round(np.concatenate([[0.0, length], x]), 3))
    if _chance(random, 0.1):  # two points that nearly coincide
        x = np.sort(np.append(x, x[-1] - 10.0 ** random.uniform(-13.0, -3.0)))
    heights = _relief(random, x, np.zeros_like(x))
    begin, end = np.sort(random.uniform(0.05 * length, 0.95 * length, 2))
    thickness = random.uniform(0.02, 0.1) * length
    surface = heights + np.where((x > begin) & (x < end), thickness, 0.0)
    rows = [f"{a:.17g},{b:.17g},{c:.17g}" for a, b, c in zip(x, heights, surface, strict=True)]
    header = "distance_m,terrain_elevation_m,surface_elevation_m"
    (folder / "profile.csv").write_text("\n".join([header, *rows]) + "\n")
    cell = max(thickness / random.uniform(1.0, 6.0), length / 200.0)
    lowest, cells = heights.min() - 5.0 * cell, np.floor(length / cell)
    up = np.ceil((np.ptp(heights) + thickness) / cell) + 12.0
    middle = random.uniform(0.1, 0.9) * length
    below = np.append(np.linspace(middle, middle + 5.0 * cell, 50), np.clip(x, middle, middle + 5.0 * cell))
    floor = float(np.interp(below, x, heights).max())
    box = f"min = [{middle:.6g}, {floor:.6g}] | max = [{middle + 5.0 * cell:.6g}, {floor + thickness:.6g}]"
    body = random.choice(['shape = "surface"', f'shape = "box" | {box}'])
    ground = random.choice(
        [
            'type = "profile" | file = "profile.csv"',
            f'type = "plane" | elevation = {floor:.6g} | slope = {random.uniform(-40.0, 40.0):.4g}',
            f'type = "flat" | elevation = {floor:.6g}',
        ],
        p=[0.7, 0.15, 0.15],
    )
    return toml(f"""
[grid] cell = {cell:.17g} | min = [0.0, {lowest:.17g}] | max = [{cells * cell:.17g}, {lowest + up * cell:.17g}]
  leaving = "{random.choice(["stop", "remove"])}"
[terrain] {ground}
[body.slide] material = "rock" | {body} | temperature = -1.0
  velocity = [{random.choice([0.0, random.uniform(-10.0, 10.0)]):.4g}, 0.0]
""")


def draw(seed: int, folder: Path) -> Commands:
    """Write the case of a seed, and return the commands to be tested on it."""
    random = np.random.default_rng(seed)
    folder.mkdir(parents=True)
    commands: Commands = []
    in_space = _chance(random, 0.7)
    tilt = 0.0 if _chance(random, 0.85) else random.uniform(-30.0, 30.0)
    times = TIMES.format(dimension=3 if in_space else 2, tilt=tilt, end=random.uniform(0.02, 0.2))
    text = _in_space(random, folder, commands) if in_space else _in_plane(random, folder)
    (folder / "case.toml").write_text(times + text + _physics(random))
    return [
        *commands, ["check", f"{folder}"], ["block", f"{folder}"],
        ["block", f"{folder}", "--set", "time.end=20", "--output", f"{folder}/block.csv"],
        ["run", f"{folder}", "--output", f"{folder}/run", "--threads", "1"],
    ]  # fmt: skip


def exit_code(program: Path, words: list[str]) -> int:
    """Run a command; return its exit code. Fail unless it succeeds, is refused, or fails with a message."""
    done = subprocess.run(
        [str(program), *words], env=os.environ | FEW_THREADS, stdin=subprocess.DEVNULL, capture_output=True,
        text=True, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST + 5)),
        timeout=10 * LONGEST, check=False,
    )  # fmt: skip
    is_expected = done.returncode in EXPECTED_CODES and "internal error" not in done.stderr
    assert is_expected, f"{' '.join(words)}: exit code {done.returncode}: {done.stderr.strip()[-2000:]}"
    return done.returncode
