"""Files of observations: units, defaults, and mistakes with file, line, found and allowed values."""

from pathlib import Path

import pytest

from thawslide.errors import ReportError
from thawslide.scores.observed import read_observed
from thawslide.scores.quantities import QUANTITIES, TABLES
from thawslide.sweeps.labels import NUMBERS

OUTLINE = '[outline]\nfile = "outline.geojson"\n'
DISTANCE = '[travel_distance]\nvalue = 4.2\nunit = "km"\n'
POINT = '[[thickness]]\nname = "A"\nx = 1\ny = -2\nvalue = 3\nunit = "m"\n'
MISTAKES = {
    "": ": no observation (allowed tables: release_volume, travel_distance,",
    '[event]\nname = "A"\n': ": no observation (allowed tables:",
    "[travel_distance\n": ":1: not valid TOML (",
    "a = 1\n": ":1: a: unknown table. Allowed: event, release_volume,",
    "\n[travel_distanc]\nvalue = 1\n": ":2: travel_distanc: unknown table; did you mean travel_distance? Allowed:",
    "travel_distance = 4000\n": ":1: travel_distance: not a table (found '4000'; allowed keys: value, unit,",
    f"{DISTANCE}# a\nsourc = 'x'\n": ":5: travel_distance.sourc: unknown key; did you mean source? Allowed: value,",
    "[travel_distance]\nvalue = 4.2\n": ":1: travel_distance: no key unit (found value). Correct it.",
    "[travel_distance]\nvalue = '4'\nunit = 'km'\n":
        ":2: travel_distance.value: invalid (found '4'; allowed: finite numbers of at least 0). Correct it.",
    "[travel_distance]\nunit = 'km'\nvalue = inf\n": ":3: travel_distance.value: invalid (found 'inf'; allowed: finite",
    "[travel_distance]\nunit = 'km'\nvalue = -3\n": ":3: travel_distance.value: invalid (found '-3'; allowed: finite",
    "[travel_distance]\nunit = 'km'\nvalue = 0\n": ":3: travel_distance.value: invalid (found 0; allowed: positive",
    "[travel_distance]\nvalue = 4.2\nunit = 'miles'\n":
        ":3: travel_distance.unit: unknown unit (found 'miles'; allowed: m, km, cm). Correct it.",
    "travel_distance = { value = 4, unit = 3 }\n": ":1: travel_distance.unit: invalid (found '3'; allowed: a text).",
    f"{DISTANCE}uncertainty = -1\n": ":4: travel_distance.uncertainty: invalid (found '-1'; allowed: finite numbers of",
    "[event]\nname = 'A'\nkind = 'snow'\n": ":3: event.kind: invalid (found 'snow'; allowed: rock).",
    POINT.replace("[[", "[").replace("]]", "]"): ":1: thickness: not an array of tables (allowed: [[thickness]]).",
    f"{POINT}{POINT}": ":8: thickness.name: two points have the name 'A'. Correct it.",
    f"{POINT}\n{POINT.replace('x = 1', 'x = nan')}": ":10: thickness.x: invalid (found 'nan'; allowed: finite numbers)",
    "[outline]\nfile = 'no.gpkg'\n": ":2: outline.file: no such file (found '",
    f"{OUTLINE}area = 'all'\n": ":3: outline.area: invalid (found 'all'; allowed: affected, deposit).",
    "[force_record]\nfile = 'f.csv'\nperiods = [200, 10]\n":
        ":3: force_record.periods: invalid (found '[200, 10]'; allowed: two positive numbers [s], the shorter first).",
    "[force_record]\nfile = 'f.csv'\n": ":1: force_record: no key periods (found file). Correct it.",
}  # fmt: skip


@pytest.mark.parametrize("text", MISTAKES)
def test_mistakes_are_named_with_their_line(tmp_path: Path, text: str) -> None:
    (tmp_path / "outline.geojson").touch()
    file = tmp_path / "observed.toml"
    file.write_text(text)
    with pytest.raises(ReportError) as error:
        read_observed(file)
    assert str(error.value).startswith(f"{file}{MISTAKES[text]}"), str(error.value)


def test_values_are_converted_and_paths_are_relative_to_the_file(tmp_path: Path) -> None:
    (tmp_path / "outline.geojson").touch()
    (tmp_path / "force.csv").write_text("time_s,up_N,north_N,east_N\n0,0,0,0\n1,5,1,2\n")
    file = tmp_path / "observed.toml"
    point = POINT + 'of = "maximum"\n'
    record = '[force_record]\nfile = "force.csv"\nperiods = [10, 200]\n'
    file.write_text(f'{DISTANCE}uncertainty = 0.1\n{OUTLINE}{point}{record}[h_over_l]\nvalue = 28\nunit = "%"\n')
    found = read_observed(file)
    distance, ratio, thickness = found.numbers
    assert (distance.name, distance.value, distance.uncertainty, distance.factor) == ("travel_distance", 4200, 100, 1e3)
    assert ratio.value == pytest.approx(0.28) and (thickness.words, thickness.point) == ("thickness at A", (1.0, -2.0))
    assert not thickness.is_deposit and found.outline is not None and not found.outline.is_deposit
    assert found.outline.file == tmp_path / "outline.geojson" and found.outline.threshold is None
    assert found.record is not None and found.record.band.longest == 200.0


def test_quantities_are_columns_of_members_and_on_the_page() -> None:
    computed = {"duration_s", "mean_speed_m_s"}
    assert {quantity.column for quantity in QUANTITIES.values()} - computed <= NUMBERS.keys()
    assert set(QUANTITIES) < set(TABLES)
    page = (Path(__file__).parents[2] / "docs" / "how-to" / "score-a-forecast.md").read_text(encoding="utf-8")
    assert [name for name in TABLES if f"`[{name}]`" not in page and f"`[[{name}]]`" not in page] == []
