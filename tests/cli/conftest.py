"""Fixtures that run the program: its start, a small case, and readers of its output."""

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import rasterio
from terrain_files import SOUTH, THICKNESS, WEST, toml, write_rectangle, write_slope

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT))  # of the package reproduction
LAMPLUGH = ROOT / "cases" / "lamplugh"
PIPES = {"text": True, "stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
HANG = 600.0  # s: a process that takes longer hangs; a busy machine reaches no such time

# A block that rests on flat ground: a valid case with 48 particles.
SMALL_CASE = toml("""
[case] title = "Block on flat ground"
[time] end = 0.2 | step = 0.001 | output_interval = 0.05 | history_interval = 0.01
[grid] cell = 1.0 | min = [0.0, -2.0] | max = [20.0, 10.0]
[terrain] type = "flat" | elevation = 0.0
[material.rock] law = "mohr_coulomb" | youngs_modulus = 1.0e8 | poisson_ratio = 0.2 | friction_angle = 35.0
  cohesion = 1.0e5
[body.block] material = "rock" | shape = "box" | min = [10.0, 0.0] | max = [14.0, 3.0] | temperature = -10.0
  porosity = 0.3
[basal] friction_angle = 10.0 | cohesion = 0.0
""")

# The small case fails in its first steps.
FALL = {
    "time__step": 0.004, "case__gravity": 1e5, "mechanics__initial_stress": '"none"', "body__block__min": "[10,4]",
    "body__block__max": "[14,8]",
}  # fmt: skip
PROFILE = "distance_m,terrain_elevation_m\n0,0\n20,0\n"

# Tests in the background of a shell ignore SIGINT, and the programs that they start would inherit it.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

Outcome = subprocess.CompletedProcess[str]
Interrupted = Callable[[Path, Path, list[str], int, int], int]
Ran = Callable[..., Path]


class Program:
    """The program: called with arguments, it runs and returns its outcome."""

    def __init__(self, binary: Path, environment: dict[str, str]) -> None:
        self.binary, self.environment = binary, environment

    def __call__(self, *words: object, environment: Any = None, folder: Path | None = None) -> Outcome:
        """Run the program; return its outcome."""
        return self.finish([self.binary, *words], env=environment or self.environment, cwd=folder)

    def ok(self, *words: object, **more: Any) -> str:
        """Run the program, which must succeed, and return its output."""
        outcome = self(*words, **more)
        assert outcome.returncode == 0, outcome.stderr
        return outcome.stdout

    def error(self, *words: object, code: int = 2, quiet: bool = False, **more: Any) -> str:
        """Run the program, which must fail with an exit code and an error, and return the error.

        `quiet`: it prints nothing else.
        """
        outcome = self(*words, **more)
        assert outcome.returncode == code, outcome.stderr
        assert outcome.stderr.startswith("error: ") and (not quiet or outcome.stdout == ""), outcome
        return outcome.stderr

    def json(self, *words: object, **more: Any) -> dict[str, Any]:
        """Run a command with --json, which must succeed, and return what it reports."""
        reported: dict[str, Any] = json.loads(self.ok(*words, "--json", **more))
        return reported

    def shell(self, script: str, *words: object, **more: Any) -> Outcome:
        """Run the program with arguments as `"$@"` of a shell's script."""
        return self.finish(["bash", "-c", script, "bash", self.binary, *words], **more)

    def start(self, *words: object, **more: Any) -> subprocess.Popen[str]:
        """Start the program in the background; its output goes to pipes."""
        command = [str(self.binary), *map(str, words)]
        return subprocess.Popen(command, **{"env": self.environment, **PIPES, **more})

    def finish(self, command: list[object], **more: Any) -> Outcome:
        """Run a command to its end."""
        return subprocess.run(list(map(str, command)), **{"env": self.environment, "timeout": HANG, **PIPES, **more})


@pytest.fixture(scope="session")
def binary() -> Path:
    path = ROOT / os.environ.get("THAWSLIDE_BINARY", "build/release/thawslide")
    if not path.is_file():
        pytest.skip(f"program not found: {path}. Build it, or set THAWSLIDE_BINARY.")
    return path


@pytest.fixture(scope="session")
def plain_environment() -> dict[str, str]:
    environment = dict(os.environ)
    folders = environment.get("PATH", "/usr/bin:/bin").split(os.pathsep)
    environment["PATH"] = os.pathsep.join(each for each in folders if not shutil.which("thawslide-report", path=each))
    return environment


@pytest.fixture(scope="session")
def report_environment(plain_environment: dict[str, str]) -> dict[str, str]:
    folder = str(Path(sys.executable).parent)
    if not shutil.which("thawslide-report", path=folder):
        pytest.skip(f"thawslide-report not found in {folder}. Run ./run --setup.")
    return plain_environment | {"PATH": folder + os.pathsep + plain_environment["PATH"], "MPLBACKEND": "Agg"}


@pytest.fixture(scope="session")
def thawslide(binary: Path, plain_environment: dict[str, str]) -> Program:
    return Program(binary, plain_environment)


@pytest.fixture(scope="session")
def interrupted(thawslide: Program) -> Interrupted:
    """Return a function that runs a case, sends a signal at a percentage, and returns the exit code."""

    def start(case: Path, run: Path, words: list[str], number: int, percent: int) -> int:
        with thawslide.start("run", case, "--output", run, *words) as process:
            assert process.stdout
            for line in process.stdout:
                progress = line.split("%")[0].strip()
                if "%" in line and progress.isdigit() and int(progress) >= percent:
                    process.send_signal(number)
                    break
            process.communicate(timeout=HANG)
            return process.returncode

    return start


@pytest.fixture
def small_case(tmp_path: Path) -> Path:
    folder = tmp_path / "small"
    folder.mkdir()
    (folder / "case.toml").write_text(SMALL_CASE)
    return folder


@pytest.fixture(scope="session")
def finished(thawslide: Program, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a finished run of the small case, of 0.2 s. Tests change copies of it."""
    folder = tmp_path_factory.mktemp("finished")
    (folder / "case.toml").write_text(SMALL_CASE)
    thawslide.ok("run", folder / "case.toml", "--output", folder / "run")
    return folder / "run"


@pytest.fixture
def ran(thawslide: Program, finished: Path, small_case: Path, tmp_path: Path) -> Ran:
    """Return a function that runs a case, by default the small one, and returns the folder of its run."""

    def run(*words: object, case: Path = small_case, name: str = "run") -> Path:
        if case == small_case and (case / "case.toml").read_text() == SMALL_CASE and not words:
            return Path(shutil.copytree(finished, tmp_path / name))
        thawslide.ok("run", case, "--output", tmp_path / name, *words)
        return tmp_path / name

    return run


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """Return the path of the folder of a run, which does not exist yet."""
    return tmp_path / "run"


@pytest.fixture
def done(ran: Ran) -> Path:
    return ran()


@pytest.fixture
def killed(done: Path) -> Path:
    """Return the folder of such a run that was killed after its last checkpoint."""
    mark_killed(done)
    return done


class Slope:
    """A slope as a DEM with a release in a folder, of which `thawslide new` makes cases."""

    def __init__(self, thawslide: Program, folder: Path) -> None:
        self.thawslide, self.folder = thawslide, folder
        self.case = folder / "slide"

    def __call__(self, name: str = "dem.tif", **words: Any) -> Path:
        """Write the DEM."""
        return write_slope(self.folder / name, **words)

    def release(self) -> Path:
        """Return a rectangle in the middle of the slope; write it if it does not exist."""
        file = self.folder / "release.geojson"
        return file if file.exists() else write_rectangle(file, WEST + 200.0, SOUTH + 250.0)

    def words(
        self, *words: object, folder: Path | None = None, dem: Path | None = None, release: Path | None = None,
        thickness: object = THICKNESS,
    ) -> list[object]:  # fmt: skip
        """Return the arguments of `thawslide new`."""
        dem = dem or (self.folder / "dem.tif" if (self.folder / "dem.tif").exists() else self())
        thick = [] if thickness is None else ["--thickness", thickness]
        return ["new", folder or self.case, "--dem", dem, "--release", release or self.release(), *thick, *words]

    def new(self, *words: object, text: bool = True, **more: Any) -> Outcome:
        """Create a case; return the outcome, with text or with bytes."""
        return self.thawslide.finish([self.thawslide.binary, *self.words(*words, **more)], text=text)

    def ok(self, *words: object, **more: Any) -> str:
        """Create a case; return the output."""
        return self.thawslide.ok(*self.words(*words, **more))

    def error(self, *words: object, **more: Any) -> str:
        """Fail unless `new` is refused and writes nothing; return the error without the folder of the test."""
        written = self.words(*words, **more)
        before = set(self.folder.rglob("*"))
        message = self.thawslide.error(*written)
        assert set(self.folder.rglob("*")) == before
        return message.replace(f"{self.folder}/", "")


@pytest.fixture
def slope(thawslide: Program, tmp_path: Path) -> Slope:
    return Slope(thawslide, tmp_path)


def sets(**values: object) -> list[str]:
    """Return options --set; two underscores represent the dot: time__end=1."""
    return [word for key, value in values.items() for word in ("--set", f"{key.replace('__', '.')}={value}")]


def edit(file: Path, old: str, new: str) -> Path:
    """Replace a text that a file contains once; return the file."""
    text = file.read_text()
    assert text.count(old) == 1, old
    file.write_text(text.replace(old, new))
    return file


def with_profile(case: Path, profile: str = PROFILE, name: str = "profile.csv") -> Path:
    edit(case / "case.toml", 'type = "flat"\nelevation = 0.0', f'type = "profile"\nfile = "{name}"')
    (case / name).write_text(profile)
    return case / name


def mark_killed(run: Path) -> None:
    """Set run.json to that of a run whose process was killed."""
    edit(run / "run.json", '"status": "done"', '"status": "running"')


def run_facts(run: Path) -> dict[str, Any]:
    facts: dict[str, Any] = json.loads((run / "run.json").read_text())
    return facts


def content_of(run: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in run.rglob("*") if path.is_file()}


def columns_of(file: Path) -> dict[str, np.ndarray]:
    """Return the columns of a table without its comments; fail if a field is not a number."""
    lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    header, *rows = csv.reader(lines)
    return dict(zip(header, np.array(rows, dtype=float).T, strict=True))


def history(run: Path) -> dict[str, np.ndarray]:
    return columns_of(run / "history.csv")


def release_volume(run: Path) -> float:
    """Return the volume of the release in the maps of a run [m3]."""
    with rasterio.open(run / "maps" / "release.tif") as file:
        return float(file.read(1, masked=True).sum()) * abs(file.transform.determinant)


def snapshot_files(run: Path) -> list[Path]:
    return sorted((run / "snapshots").glob("[0-9]*.vtkhdf"))


def datasets(file: Path) -> dict[str, np.ndarray]:
    found: dict[str, np.ndarray] = {}

    def collect(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset):
            found[name] = item[()]

    with h5py.File(file) as opened:
        opened.visititems(collect)
    return found


def assert_identical(one: Path, other: Path) -> None:
    assert (one / "history.csv").read_bytes() == (other / "history.csv").read_bytes()
    names = [file.name for file in snapshot_files(one)]
    assert names == [file.name for file in snapshot_files(other)]
    for name in names:
        first, second = (datasets(one / "snapshots" / name), datasets(other / "snapshots" / name))
        assert first.keys() == second.keys()
        for key, values in first.items():
            assert values.dtype == second[key].dtype and values.shape == second[key].shape, f"{name}: {key}"
            assert values.tobytes() == second[key].tobytes(), f"{name}: {key}"
