"""The most common mistakes of new users, with the complete messages.

Used by mistakes_test.py.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class CommonMistake:
    """One change of a valid case, and the message, in which {case} is its folder."""

    name: str
    old: str
    new: str
    message: str
    files: dict[str, str] = field(default_factory=dict)

    def write(self, valid_case: str, folder: Path) -> None:
        """Write the case with the mistake; `valid_case`: conftest.SMALL_CASE."""
        assert valid_case.count(self.old) == 1, self.name
        (folder / "case.toml").write_text(valid_case.replace(self.old, self.new))
        for name, text in self.files.items():
            (folder / name).write_text(text)


COMMON_MISTAKES = [
    CommonMistake(
        name="a key misspelt",
        old="youngs_modulus",
        new="young_modulus",
        message=(
            "error: {case}/case.toml:19:1: key 'material.rock.youngs_modulus' is missing: it is needed when "
            "mechanics.enabled is true. Add 'youngs_modulus = ...' to [material.rock]: Young's modulus, a "
            "number, > 0 [Pa].\n"
            "{case}/case.toml:21:1: key 'material.rock.young_modulus' is not known in [material.rock]; did "
            "you mean 'youngs_modulus'? Allowed here: law, youngs_modulus, poisson_ratio, friction_angle, "
            "dilation_angle, cohesion, residual_cohesion, residual_friction_angle, softening_strain, "
            "softening_slip, tension_cutoff, gaps_close_first, viscosity_time, hydraulic_conductivity.\n"
        ),
    ),
    CommonMistake(
        name="a key left out",
        old="step = 0.001\n",
        new="",
        message=(
            "error: {case}/case.toml:4:1: key 'time.step' is missing: it is needed when time.stepping is "
            "\"fixed\". Add 'step = ...' to [time]: fixed time step, or upper limit of the adaptive time "
            "step, a number, > 0 [s].\n"
        ),
    ),
    CommonMistake(
        name="a key in the wrong table",
        old="elevation = 0.0",
        new="elevation = 0.0\nporosity = 0.3",
        message=(
            "error: {case}/case.toml:18:1: key 'terrain.porosity' is not known in [terrain]; it belongs in "
            "[body.NAME] or [bed]. Allowed here: type, elevation, slope, file, extend, representation, "
            "layers, crs, resample, smooth.\n"
        ),
    ),
    CommonMistake(
        name="a number in quotes",
        old="end = 0.2",
        new='end = "0.2"',
        message=(
            'error: {case}/case.toml:5:7: time.end is the text "0.2"; allowed: a number, > 0 [s]; remove the quotes.\n'
        ),
    ),
    CommonMistake(
        name="a number with its unit",
        old="cell = 1.0",
        new="cell = 1.0 m",
        message=(
            "error: {case}/case.toml:11:12: this is not TOML: Error while parsing key-value pair: expected a "
            "comment or whitespace, saw 'm'. Write numbers without units, and text in quotes. "
            "Correct the line; see https://toml.io for the syntax.\n"
        ),
    ),
    CommonMistake(
        name="a decimal comma",
        old="cell = 1.0",
        new="cell = 1,0",
        message=(
            "error: {case}/case.toml:11:9: this is not TOML: Error while parsing key-value pair: expected a "
            "comment or whitespace, saw ','. Write a decimal point, not a comma. Correct the line; see "
            "https://toml.io for the syntax.\n"
        ),
    ),
    CommonMistake(
        name="a key twice",
        old="end = 0.2",
        new="end = 0.2\nend = 0.3",
        message=(
            "error: {case}/case.toml:6:7: this is not TOML: Error while parsing key-value pair: cannot "
            "redefine existing floating-point 'end'. A table contains a key only once. Correct the line; see "
            "https://toml.io for the syntax.\n"
        ),
    ),
    CommonMistake(
        name="a keyword misspelt",
        old='law = "mohr_coulomb"',
        new='law = "mohr-coulomb"',
        message=(
            "error: {case}/case.toml:20:7: material.rock.law is \"mohr-coulomb\"; did you mean 'mohr_coulomb'? "
            'Allowed: "elastic", "mohr_coulomb". Correct it, or leave it out for the default "mohr_coulomb".\n'
        ),
    ),
    CommonMistake(
        name="yes instead of true",
        old="elevation = 0.0",
        new='extend = "yes"',
        message=(
            'error: {case}/case.toml:17:10: terrain.extend is the text "yes"; allowed: true or false. '
            "Correct it, or leave it out for the default false.\n"
        ),
    ),
    CommonMistake(
        name="a fraction in percent",
        old="porosity = 0.3",
        new="porosity = 30",
        message=(
            "error: {case}/case.toml:32:12: body.block.porosity is 30; allowed: > 0 and <= 0.95 (porosity n "
            "at t = 0: volume fraction of ice and water); if it is in percent, it is 0.3. Correct it, or "
            "leave it out for the default 0.375.\n"
        ),
    ),
    CommonMistake(
        name="a temperature in kelvin",
        old="temperature = -10.0",
        new="temperature = 263.15",
        message=(
            "error: {case}/case.toml:31:15: body.block.temperature is 263.15; allowed: > -273.15 and <= 100 "
            "C (temperature at t = 0; depth is vertical, below the surface of the body [m]); if it is in kelvin, "
            "it is -10 C. Correct it, or leave it out for the default -10.0.\n"
        ),
    ),
    CommonMistake(
        name="a body without a name",
        old="[body.block]",
        new="[body]",
        message=(
            "error: {case}/case.toml:26:1: the case has no body; add a table [body.NAME] with its material "
            "and shape.\n"
            "{case}/case.toml:27:1: 'material' stands in [body], which needs a name; write [body.NAME] with "
            "a name of your choice above it.\n"
            "{case}/case.toml:28:1: 'shape' stands in [body], which needs a name; write [body.NAME] with a "
            "name of your choice above it.\n"
            "{case}/case.toml:29:1: 'min' stands in [body], which needs a name; write [body.NAME] with a "
            "name of your choice above it.\n"
            "{case}/case.toml:30:1: 'max' stands in [body], which needs a name; write [body.NAME] with a "
            "name of your choice above it.\n"
            "{case}/case.toml:31:1: 'temperature' stands in [body], which needs a name; write [body.NAME] "
            "with a name of your choice above it.\n"
            "{case}/case.toml:32:1: 'porosity' stands in [body], which needs a name; write [body.NAME] with "
            "a name of your choice above it.\n"
        ),
    ),
    CommonMistake(
        name="a material that does not exist",
        old='material = "rock"',
        new='material = "rocks"',
        message=(
            "error: {case}/case.toml:27:12: body.block.material is 'rocks', and there is no "
            "[material.rocks]; did you mean 'rock'? Allowed: rock.\n"
        ),
    ),
    CommonMistake(
        name="three numbers in 2D",
        old="min = [0.0, -2.0]",
        new="min = [0.0, 0.0, -2.0]",
        message=(
            "error: {case}/case.toml:12:7: grid.min is an array of 3 numbers; allowed: 2 numbers, as "
            "case.dimension is 2.\n"
        ),
    ),
    CommonMistake(
        name="a domain of no whole number of cells",
        old="max = [20.0, 10.0]",
        new="max = [20.5, 10.0]",
        message=(
            "error: {case}/case.toml:13:7: the domain is 20.5 m long along x, which is 20.5 cells of 1 m; "
            "allowed: a whole number. Move grid.max along x to 21.\n"
        ),
    ),
    CommonMistake(
        name="a body outside the domain",
        old="max = [14.0, 3.0]",
        new="max = [24.0, 3.0]",
        message=(
            "error: {case}/case.toml:30:7: body.block reaches from (10, 0) to (24, 3), outside the domain, "
            "which is (0, -2) to (20, 10); move the body, or widen grid.min and grid.max.\n"
        ),
    ),
    CommonMistake(
        name="a body below the ground",
        old="min = [10.0, 0.0]",
        new="min = [10.0, -1.0]",
        message=(
            "error: {case}/case.toml:29:7: body.block is below the terrain: at x = 10 m its elevation is -1 "
            "m and the ground's 0 m; allowed: on the ground or above it. Lift the body, or lower the "
            "terrain.\n"
        ),
    ),
    CommonMistake(
        name="a step too long",
        old="step = 0.001",
        new="step = 0.01",
        message=(
            "error: {case}/case.toml:6:8: time.step is 0.01 s, above the limit of 0.00444 s set by the "
            "elastic wave of material 'rock' (225 m/s) on cells of 1 m, with a Young's modulus of 1e+08 Pa and "
            "2,200 kg/m3. Use a smaller time.step, or "
            'time.stepping = "adaptive".\n'
        ),
    ),
    CommonMistake(
        name="a file that does not exist",
        old='type = "flat"\nelevation = 0.0',
        new='type = "profile"\nfile = "profil.csv"',
        message=(
            'error: {case}/case.toml:17:8: terrain.file is "profil.csv": no such file ({case}); did you mean '
            "'profile.csv'? Allowed: a file, relative to the folder of the case file.\n"
        ),
        files={"profile.csv": "distance_m,terrain_elevation_m\n0,0\n20,0\n"},
    ),
    CommonMistake(
        name="a profile with semicolons",
        old='type = "flat"\nelevation = 0.0',
        new='type = "profile"\nfile = "profile.csv"',
        message=(
            "error: {case}/case.toml:17:8: terrain.file: {case}/profile.csv:1: the header is "
            "'distance_m;terrain_elevation_m'; allowed: "
            "distance_m,terrain_elevation_m[,surface_elevation_m], separated by commas.\n"
        ),
        files={"profile.csv": "distance_m;terrain_elevation_m\n0;0\n20;0\n"},
    ),
]
