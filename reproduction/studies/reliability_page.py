"""The text of docs/reliability.md, from the results of its parts."""

from __future__ import annotations

import json
import re
import textwrap
from pathlib import Path
from typing import Any

KINDS = {
    ("once", "io"): "that call alone (input/output error)",
    ("onwards", "full"): "that call and all after it (disk full)",
    ("onwards", "denied"): "that call and all after it (permission denied)",
    ("size", "size"): "file size limited to 1 to 20 kB (`ulimit -f`)",
    ("disk", "disk"): "disk limited to 8 to 200 kB (tmpfs), until there is space",
    ("short", "full"): "half of the data of that call is written, and nothing after it (disk full)",
}


def paragraph(text: str) -> str:
    """Return a paragraph, wrapped for a page."""
    return textwrap.fill(text, 118, break_on_hyphens=False, break_long_words=False) + "\n"


def head() -> str:
    """Return the introduction of the page."""
    return "# Reliability\n\n" + paragraph(
        "This page reports how a run behaves when its process is killed, its disk fills up, or its files are damaged. "
        "`scripts/pages --only reliability` runs the tests and generates the page. Most of its time is fuzzing. "
        "`./test` contains a sample of each part. [Stop and resume](reference/stop-and-resume.md) explains how to "
        "continue a run that has stopped."
    )


def findings_text(rows: list[dict[str, Any]]) -> str:
    """Return the list of findings; empty if there are none."""
    findings = [finding for row in rows for finding in row["findings"]]
    if not findings:
        return ""
    lines = [f"- {finding}" for finding in findings[:20]]
    return f"\n{len(findings)} findings, of which:\n\n" + "\n".join(lines) + "\n"


def kills_text(found: dict[str, Any]) -> str:
    """Return the section on killed runs."""
    rows = found["rows"]
    lines = [
        f"| {row['subject']} | {row['seconds']:.0f} | {row['trials']} | {row['killed']} | {row['passed']} |\n"
        for row in rows
    ]
    trials, passed = sum(row["trials"] for row in rows), sum(row["passed"] for row in rows)
    return (
        "## Kills\n\n"
        + paragraph(
            "Each run is killed (SIGKILL) at a random moment, from its first millisecond on, and then resumed with "
            "`thawslide resume`. A run that was killed before it had read its case is started again. Every file "
            "must be "
            "identical to that of an undisturbed run: history, probes, maps and checkpoint byte for byte, "
            "snapshots and "
            "index in every number. Only `run.json`, which describes processes, may differ."
        )
        + "\n| case | seconds a run | runs | killed before their end | ended bitwise identical |\n"
        + "|---|---|---|---|---|\n"
        + "".join(lines)
        + f"\n{passed} of {trials} ended with bitwise identical files, without any manual repair.\n"
        + findings_text(rows)
    )


def writes_text(found: dict[str, Any]) -> str:
    """Return the section on calls that fail."""
    rows = found["rows"]
    lines = [
        f"| {row['subject']} | {KINDS[(row['kind'], row['reason'])]} | {row['trials']} of {row['calls']:,} |"
        f" {row['passed']} |\n"
        for row in rows
    ]
    return (
        "## Writing that fails\n\n"
        + paragraph(
            "Each system call by which a run changes its folder is made to fail in turn: open, write, truncate, "
            "synchronize, rename, make a folder. In 3D, with thousands of calls for maps alone, every 41st call fails. "
            "The run must end with an error that names the file, or continue if nothing is lost. With disk space "
            "available again, it is resumed and must end bitwise identical to the undisturbed run."
        )
        + "\n| case | failure | tried | passed |\n|---|---|---|---|\n"
        + "".join(lines)
        + findings_text(rows)
    )


def corruption_text(found: dict[str, Any]) -> str:
    """Return the section on damaged checkpoints."""
    row = found["rows"][0]
    return (
        "## Damaged checkpoints\n\n"
        + paragraph(
            f"One bit of one byte is changed in both checkpoints of a run that was killed, at {row['changed']:,} "
            f"of their {row['bytes']:,} bytes. Detected and refused: {row['detected']:,}. If only the newer "
            "one is damaged, the run continues from the other (`tests/cli/resume_test.py`)."
        )
        + findings_text(found["rows"])
    )


def mistakes_text(found: dict[str, Any]) -> str:
    """Return the section on wrong case files."""
    row = found["rows"][0]
    return (
        "## Wrong case files\n\n"
        + paragraph(
            f"Each of {row['cases']} case files has one error: a parameter with a value of another type, out of its "
            "range, with an unknown option, or misspelt. All parameters are tested. Each file must be refused "
            "with code "
            "2 before anything is written. The message must state file and line, the value found and the values "
            f"allowed. Files without such a message: {len(row['findings'])}. Whole messages are "
            "tested in `tests/cpp/config` and `tests/cli/mistakes_test.py`."
        )
        + findings_text(found["rows"])
    )


def commit_of(version: str) -> str:
    """Return the commit of a version."""
    named = re.search(r"commit (\w+)", version)
    return named.group(1)[:7] if named else version


def fuzzing_text(found: dict[str, Any]) -> str:
    """Return the section on random input."""
    rows = found["rows"]
    lines = [
        f"| `{row['target']}` | {row['seconds'] / 60:.1f} | {row['executions']:,} | {row['covered']:,} |"
        f" {len(row['own'])} | {len(row['library'])} | {commit_of(row.get('version', found['version']))} |\n"
        for row in rows
    ]
    findings = [
        f"- `{row['target']}`, {whose}, {count} times: {words}\n"
        for whose, of in (("in Thawslide", "own"), ("in a library", "library"))
        for row in rows
        for words, count in row[of].items()
    ]
    return (
        "## Fuzzing\n\n"
        + paragraph(
            "Readers of files that users write get random bytes, guided by code coverage. The programs are built "
            "with libFuzzer and the address and undefined-behaviour sanitizers; readers in Python use atheris. "
            "`tests/fuzz/README.md` lists the targets. A reader must return a value, or an error that names the file, "
            "within a few seconds and a few gigabytes."
        )
        + "\n| target | processor minutes | inputs tried | edges covered | findings in Thawslide | in libraries "
        + "| commit |\n"
        + "|---|---|---|---|---|---|---|\n"
        + "".join(lines)
        + ("\n" + "".join(findings) if findings else "")
    )


def soak_text(found: dict[str, Any]) -> str:
    """Return the section on a million steps."""
    row = found["rows"][0]
    same = "bitwise identical" if row["same_bits"] else "NOT bitwise identical"
    lines = [
        f"| maximum {what} | {of['first'][name]:.4g} J | {of['second'][name]:.4g} J |\n"
        for title, of in (("", row["energies"]), (", without viscosity", row["without_viscosity"]))
        for what, name in (
            (f"kinetic energy{title}", "kinetic_J"),
            (f"strain energy{title}", "strain_J"),
            (f"residual of the mechanical energy{title}", "mechanical_residual_J"),
        )
    ]
    bounded = "bounded" if row["energies"]["bounded"] else "NOT bounded"
    without = "bounded" if row["without_viscosity"]["bounded"] else "not bounded"
    return (
        "## A million steps\n\n"
        + paragraph(
            f"A block of {row['particles']} particles rests on level ground for {row['steps']:,} steps, in two "
            f"simultaneous runs ({row['wall_s']:.0f} s each), with a viscosity_time of 0.002 s. History and checkpoint "
            f"of the two runs are {same}. Memory: {row['memory_after_a_tenth_kB'] / 1024:.1f} MB after a tenth of "
            f"the steps, {row['memory_at_the_end_kB'] / 1024:.1f} MB at the end."
        )
        + "\n| quantity | in the first tenth | in the second half |\n|---|---|---|\n"
        + "".join(lines)
        + "\n"
        + paragraph(
            f"With viscosity, energy is {bounded}. The criterion is at most 1.5 times the energy of the first tenth in "
            "the second half. "
            f"Without viscosity it is {without}: an undamped elastic body flutters, and its energy grows with the "
            f"steps. "
            + (
                "The run warns of energy growth without a physical cause ([guards](reference/guards.md))."
                if row["warning_without_viscosity"]
                else f"That run ended with code {row['code_without_viscosity']}."
            )
        )
    )


TEXTS = {
    "kills": kills_text,
    "writes": writes_text,
    "corruption": corruption_text,
    "mistakes": mistakes_text,
    "fuzzing": fuzzing_text,
    "soak": soak_text,
}


def duration_text(seconds: float) -> str:
    """Return a duration in whole minutes."""
    minutes = round(seconds / 60)
    if minutes == 0:
        return "less than a minute"
    return f"{minutes} minute" if minutes == 1 else f"{minutes} minutes"


def made_text(name: str, found: dict[str, Any]) -> str:
    """Return the version of the program and the run time of a part."""
    if name == "fuzzing":  # targets can be of different versions
        return f"{sum(row['seconds'] for row in found['rows']) / 3600:.1f} hours of processor time"
    return f"{found['version']}, {duration_text(found['wall_s'])}"


def write_page(results: Path, page: Path) -> None:
    """Write the page; it names parts that have not been run."""
    parts = [head()]
    for name, text in TEXTS.items():
        file = results / f"{name}.json"
        found = json.loads(file.read_text()) if file.exists() else None
        parts.append(
            text(found) + f"\n*{made_text(name, found)}.*\n"
            if found
            else f"## {name.capitalize()}\n\nThis part has not been run.\n"
        )
    page.write_text("\n".join(parts))
