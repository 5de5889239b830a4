"""Interactive plots of a page in headless Chromium without a network: slider, fields, hover."""

import html
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from conftest import MakeRun, page_of

from thawslide.pages.markup import page_frame, table

CHROMIUM = next(
    (path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), ""
)
pytestmark = pytest.mark.skipif(not CHROMIUM, reason="Chromium not found. Install the package chromium.")
# Records the state of the plot after each action of a user; the mouse points at the given place of the plot.
PROBE = """
<script>
(async () => {
  const found = { errors: [] };
  window.addEventListener("error", (event) => found.errors.push(event.message));
  window.addEventListener("securitypolicyviolation", (event) => found.errors.push(event.blockedURI));
  const pause = (time) => new Promise((done) => setTimeout(done, time));
  while (document.body.dataset.plots !== "ready") await pause(50);
  const get = (name) => document.getElementById(name);
  const act = async (name, value, event) => {
    get(name).value = value;
    get(name).dispatchEvent(new Event(event));
    await pause(300);
  };
  const hover = async (name, x, y) => {
    const plot = get(name), { xaxis, yaxis } = plot._fullLayout, box = plot.getBoundingClientRect();
    const place = {
      clientX: box.left + xaxis._offset + xaxis.d2p(x), clientY: box.top + yaxis._offset + yaxis.d2p(y), bubbles: true,
    };
    const target = plot.querySelector(".nsewdrag");
    for (const event of ["mouseover", "mousemove"]) target.dispatchEvent(new MouseEvent(event, place));
    await pause(500);
    return plot.querySelector(".hoverlayer").textContent;
  };
  for (const part of document.querySelectorAll("details")) part.open = true;
  await pause(500);
  found.widths = [...document.querySelectorAll(".js-plotly-plot")].map((plot) => plot._fullLayout.width);
  const last = () => get("view").data.at(-1);
  ACTIONS
  found.resources = performance.getEntriesByType("resource").map((entry) => entry.name.slice(0, 60));
  document.body.dataset.found = JSON.stringify(found);
})();
</script>
"""

MEASURE = """
<script>
addEventListener("load", async () => {
  const page = document.getElementById("page").contentDocument, root = page.documentElement;
  while (page.getElementById("plotly") && page.body.dataset.plots !== "ready") {
    await new Promise((done) => setTimeout(done, 50));
  }
  for (const part of page.querySelectorAll("details")) part.open = true;
  const wide = [root, ...page.querySelectorAll("body, table, tr, th, td")].filter((each) =>
    each.getClientRects().length && each.scrollWidth > each.clientWidth + 1);
  const cells = [...page.querySelectorAll("tr:last-child td")].filter((each) => each.getClientRects().length);
  const names = cells.map((each) => page.defaultView.getComputedStyle(each, "::before").content);
  document.body.dataset.found = JSON.stringify({
    width: root.clientWidth,
    wide: wide.map((each) => each.outerHTML.slice(0, 200)),
    names: names.filter((each) => each !== "none").slice(-5),
    plots: page.querySelectorAll(".js-plotly-plot").length,
    buttons: page.querySelectorAll(".modebar-btn").length,
  });
});
</script>
"""


def recorded(page: str, tmp_path: Path, *options: str) -> dict[str, Any]:
    """Return the JSON that the scripts of a page record."""
    path = tmp_path / "page.html"
    path.write_text(page, encoding="utf-8")
    outcome = subprocess.run(
        [
            CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'profile'}",
            *options, "--virtual-time-budget=60000", "--dump-dom", path.as_uri(),
        ],
        capture_output=True, text=True, timeout=600, check=True,
    )  # fmt: skip
    match = re.search(r'data-found="([^"]*)"', outcome.stdout)
    assert match, outcome.stderr[-2000:]
    found: dict[str, Any] = json.loads(html.unescape(match[1]))
    return found


def states(folder: Path, tmp_path: Path, actions: str) -> dict[str, Any]:
    page = page_of(folder).replace("</body>", PROBE.replace("ACTIONS", actions) + "</body>")
    offline = ["--proxy-server=127.0.0.1:9", "--host-resolver-rules=MAP * ~NOTFOUND"]
    found = recorded(page, tmp_path, *offline, "--window-size=1200,2400")
    assert found["errors"] == []
    assert found["widths"] and min(found["widths"]) > 1000, "plots of a part that opens have the width of the page"
    assert all(name.startswith(("data:", "blob:")) for name in found["resources"]), "the page loads nothing"
    return found


@pytest.mark.parametrize("style", ["runs wide members", "runs wide", "facts wide", "facts", "numbers", "wide"])
def test_tables_fit_a_narrow_screen(tmp_path: Path, style: str) -> None:
    """Each row of a wide table is then a list, in which the values have the names of their columns."""
    head = ("result", "column", "unit", "mean", "SD", "P10", "P50", "P90") if "wide" in style else ("key", "value")
    row = ("maximum seismic force", "material.rock_ice.hydraulic_conductivity", "N", *["9,700,000"] * 5)
    found = measured_narrow(page_frame("A page", table([row[: len(head)]] * 3, style, head)), tmp_path)
    assert found["width"] == 390 and found["wide"] == []
    assert found["names"] == ([f'"{name} "' for name in head[-5:]] if "wide" in style else [])


def test_report_fits_a_narrow_screen(map_run: Path, tmp_path: Path) -> None:
    found = measured_narrow(page_of(map_run), tmp_path)
    assert found["width"] == 390 and found["wide"] == []
    assert found["plots"] == 2 and found["buttons"] == 0, "buttons would cover the legends"


def measured_narrow(page: str, tmp_path: Path) -> dict[str, Any]:
    """Return the width of a page on a screen of 390 px, what scrolls, names of columns, and the number of plots."""
    frame = f'<iframe id="page" style="width: 390px; border: 0" srcdoc="{html.escape(page)}"></iframe>'
    return recorded(frame + MEASURE, tmp_path, "--hide-scrollbars")


def test_section_view_follows_slider_and_field(make_run: MakeRun, tmp_path: Path) -> None:
    actions = """
  found.fields = [...get("view-field").options].map((option) => option.text);
  await act("view-time", 0, "input");
  found.start = { x: last().x[0], text: get("view-time-text").textContent };
  await act("view-time", 10, "input");
  found.end = { x: last().x[0], text: get("view-time-text").textContent, colour: last().marker.color[0] };
  found.hover = await hover("view", last().x[0], last().y[0]);
  found.exaggeration = get("view-exaggeration").textContent;
  await act("view-field", found.fields.indexOf("temperature"), "change");
  found.bar = last().marker.colorbar.title.text;
  get("view-follow").click();
  await pause(500);
  found.range = get("view").layout.xaxis.range;
    """
    found = states(make_run(), tmp_path, actions)
    assert found["fields"][:2] == ["speed", "flow thickness"]
    assert (found["start"]["text"], found["end"]["text"]) == ("0 s", "10 s")
    assert found["end"]["x"] - found["start"]["x"] == pytest.approx(120.0, abs=0.1)
    assert re.search(r"speed: [\d.]+ m/s.*distance 14\d m.*elevation \d+ m", found["hover"], re.DOTALL), found["hover"]
    assert found["bar"] == "temperature (°C)" and float(found["exaggeration"]) > 0.0
    low, high = found["range"]
    assert 130.0 < low < 140.5 < 159.5 < high < 170.0, "around the mass at 10 s"


def test_map_view_follows_slider_and_field(map_run: Path, tmp_path: Path) -> None:
    actions = """
  const covered = () => {
    const field = get("view").data[0], columns = new Set();
    field.z.forEach((row) => row.forEach((value, column) => value !== null && columns.add(column)));
    return field.x0 + field.dx * Math.min(...columns);
  };
  found.fields = [...get("view-field").options].map((option) => option.text);
  await act("view-time", 0, "input");
  found.start = covered();
  await act("view-time", 5, "input");
  found.end = covered();
  found.hover = await hover("view", 400.32, 380.13);
  await act("view-time", 0, "input");
  get("view-play").click();
  found.playing = get("view-play").textContent;
  await act("view-field", found.fields.indexOf("maximum speed"), "change");
  await pause(1000);
  found.paused = [get("view-play").textContent, get("view-time").value];
  found.static = { text: get("view-time-text").textContent, disabled: get("view-time").disabled };
  found.staticHover = await hover("view", 400.2, 380.15);
  found.event = await hover("events", 36.5, 760 / 3080);
    """
    found = states(map_run, tmp_path, actions)
    assert {"flow thickness", "depth-averaged speed", "basal temperature", "arrival time"} <= set(found["fields"])
    assert found["end"] - found["start"] == pytest.approx(0.2, abs=0.011), "20 m/s for 10 s, in km"
    assert re.search(r"flow thickness: 6(\.\d*)? m.*easting 400\.\d+ km.*elevation 1,8\d\d m", found["hover"]), found
    assert found["static"] == {"text": "whole run", "disabled": True}
    assert found["playing"] == "Pause" and found["paused"] == ["Play", "0"]
    assert "maximum speed: 20 m/s" in found["staticHover"]
    assert "Frank 1903" in found["event"] and "Mitchell et al. (2019)" in found["event"]
