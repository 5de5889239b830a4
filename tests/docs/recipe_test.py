"""The friction law of CONTRIBUTING.md compiles in the list of laws and in the code that uses the list."""

import subprocess
from pathlib import Path

from snippets import ROOT, blocks_of

HEADER = "physics/basal/weakening_friction.hpp"
UNIT = '#include "terrain/basal_law.hpp"\n'  # evaluates all laws


def test_friction_law_of_the_recipe_fits_the_list(tmp_path: Path) -> None:
    (law,) = [block.text for block in blocks_of((ROOT / "CONTRIBUTING.md").read_text()) if block.language == "cpp"]
    laws = (ROOT / "src" / "physics" / "basal" / "laws.hpp").read_text()
    first = "using FrictionLaw = std::variant<"
    assert first in laws
    listed = laws.replace("#pragma once", f'#pragma once\n#include "{HEADER}"', 1)
    listed = listed.replace(f"{first}  //", f"{first}WeakeningFriction,", 1)
    folder = tmp_path / "physics" / "basal"
    folder.mkdir(parents=True)
    (tmp_path / HEADER).write_text(law)
    (folder / "laws.hpp").write_text(listed)
    (tmp_path / "unit.cpp").write_text(UNIT)
    flags = ["-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", f"-I{tmp_path}", f"-I{ROOT / 'src'}"]
    done = subprocess.run(["g++", *flags, tmp_path / "unit.cpp"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
