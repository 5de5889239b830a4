"""Mistakes of new users with the complete messages, beyond those that tests/cpp/config compares as a whole."""

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

# Blocks of: name; one change of the small case (OLD -> NEW), options, or files (NAME: TEXT), where | is a new line; the
# message, of which each LINE:COLUMN follows the path of the case file. {case} is its folder.
MISTAKES = """
a key misspelt
  youngs_modulus -> young_modulus
    19:1: key 'material.rock.youngs_modulus' is missing: it is needed when mechanics.enabled is true. Add
    'youngs_modulus = ...' to [material.rock]: Young's modulus, a number, > 0 [Pa].
    21:1: key 'material.rock.young_modulus' is not known in [material.rock]; did you mean 'youngs_modulus'? Allowed
    here: law, youngs_modulus, poisson_ratio, friction_angle, dilation_angle, cohesion, residual_cohesion,
    residual_friction_angle, softening_strain, softening_slip, tension_cutoff, gaps_close_first, viscosity_number,
    viscosity_time, hydraulic_conductivity.

a fraction in percent
  porosity = 0.3 -> porosity = 30
    32:12: body.block.porosity is 30; allowed: > 0 and <= 0.95 (porosity n at t = 0: volume fraction of ice and water);
    if it is in percent, it is 0.3. Correct it, or leave it out for the default 0.375.

a temperature in kelvin
  temperature = -10.0 -> temperature = 263.15
    31:15: body.block.temperature is 263.15; allowed: > -273.15 and <= 100 C (temperature at t = 0; depth is vertical,
    below the surface of the body [m]); if it is in kelvin, it is -10 C. Correct it, or leave it out for the default
    -10.0.

a body without a name
  [body.block] -> [body]
    26:1: the case has no body; add a table [body.NAME] with its material and shape.
    27:1: 'material' stands in [body], which needs a name; write [body.NAME] with a name of your choice above it.
    28:1: 'shape' stands in [body], which needs a name; write [body.NAME] with a name of your choice above it.
    29:1: 'min' stands in [body], which needs a name; write [body.NAME] with a name of your choice above it.
    30:1: 'max' stands in [body], which needs a name; write [body.NAME] with a name of your choice above it.
    31:1: 'temperature' stands in [body], which needs a name; write [body.NAME] with a name of your choice above it.
    32:1: 'porosity' stands in [body], which needs a name; write [body.NAME] with a name of your choice above it.

a file that does not exist
  type = "flat"|elevation = 0.0 -> type = "profile"|file = "profil.csv"
  profile.csv: distance_m,terrain_elevation_m|0,0|20,0|
    17:8: terrain.file is "profil.csv": no such file ({case}); did you mean 'profile.csv'? Allowed: a file, relative to
    the folder of the case file.

a decimal comma in quotes
  cell = 1.0 -> cell = "1,5"
    11:8: grid.cell is the text "1,5"; allowed: a number, > 0 [m]; write a decimal point: 1.5.

decimal commas in an array
  min = [0.0, -2.0] -> min = [0,0, -2,0]
    12:7: grid.min is an array of 4 numbers; allowed: 2 numbers, as case.dimension is 2. Write decimal points, not
    commas.

a decimal comma of an option
  --set grid.cell=1,5
    --set grid.cell=1,5: grid.cell is the text "1,5"; allowed: a number, > 0 [m]; write a decimal point: 1.5.

a key without effect
  --set body.block.taper=5
    --set body.block.taper=5: body.block.taper has a meaning only when the shape is "release". Remove it, or change
    body.block.shape.

an option without a value
  --set time.end
    --set time.end: allowed: TABLE.KEY=VALUE, for example --set band.thickness=0.1.

a particle faster than the step allows
  --set 'body.block.velocity=[1000.0,0.0]'
    6:8: time.step is 0.001 s, above the limit of 0.0005 s set by the particle speed of 1,000 m/s. Use a smaller
    time.step, or time.stepping = "adaptive".
    warning: --set body.block.velocity=[1000.0,0.0]: body.block.velocity is 1000 m/s; plausible: 0.001 to 120 m/s. If it
    is in mm/s, it is 1 m/s; in cm/s, it is 10 m/s; in m/h, it is 0.2778 m/s; in m/day, it is 0.01157 m/s.
"""


@dataclass(frozen=True)
class Mistake:
    """One change of a valid case, and the message."""

    name: str
    changes: list[str]  # of the case file, as OLD -> NEW
    words: list[str]  # options of the command
    files: dict[str, str]
    text: str

    def write(self, case: str, folder: Path) -> None:
        """Write the case with the mistake; `case`: conftest.SMALL_CASE."""
        for change in self.changes:
            old, _, new = change.partition(" ->")
            assert case.count(old) == 1, self.name
            case = case.replace(old, new.removeprefix(" "))
        for name, text in ({"case.toml": case} | self.files).items():
            (folder / name).write_text(text)

    def message(self, folder: Path) -> str:
        """Return the complete message about the case in a folder."""
        lines = re.sub(r"(?:^| )(\d+:\d+: |(?:warning: )?--set \S+=\S+: )", r"\n\1", self.text).strip()
        located = re.sub(r"^(?=\d+:\d+: )", "{case}/case.toml:", lines, flags=re.MULTILINE)
        return f"error: {located}\n".replace("{case}", str(folder))


def parsed(block: str) -> Mistake:
    """Return the mistake of a block."""
    name, *lines = block.splitlines()
    given = [line[2:].replace("|", "\n") for line in lines if line[2] != " "]
    changes = [line for line in given if " ->" in line]
    words = [word for line in given if line.startswith("--") for word in shlex.split(line)]
    files = dict(re.split(": ?", line, maxsplit=1) for line in given if " ->" not in line and line[:2] != "--")
    return Mistake(name, changes, words, files, " ".join(line.strip() for line in lines if line[2] == " "))


CASES = [parsed(block) for block in MISTAKES.strip().split("\n\n")]
