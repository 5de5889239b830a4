"""Page of `./run paper`: figures with summaries of the paper, sentences with verdicts, and runs."""

from __future__ import annotations

import html
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

from reproduction import block, freezing, incline, lamplugh, lamplugh_figures, old_capacity, stages
from reproduction.sentences import MEANINGS, VERDICTS, filled, sentences, table
from thawslide.errors import NotInRunError, ReportError
from thawslide.figures.motion import motion
from thawslide.figures.snapshots import pore_pressure, temperature
from thawslide.figures.style import without_title
from thawslide.pages import markup
from thawslide.run_folder import Run

Runs = dict[str, Run]
_DPI = 150
_OWN: dict[str, Callable[[Runs], Figure]] = {
    "figure-4": freezing.figure_4,
    "figure-6": block.figure_6,
    "figure-7": block.figure_7,
    "figure-9": incline.figure_9,
    "figure-10": incline.figure_10,
    "figure-11": incline.figure_11,
    "figure-14": lamplugh_figures.figure_14,
    "figure-15": lamplugh_figures.figure_15,
    "figure-17": lamplugh_figures.figure_17,
    "figure-20": lamplugh_figures.figure_20,
    "lamplugh-block": lamplugh.figure_blocks,
    "deposit": lamplugh.figure_deposit,
}
# Figures of any report, of the Lamplugh run.
_SHARED = {"figure-16": motion, "figure-18": temperature, "figure-19": pore_pressure}
NAMES = (*_OWN, *_SHARED)


def draw(name: str, runs: Runs) -> Figure:
    """Return one figure by its name."""
    return _SHARED[name](runs["lamplugh"]) if name in _SHARED else _OWN[name](runs)


def measure(runs: Runs) -> dict[str, float]:
    """Return all numbers of texts and tests, by name."""
    bars = {name: run for name, run in runs.items() if name.startswith("freezing-bar")}
    found = freezing.measures(bars) | old_capacity.measures()
    for section in (block, incline, lamplugh, stages):
        found |= section.measures(runs)
    return found


def make_page(runs: Runs, output: Path, quick: bool, progress: Callable[[str], None]) -> Path:
    """Write figures/NAME.png, measures.csv and report.html below `output`; return the page."""
    try:
        (output / "figures").mkdir(parents=True, exist_ok=True)
        for name in NAMES:
            try:
                without_title(draw(name, runs)).savefig(output / "figures" / f"{name}.png", dpi=_DPI)
                progress(f"{name}: plotted")
            except NotInRunError as error:
                progress(f"{name}: not available: {error}")
        measures = measure(runs)
        rows = "".join(f"{name},{float(value)!r}\n" for name, value in measures.items())
        (output / "measures.csv").write_text("measure,value\n" + rows, encoding="utf-8")
        page = output / "report.html"
        page.write_text(_page(runs, measures, output, quick), encoding="utf-8")
    except OSError as error:
        raise ReportError(
            f"{error.filename or output}: cannot be written ({error.strerror or error}). Select another --output."
        ) from error
    return page


def _page(runs: Runs, measures: dict[str, float], output: Path, quick: bool) -> str:
    parts = ["<h1>The paper and Thawslide</h1>"]
    if quick:
        parts.append(
            '<p class="note">Shortened runs: first steps of each case. Figures and verdicts are not meaningful.</p>'
        )
    links = [(row["name"], row["heading"]) for row in table("figures")]
    parts.append(
        "<nav>" + " · ".join(f'<a href="#{name}">{html.escape(words)}</a>' for name, words in links)
        + ' · <a href="#sentences">Sentences</a> · <a href="#runs">Runs</a></nav>'
    )  # fmt: skip
    for row in table("figures"):
        parts += _figure(row, measures, output)
    parts += _sentences(measures)
    parts += _runs(runs)
    return markup.page_frame("The paper and Thawslide", "\n".join(parts))


def _figure(row: dict[str, str], measures: dict[str, float], output: Path) -> list[str]:
    link = f"figures/{row['name']}.png"
    parts = [f'<h2 id="{row["name"]}">{html.escape(row["heading"])}</h2>']
    if (output / link).is_file():
        parts.append(f'<figure><a href="{link}"><img src="{link}" alt="{html.escape(row["heading"])}"></a></figure>')
    for words, key in (("Paper", "paper"), ("Thawslide", "result"), ("Differences", "why")):
        parts.append(f"<p><b>{words}.</b> {html.escape(filled(row[key], measures))}</p>")
    return parts


def _sentences(measures: dict[str, float]) -> list[str]:
    found = sentences(measures)
    count = Counter(sentence.verdict for sentence in found)
    tally = ", ".join(f"{count[key]} {words}" for key, words in VERDICTS.items())
    rows = ((row.section, row.text, row.reported, row.result, VERDICTS[row.verdict]) for row in found)
    return [
        '<h2 id="sentences">Sentences with a number or an ordering</h2>',
        f"<p>Abstract and Sections 3.1 to 4.2: {len(found)} sentences, {tally}. Each verdict is computed from "
        "the runs or from a closed form. The words of the paper have the same numerical meaning in all sentences:</p>",
        "<ul>" + "".join(f"<li>{html.escape(line)}</li>" for line in MEANINGS) + "</ul>",
        markup.table(rows, "wide", ("Section", "Sentence", "Claim", "Thawslide", "Verdict")),
    ]


def _runs(runs: Runs) -> list[str]:
    lines = []
    for name, run in runs.items():
        facts = run.facts
        wall = facts.get("wall_s")
        cells = (run.title, str(facts.get("status", "")), f"{wall:.0f} s" if isinstance(wall, (int, float)) else "")
        lines.append(
            f"<tr><td>{html.escape(name)}</td>" + "".join(f"<td>{html.escape(c)}</td>" for c in cells) + "</tr>"
        )
    return ['<h2 id="runs">Runs</h2>', '<table class="facts">', *lines, "</table>"]
